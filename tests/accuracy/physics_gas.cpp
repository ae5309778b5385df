// Equation of state and rate of collisions of discs in a periodic box.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "accuracy/physics_run.hpp"
#include "core/random.hpp"
#include "core/table.hpp"

namespace carom::accuracy {
namespace {

constexpr int kBlocks = 1024;

/// Z of the infinite fluid and the bound of its error, where the reference has the packing.
std::pair<double, double> reference(double packing) {
    for (const test::Row& row : test::read_table("hard_disc_equation_of_state.csv"))
        if (std::stod(row[0]) == packing) return {std::stod(row[1]), std::stod(row[2])};
    return {compressibility(packing), 1e-3};
}

Figure compressibility_figure(const GasRun& run, const GasSeries& series, double temperature) {
    const Estimate z = compressibility_of(series, run.discs, temperature);
    const auto [infinite, error] = reference(run.packing);
    const double shift = finite_size_shift(run.packing, static_cast<double>(run.discs));
    // The next order of the shift, and what its derivatives are off by: a twentieth of it at these sizes.
    return {"Z from the virial", system_name(run), z, infinite + shift, error + std::abs(shift) / 20};
}

// The rate M / t over 2 n sigma chi sqrt(pi k T / m) N / 2 with chi = (Z - 1) / (2 eta) and Z - 1 = W / (2 N
// k T t) is M sqrt(pi m k T) sigma / W: one over the mean impulse of a collision. The impulse is m times the
// normal velocity of approach, the rate its first absolute moment and the virial its second: the first is
// that of a component of a sphere.
Figure enskog_figure(const GasRun& run, const GasSeries& series, double temperature) {
    const double factor = sphere_factor(2 * static_cast<double>(run.discs - 1));
    const Estimate ratio = ratio_of(series.collisions, series.virial);
    return {"collision rate over Enskog's, chi from the measured Z", system_name(run),
            scaled(ratio, std::sqrt(std::numbers::pi * temperature) / factor), 1, 0};
}

Scene two_disc_scene(double side, test::Random& random) {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {side, side}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.until = 1;
    scene.balls.resize(2);
    scene.balls[1].position = {side / 2, random.uniform(side / 4, side / 2)};
    scene.balls[0].velocity = random.direction(1);
    scene.balls[1].velocity = -scene.balls[0].velocity;
    return scene;
}

}  // namespace

std::vector<Figure> periodic_gas(const GasRun& run) {
    World world(filled_box(run, kEqualDiscs, Boundary::kPeriodic), run.options);
    const double rate = collision_rate(run.packing);
    // Collisions of a disc until the start is forgotten, at the slowest: a dense lattice melts, and heat
    // spreads over the box, which takes L^2 / (4 pi^2 D), some hundred collisions for 1,024 dense discs.
    constexpr double kRelaxation = 1000;
    world.advance_to(std::min(kRelaxation, run.collisions / 4) / rate);
    const GasSeries series = measure_gas(world, kBlocks, run.collisions / rate / kBlocks);
    const double temperature = periodic_temperature(world);
    return {compressibility_figure(run, series, temperature), enskog_figure(run, series, temperature)};
}

Figure two_discs(double packing, int runs, double time, std::uint64_t seed) {
    test::Random random(seed);
    std::vector<double> z;
    for (int run = 0; run < runs; ++run) {
        World world(two_disc_scene(std::sqrt(2 * std::numbers::pi / 4 / packing), random), {.threads = 1});
        world.advance_to(time);
        z.push_back(world.compressibility_factor().value_or(0));
    }
    return {"Z from the virial", fmt::format("2 discs, packing {}", packing), mean_of(z),
            (1 - packing) / (1 - 2 * packing), 0};
}

}  // namespace carom::accuracy
