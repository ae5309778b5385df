// Figures of statistical mechanics that others have published.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <carom/parallel/world.hpp>

#include "blocks.hpp"
#include "core/table.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

Scene filled(std::size_t count, double packing, std::uint64_t seed) {
    Scene s;
    const double side = std::sqrt(double(count) * std::numbers::pi / 4 / packing);
    s.domain = Domain{{{0, 0}, {side, side}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    Fill fill;
    fill.count = count;
    fill.temperature = 1;
    fill.seed = seed;
    s.fills = {fill};
    s.until = 1;
    return s;
}

// Z from the virial, against Kolafa and Rottner 2006, corrected for the number of discs.
TEST(GasPhysics, EquationOfState) {
    constexpr std::size_t kDiscs = 1024;
    constexpr int kBlocks = 20;
    std::vector<std::pair<double, double>> table;
    for (const Row& row : read_table("hard_disc_equation_of_state.csv"))
        table.emplace_back(std::stod(row[0]), std::stod(row[1]));
    for (const auto& [packing, infinite] : table) {
        World world(filled(kDiscs, packing, 5));
        run_collisions(world, 50);  // forget the start
        const auto [mean, error] = compressibility_in_blocks(world, kBlocks, 40);
        // Finite size: Z_N = Z - (eta / 2N) (2 Z' + eta Z'') / (Z + eta Z'), with the derivatives of
        // Henderson's 1975 Z = (1 + eta^2 / 8) / (1 - eta)^2, which suffice for a correction of order 1 / N.
        const double eta = packing;
        const double q = 1 - eta;
        const double z1 = 2 * (1 + eta * eta / 8) / (q * q * q) + eta / 4 / (q * q);
        const double z2 = 6 * (1 + eta * eta / 8) / (q * q * q * q) + eta / (q * q * q) + 0.25 / (q * q);
        const double expected = infinite - eta / (2.0 * kDiscs) * (2 * z1 + eta * z2) / (infinite + eta * z1);
        EXPECT_NEAR(mean, expected, 4 * error) << "packing " << packing << ", standard error " << error;
        EXPECT_LT(error, 0.004 * infinite) << "packing " << packing;
    }
}

// Two discs in a periodic box: Z = (1 - eta) / (1 - 2 eta) exactly, for the relative motion is one point
// among one obstacle's images. At packing 0.35 the box is not five cells wide.
TEST(GasPhysics, TwoDiscsInAPeriodicBox) {
    for (const double packing : {0.1, 0.2, 0.35}) {
        const double side = std::sqrt(2 * std::numbers::pi / 4 / packing);
        std::vector<double> runs;
        for (int run = 0; run < 40; ++run) {
            std::mt19937_64 random(100 + run);
            Scene s;
            s.domain = Domain{{{0, 0}, {side, side}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
            s.until = 1;
            s.balls.resize(2);
            s.balls[1].position = {side / 2, uniform(random, side / 4, side / 2)};
            const double angle = uniform(random, 0, 2 * std::numbers::pi);
            s.balls[0].velocity = {std::cos(angle), std::sin(angle)};
            s.balls[1].velocity = -s.balls[0].velocity;
            World world(s);
            world.advance_to(4000);
            runs.push_back(world.compressibility_factor().value());
        }
        const auto [mean, error] = block_mean(runs);
        EXPECT_NEAR(mean, (1 - packing) / (1 - 2 * packing), 4 * error) << "packing " << packing;
        EXPECT_LT(error, 0.01) << "packing " << packing;
    }
}

// Haff's law in the form ln(T0 / T) = k c, with c the collisions a particle has had (van Noije and Ernst
// 1998).
TEST(GasPhysics, HaffCooling) {
    for (const Row& row : read_table("haff_cooling.csv")) {
        const double packing = std::stod(row[0]);
        const double restitution = std::stod(row[1]);
        const double rate = std::stod(row[5]);
        constexpr std::size_t kDiscs = 4900;
        Scene s = filled(kDiscs, packing, 9);
        s.contact_time = 0;
        s.fills[0].restitution = restitution;
        World world(s);
        run_collisions(world, 2);  // the velocities leave the Maxwell distribution
        const double energy = world.kinetic_energy();
        const auto collisions = double(world.counts().ball_collisions);
        while (2 * (double(world.counts().ball_collisions) - collisions) < 10 * kDiscs) world.step(0.1);
        const double each = 2 * (double(world.counts().ball_collisions) - collisions) / kDiscs;
        EXPECT_NEAR(std::log(energy / world.kinetic_energy()) / each / rate, 1, 0.03)
            << "packing " << packing;
    }
}

}  // namespace
}  // namespace carom::test
