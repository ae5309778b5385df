// The sum without order: any order and any split gives the same bits, for terms of any size it holds.
#include "ordered_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace carom {
namespace {

double sum_of(const std::vector<double>& terms, double typical = 1) {
    OrderedSum sum;
    sum.set_scale(typical);
    for (const double term : terms) sum += term;
    return sum.value();
}

TEST(OrderedSum, IsTheSameInAnyOrder) {
    std::mt19937_64 random(1);
    std::vector<double> terms;
    for (int k = 0; k < 1000; ++k) {
        const double size = std::exp2(static_cast<double>(random() % 40) - 10);
        terms.push_back(size * std::uniform_real_distribution<double>(-1, 1)(random));
    }
    const double first = sum_of(terms);
    for (int k = 0; k < 20; ++k) {
        std::shuffle(terms.begin(), terms.end(), random);
        EXPECT_EQ(sum_of(terms), first);
    }
}

// 2^12 typical terms and more go another way, 2^70 and more are beyond it.
TEST(OrderedSum, HoldsLargeTermsExactly) {
    EXPECT_EQ(sum_of({0x1p40, 1, -0x1p40}), 1);
    EXPECT_EQ(sum_of({1, 0x1p69, 0x1p-50, -0x1p69}), 1 + 0x1p-50);
    EXPECT_EQ(sum_of({3 * 0x1p-1000, 0x1p-940}, 0x1p-1000), 3 * 0x1p-1000 + 0x1p-940);
    EXPECT_EQ(sum_of({0x1p1001, -0x1p1000}, 0x1p1000), 0x1p1000);
}

TEST(OrderedSum, IsNoNumberBeyondWhatItHolds) {
    EXPECT_TRUE(std::isnan(sum_of({1, 0x1p70, -0x1p70})));
    EXPECT_TRUE(std::isnan(sum_of({std::numeric_limits<double>::infinity()})));
    EXPECT_TRUE(std::isnan(sum_of({std::numeric_limits<double>::quiet_NaN(), 1})));
}

TEST(OrderedSum, GoesOnFromWhatWasSaved) {
    for (const double large : {-0x1p60, 0x1p65, 0x1p75}) {
        OrderedSum sum;
        sum.set_scale(1);
        sum += large;
        OrderedSum other;
        other.set_scale(1);
        other.restore(sum.saved());
        sum += 0.5;
        other += 0.5;
        EXPECT_EQ(std::isnan(sum.value()), large == 0x1p75);
        EXPECT_TRUE(std::isnan(other.value()) || other.value() == sum.value());
        EXPECT_EQ(other.saved().high, sum.saved().high);
        EXPECT_EQ(other.saved().low, sum.saved().low);
        EXPECT_EQ(other.saved().is_lost, sum.saved().is_lost);
    }
}

}  // namespace
}  // namespace carom
