// The error-free transformations, against 100 digits.
#include <carom/core/compensated.hpp>

#include <gtest/gtest.h>

#include "core/limits.hpp"
#include "core/many_digits.hpp"
#include "core/random.hpp"

namespace carom {
namespace {

using test::Big;
using test::kEpsilon;
using test::Random;

TEST(Compensated, SumsAndProductsLoseNothing) {
    SCOPED_TRACE("seed 1");
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const double a = random.sign() * random.decades(-20, 20);
        const double b = random.sign() * random.decades(-20, 20);
        const Twofold<double> product = two_product<double>(a, b);
        const Twofold<double> sum = two_sum<double>(a, b);
        ASSERT_EQ(Big(product.high) + product.low, Big(a) * b);
        ASSERT_EQ(Big(sum.high) + sum.low, Big(a) + b);
        ASSERT_EQ(product.high, a * b);
        ASSERT_EQ(sum.high, a + b);
    }
}

// Jeannerod, Louvet and Muller 2013: at most 1.5 ulp, that is 1.5 eps of the exact value.
TEST(Compensated, ADifferenceOfProductsKeepsItsDigits) {
    SCOPED_TRACE("seed 2");
    Random random(2);
    for (int i = 0; i < 10000; ++i) {
        const double a = random.uniform(-1, 1);
        const double b = random.uniform(-1, 1);
        const double c = a * (1 + random.sign() * random.decades(-16, 0));
        const Big exact = Big(a) * b - Big(c) * b;
        ASSERT_LE(abs(difference_of_products<double>(a, b, c, b) - exact), abs(exact) * 1.5 * kEpsilon);
    }
}

// A few eps^2 each: the parts dropped are products of two low parts, and each of some four sums of low parts
// rounds by eps / 2 of eps / 2.
TEST(Compensated, TwofoldNumbersKeepTwiceTheDigits) {
    SCOPED_TRACE("seed 4");
    Random random(4);
    const auto exact = [](const Twofold<double>& t) { return Big(Big(t.high) + t.low); };
    const auto twofold = [&] {
        return two_sum<double>(random.uniform(1, 2), random.uniform(-1, 1) * 0x1p-53);
    };
    constexpr double kBound = 4 * kEpsilon * kEpsilon;
    for (int i = 0; i < 10000; ++i) {
        const Twofold<double> a = twofold();
        const Twofold<double> b = twofold();
        const Big product = exact(a) * exact(b);
        const Big quotient = exact(a) / exact(b);
        ASSERT_LE(abs(exact(twofold_product<double>(a, b)) - product), kBound * product) << i;
        ASSERT_LE(abs(exact(twofold_quotient<double>(a, b)) - quotient), kBound * quotient) << i;
        const Vec2 r(a.high * random.decades(-3, 3), b.high);
        const Big square = dot<Big>(test::big(r), test::big(r));
        ASSERT_LE(abs(exact(length_squared_twofold<double>(r)) - square), kBound * square) << i;
    }
}

TEST(Compensated, TheGapNearContactKeepsItsDigits) {
    SCOPED_TRACE("seed 3");
    Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const Vec2 r = random.direction(1 + random.sign() * random.decades(-16, -1));
        const Big exact = dot<Big>(test::big(r), test::big(r)) - 1;
        // One rounding of the result, some of the lost halves.
        const Big bound = abs(exact) * kEpsilon + Big(8) * kEpsilon * kEpsilon;
        ASSERT_LE(abs(gap_squared<double>(r, 1.0) - exact), bound);
        ASSERT_EQ(gap_squared<double>({r.x(), 0}, {r.y(), 0}, 1.0), gap_squared<double>(r, 1.0));
    }
}

}  // namespace
}  // namespace carom
