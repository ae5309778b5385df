// The time of impact of two discs: its rule case by case, the accuracy of the quadratic against many digits
// and the published figures of its formulations, the quartic's exact cases.
#include <carom/core/disc_time.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "core/limits.hpp"
#include "core/many_digits.hpp"
#include "core/random.hpp"
#include "core/table.hpp"

namespace carom {
namespace {

using test::Big;
using test::kInfinity;
using test::Random;

double straight(const Vec2& r, const Vec2& v, double s) {
    return disc_time_of_impact<double>(r, v, s);
}

double curved(const Vec2& r, const Vec2& v, const Vec2& a, double s) {
    return disc_time_of_impact<double>(r, v, a, s);
}

TEST(DiscTime, MeetsHeadOn) {
    EXPECT_EQ(straight({-5, 0}, {2, 0}, 1), 2);
}

TEST(DiscTime, FollowsTheRuleInContact) {
    EXPECT_EQ(straight({1, 0}, {-1, 3}, 1), 0) << "touching and approaching";
    EXPECT_EQ(straight({1, 0}, {-1e-170, 1}, 1), 0) << "touching and approaching, however slowly";
    EXPECT_EQ(straight({1, 0}, {1, 0}, 1), kInfinity) << "touching and receding";
    EXPECT_EQ(straight({1, 0}, {0, 1}, 1), kInfinity) << "touching and sliding";
    EXPECT_EQ(straight({0.5, 0}, {-1, 0}, 1), 0) << "overlapping and approaching";
    EXPECT_EQ(straight({0.5, 0}, {1, 0}, 1), kInfinity) << "overlapping and receding";
    EXPECT_EQ(straight({3, 1}, {-1, 0}, 1), kInfinity) << "a touch on the way";
}

TEST(DiscTime, IsNeverNan) {
    EXPECT_EQ(straight({2, 0}, {0, 0}, 1), kInfinity);
    EXPECT_EQ(straight({0, 0}, {0, 0}, 1), kInfinity);
    EXPECT_EQ(straight({0, 0}, {1, 0}, 1), kInfinity);
    EXPECT_EQ(straight({1, 1}, {-1, -1}, 0), kInfinity) << "points touch, they do not overlap";
    EXPECT_EQ(curved({0, 0}, {0, 0}, {0, 0}, 1), kInfinity);
    EXPECT_EQ(curved({0, 0}, {0, 0}, {1, 0}, 1), kInfinity) << "from one centre every way leads out";
    EXPECT_EQ(curved({2, 0}, {0, 0}, {1e-200, 0}, 1), kInfinity) << "an acceleration whose square underflows";
}

TEST(DiscTime, FollowsTheRuleUnderAcceleration) {
    EXPECT_EQ(curved({0, 1}, {0, 0}, {0, -1}, 1), 0) << "at rest in contact, pressed together";
    EXPECT_EQ(curved({0, 1}, {0, 0}, {0, 1}, 1), kInfinity) << "at rest in contact, pulled apart";
    EXPECT_EQ(curved({0, 0.5}, {0, 0}, {0, -1}, 1), 0) << "at rest in overlap, pressed together";
    EXPECT_EQ(curved({0, 3}, {0, 0}, {0, -1}, 1), 2) << "falls from rest";
    EXPECT_EQ(curved({0, -3}, {0, 0}, {0, 1}, 1), 2);
    EXPECT_EQ(curved({-3, 0}, {0, 0}, {1, 0}, 1), 2);
    EXPECT_EQ(curved({0, 3}, {0, 4}, {0, 1}, 1), kInfinity) << "leaves";
    EXPECT_EQ(curved({5, 3}, {0, 4}, {0, -1}, 1), kInfinity) << "falls past";
}

TEST(DiscTime, HorizonCutsOffAndChangesNothingElse) {
    const Vec2 r(-3, -16);
    const Vec2 v(1, 12);
    const Vec2 a(0, -4);
    EXPECT_EQ(disc_time_of_impact<double>(r, v, a, 1.0, 2.0), 2);
    EXPECT_EQ(disc_time_of_impact<double>(r, v, a, 1.0, 1.999), kInfinity);
    EXPECT_EQ(disc_time_of_impact<double>(r, v, a, 1.0, 0.001), kInfinity);
    EXPECT_EQ(disc_time_of_impact<double>(r, v, a, 1.0, kInfinity), 2);
}

// What is found within any horizon from the impact on, and before it nothing: also where the acceleration
// alone brings the discs together, and after long.
TEST(DiscTime, AHorizonAtTheImpactItselfIsWideEnough) {
    SCOPED_TRACE("seed 15");
    Random random(15);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const double length = random.decades(-6, 6);
        const double time = random.decades(-6, 6);
        const Vec2 r = random.direction(length * random.uniform(1.1, 30));
        const Vec2 v = i % 2 == 0 ? Vec2(0, 0) : Vec2(random.vector(length / time));
        const Vec2 a = -r / (time * time);
        const double t = curved(r, v, a, length);
        if (!(t < kInfinity)) continue;
        ++hits;
        ASSERT_EQ(disc_time_of_impact<double>(r, v, a, length, t), t) << i;
        ASSERT_EQ(disc_time_of_impact<double>(r, v, a, length, std::nextafter(t, 0.0)), kInfinity) << i;
    }
    EXPECT_GT(hits, 1500);
}

// A disc that goes through another from x = -5 at speed 2: from t = 2 to t = 3 they overlap, at 2.5 they are
// one.
TEST(DiscTime, StartsInAnOverlapLaterOn) {
    const auto from = [](double not_before) {
        return detail::disc_time_from<double>({-5, 0}, {2, 0}, 1.0, not_before);
    };
    EXPECT_EQ(from(1), 2);
    EXPECT_EQ(from(2), 2);
    EXPECT_EQ(from(2.25), 2.25) << "still approaching";
    EXPECT_EQ(from(2.5), kInfinity) << "neither approaching nor receding";
    EXPECT_EQ(from(2.75), kInfinity);
}

// The discs are brought nearer until t = 1, where they turn: what is asked from there on finds nothing.
TEST(DiscTime, AStretchThatEndsWhereTheSearchBeginsIsOver) {
    const auto from = [](double not_before) {
        return detail::disc_time_from<double>({0.5, 0}, {-0.25, 0}, {0.25, 0}, 1.0, not_before);
    };
    EXPECT_EQ(from(0.5), 0.5);
    EXPECT_EQ(from(1), kInfinity);
}

// Gravity along -y is no danger to who stays aside of the disc; but only where rounding leaves no doubt.
TEST(DiscTime, KnowsWhoPassesBy) {
    const auto passes = [](const Vec2& r, const Vec2& v) {
        return detail::DiscQuartic<double>(r, v, {0, -1}, 1.0).passes_by();
    };
    for (const double side : {-1, 1}) {
        EXPECT_TRUE(passes({3 * side, 1}, {0, 2}));
        EXPECT_TRUE(passes({3 * side, 1}, {side, 0}));
        EXPECT_TRUE(passes({3 * side, 1}, {0.25 * side, 0}));
        EXPECT_FALSE(passes({3 * side, 1}, {-side, 0})) << "comes nearer";
        EXPECT_FALSE(passes({0.5 * side, 1}, {side, 0})) << "is above";
        EXPECT_FALSE(passes({side * (1 + 4 * std::numeric_limits<double>::epsilon()), 1}, {0, 0}));
    }
}

TEST(DiscTime, WithoutAccelerationTheQuarticHasTheQuadraticsBits) {
    Random random(11);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 r = random.vector(5);
        const Vec2 v = random.vector(1) - 0.3 * r;
        ASSERT_EQ(curved(r, v, {0, 0}, 1), straight(r, v, 1)) << i;
    }
}

// A vanishing acceleration moves the time by less than it is rounded: both must then be the exact time to an
// ulp or two.
TEST(DiscTime, ATinyAccelerationJoinsTheQuadraticWithoutASeam) {
    Random random(12);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec2 r = random.direction(random.uniform(1.001, 20));
        const Vec2 v = -r / random.uniform(1, 10) + random.vector(0.2);
        const double without = straight(r, v, 1);
        const double with = curved(r, v, random.direction(random.decades(-300, -25)), 1);
        ASSERT_EQ(without < kInfinity, with < kInfinity) << i;
        if (!(without < kInfinity)) continue;
        ++hits;
        // 4 half-ulps of the quadratic's own measured worst case (3.9e-16), one of the quartic's.
        ASSERT_NEAR(with, without, 6e-16 * without) << i;
    }
    EXPECT_GT(hits, 10000);
}

TEST(DiscTime, FloatAgreesWithDoubleToItsOwnDigits) {
    Random random(13);
    for (int i = 0; i < 2000; ++i) {
        const Vector2<float> r = random.direction(random.uniform(1.5, 20)).cast<float>();
        const Vector2<float> v = -r;
        const Vector2<float> a = random.vector(0.1).cast<float>();
        const double exact = curved(r.cast<double>(), v.cast<double>(), a.cast<double>(), 1);
        const float found = disc_time_of_impact<float>(r, v, a, 1.0F);
        ASSERT_EQ(exact < kInfinity, found < std::numeric_limits<float>::infinity());
        if (!(exact < kInfinity)) continue;
        // Four of float's ulps.
        ASSERT_NEAR(found, exact, 4 * 1.2e-7 * exact);
    }
}

// --- the published accuracy of the quadratic's formulations ---

struct Approach {
    Vec2 r, v;
    double s;
};

/// A scenario of impact_time_formulations.csv: impact parameter and distance in units of s.
Approach make_approach(Random& random, const std::string& scenario) {
    double parameter = random.uniform(-1, 1);
    double distance = random.uniform(1.001, 20);
    if (scenario.find("1e-6..1e-2") != std::string::npos)
        parameter = random.sign() * (1 - random.decades(-6, -2));
    if (scenario.find("1e-12..1e-8") != std::string::npos)
        parameter = random.sign() * (1 - random.decades(-12, -8));
    if (scenario.find("+-1e-16") != std::string::npos)
        parameter = random.sign() * (1 + random.sign() * random.decades(-16, -13));
    if (scenario.find("far") != std::string::npos) distance = random.decades(6, 8);
    if (scenario.find("near") != std::string::npos) distance = 1 + random.decades(-12, -6);
    const double s = random.uniform(0.5, 1.5);
    const Vec2 direction = random.direction(1);
    const Vec2 across(-direction.y(), direction.x());
    const double along = std::sqrt(std::max(0.0, (distance - parameter) * (distance + parameter)));
    return {s * (parameter * across - along * direction), random.uniform(0.1, 2) * direction, s};
}

/// The first crossing to overlap in 100 digits by the textbook's b^2 - a c; infinite where there is none.
Big exact_time(const Approach& p) {
    const auto r = test::big(p.r);
    const auto v = test::big(p.v);
    const Big b = dot<Big>(r, v);
    const Big a = dot<Big>(v, v);
    const Big c = dot<Big>(r, r) - Big(p.s) * Big(p.s);
    const Big discriminant = b * b - a * c;
    if (b >= 0 || discriminant <= 0) return std::numeric_limits<Big>::infinity();
    return c <= 0 ? Big(0) : Big((-b - sqrt(discriminant)) / a);
}

TEST(DiscTime, IsAsAccurateAsTheBestPublishedFormulation) {
    int scenarios = 0;
    for (const test::Row& row : test::read_table("impact_time_formulations.csv")) {
        const std::string& scenario = row[0];
        if (row[1] != "FMA cross+FMA D+double-double c") continue;
        SCOPED_TRACE(scenario + ", seed 14");
        ++scenarios;
        Random random(14);
        constexpr int kCases = 20000;
        std::vector<double> errors;
        int false_misses = 0;
        int false_hits = 0;
        for (int i = 0; i < kCases; ++i) {
            const Approach p = make_approach(random, scenario);
            const Big exact = exact_time(p);
            const double found = straight(p.r, p.v, p.s);
            const bool hits = exact < std::numeric_limits<Big>::infinity();
            if (hits && found < kInfinity)
                errors.push_back(exact == 0 ? found : double(abs((Big(found) - exact) / exact)));
            if (hits && !(found < kInfinity)) ++false_misses;
            if (!hits && found < kInfinity) ++false_hits;
        }
        std::sort(errors.begin(), errors.end());
        ASSERT_GT(errors.size(), 1000U);
        // The rows' figures are those of a sample: a tenth is allowed for the median's and the percentile's
        // scatter.
        EXPECT_LE(errors[errors.size() / 2], 1.1 * std::stod(row[2]));
        EXPECT_LE(errors[errors.size() * 99 / 100], 1.1 * std::stod(row[3]));
        EXPECT_LE(errors.back(), std::max(std::stod(row[4]), 4e-15));
        EXPECT_EQ(false_misses, 0);
        EXPECT_EQ(false_hits, 0);
    }
    EXPECT_EQ(scenarios, 6);
}

// --- the quartic's exact cases ---

TEST(DiscTime, SolvesEveryQuarticOfTheTable) {
    const auto rows = test::read_table("quartic_impacts.csv");
    ASSERT_EQ(rows.size(), 30U);
    for (const test::Row& row : rows) {
        SCOPED_TRACE(row[0]);
        double x[7];
        for (int i = 0; i < 7; ++i) x[i] = std::strtod(row[static_cast<std::size_t>(i) + 1].c_str(), nullptr);
        const double found = curved({x[0], x[1]}, {x[2], x[3]}, {x[4], x[5]}, x[6]);
        if (row[8] == "none") {
            EXPECT_EQ(found, kInfinity);
        } else {
            const Big exact(row[8]);
            // Two half-ulps: one of the answer, one of the last step.
            EXPECT_LE(abs(Big(found) - exact), exact * Big(std::numeric_limits<double>::epsilon())) << found;
        }
    }
}

}  // namespace
}  // namespace carom
