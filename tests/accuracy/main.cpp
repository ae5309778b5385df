// carom_accuracy: the tables of docs/accuracy.md, each after a line that names it. bench/accuracy-tables
// builds it and puts them there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/physics.hpp"
#include "accuracy/precision_cost.hpp"
#include "accuracy/response_accuracy.hpp"
#include "accuracy/rest.hpp"
#include "accuracy/speed.hpp"
#include "accuracy/systems.hpp"
#include "accuracy/wall_accuracy.hpp"

namespace carom::accuracy {
namespace {

constexpr const char* kUsage =
    "carom_accuracy [--queries N] [--collisions N] [--check-every N] [--length F]\n"
    "               [--only TABLE] [--kind TEXT]\n"
    "  --queries N      queries a kind (100000); 10000000 takes about half an hour for a table\n"
    "  --collisions N   collisions of the longest drift (10000000)\n"
    "  --check-every N  one query in N goes to the slow oracles as well (1000)\n"
    "  --length F       of the runs of physics, a share of the usual ones, from 0.01 (1, some 15 minutes)\n"
    "  --only TABLE     straight, curved, walls, seam, response, drift, systems, rest, precision, speed or\n"
    "                   physics; or a part of it: physics_gas, physics_dense, physics_velocities,\n"
    "                   physics_walls, physics_gravity, physics_cooling, physics_mixtures\n"
    "  --kind TEXT      of straight, curved and walls, only the kinds whose names have this in them\n";

constexpr double kShortest = 0.01;  // of --length: some runs need a few blocks for an error

struct Options {
    Effort effort{100000, 1000};
    std::int64_t collisions = 10000000;
    double length = 1;
    std::string only;
    std::string kind;
};

void print(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

/// True when the table, or all that it is a part of, is wanted; names it.
bool begin(const Options& options, const std::string& table) {
    if (!options.only.empty() && options.only != table && !table.starts_with(options.only + "_"))
        return false;
    print("table " + table + "\n");
    return true;
}

template <class Kind>
void print_times(const std::vector<Kind>& kinds, std::uint64_t seed, const Options& options) {
    print(tally_header());
    std::vector<Tally> tallies;
    for (const Kind& kind : kinds) {
        ++seed;
        if (kind.name.find(options.kind) == std::string::npos) continue;
        tallies.push_back(measure(kind, seed, options.effort));
        print(tally_line(tallies.back()));
        tallies.back().in_units = {};
        tallies.back().relative = {};
    }
    print(oracle_line(tallies));
}

void print_seam(const Effort& effort) {
    print(
        "| relative acceleration | queries | hits | verdict wrong | error in units, worst "
        "| jump against the quadratic, worst |\n| --- | ---: | ---: | ---: | ---: | ---: |\n");
    const std::vector<std::pair<double, double>> stretches = {{-300, -160}, {-160, -146}, {-146, -140},
                                                              {-140, -70},  {-70, -30},   {-30, -20},
                                                              {-20, -12},   {-12, -6},    {-6, -1}};
    std::uint64_t seed = 4000;
    for (const auto& [low, high] : stretches) {
        const Seam s = measure_seam(low, high, ++seed, effort.queries);
        print(fmt::format("| 1e{} to 1e{} | {} | {} | {} | {} | {} |\n", low, high, grouped(s.queries),
                          grouped(s.hits), s.verdicts_differ, brief(s.worst_in_units), brief(s.worst_seam)));
    }
}

void print_response(const Effort& effort) {
    print(response_header());
    std::uint64_t seed = 5000;
    for (const ResponseKind& kind : response_kinds()) {
        ResponseTally tally = measure(kind, ++seed, effort.queries);
        print(response_line(tally));
    }
    ResponseTally elastic = measure_bounce("off a wall, elastic", 1, ++seed, effort.queries);
    print(response_line(elastic));
    ResponseTally lossy = measure_bounce("off a wall, restitution 0 to 1", 0, ++seed, effort.queries);
    print(response_line(lossy));
}

void print_drift(std::int64_t most) {
    constexpr int kSeeds = 16;
    print(
        "| discs | collisions | change of energy, root mean square of 16 runs | largest | mean "
        "| bound: sigma of a random walk |\n| ---: | ---: | ---: | ---: | ---: | ---: |\n");
    std::vector<std::int64_t> counts;
    for (std::int64_t n = most; n >= 1000 && counts.size() < 4; n /= 10) counts.insert(counts.begin(), n);
    for (const int discs : {2, 256}) {
        std::vector<double> squares(counts.size()), largest(counts.size()), mean(counts.size());
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            const std::vector<double> changes = energy_changes(discs, counts, 6000 + seed);
            for (std::size_t i = 0; i < counts.size(); ++i) {
                squares[i] += changes[i] * changes[i] / kSeeds;
                mean[i] += changes[i] / kSeeds;
                largest[i] = std::max(largest[i], std::abs(changes[i]));
            }
        }
        for (std::size_t i = 0; i < counts.size(); ++i)
            print(fmt::format("| {} | {} | {} | {} | {} | {} |\n", discs, grouped(counts[i]),
                              brief(std::sqrt(squares[i])), brief(largest[i]), brief(mean[i]),
                              brief(random_walk(discs, counts[i]))));
    }
}

void print_precision() {
    print("| figure | double | double, read in float | float |\n| --- | ---: | ---: | ---: |\n");
    for (const PrecisionRow& row : measure_precision())
        print(fmt::format("| {} | {} | {} | {} |\n", row.figure, row.in_double, row.read_in_float,
                          row.in_float));
}

void print_rest() {
    print(rest_header());
    for (const RestCase& rest : rest_cases(true)) print(rest_line(rest, measure(rest)));
}

void print_systems() {
    print(systems_header());
    for (const auto& systems : {line_systems(), mass_systems(), bounce_systems(), billiard_systems(),
                                reversal_systems(), long_systems()})
        for (const System& system : systems) print(system_line(system, system.measure()));
}

void print_speed() {
    print(
        "| queries | hits | Carom, ns | Eigen, ns | Eigen / Carom | Eigen's answers that are wrong |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: |\n");
    for (const SpeedRow& row : compare_speed())
        print(fmt::format("| {} | {:.0f} % | {:.0f} | {:.0f} | {:.1f} | {:.2g} % |\n", row.mix,
                          100 * row.hits, row.carom_ns, row.eigen_ns, row.eigen_ns / row.carom_ns,
                          100 * row.eigen_wrong));
}

void print_physics(const Options& options) {
    std::string table;
    bool is_wanted = false;
    for (const PhysicsSystem& system : physics_systems()) {
        if (system.table != table) {
            table = system.table;
            is_wanted = begin(options, table);
            if (is_wanted) print(physics_header());
        }
        if (!is_wanted) continue;
        for (const Figure& figure : system.measure(system.long_run * options.length))
            print(physics_line(figure));
    }
}

void print_tables(const Options& options) {
    if (begin(options, "straight")) print_times(straight_kinds(), 1000, options);
    if (begin(options, "curved")) print_times(curved_kinds(), 2000, options);
    if (begin(options, "walls")) print_times(wall_kinds(), 3000, options);
    if (begin(options, "seam")) print_seam(options.effort);
    if (begin(options, "response")) print_response(options.effort);
    if (begin(options, "drift")) print_drift(options.collisions);
    if (begin(options, "rest")) print_rest();
    if (begin(options, "precision")) print_precision();
    if (begin(options, "systems")) print_systems();
    if (begin(options, "speed")) print_speed();
    print_physics(options);
}

/// False where an option is unknown or not a number above 0, or a length too short.
bool read(int argc, char** argv, Options& options) {
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        const std::int64_t number = std::atoll(argv[i + 1]);
        if (name == "--only" || name == "--kind") {
            (name == "--only" ? options.only : options.kind) = argv[i + 1];
            continue;
        }
        if (name == "--length") {
            options.length = std::atof(argv[i + 1]);
            if (!(options.length >= kShortest)) return false;
            continue;
        }
        if (number <= 0) return false;
        if (name == "--queries") {
            options.effort.queries = number;
        } else if (name == "--check-every") {
            options.effort.check_every = number;
        } else if (name == "--collisions") {
            options.collisions = number;
        } else {
            return false;
        }
    }
    return argc % 2 == 1;
}

}  // namespace
}  // namespace carom::accuracy

int main(int argc, char** argv) {
    carom::accuracy::Options options;
    if (argc == 2 && std::string(argv[1]) == "--help") {
        std::fputs(carom::accuracy::kUsage, stdout);
        return 0;
    }
    if (!carom::accuracy::read(argc, argv, options)) {
        std::fputs(carom::accuracy::kUsage, stderr);
        return 2;
    }
    carom::accuracy::print_tables(options);
}
