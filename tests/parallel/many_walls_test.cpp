// Walls: a hundred thousand, crossing ones, and no room between two.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
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

/// Short segments of any slant on a jittered lattice of pitch 1, which small balls find their way among.
Scene maze(int across, int balls) {
    std::mt19937_64 random(86);
    Scene s;
    s.domain = Domain{{{0, 0}, {double(across), double(across)}}, {Boundary::kWall, Boundary::kWall}, 1};
    for (int k = 0; k < across * across; ++k) {
        const Vec2 middle(k % across + 0.5 + uniform(random, -0.2, 0.2),
                          double(k / across) + 0.5 + uniform(random, -0.2, 0.2));
        const double angle = uniform(random, 0, std::numbers::pi);
        const Vec2 half = uniform(random, 0.05, 0.2) * Vec2(std::cos(angle), std::sin(angle));
        s.walls.push_back({middle - half, middle + half, 1});
    }
    for (int k = 0; k < balls; ++k) {
        const double place = double(1 + (k + 1) * (across - 2) / (balls + 1));
        const Vec2 v = random_velocity(random, 1);
        s.balls.push_back(ball_at(place, place, v.x(), v.y()));
        s.balls.back().radius = 0.08;
    }
    return s;
}

TEST(ManyWalls, AHundredThousandSegmentsAgreeWithTheReference) {
    const Scene s = maze(317, 3);
    ASSERT_GT(s.walls.size(), 100'000U);
    audit(s, 0, 200);
}

TEST(ManyWalls, AHundredThousandSegmentsForLong) {
    const Scene s = maze(317, 40);
    World world(s, {.threads = 1});
    world.advance_to(200);
    EXPECT_GT(world.counts().wall_collisions, 1000U);
    EXPECT_TRUE(world.validate().empty());
    EXPECT_LT(world.max_overlap(), 1e-11) << "a step of an ulp of 317, over 0.08";
    const auto collisions = double(world.counts().wall_collisions + world.counts().ball_collisions);
    // Every bounce rounds one ball's energy by a few ulp.
    EXPECT_NEAR(world.kinetic_energy() / World(s).kinetic_energy(), 1, 8 * kRounding * std::sqrt(collisions));
    const Outcome serial = run(s, {.threads = 1, .domains = 1}, 20);
    for (const int domains : {2, 4}) expect_equal(run(s, {.threads = 2, .domains = domains}, 20), serial);
    EXPECT_EQ(run(s, {.threads = 1, .cell_size = 5}, 20).hash, serial.hash);
}

// Two walls that cross make four corners: in each a ball goes as between the sides of a box of its own, to
// the bit where the walls lie along the axes.
TEST(ManyWalls, CrossingWallsMakeFourCorners) {
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            Scene crossed;
            crossed.balls = {ball_at(3 * x, 2.5 * y, -0.75 * x, -0.625 * y)};
            crossed.walls = {{{-9, 0}, {9, 0}, 1}, {{0, -9}, {0, 9}, 1}};
            Scene corner = crossed;
            corner.walls.clear();
            const Vec2 far(9 * x, 9 * y);
            corner.domain = Domain{{far.cwiseMin(Vec2::Zero()), far.cwiseMax(Vec2::Zero())},
                                   {Boundary::kWall, Boundary::kWall},
                                   1};
            World world(crossed);
            World other(corner);
            world.advance_to(8);
            other.advance_to(8);
            EXPECT_EQ(world.counts().wall_collisions, 2U);
            EXPECT_EQ(other.counts().wall_collisions, 2U);
            EXPECT_EQ(world.positions()[0], other.positions()[0]);
            EXPECT_EQ(world.velocities()[0], other.velocities()[0]);
        }
}

// Turned by 45 degrees the cross is the 90-degree corner again: two hits turn the velocity round.
TEST(ManyWalls, SlantedCrossTurnsBack) {
    Scene s;
    s.balls = {ball_at(0.125, 4, 0.0625, -1)};
    s.walls = {{{-9, -9}, {9, 9}, 1}, {{-9, 9}, {9, -9}, 1}};
    World world(s);
    world.advance_to(8);
    EXPECT_EQ(world.counts().wall_collisions, 2U);
    EXPECT_NEAR(world.velocities()[0].x(), -0.0625, 16 * kRounding);
    EXPECT_NEAR(world.velocities()[0].y(), 1, 16 * kRounding);
}

/// A ball between two walls that leave it `room`, at right angles to them at speed 1.
Scene channel(double room, const Vec2& velocity) {
    Scene s;
    s.balls = {ball_at(0, 0, velocity.x(), velocity.y())};
    s.walls = {{{-9, -0.5 - room / 2}, {9, -0.5 - room / 2}, 1},
               {{-9, 0.5 + room / 2}, {9, 0.5 + room / 2}, 1}};
    return s;
}

// Without any room it may slide along; across, it is refused with a reason. With a little, it has as many
// hits as the room's width allows.
TEST(ManyWalls, NoRoomBetweenTwo) {
    World along(channel(0, {1, 0}));
    along.advance_to(4);
    EXPECT_EQ(along.positions()[0], Vec2(4, 0));
    EXPECT_EQ(along.counts().wall_collisions, 0U);
    for (const Vec2& v : {Vec2(0, 1), Vec2(1, 1e-9)}) {
        World across(channel(0, v));
        try {
            across.advance_to(1);
            FAIL() << "advanced";
        } catch (const std::runtime_error& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with("balls[0]: is wedged: ")) << error.what();
        }
    }
    constexpr double kRoom = 0x1p-30;
    World narrow(channel(kRoom, {0, 1}));
    const double end = kIsSanitized ? 0x1p-15 : 0x1p-12;
    narrow.advance_to(end);
    // One at half the room, then one a room: the walls' places are exact.
    EXPECT_EQ(narrow.counts().wall_collisions, static_cast<std::uint64_t>(end / kRoom + 0.5));
    EXPECT_LT(narrow.max_overlap(), 4 * kRounding);
}

}  // namespace
}  // namespace carom::test
