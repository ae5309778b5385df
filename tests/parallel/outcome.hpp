// What a run of the engine shows, to be compared between domains, cells and threads.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <tuple>
#include <vector>

#include <carom/parallel/world.hpp>

namespace carom::test {

/// What a run shows: the state, the counts, and every collision in order.
struct Outcome {
    std::uint64_t hash = 0;
    std::uint64_t balls = 0;
    std::uint64_t walls = 0;
    double virial = 0;
    double energy = 0;
    std::vector<std::tuple<double, std::uint32_t, std::uint32_t, double>> collisions;
    Counts counts;
};

/// All of an outcome but the list of collisions.
inline void take_counts(const World& world, Outcome& out) {
    out.hash = world.state_hash();
    out.counts = world.counts();
    out.balls = out.counts.ball_collisions;
    out.walls = out.counts.wall_collisions;
    out.virial = world.virial();
    out.energy = world.energy();
}

inline Outcome run(const Scene& scene, const WorldOptions& options, double until, double step = 0) {
    Outcome out;
    World world(scene, options);
    world.on_collision(
        [&out](const Collision& c) { out.collisions.emplace_back(c.time, c.i, c.j, c.impulse); });
    for (int k = 1; step > 0 && k * step < until; ++k) world.advance_to(k * step);
    world.advance_to(until);
    EXPECT_TRUE(world.validate().empty()) << world.validate().front().what;
    take_counts(world, out);
    return out;
}

inline void expect_equal(const Outcome& a, const Outcome& b) {
    EXPECT_EQ(a.hash, b.hash);
    EXPECT_EQ(a.balls, b.balls);
    EXPECT_EQ(a.walls, b.walls);
    EXPECT_EQ(a.virial, b.virial);  // to the bit: the sum must not know who added
    EXPECT_EQ(a.energy, b.energy);
    // Not EXPECT_EQ: on a failure it would print thousands of lines.
    EXPECT_TRUE(a.collisions == b.collisions) << "the lists of collisions differ";
}

}  // namespace carom::test
