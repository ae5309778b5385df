// The engine against the baseline of bench/plain, which shares no line with it: the same collisions in the
// same order, at times that agree to rounding, for as long as chaos lets two roundings be compared.
#include <gtest/gtest.h>

#include <cmath>
#include <plain.hpp>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"

namespace carom::test {
namespace {

TEST(PlainOracle, SameCollisionsInTheSameOrder) {
    for (const double packing : {0.05, 0.3, 0.6}) {
        for (const std::uint64_t seed : {51, 52, 53}) {
            const Scene scene = gas(seed, {.count = 1000, .packing = packing});
            std::vector<PlainSimulation::Vector> positions;
            std::vector<PlainSimulation::Vector> velocities;
            for (const Ball& b : scene.balls) {
                positions.push_back({b.position.x(), b.position.y()});
                velocities.push_back({b.velocity.x(), b.velocity.y()});
            }
            PlainSimulation plain(positions, velocities, 1, scene.domain->box.max.x());
            std::vector<PlainEvent> expected;
            plain.log_to(&expected);
            // Three collisions a ball: errors of 1e-15 times the box grow as exp(lambda k), lambda = 4.3 at
            // packing 0.05, 1.2 at 0.3 and 0.5 at 0.6, so k = 3 leaves 1e-8 at the mean of the worst.
            const double growth = packing < 0.1 ? 4.3 : packing < 0.5 ? 1.2 : 0.5;
            plain.run_events(3 * 1000 / 2);

            World world(scene);
            std::vector<Collision> seen;
            world.on_collision([&seen](const Collision& c) { seen.push_back(c); });
            world.advance_to(expected.back().time * (1 + 1e-6));
            ASSERT_GE(seen.size(), expected.size());
            // The fastest of the directions is some way from the mean: three more collisions' growth.
            const double tolerance = 1e-15 * scene.domain->box.max.x() * std::exp(growth * 6);
            for (std::size_t k = 0; k < expected.size(); ++k) {
                ASSERT_EQ(seen[k].i, expected[k].i)
                    << "collision " << k << ", packing " << packing << ", seed " << seed;
                ASSERT_EQ(seen[k].j, expected[k].j)
                    << "collision " << k << ", packing " << packing << ", seed " << seed;
                ASSERT_NEAR(seen[k].time, expected[k].time, tolerance)
                    << "collision " << k << ", packing " << packing;
            }
        }
    }
}

}  // namespace
}  // namespace carom::test
