// Whole impacts: time, point, normal and velocities of each kind of pair, and none where there is none.
#include <carom/core/impact.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "core/disc.hpp"
#include "core/limits.hpp"
#include "core/many_digits.hpp"
#include "core/random.hpp"

namespace carom {
namespace {

using test::disc;
using test::kEpsilon;

TEST(BallBallImpact, TellsWhenWhereAndHow) {
    const auto impact =
        ball_ball_impact<double>(disc({0, 0}, {1, 0}, 0.5, 1), disc({4, 0}, {-1, 0}, 0.5, 3), 10.0);
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 1.5);
    EXPECT_EQ(impact->point, Vec2(2, 0));
    EXPECT_EQ(impact->normal, Vec2(-1, 0)) << "from b to a";
    EXPECT_EQ(impact->velocity_a, Vec2(-2, 0));
    EXPECT_EQ(impact->velocity_b, Vec2(0, 0));
}

TEST(BallBallImpact, ReturnsNothingWhenReceding) {
    EXPECT_FALSE(ball_ball_impact<double>(disc({0, 0}, {-1, 0}, 0.5), disc({4, 0}, {1, 0}, 0.5), 10.0));
}

TEST(BallBallImpact, ReturnsNothingBeyondTheDuration) {
    const auto a = disc({0, 0}, {1, 0}, 0.5);
    const auto b = disc({4, 0}, {-1, 0}, 0.5);
    EXPECT_TRUE(ball_ball_impact<double>(a, b, 1.5));
    EXPECT_FALSE(ball_ball_impact<double>(a, b, 1.4999));
}

TEST(BallBallImpact, TakesTheSceneRule) {
    const auto a = disc({0, 0}, {1, 0}, 0.5, 1, 1);
    const auto b = disc({4, 0}, {-1, 0}, 0.5, 1, 0);
    EXPECT_EQ(ball_ball_impact<double>(a, b, 10.0)->velocity_a, Vec2(0, 0));
    EXPECT_EQ(ball_ball_impact<double>(a, b, 10.0, RestitutionRule::kMax)->velocity_a, Vec2(-1, 0));
}

TEST(BallBallImpact, ACommonAccelerationCancels) {
    const auto a = disc({0, 0}, {1, 0}, 0.5, 1, 1, {0, -10});
    const auto b = disc({4, 0}, {-1, 0}, 0.5, 1, 1, {0, -10});
    const auto impact = ball_ball_impact<double>(a, b, 10.0);
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 1.5);
    EXPECT_EQ(impact->point, Vec2(2, -11.25));
    EXPECT_EQ(impact->velocity_a, Vec2(-1, -15)) << "velocities fall too";
}

TEST(BallBallImpact, UnequalAccelerationsAreAQuartic) {
    const auto impact = ball_ball_impact<double>(disc({-3, -16}, {1, 12}, 0.25, 1, 1, {0, -4}),
                                                 disc({0, 0}, {0, 0}, 0.75), 10.0);
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 2);
    EXPECT_EQ(impact->normal, Vec2(-1, 0));
    EXPECT_EQ(impact->point, Vec2(-0.75, 0));
}

TEST(BallStaticImpact, TheObstacleStaysWhateverItsVelocity) {
    const auto impact =
        ball_static_impact<double>(disc({0, 0}, {1, 0.25}, 0.5), disc({4, 0.375 * 2}, {7, 7}, 0.5), 10.0);
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 3);
    EXPECT_EQ(impact->velocity_a, Vec2(-1, 0.25));
    EXPECT_EQ(impact->velocity_b, Vec2(0, 0));
    EXPECT_EQ(impact->point, Vec2(3.5, 0.75));
}

TEST(BallStaticImpact, ReturnsNothingBeyondTheDuration) {
    const auto impact = [](double duration) {
        return ball_static_impact<double>(disc({0, 0}, {1, 0}, 0.5), disc({4, 0}, {0, 0}, 0.5), duration);
    };
    EXPECT_TRUE(impact(3));
    EXPECT_FALSE(impact(2.9999));
}

TEST(BallStaticImpact, IsTheLimitOfAHugeMass) {
    test::Random random(51);
    for (int i = 0; i < 1000; ++i) {
        const auto ball = disc(random.direction(4), {0, 0}, 0.5, 1, random.uniform(0, 1));
        auto moving = ball;
        moving.motion.velocity = -ball.motion.position + random.vector(0.5);
        const auto fixed = ball_static_impact<double>(moving, disc({0, 0}, {0, 0}, 1), 10.0);
        const auto heavy = ball_ball_impact<double>(moving, disc({0, 0}, {0, 0}, 1, 1e300), 10.0);
        ASSERT_TRUE(fixed && heavy) << i;
        EXPECT_EQ(fixed->time, heavy->time);
        // Speeds are at most about 5: a few roundings of them.
        EXPECT_LE((fixed->velocity_a - heavy->velocity_a).norm(), 32 * kEpsilon);
    }
}

TEST(BallWallImpact, ReflectsOffTheFace) {
    const auto impact =
        ball_wall_impact<double>(disc({0, 3}, {1, -1}, 1, 1, 0.5), {-5, 0}, {5, 0}, 1.0, 10.0);
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 2);
    EXPECT_EQ(impact->point, Vec2(2, 0));
    EXPECT_EQ(impact->normal, Vec2(0, 1));
    EXPECT_EQ(impact->velocity_a, Vec2(1, 0.5));
    EXPECT_FALSE(ball_wall_impact<double>(disc({0, 3}, {1, -1}, 1), {-5, 0}, {5, 0}, 1.0, 1.9));
    EXPECT_TRUE(ball_wall_impact<double>(disc({0, 3}, {1, -1}, 1), {-5, 0}, {5, 0}, 1.0, 2.0));
    const auto above = ball_wall_impact<double>(disc({0, 5}, {1, -1}, 1), {-5, 2}, {5, 2}, 1.0, 10.0);
    ASSERT_TRUE(above);
    EXPECT_EQ(above->point, Vec2(2, 2));
}

TEST(BallWallImpact, ReflectsOffTheTip) {
    const auto impact = ball_wall_impact<double>(disc({1.06, 1}, {0, -1}, 0.1), {0, 0}, {1, 0}, 1.0, 10.0);
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->point, Vec2(1, 0));
    EXPECT_NEAR(impact->normal.x(), 0.6, 16 * kEpsilon);
    EXPECT_NEAR(impact->normal.y(), 0.8, 16 * kEpsilon);
    // v' = v - 2 (v.n) n
    EXPECT_NEAR(impact->velocity_a.x(), 2 * 0.8 * 0.6, 32 * kEpsilon);
    EXPECT_NEAR(impact->velocity_a.y(), 2 * 0.8 * 0.8 - 1, 32 * kEpsilon);
}

TEST(Impact, DiscsInOnePlaceMeetAlongX) {
    EXPECT_EQ(detail::unit_or_x<double>({0, 0}), Vec2(1, 0));
    EXPECT_EQ(detail::unit_or_x<double>({0, -3}), Vec2(0, -1));
}

TEST(Impact, ADiscIsOfDiameterAndMassOneAndElastic) {
    const Disc<double> d;
    EXPECT_EQ(d.radius, 0.5);
    EXPECT_EQ(d.mass, 1);
    EXPECT_EQ(d.restitution, 1);
}

// The same source in 100 digits is its own oracle.
TEST(BallBallImpact, AgreesWithManyDigits) {
    SCOPED_TRACE("seed 52");
    using test::Big;
    test::Random random(52);
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec2 p = random.direction(random.uniform(2, 10));
        const auto a = disc(p, random.vector(1) - p / 2, 0.5, random.decades(-2, 2), 1, random.vector(0.5));
        const auto b = disc({0, 0}, random.vector(0.1), 0.75, 1, 0.5, random.vector(0.1));
        const auto wide = [](const Disc<double>& d) {
            return Disc<Big>{{test::big(d.motion.position), test::big(d.motion.velocity),
                              test::big(d.motion.acceleration)},
                             d.radius,
                             d.mass,
                             d.restitution};
        };
        const auto found = ball_ball_impact<double>(a, b, 5.0);
        const auto exact = ball_ball_impact<Big>(wide(a), wide(b), Big(5));
        ASSERT_EQ(found.has_value(), exact.has_value()) << i;
        if (!found) continue;
        ++hits;
        // The relative motion is rounded once: a graze of depth d turns 1e-16 into 1e-16 / sqrt(d).
        EXPECT_NEAR(found->time, static_cast<double>(exact->time), 1e-12) << i;
        EXPECT_LE((found->velocity_a - exact->velocity_a.cast<double>()).norm(), 1e-11) << i;
    }
    EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace carom
