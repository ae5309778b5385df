// The empirical method: near the exact one where a step ends in overlap, and what it misses.
#include <carom/core/bisection.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "core/disc.hpp"
#include "core/random.hpp"

namespace carom {
namespace {

using test::disc;

constexpr double kTolerance = 1e-6;

TEST(Bisection, FindsWhatTheStepEndsIn) {
    const auto impact =
        bisect_ball_ball<double>(disc({0, 0}, {1, 0}, 0.5), disc({4, 0}, {-1, 0}, 0.5), 2.0, kTolerance);
    ASSERT_TRUE(impact);
    EXPECT_LE(impact->time, 1.5);
    EXPECT_GE(impact->time, 1.5 - kTolerance / 2) << "the gap closes at speed 2";
    EXPECT_EQ(impact->velocity_a, Vec2(-1, 0));
    EXPECT_EQ(impact->normal, Vec2(-1, 0));
}

// By hand: the parts of a short wall, whose length is none of its units.
TEST(Bisection, KnowsThePartOfAWallThatIsNearest) {
    const auto nearest = [](const Vec2& p) { return detail::distance_to_wall<double>(p, {1, 1}, {1.5, 1}); };
    EXPECT_EQ(nearest({1.25, 3}).feature, WallFeature::kFace);
    EXPECT_EQ(nearest({1.25, 3}).distance, 2);
    EXPECT_EQ(nearest({1.0625, 1.5}).feature, WallFeature::kFace);
    EXPECT_EQ(nearest({1.0625, 1.5}).distance, 0.5);
    EXPECT_EQ(nearest({0.25, 2}).feature, WallFeature::kFrom);
    EXPECT_EQ(nearest({0.25, 2}).distance, 1.25);
    EXPECT_EQ(nearest({2.25, 0}).feature, WallFeature::kTo);
    EXPECT_EQ(nearest({2.25, 0}).distance, 1.25);
}

TEST(Bisection, AWallWithoutLengthIsAPoint) {
    const auto nearest = detail::distance_to_wall<double>({4, 5}, {1, 1}, {1, 1});
    EXPECT_EQ(nearest.distance, 5);
    EXPECT_EQ(nearest.feature, WallFeature::kFrom);
}

TEST(Bisection, ATouchAtTheEndIsNoOverlap) {
    EXPECT_FALSE(
        bisect_ball_ball<double>(disc({0, 0}, {1, 0}, 0.5), disc({4, 0}, {0, 0}, 0.5), 3.0, kTolerance));
}

TEST(Bisection, EndsAtTheToleranceOrAtTheContactItself) {
    const auto closing = [](double t) { return 1 - t; };
    EXPECT_EQ(detail::bisect_contact<double>(2, 1, closing), 0) << "as far away as is allowed";
    EXPECT_EQ(detail::bisect_contact<double>(2, 0, closing), 1) << "met by the first cut";
}

// Each cut halves the stretch, and the gap that is left is at most as long: 20 cuts, besides both ends.
TEST(Bisection, CutsInHalves) {
    for (const double contact : {0.001, 0.3, 0.7, 0.999}) {
        int asked = 0;
        const auto gap = [&](double t) {
            ++asked;
            return contact - t;
        };
        const auto time = detail::bisect_contact<double>(1, 0x1p-20, gap);
        ASSERT_TRUE(time);
        EXPECT_LE(contact - *time, 0x1p-20);
        EXPECT_LE(asked, 22) << contact;
    }
}

// A gap that jumps below 0 leaves two neighbours, whose middle rounds to the one or the other.
TEST(Bisection, EndsWhereNoTimeIsBetween) {
    double contact = 1.25;
    for (int i = 0; i < 8; ++i, contact = std::nextafter(contact, 2.0)) {
        const auto gap = [&](double t) { return t < contact ? 1.0 : -1.0; };
        EXPECT_EQ(detail::bisect_contact<double>(2, 0, gap), std::nextafter(contact, 0.0));
    }
}

TEST(Bisection, ComesWithinTheToleranceOfTheExactTime) {
    SCOPED_TRACE("seed 61");
    test::Random random(61);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto a = disc(random.direction(3), {0, 0}, 0.5, 1, 1, random.vector(1));
        auto moving = a;
        moving.motion.velocity = -a.motion.position + random.vector(0.3);
        const auto b = disc({0, 0}, {0, 0}, 0.5);
        const auto exact = ball_static_impact<double>(moving, b, 1.0);
        const auto found = bisect_ball_static<double>(moving, b, 1.0, kTolerance);
        if (!found) continue;
        ++hits;
        ASSERT_TRUE(exact) << i;
        const double gap = position_at<double>(moving.motion, found->time).norm() - 1;
        ASSERT_GE(gap, 0) << i;
        ASSERT_LE(gap, kTolerance) << i;
        // From the gap left at time t the exact way closes within the rest of the step.
        auto later = moving;
        later.motion = {position_at<double>(moving.motion, found->time),
                        velocity_at<double>(moving.motion, found->time), moving.motion.acceleration};
        const auto rest = ball_static_impact<double>(later, b, 1.0);
        ASSERT_TRUE(rest) << i;
        ASSERT_LE(found->time + rest->time, 1) << i;
    }
    EXPECT_GT(hits, 1000);
}

TEST(Bisection, FindsFacesAndTipsOfWalls) {
    const auto face =
        bisect_ball_wall<double>(disc({0, 3}, {1, -1}, 1), {-5, 0}, {5, 0}, 1.0, 2.5, kTolerance);
    ASSERT_TRUE(face);
    EXPECT_NEAR(face->time, 2, kTolerance);
    EXPECT_EQ(face->velocity_a, Vec2(1, 1));
    const auto tip =
        bisect_ball_wall<double>(disc({1.06, 1}, {0, -1}, 0.1), {0, 0}, {1, 0}, 1.0, 0.95, kTolerance);
    ASSERT_TRUE(tip);
    EXPECT_NEAR(tip->time, 0.92, 2 * kTolerance);
    EXPECT_EQ(tip->point, Vec2(1, 0));
}

TEST(Bisection, OverlapAtTheStartIsTimeZeroOrNothing) {
    const auto in =
        bisect_ball_ball<double>(disc({0, 0}, {1, 0}, 0.5), disc({0.9, 0}, {0, 0}, 0.5), 0.1, kTolerance);
    ASSERT_TRUE(in);
    EXPECT_EQ(in->time, 0);
    EXPECT_FALSE(
        bisect_ball_ball<double>(disc({0, 0}, {-0.1, 0}, 0.5), disc({0.9, 0}, {0, 0}, 0.5), 0.1, kTolerance));
    EXPECT_FALSE(
        bisect_ball_ball<double>(disc({0, 0}, {0, 1}, 0.5), disc({0.9, 0}, {0, 0}, 0.5), 0.1, kTolerance))
        << "slides";
}

TEST(Bisection, EndsWithoutATolerance) {
    const auto impact =
        bisect_ball_ball<double>(disc({0, 0}, {1, 0.1}, 0.5), disc({4, 0}, {-1, 0}, 0.5), 2.0, 0.0);
    ASSERT_TRUE(impact);
    EXPECT_NEAR(impact->time,
                ball_ball_impact<double>(disc({0, 0}, {1, 0.1}, 0.5), disc({4, 0}, {-1, 0}, 0.5), 2.0)->time,
                1e-14);
}

// A fast ball is past the other, or the wall, when the step ends.
TEST(Bisection, MissesTunnelling) {
    const auto bullet = disc({-10, 0}, {100, 0}, 0.1);
    const auto target = disc({0, 0}, {0, 0}, 0.5);
    EXPECT_TRUE(ball_ball_impact<double>(bullet, target, 1.0));
    EXPECT_FALSE(bisect_ball_ball<double>(bullet, target, 1.0, kTolerance));
    EXPECT_TRUE(bisect_ball_ball<double>(bullet, target, 0.1, kTolerance)) << "a shorter step sees it";
    EXPECT_TRUE(ball_wall_impact<double>(bullet, {0, -1}, {0, 1}, 1.0, 1.0));
    EXPECT_FALSE(bisect_ball_wall<double>(bullet, {0, -1}, {0, 1}, 1.0, 1.0, kTolerance));
}

// The case with four roots, dt = 6, and the parabolas of the chord test: they come back within the step.
TEST(Bisection, MissesParabolasThatComeBack) {
    const auto arch = disc({-3, -16}, {1, 12}, 0.5, 1, 1, {0, -4});
    const auto target = disc({0, 0}, {0, 0}, 0.5);
    EXPECT_EQ(ball_static_impact<double>(arch, target, 6.0)->time, 2);
    EXPECT_FALSE(bisect_ball_static<double>(arch, target, 6.0, kTolerance));
    const auto ceiling = disc({0, -1}, {0, 3}, 0.25, 1, 1, {0, -2});
    EXPECT_TRUE(ball_wall_impact<double>(ceiling, {-10, 1}, {10, 1}, 1.0, 3.0));
    EXPECT_FALSE(bisect_ball_wall<double>(ceiling, {-10, 1}, {10, 1}, 1.0, 3.0, kTolerance));
}

}  // namespace
}  // namespace carom
