// What a collision does to the velocities: the corrected formulas, the article's as printed with what they
// break, the limits.
#include <carom/core/response.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/limits.hpp"
#include "core/table.hpp"

namespace carom {
namespace {

using test::kEpsilon;

/// "7/16" or "-2".
double fraction(const std::string& text) {
    const std::size_t bar = text.find('/');
    return bar == std::string::npos ? std::stod(text)
                                    : std::stod(text.substr(0, bar)) / std::stod(text.substr(bar + 1));
}

struct HeadOn {
    double m1, m2, v1, v2, e1, e2;
};

struct Speeds {
    double v1, v2;
};

/// The article as printed: m1 - e m2 in both lines, and restitutions of both bodies mixed in them.
Speeds article(const HeadOn& c) {
    const double total = c.m1 + c.m2;
    return {((1 + c.e2) * c.m2 * c.v2 + (c.m1 - c.e2 * c.m2) * c.v1) / total,
            ((1 + c.e1) * c.m1 * c.v1 + (c.m1 - c.e2 * c.m2) * c.v2) / total};
}

/// The second line with m2 - e m1, but still two restitutions, one a line.
Speeds article_with_term_fixed(const HeadOn& c) {
    const double total = c.m1 + c.m2;
    return {article(c).v1, ((1 + c.e1) * c.m1 * c.v1 + (c.m2 - c.e1 * c.m1) * c.v2) / total};
}

/// collide() with body 2 to the right of body 1.
Speeds carom_speeds(const HeadOn& c) {
    const double e = pair_restitution(RestitutionRule::kMin, c.e1, c.e2);
    const auto after = collide<double>({c.v1, 0}, {c.v2, 0}, {-1, 0}, c.m1, c.m2, e);
    return {after.a.x(), after.b.x()};
}

double momentum_change(const HeadOn& c, const Speeds& after) {
    return c.m1 * (after.v1 - c.v1) + c.m2 * (after.v2 - c.v2);
}

double energy_ratio(const HeadOn& c, const Speeds& after) {
    const auto energy = [&](double v1, double v2) { return c.m1 * v1 * v1 + c.m2 * v2 * v2; };
    return energy(after.v1, after.v2) / energy(c.v1, c.v2);
}

void expect_columns(const HeadOn& c, const Speeds& after, const test::Row& row, std::size_t first) {
    // The figures are of order one, from a handful of roundings.
    EXPECT_NEAR(after.v1, fraction(row[first]), 8 * kEpsilon);
    EXPECT_NEAR(after.v2, fraction(row[first + 1]), 8 * kEpsilon);
    EXPECT_NEAR(momentum_change(c, after), fraction(row[first + 2]), 16 * kEpsilon);
    EXPECT_NEAR(energy_ratio(c, after), fraction(row[first + 3]), 16 * kEpsilon);
}

TEST(Response, GivesTheCorrectColumnsAndShowsTheArticlesErrors) {
    const auto rows = test::read_table("response_errata.csv");
    ASSERT_EQ(rows.size(), 6U);
    for (const test::Row& row : rows) {
        SCOPED_TRACE("m " + row[0] + " " + row[1] + ", v " + row[2] + " " + row[3] + ", e " + row[4] + " " +
                     row[5]);
        const HeadOn c{fraction(row[0]), fraction(row[1]), fraction(row[2]),
                       fraction(row[3]), fraction(row[4]), fraction(row[5])};
        expect_columns(c, article(c), row, 6);
        expect_columns(c, article_with_term_fixed(c), row, 10);
        EXPECT_EQ(pair_restitution(RestitutionRule::kMin, c.e1, c.e2), fraction(row[14]));
        expect_columns(c, carom_speeds(c), row, 15);
        EXPECT_NEAR(momentum_change(c, carom_speeds(c)), 0, 16 * kEpsilon);
    }
}

TEST(Response, RestitutionRules) {
    EXPECT_EQ(pair_restitution(RestitutionRule::kMin, 0.25, 1.0), 0.25);
    EXPECT_EQ(pair_restitution(RestitutionRule::kMax, 0.25, 1.0), 1);
    EXPECT_EQ(pair_restitution(RestitutionRule::kProduct, 0.25, 0.5), 0.125);
    EXPECT_EQ(pair_restitution(RestitutionRule::kMean, 0.25, 0.75), 0.5);
    EXPECT_EQ(pair_restitution(RestitutionRule::kGeometric, 0.25, 1.0), 0.5);
    EXPECT_EQ(pair_restitution(RestitutionRule::kGeometric, 0.5, 0.125), 0.25);
    EXPECT_EQ(pair_restitution(RestitutionRule::kGeometric, 0.9, 0.9), 0.9)
        << "equal ones give themselves, to the bit";
}

TEST(Response, ContactTimeMakesQuickRepeatsElastic) {
    EXPECT_EQ(tc_restitution(0.5, 0.9, 1.0), 1);
    EXPECT_EQ(tc_restitution(0.5, 1.0, 1.0), 0.5);
    EXPECT_EQ(tc_restitution(0.5, 0.0, 0.0), 0.5) << "a contact time of 0 turns it off";
}

TEST(Response, EqualMassesSwapTheirSpeedsExactly) {
    for (const double s : {1.0, 0.6, 1e-3}) {
        const auto after = collide<double>({3, 7}, {-2, 5}, {-s, 0}, 0.3, 0.3, 1.0);
        EXPECT_EQ(after.a, Vec2(-2, 7));
        EXPECT_EQ(after.b, Vec2(3, 5));
    }
}

// Five touching equal balls in a row: those that come in go out, and nothing else moves.
TEST(Response, TheCradleIsExact) {
    for (const int in : {1, 2}) {
        double v[5] = {};
        for (int k = 0; k < in; ++k) v[k] = 1;
        int collisions = 0;
        for (bool again = true; again;) {
            again = false;
            for (int k = 0; k < 4; ++k) {
                if (!(v[k] > v[k + 1])) continue;
                const auto after = collide<double>({v[k], 0}, {v[k + 1], 0}, {-1, 0}, 1.0, 1.0, 1.0);
                v[k] = after.a.x();
                v[k + 1] = after.b.x();
                ++collisions;
                again = true;
            }
        }
        EXPECT_EQ(collisions, in == 1 ? 4 : 6);
        for (int k = 0; k < 5; ++k) EXPECT_EQ(v[k], k >= 5 - in ? 1 : 0);
    }
}

// Two bodies and a wall count the digits of pi (Galperin 2003).
TEST(Response, TheBilliardCountsPi) {
    for (const test::Row& row : test::read_table("galperin.csv")) {
        const double ratio = std::stod(row[0]);
        double light = 0;
        double heavy = -1;
        int collisions = 0;
        for (;; ++collisions) {
            if (heavy < light) {
                const auto after = collide<double>({light, 0}, {heavy, 0}, {-1, 0}, 1.0, ratio, 1.0);
                light = after.a.x();
                heavy = after.b.x();
            } else if (light < 0) {
                light = bounce<double>({light, 0}, {1, 0}, 1.0).x();
            } else {
                break;
            }
        }
        EXPECT_EQ(collisions, std::stoi(row[1])) << "mass ratio " << ratio;
    }
}

// A head-on collision of equal masses in each of the four directions, at any distance.
TEST(Response, SwapsAlongEitherAxisExactly) {
    for (const double s : {0.3, 1.0, 3.0}) {
        for (const Vec2& n : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
            const auto after = collide<double>(-0.75 * n, 0.5 * n, s * n, 2.0, 2.0, 1.0);
            EXPECT_EQ(after.a, 0.5 * n);
            EXPECT_EQ(after.b, -0.75 * n);
            EXPECT_EQ(bounce<double>(-0.75 * n, s * n, 0.5), 0.375 * n);
        }
    }
}

TEST(Response, SeparatingBodiesKeepTheirVelocities) {
    const auto after = collide<double>({1, 2}, {-1, 3}, {1, 0}, 1.0, 2.0, 0.5, 1.0);
    EXPECT_EQ(after.a, Vec2(1, 2));
    EXPECT_EQ(after.b, Vec2(-1, 3));
    EXPECT_EQ(bounce<double>({1, 2}, {0, 1}, 0.5, 1.0), Vec2(1, 2));
    const auto at_one_place = collide<double>({1, 2}, {-1, 3}, {0, 0}, 1.0, 2.0, 0.5);
    EXPECT_EQ(at_one_place.a, Vec2(1, 2));
    for (const Vec2& v : {Vec2(3, 1), Vec2(-3, 1), Vec2(-3, -5)}) {
        EXPECT_EQ(collide<double>(v, {0, 0}, {0, 0}, 1.0, 2.0, 0.5).a, v) << "at one place";
        EXPECT_EQ(bounce<double>(v, {0, 0}, 0.5), v) << "at one place";
    }
    EXPECT_EQ(collide<double>({0.5, 2}, {0.25, 3}, {1, 0}, 1.0, 2.0, 0.5).a, Vec2(0.5, 2)) << "slowly";
    EXPECT_EQ(bounce<double>({-3, -4}, {3, 4}, 0.0), Vec2(0, 0)) << "and one that stops is not pushed";
}

TEST(Response, PartsAtTheSpeedAskedFor) {
    const auto slow = collide<double>({1, 0}, {0, 0}, {-1, 0}, 1.0, 1.0, 0.5, 0.125);
    EXPECT_EQ(slow.b.x() - slow.a.x(), 0.5) << "the restitution gives more";
    const auto fast = collide<double>({1, 0}, {0, 0}, {-1, 0}, 1.0, 1.0, 0.0, 0.125);
    EXPECT_EQ(fast.b.x() - fast.a.x(), 0.125) << "the restitution gives less";
    const auto at_rest = collide<double>({0, 0}, {0, 0}, {-2, 0}, 1.0, 1.0, 0.5, 0.125);
    EXPECT_EQ(at_rest.b.x() - at_rest.a.x(), 0.125);
    EXPECT_EQ(bounce<double>({3, 0}, {0, 1}, 0.5, 0.125), Vec2(3, 0.125));
    EXPECT_EQ(bounce<double>({3, 0.0625}, {0, 1}, 0.5, 0.125), Vec2(3, 0.125)) << "parts, but too slowly";
}

// The same along a line of centres that is neither an axis nor of length 1.
TEST(Response, PartsAtTheSpeedAskedForAlongAnyLine) {
    const Vec2 n(0.6, 0.8);
    for (const double speed : {-1.0, 0.0, 0.1}) {
        const auto after = collide<double>(speed * n, {0, 0}, 5 * n, 1.0, 1.0, 0.0, 0.125);
        EXPECT_NEAR((after.a - after.b).dot(n), 0.125, 8 * kEpsilon) << speed;
        EXPECT_NEAR(bounce<double>(speed * n, 5 * n, 0.0, 0.125).dot(n), 0.125, 8 * kEpsilon) << speed;
    }
    double impulse = 0;
    (void)collide<double>(-1 * n, {0, 0}, 5 * n, 1.0, 1.0, 1.0, 0.0, &impulse);
    EXPECT_NEAR(impulse, 1, 8 * kEpsilon) << "reduced mass 1/2, change of speed 2";
}

TEST(Response, ReportsTheImpulse) {
    double impulse = -1;
    (void)collide<double>({1, 0}, {-1, 0}, {-3, 0}, 1.0, 3.0, 1.0, 0.0, &impulse);
    EXPECT_EQ(impulse, 3) << "reduced mass 3/4, change of speed 4";
    (void)collide<double>({-1, 0}, {1, 0}, {-3, 0}, 1.0, 3.0, 1.0, 0.0, &impulse);
    EXPECT_EQ(impulse, 0);
}

TEST(Response, WallsAlongTheAxesAreExact) {
    EXPECT_EQ(bounce<double>({0.1, -0.3}, {0, 7}, 1.0), Vec2(0.1, 0.3));
    EXPECT_EQ(bounce<double>({0.1, 0.3}, {0, -0.7}, 0.9), Vec2(0.1, -(0.9 * 0.3)));
    EXPECT_EQ(bounce<double>({-0.1, 0.3}, {3, 0}, 0.9), Vec2(0.9 * 0.1, 0.3));
}

}  // namespace
}  // namespace carom
