// Ratios as large as they get in one scene: of radii, of masses, of speeds. Each against the reference engine
// where that is quick enough, and the same bits for any cells, threads and domains.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/systems.hpp"
#include "brute_force_audit.hpp"
#include "outcome.hpp"
#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

using accuracy::ball_at;
using accuracy::kRounding;

/// Four standard deviations of what rounding makes of the energy: a collision rounds some twelve numbers of
/// the energy's size at most, each uniformly within half an ulp.
double energy_bound(double collisions) {
    return 4 * 2 * kRounding * std::sqrt(collisions);
}

/// Two balls of radius 5,000 come from below and above upon rows of balls of radius 1/2.
Scene huge_among_tiny(int columns, int rows) {
    constexpr double kRadius = 5000;
    std::mt19937_64 random(81);
    Scene s;
    for (int k = 0; k < columns * rows; ++k) {
        const Vec2 v = random_velocity(random, 1);
        s.balls.push_back(ball_at(1.5 * (k % columns), 1.5 * double(k / columns), v.x(), v.y()));
    }
    const double middle = 0.75 * columns;
    for (const double side : {-1.0, 1.0}) {
        const double surface = side < 0 ? -1 : 1.5 * rows + 1;
        s.balls.push_back(ball_at(middle, surface + side * kRadius, 0, -side));
        s.balls.back().radius = kRadius;
        s.balls.back().mass = 1e4;
    }
    return s;
}

TEST(Extremes, HugeBallsAmongThousandsOfTinyOnes) {
    const Scene s = huge_among_tiny(50, 30);
    const double energy = World(s).energy();
    World world(s, {.threads = 1});
    for (int k = 1; k <= 5; ++k) {
        world.advance_to(k);
        // Places reach 10^4 and are rounded there, some ulps a collision at most.
        EXPECT_LT(world.max_overlap(), 1e4 * 16 * kRounding);
    }
    const auto collisions = double(world.counts().ball_collisions);
    EXPECT_GT(collisions, 2000);
    EXPECT_NEAR(world.energy() / energy, 1, energy_bound(collisions));
    const std::uint64_t hash = world.state_hash();
    for (const WorldOptions& options : {WorldOptions{.threads = 2},
                                        {.threads = 1, .cell_size = 3},
                                        {.threads = 1, .cell_size = 40},
                                        {.threads = 1, .cell_size = 2e4},
                                        {.threads = 2, .domains = 4}}) {
        if (kIsSanitized && options.cell_size > 1000) continue;  // all in one cell
        World other(s, options);
        other.advance_to(5);
        EXPECT_EQ(other.state_hash(), hash);
    }
}

TEST(Extremes, HugeBallsAgreeWithTheReference) {
    audit(huge_among_tiny(12, 8), 0, 2000);
    audit(huge_among_tiny(12, 8), 50, 2000);
}

/// One ball in ten is 10^12 times as heavy as the rest.
TEST(Extremes, MassesOneToATrillion) {
    Scene s = gas(82, {.count = 400, .packing = 0.4});
    for (std::size_t i = 0; i < s.balls.size(); i += 10) s.balls[i].mass = 1e12;
    World world(s, {.threads = 1});
    const double energy = world.energy();
    const Vec2 momentum = world.momentum();
    double of_all = 0;
    for (const Ball& b : s.balls) of_all += b.mass * b.velocity.norm();
    world.advance_to(5);
    const auto collisions = double(world.counts().ball_collisions);
    EXPECT_GT(collisions, 2000);
    EXPECT_NEAR(world.energy() / energy, 1, energy_bound(collisions));
    // A collision loses the rounding of the velocities when they are stored, each an ulp of its momentum.
    const double bound = 2 * kRounding * collisions * of_all / 40;
    EXPECT_NEAR(world.momentum().x(), momentum.x(), bound);
    EXPECT_NEAR(world.momentum().y(), momentum.y(), bound);
    audit(s, 0, 2000);
    const Outcome serial = run(s, {.threads = 1, .domains = 1}, 5);
    for (const int domains : {2, 5}) expect_equal(run(s, {.threads = 2, .domains = domains}, 5), serial);
}

/// A light ball at 10^9 among balls at 10^-9, which it hardly moves.
Scene fast_among_slow() {
    Scene s = gas(83, {.count = 300,
                       .packing = 0.05,
                       .boundary_x = Boundary::kWall,
                       .boundary_y = Boundary::kWall,
                       .speed = 1e-9});
    Ball& fast = s.balls[0];
    fast.velocity = {0.6e9, 0.8e9};
    fast.radius = 1e-2;
    fast.mass = 1e-12;
    return s;
}

TEST(Extremes, FastAndSlowSideBySide) {
    constexpr double kEnd = 4e-6;
    const Scene s = fast_among_slow();
    audit(s, 0, 400);
    std::set<std::uint32_t> hit;
    World world(s, {.threads = 1});
    world.on_collision([&](const Collision& c) {
        hit.insert(c.i);
        if (c.kind == CollisionKind::kBall) hit.insert(c.j);
    });
    world.advance_to(kEnd);
    const PlaneVectors x = world.positions();
    const PlaneVectors v = world.velocities();
    std::size_t untouched = 0;
    for (std::uint32_t i = 0; i < s.balls.size(); ++i) {
        if (hit.contains(i)) continue;
        ++untouched;
        // One rounding of the product and one of the sum, from the start: nothing has anchored it since.
        EXPECT_EQ(x[i], s.balls[i].position + kEnd * s.balls[i].velocity) << "ball " << i;
        EXPECT_EQ(v[i], s.balls[i].velocity) << "ball " << i;
    }
    EXPECT_GT(hit.size(), 100U);
    EXPECT_GT(untouched, 20U);
    EXPECT_LT(world.max_overlap(), 1e-12);
    const Outcome serial = run(s, {.threads = 1, .domains = 1}, kEnd);
    for (const int domains : {2, 5}) expect_equal(run(s, {.threads = 2, .domains = domains}, kEnd), serial);
}

}  // namespace
}  // namespace carom::test
