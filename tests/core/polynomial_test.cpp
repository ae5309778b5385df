// Where a cubic is negative: cubics made of chosen roots.
#include <carom/core/polynomial.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace carom {
namespace {

using Stretches = std::vector<std::pair<double, double>>;

Stretches stretches(const Cubic<double>& g, bool first_only = false) {
    Stretches found;
    visit_negative_stretches<double>(g, [&](double from, double to) {
        found.emplace_back(from, to);
        return first_only;
    });
    return found;
}

/// (t - a) (t - b) (t - c); exact for small whole numbers.
Cubic<double> of_roots(double a, double b, double c) {
    return {-a * b * c, a * b + b * c + c * a, -(a + b + c), 1};
}

/// (t - a) ((t - b)^2 + c^2)
Cubic<double> of_one_root(double a, double b, double c) {
    const double square = b * b + c * c;
    return {-a * square, square + 2 * a * b, -(a + 2 * b), 1};
}

void expect_stretches(const Cubic<double>& g, const Stretches& expected) {
    const Stretches found = stretches(g);
    ASSERT_EQ(found.size(), expected.size());
    // A root of whole coefficients that are exact, well apart from the others: some roundings of g's terms.
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].first, expected[i].first, 1e-13);
        EXPECT_EQ(found[i].first == 0, expected[i].first == 0);
        EXPECT_NEAR(found[i].second, expected[i].second, 1e-13);
    }
}

TEST(Polynomial, AnswersBetweenTheRootsThatLieAhead) {
    expect_stretches(of_roots(1, 2, 5), {{0, 1}, {2, 5}});
    expect_stretches(of_roots(-1, 2, 5), {{2, 5}});
    expect_stretches(of_roots(-3, -2, 5), {{0, 5}});
    expect_stretches(of_roots(-3, -2, -1), {});
    expect_stretches(of_roots(-7, 1, 2), {{1, 2}});
    expect_stretches(of_roots(1, 8, 9), {{0, 1}, {8, 9}});
    expect_stretches(of_roots(0.25, 0.5, 9), {{0, 0.25}, {0.5, 9}});
    expect_stretches(of_roots(0.5, 0.625, 0.75), {{0, 0.5}, {0.625, 0.75}});
    EXPECT_EQ(stretches(of_roots(1, 2, 5), true).size(), 1U) << "ends where the visitor has seen enough";
}

TEST(Polynomial, AnswersOfCubicsWithOneRoot) {
    expect_stretches(of_one_root(3, 0, 1), {{0, 3}});
    expect_stretches(of_one_root(3, -4, 1), {{0, 3}});
    expect_stretches(of_one_root(1, 5, 1), {{0, 1}});
    expect_stretches(of_one_root(0.5, 2, 8), {{0, 0.5}});
    expect_stretches(of_one_root(-1, 2, 1), {});
    expect_stretches(of_one_root(-0.01, 1, 5), {});
    expect_stretches(of_one_root(-1, -2, 1), {});
    expect_stretches({-7, 0, 0, 1}, {{0, std::cbrt(7.0)}});
}

// It is negative between roots only: from a root at 0 on as its slope there says.
TEST(Polynomial, ARootAtZeroIsNoStretchOfItsOwn) {
    expect_stretches(of_roots(0, 2, 5), {{2, 5}});
    expect_stretches(of_roots(0, 1, 5), {{1, 5}});
    expect_stretches(of_roots(-1, 0, 5), {{0, 5}});
    expect_stretches(of_roots(-2, -1, 0), {});
    expect_stretches(of_one_root(0, 2, 1), {});
    expect_stretches(of_one_root(0, 1, 5), {});
    expect_stretches(of_one_root(0, -2, 1), {});
    expect_stretches({0, 0, -3, 1}, {{0, 3}});
    EXPECT_EQ(detail::last_root<double>(of_roots(1, 1, 1), 1), 1) << "no way to go";
}

// A touch from above begins no stretch, one from below ends none.
TEST(Polynomial, TouchesDoNotCount) {
    expect_stretches(of_roots(-1, 2, 2), {});
    expect_stretches(of_roots(1, 1, 4), {{0, 4}});
}

// t^3 + t^2 / 2 - 1e-20 t + 1e-41 is a parabola as far as 1e-20 goes, whose roots are 1e-20 (1 -+ sqrt(0.8)).
// Its turning point is lost where the textbook's formula cancels.
TEST(Polynomial, KeepsATurningPointNearZero) {
    const Stretches found = stretches({1e-41, -1e-20, 0.5, 1});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].first, 1e-20 * (1 - std::sqrt(0.8)), 1e-33);
    EXPECT_NEAR(found[0].second, 1e-20 * (1 + std::sqrt(0.8)), 1e-33);
}

TEST(Polynomial, APowerOfTwoAboveTheCubeRoot) {
    for (double x = 1e-30; x < 1e30; x *= 1.01) {
        const double above = detail::above_cube_root(x);
        ASSERT_EQ(std::exp2(std::round(std::log2(above))), above);
        ASSERT_GT(above, std::cbrt(x) * (1 - 1e-15));
        ASSERT_LE(above, 2 * std::cbrt(x) * (1 + 1e-15));
    }
}

// Newton's step from a turning point leads nowhere, from beside it far away.
TEST(Polynomial, AMonotoneRootFromAnywhere) {
    const Cubic<double> g = of_roots(-4, 1, 5);
    for (const double start : {-1.0, 0.0, 1.0, 2.0, 3.0, 3.5}) {
        EXPECT_NEAR(detail::monotone_root<double>(g, -1, 3.5, false, start), 1, 1e-14) << start;
    }
    const Cubic<double> flat{-0.25, 0, 0, 1};  // its slope is 0 at 0
    EXPECT_NEAR(detail::monotone_root<double>(flat, -1, 2, true, 0), std::cbrt(0.25), 1e-15);
}

}  // namespace
}  // namespace carom
