// The engine against the reference engine, event by event: time, bodies and the state at the end must agree
// to the bit.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <carom/parallel/world.hpp>

#include "stress/reference_engine.hpp"

namespace carom::test {

/// Runs both until the reference has had its events, or nothing is left to happen.
inline void audit(const Scene& scene, double cell_size, std::size_t events) {
    stress::BruteForce reference(stress::rules_of(scene), scene.balls, scene.walls);
    World world(scene, {.threads = 1, .cell_size = cell_size});
    std::vector<Collision> seen;
    world.on_collision([&seen](const Collision& c) { seen.push_back(c); });
    const std::size_t balls = scene.balls.size();
    double time = 0;
    for (std::size_t k = 0; k < events && !reference.finished(); ++k) {
        const stress::BruteForceEvent expected = reference.next();
        // An event's time in seconds is rounded from epoch and offset: one step further holds it for sure.
        time = std::nextafter(expected.time, std::numeric_limits<double>::infinity());
        if (seen.size() <= k) world.advance_to(time);
        ASSERT_GT(seen.size(), k) << "event " << k << " at " << expected.time << " between " << expected.i
                                  << " and " << expected.j << " was missed";
        const Collision& got = seen[k];
        const std::size_t j = got.kind == CollisionKind::kBall ? got.j : balls + got.j;
        ASSERT_EQ(got.time, expected.time) << "event " << k;
        ASSERT_EQ(std::min<std::size_t>(got.i, j), expected.i) << "event " << k << " at " << time;
        ASSERT_EQ(std::max<std::size_t>(got.i, j), expected.j) << "event " << k << " at " << time;
    }
    ASSERT_TRUE(world.validate().empty()) << world.validate().front().what;
    const PlaneVectors x = world.positions();
    const PlaneVectors v = world.velocities();
    for (std::size_t i = 0; i < balls; ++i) {
        const auto [position, velocity] = reference.state_at(i, world.time());
        ASSERT_EQ(x[i], position) << "ball " << i;
        ASSERT_EQ(v[i], velocity) << "ball " << i;
    }
}

}  // namespace carom::test
