// Scenes that are allowed to start with bodies inside each other: a pair is hit when it approaches, let go
// when it parts, and no overlap ever deepens.
#include <gtest/gtest.h>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"

namespace carom::test {
namespace {

Scene pair_at(double distance, const Vec2& v_a, const Vec2& v_b) {
    Scene s;
    s.until = 10;
    s.allows_overlap = true;
    s.balls.resize(2);
    s.balls[1].position = {distance, 0};
    s.balls[0].velocity = v_a;
    s.balls[1].velocity = v_b;
    return s;
}

TEST(OverlapAtStart, ApproachingPairIsHitAtOnce) {
    World world(pair_at(0.25, {1, 0}, {-1, 0}));
    std::vector<double> times;
    world.on_collision([&times](const Collision& c) { times.push_back(c.time); });
    world.advance_to(5);
    EXPECT_EQ(times, std::vector<double>{0});
    EXPECT_EQ(world.positions()[0], Vec2(-5, 0));
    EXPECT_EQ(world.positions()[1], Vec2(5.25, 0));
}

TEST(OverlapAtStart, PartingPairIsLetGo) {
    World world(pair_at(0.25, {-1, 0}, {1, 0}));
    world.advance_to(5);
    EXPECT_EQ(world.counts().ball_collisions, 0u);
    EXPECT_EQ(world.positions()[0], Vec2(-5, 0));
}

// One centre on the other: no direction to push in, but the pair parts by itself.
TEST(OverlapAtStart, OneInTheOtherParts) {
    World world(pair_at(0, {1, 0}, {0, 0.5}));
    world.advance_to(5);
    EXPECT_EQ(world.counts().ball_collisions, 0u);
    EXPECT_EQ(world.positions()[0], Vec2(5, 0));
    World still(pair_at(0, {0, 0}, {0, 0}));
    still.advance_to(5);
    EXPECT_EQ(still.counts().events, 0u);
}

TEST(OverlapAtStart, BallInAWallLeavesIt) {
    for (const double height : {0.25, -0.25, 0.0}) {
        Scene s;
        s.until = 10;
        s.allows_overlap = true;
        s.balls.resize(1);
        s.balls[0].position = {0, height};
        s.balls[0].velocity = {0.1, height < 0 ? -1.0 : 1.0};
        s.walls = {{{-5, 0}, {5, 0}, 1}};
        World world(s);
        world.advance_to(5);
        EXPECT_EQ(world.counts().wall_collisions, 0u) << height;
        EXPECT_NEAR(world.positions()[0].y(), height + (height < 0 ? -5 : 5), 1e-14);
    }
}

/// A gas whose balls have grown into each other.
Scene grown_gas(std::uint64_t seed, const Vec2& gravity, double restitution) {
    Scene s = gas(seed, {.packing = 0.3, .boundary_y = Boundary::kWall, .restitution = restitution});
    const double margin = 0.25;  // keeps the grown ones inside the walled sides
    s.domain->box.min.y() -= margin;
    s.domain->box.max.y() += margin;
    for (std::size_t i = 0; i < s.balls.size(); ++i) s.balls[i].radius = 0.5 + (i % 3 == 0 ? margin : 0.1);
    s.gravity = gravity;
    s.allows_overlap = true;
    return s;
}

TEST(OverlapAtStart, NoOverlapDeepensAndAllPart) {
    for (const double restitution : {1.0, 0.7}) {
        const Scene s = grown_gas(71, Vec2::Zero(), restitution);
        World world(s);
        double deepest = world.max_overlap();
        ASSERT_GT(deepest, 0.05);
        for (int k = 1; k <= 40; ++k) {
            world.advance_to(0.25 * k);
            const double now = world.max_overlap();
            ASSERT_LE(now, deepest + 1e-12) << "time " << world.time();
            ASSERT_TRUE(world.validate().empty()) << world.validate().front().what;
            deepest = now;
        }
        EXPECT_LT(deepest, 1e-12) << "restitution " << restitution;
    }
}

TEST(OverlapAtStart, TheSameBitsOnDomains) {
    const Scene s = grown_gas(72, {0.1, -0.2}, 0.8);
    World one(s, {.threads = 1, .domains = 1});
    one.advance_to(5);
    for (const int domains : {2, 5}) {
        World world(s, {.threads = 2, .domains = domains});
        world.advance_to(5);
        EXPECT_EQ(world.state_hash(), one.state_hash()) << domains << " domains";
    }
}

TEST(OverlapAtStart, IsRefusedWhereItIsNotAllowed) {
    Scene s = grown_gas(73, Vec2::Zero(), 1);
    s.allows_overlap = false;
    EXPECT_THROW(World{s}, SceneError);
}

}  // namespace
}  // namespace carom::test
