// carom_price: what each feature of a scene costs over the plain elastic gas, and what setting up costs over
// running. Ratios of neighbouring measurements; docs/performance.md has the tables, by bench/price-tables.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <carom/broadphase/placement.hpp>
#include <carom/parallel/world.hpp>

#include "price_features.hpp"
#include "table.hpp"

namespace carom::bench {
namespace {

constexpr const char* kUsage =
    "carom_price [features|setup] [--balls N] [--packing F] [--rounds N] [--only TEXT] [--markdown]\n"
    "  features        the price of each feature (10000 balls, 9 rounds)\n"
    "  setup           from a scene to its first event (1000000 balls, 3 rounds)\n"
    "  --balls N       of the gas\n"
    "  --packing F     of the gas (0.5)\n"
    "  --rounds N      of which the median counts\n"
    "  --only TEXT     only the features whose names have this in them\n"
    "  --markdown      for a page, each table after a line that names it\n"
    "On one thread. Without a first word both tables.\n";

struct Options {
    bool features = true;
    bool setup = true;
    double balls = 0;  // 0: each table's own
    double packing = 0.5;
    int rounds = 0;  // the same
    std::string only;
    bool markdown = false;
};

double seconds_of(auto&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

double collisions_of(const Counts& counts) {
    return static_cast<double>(counts.ball_collisions + counts.wall_collisions);
}

// ---- The price of features.

constexpr double kSettled = 1;   // mean free times, until caches are warm and windows have their length
constexpr double kMeasured = 4;  // more of them

/// Time and events of a stretch that starts from the same state each time.
struct Stretch {
    double seconds = 0, collisions = 0, events = 0;
    [[nodiscard]] double time_of_collision() const { return seconds / collisions; }
    [[nodiscard]] double time_of_event() const { return seconds / events; }
};

void run(World& world, double duration, const Running& how) {
    const double end = world.time() + duration;
    while (how.frame > 0 && world.time() + how.frame < end) {
        world.step(how.frame);
        if (how.reads) (void)world.positions();
    }
    world.advance_to(end);
}

Stretch measure(const Scene& scene, const Running& how, double free_time) {
    World world(scene, {.threads = 1});
    double impulses = 0;
    if (how.listens) world.on_collision([&impulses](const Collision& c) { impulses += c.impulse; });
    run(world, kSettled * free_time, how);
    const Counts before = world.counts();
    Stretch s;
    s.seconds = seconds_of([&] { run(world, kMeasured * free_time, how); });
    s.collisions = collisions_of(world.counts()) - collisions_of(before);
    s.events = static_cast<double>(world.counts().events - before.events);
    if (how.listens && !(impulses > 0)) throw std::logic_error("the listener was not called");
    return s;
}

std::vector<std::string> parts_of(const std::string& description) {
    std::vector<std::string> parts(1);
    for (const char c : description) {
        if (c == ',' || c == ';')
            parts.emplace_back();
        else if (c != ' ' || !parts.back().empty())
            parts.back() += c;
    }
    return parts;
}

/// What the kernel has that the plain gas's has not.
std::string difference(const Scene& scene, const Scene& plain) {
    const auto described = [](const Scene& s) {
        return parts_of(describe(World(s, {.threads = 1}).kernel()));
    };
    const std::vector<std::string> of_plain = described(plain);
    std::string text;
    for (const std::string& part : described(scene))
        if (std::ranges::find(of_plain, part) == of_plain.end()) text += (text.empty() ? "" : ", ") + part;
    return text.empty() ? "the same" : text;
}

std::vector<std::string> feature_row(const PlainGas& gas, const Feature& feature, const Scene& plain,
                                     int rounds) {
    Scene scene = feature.starts_from_plain_gas() ? plain : melted(gas, feature);
    if (feature.force != nullptr) feature.force(scene, gas);
    std::vector<double> prices, prices_of_event;
    Stretch with;
    for (int round = 0; round < rounds; ++round) {
        Stretch without;
        const auto measure_plain = [&] { without = measure(plain, {}, gas.free_time()); };
        if (round % 2 == 0) measure_plain();
        with = measure(scene, feature.running, gas.free_time());
        if (round % 2 != 0) measure_plain();
        prices.push_back(with.time_of_collision() / without.time_of_collision());
        prices_of_event.push_back(with.time_of_event() / without.time_of_event());
    }
    const auto [least, most] = std::ranges::minmax(prices);
    return {feature.name,
            fmt::format("{:.2f}", median(prices)),
            fmt::format("{:.2f} to {:.2f}", least, most),
            fmt::format("{:.2f}", 1 / median(prices)),
            fmt::format("{:.2f}", with.events / with.collisions),
            fmt::format("{:.2f}", median(prices_of_event)),
            difference(scene, plain)};
}

Table price_of_features(const Options& options) {
    PlainGas gas{.packing = options.packing};
    if (options.balls > 0) gas.count = static_cast<std::uint64_t>(options.balls);
    const Scene plain = melted(gas, {});
    const int rounds = options.rounds > 0 ? options.rounds : 9;
    Table table{{{"feature", "time a collision", "range", "collisions a second", "events a collision",
                  "time an event", "kernel, where it is another"}},
                true};
    table.rows.push_back(feature_row(gas, {.name = "the plain gas, against itself"}, plain, rounds));
    for (const Feature& feature : features())
        if (feature.name.find(options.only) != std::string::npos)
            table.rows.push_back(feature_row(gas, feature, plain, rounds));
    return table;
}

// ---- Setting up.

Table price_of_setting_up(const Options& options) {
    const double balls = options.balls > 0 ? options.balls : 1e6;
    const Scene scene = gas_scene(static_cast<std::uint64_t>(balls), options.packing);
    std::vector<double> placing, building, both, running;
    for (int round = 0; round < (options.rounds > 0 ? options.rounds : 3); ++round) {
        const WorldOptions one_thread{.threads = 1};
        std::unique_ptr<World> world;
        {
            Scene placed = scene;
            placing.push_back(seconds_of([&] { placed.balls = place_balls(scene); }));
            placed.fills.clear();
            building.push_back(seconds_of([&] { world = std::make_unique<World>(placed, one_thread); }));
            world.reset();
        }
        both.push_back(seconds_of([&] { world = std::make_unique<World>(scene, one_thread); }));
        // Long enough to hold many windows, which are gone through ahead of the time that is asked for.
        const double free_time = mean_free_time(options.packing);
        world->step(4 * free_time);
        const double before = collisions_of(world->counts());
        const double seconds = seconds_of([&] { world->step(16 * free_time); });
        running.push_back(seconds * balls / (collisions_of(world->counts()) - before));
    }
    Table table{{{"stage", "over the time of as many collisions", "range"}}, false};
    const auto add = [&](const std::string& name, auto&& seconds) {
        std::vector<double> ratios;
        for (std::size_t k = 0; k < running.size(); ++k) ratios.push_back(seconds(k) / running[k]);
        const auto [least, most] = std::ranges::minmax(ratios);
        table.rows.push_back(
            {name, fmt::format("{:.2f}", median(ratios)), fmt::format("{:.2f} to {:.2f}", least, most)});
    };
    add("from a scene with a fill to its first event", [&](std::size_t k) { return both[k]; });
    add("of it, placing the fill", [&](std::size_t k) { return placing[k]; });
    add("from a scene with as many balls of its own", [&](std::size_t k) { return building[k]; });
    return table;
}

void print(const std::string& name, const Table& table, bool markdown) {
    const std::string text = markdown ? "table " + name + "\n" + table.as_markdown() : table.as_text() + "\n";
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

/// False where an option is unknown or a number not above 0.
bool read(int argc, char** argv, Options& options) {
    int i = 1;
    if (argc > 1 && argv[1][0] != '-') {
        const std::string table = argv[i++];
        options.features = table == "features";
        options.setup = table == "setup";
        if (!options.features && !options.setup) return false;
    }
    for (; i < argc; ++i) {
        const std::string name = argv[i];
        if (name == "--markdown") {
            options.markdown = true;
            continue;
        }
        if (++i == argc) return false;
        const double number = std::atof(argv[i]);
        if (name == "--only") {
            options.only = argv[i];
            continue;
        }
        if (!(number > 0)) return false;
        if (name == "--balls")
            options.balls = std::floor(number);
        else if (name == "--packing")
            options.packing = number;
        else if (name == "--rounds")
            options.rounds = static_cast<int>(number);
        else
            return false;
    }
    return true;
}

}  // namespace
}  // namespace carom::bench

int main(int argc, char** argv) {
    using namespace carom::bench;
    Options options;
    if (argc == 2 && std::string(argv[1]) == "--help") {
        std::fputs(kUsage, stdout);
        return 0;
    }
    if (!read(argc, argv, options)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    try {
        if (options.features) print("features", price_of_features(options), options.markdown);
        if (options.setup) print("setup", price_of_setting_up(options), options.markdown);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "carom_price: %s\n", error.what());
        return 1;
    }
}
