// The empirical method counts what it misses: constructed passes, to the number; grazes in a gas, against the
// closed form.
#include <gtest/gtest.h>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"

namespace carom::test {
namespace {

Scene stepped(Scene scene, double step) {
    scene.method = Method::kEmpirical;
    scene.step = step;
    return scene;
}

/// A bullet at the origin that flies along x at 100.
Scene bullet() {
    Scene s = stepped({}, 1);
    s.until = 1;
    s.balls.resize(1);
    s.balls[0].velocity = {100, 0};
    return s;
}

std::uint64_t missed(const World& world) {
    return world.counts().missed_collisions.value();
}

// Ten free balls, four nailed down and three walls stand in its way; one ball and one wall beside it do not.
TEST(EmpiricalMissed, BulletThroughARow) {
    Scene s = bullet();
    for (int k = 0; k < 14; ++k) {
        Ball b;
        b.position = {3.0 + 5 * k, 0.9 * (k % 2)};
        b.is_static = k % 4 == 3;  // 3, 7 and 11
        s.balls.push_back(b);
    }
    s.balls.emplace_back().position = {20, 1.1};
    s.walls = {
        {{80, -5}, {80, 5}, 1}, {{84, 0.4}, {84, 9}, 1}, {{88, -1}, {90, 1}, 1}, {{92, 0.6}, {92, 9}, 1}};
    World world(s);
    world.advance_to(1);
    EXPECT_EQ(missed(world), 14u + 3u);
    EXPECT_EQ(world.counts().ball_collisions + world.counts().wall_collisions, 0u);
    EXPECT_EQ(world.positions()[0], Vec2(100, 0));
}

// Where the step ends inside a ball that one is hit, and the bullet goes no further.
TEST(EmpiricalMissed, WhatIsResolvedIsNotMissed) {
    Scene s = bullet();
    for (const double x : {30.0, 60.0, 100.5}) s.balls.emplace_back().position = {x, 0};
    World world(s);
    world.advance_to(1);
    EXPECT_EQ(missed(world), 2u);
    EXPECT_EQ(world.counts().ball_collisions, 1u);
    world.advance_to(2);  // the last ball has the velocity and meets nobody
    EXPECT_EQ(missed(world), 2u);
    EXPECT_EQ(world.counts().ball_collisions, 1u);
}

// Through a periodic box of 10 from x = 0 to 23, the ball at 5 is passed at 5 and at 15; a wall at 8
// likewise.
TEST(EmpiricalMissed, EveryImageCounts) {
    Scene s = bullet();
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.balls[0].position = {0, 5};
    s.balls[0].velocity = {23, 0};
    s.balls.emplace_back().position = {5, 5.5};
    s.walls = {{{8, 4}, {8, 6}, 1}};
    for (const int repeats : {1, 2}) {  // with the bullet the later of the two as well
        World world(s);
        world.advance_to(1);
        EXPECT_EQ(missed(world), 4u) << repeats;
        std::swap(s.balls[0], s.balls[1]);
    }
}

// Thrown up at 2 under gravity 4 from 0.25 below the ceiling's contact: the way there takes less than half of
// the second after which it is back.
TEST(EmpiricalMissed, ParabolaThatComesAndGoes) {
    Scene s = stepped({}, 1);
    s.until = 1;
    s.gravity = {0, -4};
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls.resize(1);
    s.balls[0].position = {5, 9.25};
    s.balls[0].velocity = {0, 2};
    World world(s);
    world.advance_to(1);
    EXPECT_EQ(missed(world), 1u);
    EXPECT_EQ(world.counts().wall_collisions, 0u);
    EXPECT_EQ(world.positions()[0], Vec2(5, 9.25));

    s.domain->boundary[1] = Boundary::kOpen;
    s.walls = {{{0, 10}, {10, 10}, 1}};  // the same as a wall
    World walled(s);
    walled.advance_to(1);
    EXPECT_EQ(missed(walled), 1u);
}

TEST(EmpiricalMissed, NothingWhereTheStepsAreShort) {
    Scene s = bullet();
    s.max_travel = 0.5;  // head on: a way of two radii, less in depth than any step
    for (int k = 0; k < 10; ++k) s.balls.emplace_back().position = {3.0 + 5 * k, 0};
    s.walls = {{{80, -5}, {80, 5}, 1}};
    World world(s);
    world.advance_to(2);
    EXPECT_EQ(missed(world), 0u);
    EXPECT_EQ(world.counts().wall_collisions, 1u);
    EXPECT_EQ(world.counts().ball_collisions, 20u) << "there and back";
}

TEST(EmpiricalMissed, CountingChangesNothing) {
    for (const NamedScene& named : all_scenes()) {
        const Scene s = stepped(named.scene, 0.2);
        World counting(s);
        World other(s, {.count_missed = false});
        counting.advance_to(3);
        other.advance_to(3);
        EXPECT_EQ(counting.state_hash(), other.state_hash()) << named.name;
        EXPECT_EQ(other.counts().missed_collisions, std::nullopt);
        EXPECT_TRUE(counting.counts().missed_collisions.has_value());
    }
    World event(gas(1, {}));
    event.advance_to(1);
    EXPECT_EQ(event.counts().missed_collisions, std::nullopt);
    EXPECT_EQ(event.counts().steps, std::nullopt);
}

// A pair at relative speed v is missed where the chord of its pass, l long, lies within one step h: with the
// offset b uniform up to the radii's sum s, db = l dl / 4 s, and the share is the integral over l from 0 to v
// h of (1 - l / v h) l / 4 s^2, which is (v h)^2 / 24 s^2. Over the pairs that meet in a gas of temperature
// T, at a rate v^2 exp(-m v^2 / 4 T), v^2 is 6 T / m on average: a share of T h^2 / 4 m s^2. What is left
// out:
// - db is l dl / 4 s (1 + l^2 / 8 s^2): l^2 is 0.3 (v h)^2 on average, v^2 there 10 T / m: 3 T h^2 / 8 m s^2;
// - who meets a third ball in the step: h times the rates of two balls, each 2 sqrt(pi T / m) n s with n the
//   number a unit of area.
// The number missed is a Poisson variable; five of its standard deviations.
TEST(EmpiricalMissed, ShareOfGrazesInADiluteGas) {
    constexpr double kStep = 0.2;
    constexpr double kPacking = 0.02;
    World world(stepped(gas(81, {.count = 2000, .packing = kPacking, .speed = 2}), kStep));
    world.advance_to(200);
    const double temperature = world.kinetic_energy() / 2000;
    const double share = temperature * kStep * kStep / 4;
    const double expected = share * double(world.counts().ball_collisions);
    const double third =
        2 * kStep * 2 * std::sqrt(std::numbers::pi * temperature) * kPacking * 4 / std::numbers::pi;
    ASSERT_GT(expected, 200);
    EXPECT_NEAR(double(missed(world)), expected, 5 * std::sqrt(expected) + (1.5 * share + third) * expected);
}

}  // namespace
}  // namespace carom::test
