// Time of impact on a line and on a segment: the rule case by case, the scenes where simpler ways go wrong,
// the bouncing ball.
#include <carom/core/wall_time.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include <carom/core/disc_time.hpp>
#include <carom/core/response.hpp>

#include "core/limits.hpp"
#include "core/table.hpp"

namespace carom {
namespace {

using test::kEpsilon;
using test::kInfinity;

double side(double gap, double speed, double acceleration) {
    return side_time_of_impact<double>(gap, speed, acceleration);
}

TEST(SideTime, MeetsTheSide) {
    EXPECT_EQ(side(6, -2, 0), 3);
    EXPECT_EQ(side(1, 0, -2), 1) << "falls from rest";
    EXPECT_EQ(side(0, 2, -2), 2) << "thrown up from the floor";
    EXPECT_EQ(side(3, 2, -2), 3) << "thrown up from above";
    EXPECT_EQ(side(3, -4, 2), 1) << "braked, and still arrives";
    EXPECT_EQ(side(4, -4, 2), kInfinity) << "braked to a touch";
    EXPECT_EQ(side(1, 0, 0), kInfinity);
    EXPECT_EQ(side(1, 1, 0), kInfinity);
}

TEST(SideTime, FollowsTheRuleInContact) {
    EXPECT_EQ(side(0, -1, 0), 0) << "approaches";
    EXPECT_EQ(side(0, -1e-170, 0), 0) << "approaches, however slowly";
    EXPECT_EQ(side(0, 1, 0), kInfinity) << "leaves";
    EXPECT_EQ(side(0, 0, 0), kInfinity) << "rests";
    EXPECT_EQ(side(0, 0, -1), 0) << "rests and is pressed on";
    EXPECT_EQ(side(0, 0, 1), kInfinity) << "rests and is lifted";
    EXPECT_EQ(side(0, -1, 1), 0) << "approaches while braked";
    EXPECT_EQ(side(-1, 1, -1), 1) << "still below at the turning point";
    EXPECT_EQ(side(-0.5, 1, -1), 1) << "just up to the line at the turning point";
    EXPECT_EQ(side(-1.5, 2, -1), 3) << "rises through at 1, falls through at 3";
    EXPECT_EQ(side(-1, -1, 0), 0) << "below and falling";
    EXPECT_EQ(side(-1, 1, 1), kInfinity) << "below and leaving";
}

// The small root of a parabola whose large root is 1e9 away: the textbook's formula keeps seven digits of it.
TEST(SideTime, KeepsItsDigitsWhereTheTextbookFormulaCancels) {
    const double t = side(1e-9, -1, 1e-9);
    EXPECT_NEAR(t, 1e-9, 1e-9 * 4 * kEpsilon);
}

// Impacts on the floor: gap 1, gravity 2, restitution e. Times and speeds of the closed form, after at most
// 51 events.
TEST(SideTime, FollowsTheBouncingBall) {
    for (const test::Row& row : test::read_table("bouncing_ball.csv")) {
        SCOPED_TRACE("e " + row[0] + ", impact " + row[1]);
        const double e = std::stod(row[0]);
        const int impacts = std::stoi(row[1]);
        double time = 0;
        double speed = 0;
        double gap = 1;
        for (int k = 0; k <= impacts; ++k) {
            const double t = side(gap, speed, -2);
            time += t;
            speed = bounce<double>({0, speed - 2 * t}, {0, 1}, e).y();
            gap = 0;
        }
        // Each of the impacts rounds time and speed a few times.
        const double bound = 4 * (impacts + 1) * kEpsilon;
        EXPECT_NEAR(time, std::stod(row[2]), bound * time);
        EXPECT_NEAR(speed, std::stod(row[3]), bound * speed);
    }
}

// --- segments ---

WallHit<double> hit(const Vec2& p, const Vec2& v, const Vec2& a, double radius, const Vec2& from,
                    const Vec2& to) {
    return wall_time_of_impact<double>(Motion<double>{p, v, a}, radius, from, to);
}

struct WallCase {
    Vec2 p, v, a;
    double radius;
    Vec2 from, to;
    double time;
    WallFeature feature;
};

/// wall_counterexamples.csv in numbers, by the first words of its scenes. The last is a static disc and
/// stands in disc_time_test.
std::map<std::string, WallCase> wall_cases() {
    const double root2 = std::sqrt(2.0);
    return {
        {"slanted 45deg wall",
         {{0.5, 2}, {0, -1}, {0, 0}, 0.1, {0, 0}, {1, 1}, 1.5 - 0.1 * root2, WallFeature::kFace}},
        {"vertical wall", {{1, 0.5}, {-1, 0}, {0, 0}, 0.1, {0, 0}, {0, 1}, 0.9, WallFeature::kFace}},
        {"endpoint: wall", {{1.06, 1}, {0, -1}, {0, 0}, 0.1, {0, 0}, {1, 0}, 0.92, WallFeature::kTo}},
        {"endpoint with gravity", {{1.06, 1.08}, {0, 0}, {0, -2}, 0.1, {0, 0}, {1, 0}, 1, WallFeature::kTo}},
        {"chord prefilter miss (two roots)",
         {{0, -2}, {1, 3}, {0, -2}, 0, {-10, 0}, {10, 0}, 1, WallFeature::kFace}},
        {"chord prefilter miss with radius",
         {{0, -1}, {0, 3}, {0, -2}, 0.25, {-10, 1}, {10, 1}, (3 - root2) / 2, WallFeature::kFace}},
        {"chord ok for line but misses",
         {{0, 0}, {1, 2}, {0, -2}, 0, {1, 0.8}, {1, 1.2}, 1, WallFeature::kFace}},
    };
}

TEST(WallTime, HitsWhereSimplerWaysGoWrong) {
    const auto cases = wall_cases();
    std::size_t found = 0;
    for (const test::Row& row : test::read_table("wall_counterexamples.csv")) {
        SCOPED_TRACE(row[0]);
        for (const auto& [name, c] : cases) {
            if (row[0].rfind(name, 0) != 0) continue;
            ++found;
            // Decimal inputs are rounded to doubles: 1.06 - 1 has lost four bits, and the tip's normal is
            // steep.
            for (const bool turned : {false, true}) {
                const WallHit<double> h = turned ? hit(c.p, c.v, c.a, c.radius, c.to, c.from)
                                                 : hit(c.p, c.v, c.a, c.radius, c.from, c.to);
                EXPECT_NEAR(h.time, c.time, 8 * kEpsilon);
                const WallFeature other = c.feature == WallFeature::kTo ? WallFeature::kFrom : c.feature;
                EXPECT_EQ(h.feature, turned ? other : c.feature);
            }
        }
        if (row[0].rfind("4-root quartic", 0) == 0) {
            ++found;
            EXPECT_EQ(disc_time_of_impact<double>({-3, -16}, {1, 12}, {0, -4}, 1.0), 2);
        }
    }
    EXPECT_EQ(found, 8U) << "every row of the table has its case";
}

TEST(WallTime, TheTipsNormalPointsFromTheTip) {
    const WallHit<double> h = hit({1.06, 1}, {0, -1}, {0, 0}, 0.1, {0, 0}, {1, 0});
    const Vec2 n = contact_normal<double>({1.06, 1 - h.time}, h.feature, {0, 0}, {1, 0}) / 0.1;
    EXPECT_NEAR(n.x(), 0.6, 16 * kEpsilon);
    EXPECT_NEAR(n.y(), 0.8, 16 * kEpsilon);
}

TEST(WallTime, TheFacesNormalPointsToTheLeft) {
    EXPECT_EQ(face_normal<double>({1, 1}, {3, 1}), Vec2(0, 1));
    EXPECT_EQ(face_normal<double>({1, 1}, {0.5, 1}), Vec2(0, -1));
    EXPECT_EQ(face_normal<double>({1, 1}, {1, 3}), Vec2(-1, 0));
    EXPECT_EQ(face_normal<double>({1, 1}, {1, 0.5}), Vec2(1, 0));
    EXPECT_EQ(face_normal<double>({1, 1}, {1, 1}), Vec2(0, 0)) << "no length";
}

// The foot goes by -1 + t / 2 + 5e-19 t^2, a parabola that is a line as far as doubles see.
TEST(WallTime, CrossesTheEndsUnderATinyAcceleration) {
    const detail::FootCrossings<double> crossings(-1, 0.5, 1e-18, 1);
    EXPECT_EQ(crossings.next(0), 2);
    EXPECT_EQ(crossings.next(3), 4);
    EXPECT_EQ(crossings.next(5), kInfinity);
}

// Height t - t^2: at time 1 the centre comes down through the line. So it is on its way to the other side.
TEST(WallTime, OnTheLineTheSideIsTheOneItGoesTo) {
    const Motion<double> arch{{0, 0}, {0, 1}, {0, -2}};
    const detail::LineApproach<double> rising(arch, 0.25, {-1, 0}, {1, 0}, 0.0);
    EXPECT_EQ(rising.speed, 1);
    const detail::LineApproach<double> falling(arch, 0.25, {-1, 0}, {1, 0}, 1.0);
    EXPECT_EQ(falling.speed, -1) << "seen from below";
    EXPECT_EQ(falling.acceleration, 2);
    EXPECT_EQ(falling.gap, -0.25);
}

TEST(WallTime, HasTwoSides) {
    EXPECT_EQ(hit({0, 3}, {0, -1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, 2);
    EXPECT_EQ(hit({0, -3}, {0, 1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, 2);
    EXPECT_EQ(contact_normal<double>({0, -1}, WallFeature::kFace, {-2, 0}, {2, 0}), Vec2(0, -1));
    EXPECT_EQ(contact_normal<double>({0, 1}, WallFeature::kFace, {-2, 0}, {2, 0}), Vec2(0, 1));
}

TEST(WallTime, HitsAnEndHeadOn) {
    const WallHit<double> h = hit({-5, 0}, {1, 0}, {0, 0}, 1, {0, 0}, {2, 0});
    EXPECT_EQ(h.time, 4);
    EXPECT_EQ(h.feature, WallFeature::kFrom);
}

TEST(WallTime, FallsOnAnEndAlongTheWall) {
    for (const double a : {6.0, 1.5}) {
        const WallHit<double> h = hit({-4, 0}, {0, 0}, {a, 0}, 1, {0, 0}, {2, 0});
        EXPECT_EQ(h.time, std::sqrt(6 / a));
        EXPECT_EQ(h.feature, WallFeature::kFrom);
    }
    EXPECT_EQ(hit({-3, 0}, {0, 0}, {1, 0}, 1, {0, 0}, {2, 0}).time, 2);
}

TEST(WallTime, PassesBeyondTheEnds) {
    EXPECT_EQ(hit({3.5, 3}, {0, -1}, {0, 0}, 1, {-2, 0}, {2, 0}).feature, WallFeature::kFace)
        << "as of no hit";
    EXPECT_EQ(hit({3.5, 3}, {0, -1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity);
    EXPECT_EQ(hit({0, 3}, {1, 0}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity);
    EXPECT_EQ(hit({3, 3}, {0, -1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity)
        << "a touch of the end's disc";
}

TEST(WallTime, FollowsTheRuleInContact) {
    EXPECT_EQ(hit({0, 1}, {1, -1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, 0) << "approaches";
    EXPECT_EQ(hit({0, 1}, {1, 1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity) << "leaves";
    EXPECT_EQ(hit({0, 1}, {1, 0}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity)
        << "slides along and off the end";
    EXPECT_EQ(hit({0, 1}, {0, 0}, {0, -1}, 1, {-2, 0}, {2, 0}).time, 0) << "rests under gravity";
    EXPECT_EQ(hit({0, 1}, {0, 2}, {0, -2}, 1, {-2, 0}, {2, 0}).time, 2) << "falls back";
    EXPECT_EQ(hit({0, 0}, {0, 1}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity)
        << "on the line itself, leaves upwards";
    EXPECT_EQ(hit({0, 0}, {0, 0}, {0, 0}, 1, {-2, 0}, {2, 0}).time, kInfinity)
        << "on the line itself, at rest";
    EXPECT_EQ(hit({0, 0}, {0, 0}, {0, 0.5}, 1, {-2, 0}, {2, 0}).time, kInfinity)
        << "on the line itself, drawn upwards";
}

// From the end's disc over the join to the face: pressed on by gravity there, it must be hit where it enters,
// not fall through.
TEST(WallTime, GoesFromTheEndToTheFace) {
    // In contact with the end at 45 degrees, moving along the disc's tangent and up: falls back on the face.
    const double h = std::sqrt(0.5);
    const WallHit<double> onto = hit({-h, h}, {1, 1}, {0, -1}, 1, {0, 0}, {10, 0});
    EXPECT_EQ(onto.feature, WallFeature::kFace);
    EXPECT_NEAR(h + onto.time - onto.time * onto.time / 2, 1, 8 * kEpsilon);
    EXPECT_GT(onto.time, 1);
    // Overlapping the end and sinking into the face only after the foot has passed the join.
    const WallHit<double> sinking = hit({-0.5, 0.8}, {1, 0.4}, {0, -0.5}, 1, {0, 0}, {10, 0});
    EXPECT_LT(sinking.time, kInfinity);
}

TEST(WallTime, AWallWithoutLengthIsAPoint) {
    const WallHit<double> h = hit({-5, 0}, {1, 0}, {0, 0}, 1, {0, 0}, {0, 0});
    EXPECT_EQ(h.time, 4);
    EXPECT_EQ(h.feature, WallFeature::kFrom);
    EXPECT_EQ(hit({-1.5, 0}, {1, 0}, {0, 0}, 1, {0, 0}, {0, 0}).time, 0.5);
    EXPECT_EQ(hit({-5, 2}, {1, 0}, {0, 0}, 1, {0, 0}, {0, 0}).time, kInfinity);
    EXPECT_EQ(hit({-5, 2}, {1, 0}, {0, 0}, 1, {0, 0}, {0, 0}).feature, WallFeature::kFace) << "as of no hit";
}

TEST(WallTime, ReadsASceneWall) {
    const Wall wall{{-2, 0}, {2, 0}, 1};
    EXPECT_EQ(wall_time_of_impact(Motion<double>{{0, 3}, {0, -1}, {0, 0}}, 1, wall).time, 2);
}

}  // namespace
}  // namespace carom
