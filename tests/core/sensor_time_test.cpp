// When a ball is in a sensor: closed forms, and the distance at many times.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <carom/core/sensor_time.hpp>

#include "core/limits.hpp"
#include "random.hpp"
#include "sensor_distance.hpp"

namespace carom::test {
namespace {

// Seven units to the left, speed two: the surfaces meet at 3 and part at 9 of the way.
TEST(SensorTime, StraightThroughADisc) {
    const auto s = stretches_inside({{-6, 0}, {2, 0}, {0, 0}}, 1, {{{0, 0}}, 2}, kInfinity);
    ASSERT_EQ(s.size(), 1U);
    EXPECT_NEAR(s[0].from, 1.5, 2 * kEpsilon);
    EXPECT_NEAR(s[0].to, 4.5, 4 * kEpsilon);
}

TEST(SensorTime, BallsThatStandStillStayWhereTheyAre) {
    const Sensor disc{{{0, 0}}, 2};
    const auto in = stretches_inside({{1, 2.5}, {0, 0}, {0, 0}}, 1, disc, 100);
    ASSERT_EQ(in.size(), 1U);
    EXPECT_EQ(in[0].from, 0);
    EXPECT_EQ(in[0].to, kInfinity);
    EXPECT_TRUE(stretches_inside({{1, 3.5}, {0, 0}, {0, 0}}, 1, disc, 100).empty());
}

// Thrown up through a gate, down again through it: y = 4 t - t^2 passes 3 -+ 1/2 at 2 -+ sqrt(1 +- 1/2).
TEST(SensorTime, UpAndDownThroughAGate) {
    const Sensor gate{{{-5, 3}, {5, 3}}};
    const auto s = stretches_inside({{0, 0}, {0, 4}, {0, -2}}, 0.5, gate, 10);
    ASSERT_EQ(s.size(), 2U);
    EXPECT_NEAR(s[0].from, 2 - std::sqrt(1.5), 8 * kEpsilon);
    EXPECT_NEAR(s[0].to, 2 - std::sqrt(0.5), 8 * kEpsilon);
    EXPECT_NEAR(s[1].from, 2 + std::sqrt(0.5), 16 * kEpsilon);
    EXPECT_NEAR(s[1].to, 2 + std::sqrt(1.5), 16 * kEpsilon);
}

// Past the gate's end: the ball touches the end alone, half a radius aside.
TEST(SensorTime, PastAnEnd) {
    const Sensor gate{{{0, 0}, {0, 4}}};
    const auto s = stretches_inside({{-3, 4.5}, {1, 0}, {0, 0}}, 1, gate, 10);
    ASSERT_EQ(s.size(), 1U);
    EXPECT_NEAR(s[0].from, 3 - std::sqrt(0.75), 8 * kEpsilon);
    EXPECT_NEAR(s[0].to, 3 + std::sqrt(0.75), 8 * kEpsilon);
}

// Through a square from side to side, along a diagonal, and round its corner at a distance.
TEST(SensorTime, ThroughASquareInEitherOrderOfItsCorners) {
    Sensor square{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, 0.25};
    for (int turn = 0; turn < 2; ++turn) {
        auto s = stretches_inside({{-3, 1}, {1, 0}, {0, 0}}, 0.75, square, 20);
        ASSERT_EQ(s.size(), 1U);
        EXPECT_NEAR(s[0].from, 2, 8 * kEpsilon);
        EXPECT_NEAR(s[0].to, 8, 16 * kEpsilon);
        s = stretches_inside({{-3, -3}, {1, 1}, {0, 0}}, 0.75, square, 20);
        ASSERT_EQ(s.size(), 1U);
        EXPECT_NEAR(s[0].from, 3 - std::numbers::sqrt2 / 2, 16 * kEpsilon);
        EXPECT_NEAR(s[0].to, 7 + std::numbers::sqrt2 / 2, 32 * kEpsilon);
        std::swap(square.corners[1], square.corners[3]);
    }
}

Sensor random_sensor(Random& random) {
    Sensor s;
    const int kind = static_cast<int>(random.uniform(0, 4));
    const Vec2 centre = random.vector(3);
    if (kind < 2) {
        for (int k = 0; k <= kind; ++k) s.corners.push_back(centre + random.vector(2));
    } else {  // on a circle, so convex
        const int n = 3 + static_cast<int>(random.uniform(0, 5));
        const double start = random.uniform(0, 6);
        const double size = random.uniform(0.1, 2);
        const double way = random.sign() * 2 * std::numbers::pi / n;
        for (int k = 0; k < n; ++k) {
            const double angle = start + way * (k + random.uniform(-0.3, 0.3));
            s.corners.push_back(centre + size * Vec2(std::cos(angle), std::sin(angle)));
        }
    }
    s.radius = kind % 2 == 0 ? random.uniform(0, 1) : 0;
    return s;
}

// The distance is computed to some ulps of the places, ten; whoever is nearer to the border than 1e-12 may be
// counted on either side.
TEST(SensorTime, AgreesWithTheDistanceAtAnyTime) {
    Random random(7);
    int inside = 0;
    int looked = 0;
    for (int k = 0; k < 4000; ++k) {
        const Sensor sensor = random_sensor(random);
        const bool curved = random.sign() > 0;
        const Motion<double> m{random.vector(4), random.vector(1.5), curved ? random.vector(1) : Vec2(0, 0)};
        const double radius = random.uniform(0.1, 1);
        const auto stretches = stretches_inside(m, radius, sensor, 5);
        for (const Stretch& s : stretches) {
            ASSERT_GE(s.from, 0);
            ASSERT_GT(s.to, s.from);
            ASSERT_LE(s.from, 5) << "beyond the horizon";
        }
        for (std::size_t i = 0; i + 1 < stretches.size(); ++i)
            ASSERT_LT(stretches[i].to, stretches[i + 1].from);
        for (int i = 0; i < 50; ++i) {
            const double t = random.uniform(0, 5);
            const double depth = distance_to_shape(position_at(m, t), sensor) - radius - sensor.radius;
            if (std::abs(depth) < 1e-12) continue;
            const bool is_told =
                std::ranges::any_of(stretches, [t](const Stretch& s) { return s.from <= t && t < s.to; });
            ASSERT_EQ(is_told, depth < 0) << "case " << k << " at " << t << ", depth " << depth;
            inside += is_told;
            ++looked;
        }
    }
    EXPECT_GT(inside, looked / 30);
    EXPECT_LT(inside, looked / 2);
}

// What a frame asks for must not depend on where the frame ends.
TEST(SensorTime, EndsDoNotDependOnTheHorizon) {
    Random random(8);
    for (int k = 0; k < 2000; ++k) {
        const Sensor sensor = random_sensor(random);
        const Motion<double> m{random.vector(6), random.vector(3), random.vector(2)};
        const auto all = stretches_inside(m, 0.5, sensor, 1e3);
        for (int i = 0; i < 10; ++i) {
            const double horizon = random.uniform(0, 6);
            const auto some = stretches_inside(m, 0.5, sensor, horizon);
            for (std::size_t j = 0; j < all.size() && all[j].from <= horizon; ++j) {
                ASSERT_LT(j, some.size());
                ASSERT_EQ(some[j].from, all[j].from);
                if (all[j].to <= horizon)
                    ASSERT_EQ(some[j].to, all[j].to);
                else
                    ASSERT_GT(some[j].to, horizon);
            }
        }
    }
}

}  // namespace
}  // namespace carom::test
