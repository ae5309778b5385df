// No scene hangs: resting contacts, inelastic collapse and simultaneous hits cost a bounded number of events
// per ball and time.
#include <gtest/gtest.h>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"

namespace carom::test {
namespace {

struct EnoughEvents {};

/// Runs to `end` and gives collisions per ball and contact time (or second where that is 0); stops a run that
/// does not end.
double collisions_per_contact_time(const Scene& scene, double end) {
    World world(scene, {.threads = 1});
    std::uint64_t collisions = 0;
    world.on_collision([&](const Collision&) {
        if (++collisions > 5'000'000) throw EnoughEvents{};
    });
    try {
        world.advance_to(end);
    } catch (const EnoughEvents&) {
        ADD_FAILURE() << "more than 5 million collisions before time " << end;
    }
    EXPECT_TRUE(world.validate().empty()) << world.validate().front().what;
    const double unit = world.contact_time() > 0 ? world.contact_time() : 1;
    return double(collisions) / double(scene.balls.size()) / end * unit;
}

Ball ball(double x, double y) {
    Ball b;
    b.position = {x, y};
    return b;
}

Scene box_under_gravity(std::vector<Ball> balls, double restitution) {
    Scene s;
    s.gravity = {0, -9.81};
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.until = 10;
    for (Ball& b : balls) b.restitution = restitution;
    s.balls = std::move(balls);
    return s;
}

class Progress : public testing::TestWithParam<double> {};
/// What never comes to rest without losses.
class LossyProgress : public testing::TestWithParam<double> {};

// A ball has at most six neighbours in the plane; a resting contact takes about one collision in a contact
// time (rest_time), a ball in the middle of a pile a few from each side. 30 leaves room for the waves that
// run through a column.
constexpr double kMostPerContactTime = 30;

TEST_P(Progress, BallAtRestOnTheFloor) {
    const Scene s = box_under_gravity({ball(5, 0.5)}, GetParam());
    if (GetParam() < 1) {
        EXPECT_LE(collisions_per_contact_time(s, 10), 1.01);
    } else {
        // It hops for 1e-4 of the time of falling a diameter, sqrt(1 / 9.81): 31,321 hops a second.
        EXPECT_LE(collisions_per_contact_time(s, 10), 31'400);
    }
}

TEST_P(Progress, BallAtRestKeepsItsPlace) {
    World world(box_under_gravity({ball(5, 0.5)}, GetParam()));
    for (int k = 1; k <= 1000; ++k) {
        world.advance_to(0.01 * k);
        const Vec2 x = world.positions()[0];
        const double hop = 9.81 * std::pow(GetParam() < 1 ? world.contact_time() : 1e-4, 2) / 8;
        ASSERT_NEAR(x.y(), 0.5 + hop / 2, hop / 2 + 1e-12);
        ASSERT_EQ(x.x(), 5.0);
    }
}

TEST_P(LossyProgress, CornerWedgeAndPegs) {
    EXPECT_LE(collisions_per_contact_time(box_under_gravity({ball(0.5, 0.5)}, GetParam()), 10),
              kMostPerContactTime);
    Scene wedge = box_under_gravity({ball(5, 4)}, GetParam());
    wedge.walls = {{{0, 5}, {5, 0.5}, 1}, {{5, 0.5}, {10, 5}, 1}};
    EXPECT_LE(collisions_per_contact_time(wedge, 20), kMostPerContactTime);
    Ball peg = ball(5, 2);
    peg.is_static = true;
    Ball other = ball(6.5, 2);
    other.is_static = true;
    EXPECT_LE(
        collisions_per_contact_time(
            box_under_gravity({peg, other, ball(5.75, 2.6614378277661477), ball(5, 8)}, GetParam()), 10),
        kMostPerContactTime);
}

TEST_P(Progress, ElasticBallLaidOnTwoPegs) {
    Ball peg = ball(5, 2);
    peg.is_static = true;
    Ball other = ball(6.5, 2);
    other.is_static = true;
    const Scene s = box_under_gravity({peg, other, ball(5.75, 2.6614378277661477)}, GetParam());
    // Two contacts of the hop's length each, over three balls.
    EXPECT_LE(collisions_per_contact_time(s, 1), 2 * 31'400);
}

TEST_P(LossyProgress, ColumnAndPile) {
    std::vector<Ball> column;
    for (int i = 0; i < 8; ++i) column.push_back(ball(5, 0.5 + i));
    EXPECT_LE(collisions_per_contact_time(box_under_gravity(column, GetParam()), 5), kMostPerContactTime);
    std::vector<Ball> pyramid;
    for (int row = 0; row < 6; ++row)
        for (int i = 0; i < 6 - row; ++i)
            pyramid.push_back(ball(1 + 1.0000001 * i + 0.5 * row, 0.5 + 0.8660255 * row));
    EXPECT_LE(collisions_per_contact_time(box_under_gravity(pyramid, GetParam()), 5), kMostPerContactTime);
    std::vector<Ball> poured;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) poured.push_back(ball(1 + 1.01 * i, 0.55 + 1.01 * j));
    EXPECT_LE(collisions_per_contact_time(box_under_gravity(poured, GetParam()), 10), kMostPerContactTime);
}

TEST_P(Progress, CollapseOfThree) {
    Scene s = box_under_gravity({ball(2, 5), ball(4, 5), ball(6, 5)}, GetParam());
    s.gravity = Vec2::Zero();
    s.balls[0].velocity = {1, 0};
    s.balls[2].velocity = {-1, 0};
    EXPECT_LE(collisions_per_contact_time(s, 20), kMostPerContactTime);
}

TEST_P(LossyProgress, ClusterInABlackHole) {
    std::vector<Ball> balls;
    std::mt19937_64 random(1);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
            balls.push_back(ball(1 + 1.5 * i, 1 + 1.5 * j));
            balls.back().velocity = random_velocity(random, 1);
        }
    Scene s = box_under_gravity(balls, GetParam());
    s.gravity = Vec2::Zero();
    s.attractors = {{{5, 5}, 50, 0.5}};
    EXPECT_LE(collisions_per_contact_time(s, 10), kMostPerContactTime);
}

INSTANTIATE_TEST_SUITE_P(Restitution, Progress, testing::Values(1.0, 0.9, 0.5, 0.1, 0.0));
INSTANTIATE_TEST_SUITE_P(Restitution, LossyProgress, testing::Values(0.9, 0.5, 0.1, 0.0));

TEST(Progress, ThousandsOfSimultaneousHits) {
    // A lattice of pairs that approach head on at one speed: every pair hits at time 0.5, and by symmetry
    // again and again.
    Scene s;
    s.domain = Domain{{{0, 0}, {200, 200}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.until = 100;
    for (int row = 0; row < 50; ++row)
        for (int k = 0; k < 100; ++k) {
            Ball b = ball(2.0 * k + 1, 4.0 * row + 2);
            b.velocity = {k % 2 == 0 ? 1.0 : -1.0, 0};
            s.balls.push_back(b);
        }
    World world(s, {.threads = 1});
    world.advance_to(100.25);
    // Every ball meets each neighbour in turn, at 0.5, 1.5, 2.5, ...: 100 collisions up to time 99.5 and one
    // at 100.5.
    EXPECT_EQ(world.counts().ball_collisions, 2500u * 100u);
    EXPECT_TRUE(world.validate().empty());
    EXPECT_EQ(world.energy(), 2500);
}

// The halves of a row of touching balls fly at each other: each ball of the one passes its velocity through
// all of the other.
TEST(Progress, TouchingRowMeetsAtOneInstant) {
    constexpr int kBalls = 1000;
    Scene s;
    s.until = 1;
    for (int k = 0; k < kBalls; ++k) {
        s.balls.push_back(ball(k, 0));
        s.balls.back().velocity = {k < kBalls / 2 ? 1.0 : -1.0, 0};
    }
    World world(s, {.threads = 1});
    world.advance_to(1);
    EXPECT_EQ(world.counts().ball_collisions, std::uint64_t{kBalls} * kBalls / 4);
    EXPECT_EQ(world.energy(), kBalls / 2.0);
}

TEST(Progress, SpeedFactorDoesNotUndoTheHop) {
    Scene s = box_under_gravity({ball(5, 3)}, 1);
    s.contact_time = 0;
    s.speed_factor = 1e-3;
    EXPECT_LE(collisions_per_contact_time(s, 10), 31'400);
}

// A heavy ball presses a light one against a wall. Within the contact time the speed factor takes nothing
// either, or the light ball would never turn the heavy one back. Without any loss a light ball turns it after
// about pi sqrt(M / m) / 2 hits on each side (Galperin 2003), 314 in all for a mass ratio of 10^4.
TEST(Progress, SpeedFactorLeavesASqueezedBallItsSpeed) {
    Scene s = box_under_gravity({ball(5, 0.6), ball(5, 2)}, 1);
    s.gravity = Vec2::Zero();
    s.speed_factor = 0.8;
    s.balls[1].mass = 1e4;
    s.balls[1].velocity = {0, -1};
    World world(s, {.threads = 1});
    world.advance_to(3);
    EXPECT_LE(world.counts().ball_collisions + world.counts().wall_collisions, 400U);
    EXPECT_GT(world.velocities()[1].y(), 0.5);
    EXPECT_TRUE(world.validate().empty());
}

TEST(Progress, BallWithoutRoomIsRefused) {
    Scene s = box_under_gravity({ball(5, 0.5)}, 1);
    s.walls = {{{0, 1}, {10, 1}, 1}};
    s.balls[0].velocity = {1, 0};
    World world(s);
    try {
        world.advance_to(1);
        FAIL() << "advanced";
    } catch (const std::runtime_error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("balls[0]: is wedged: more than ")) << error.what();
    }
}

}  // namespace
}  // namespace carom::test
