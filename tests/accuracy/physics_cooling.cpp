// A granular gas cools: Haff's law, for each collision and in time.
#include <fmt/format.h>

#include <cmath>

#include "accuracy/physics_run.hpp"
#include "core/table.hpp"

namespace carom::accuracy {
namespace {

/// A row of haff_cooling.csv: zeta0 is the rate of cooling at k T = 1, dT/dt = -zeta0 T^(3/2), and
/// per_collision that of ln T for each collision a disc has.
struct CoolingRow {
    double packing, restitution, zeta0, per_collision;
};

std::vector<CoolingRow> cooling_rows() {
    std::vector<CoolingRow> rows;
    for (const test::Row& row : test::read_table("haff_cooling.csv"))
        rows.push_back({std::stod(row[0]), std::stod(row[1]), std::stod(row[4]), std::stod(row[5])});
    return rows;
}

double collisions_each(const World& world) {
    return 2 * static_cast<double>(world.counts().ball_collisions) / static_cast<double>(world.ball_count());
}

void run_collisions(World& world, double each) {
    const double end = collisions_each(world) + each;
    while (collisions_each(world) < end) world.step(0.05);
}

/// Rates for each collision and in time, each over the theory's.
struct Cooling {
    double per_collision, in_time;
};

Cooling measure_cooling(const CoolingRow& row, std::size_t discs, std::uint64_t seed) {
    Scene scene = filled_box({discs, row.packing, 0, seed}, kEqualDiscs, Boundary::kPeriodic);
    scene.contact_time = 0;
    scene.fills[0].restitution = row.restitution;
    World world(scene, {.threads = 1});
    run_collisions(world, 2);  // the velocities leave the Maxwell distribution
    const double before = periodic_temperature(world), start = world.time();
    const double collisions = collisions_each(world);
    run_collisions(world, 4);
    const double after = periodic_temperature(world);
    // T = T0 / (1 + t / tau)^2 with 1 / tau = zeta0 sqrt(T0) / 2.
    const double zeta = 2 * (1 / std::sqrt(after) - 1 / std::sqrt(before)) / (world.time() - start);
    return {std::log(before / after) / (collisions_each(world) - collisions) / row.per_collision,
            zeta / row.zeta0};
}

}  // namespace

std::vector<Figure> haff_cooling(std::size_t discs, int runs, std::uint64_t seed) {
    // The theory is that of a homogeneous gas without correlations. Vortices take energy out of the
    // collisions' reach, from the first collision on and the more the longer the run and the larger the box:
    // at packing 0.3 in time 1 % of the rate in 4 collisions of 100 discs, 2 % of 400, and 4 % in 10
    // collisions of 4,900.
    constexpr double kTheory = 0.03;
    std::vector<Figure> figures;
    for (const CoolingRow& row : cooling_rows()) {
        std::vector<double> per_collision, in_time;
        for (int k = 0; k < runs; ++k) {
            const Cooling cooling = measure_cooling(row, discs, seed + static_cast<std::uint64_t>(k));
            per_collision.push_back(cooling.per_collision);
            in_time.push_back(cooling.in_time);
        }
        const std::string system =
            fmt::format("{} discs, packing {}, restitution {}", discs, row.packing, row.restitution);
        figures.push_back({"cooling a collision, over theory's", system, mean_of(per_collision), 1, kTheory});
        figures.push_back({"cooling in time, over theory's", system, mean_of(in_time), 1, kTheory});
    }
    return figures;
}

}  // namespace carom::accuracy
