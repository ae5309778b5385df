// A coordinate brought into a period: what is inside already is spared the division, and comes out the same.
#include "pair_search.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace carom::detail {
namespace {

/// The definition, whatever x.
double wrapped_by_division(const Axis& axis, double x) {
    const double turned = x - axis.period * std::floor((x - axis.min) / axis.period);
    return turned - axis.min < axis.period ? turned : axis.min;
}

TEST(Axis, WrapsToTheBitsOfTheDivision) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::mt19937_64 random(71);
    const auto uniform = [&random] { return double(random() >> 11) * 0x1p-53; };
    for (int k = 0; k < 20000; ++k) {
        Axis axis;
        axis.period = std::ldexp(1 + uniform(), int(random() % 40) - 20);
        axis.min = k % 4 == 0 ? 0 : std::ldexp(uniform() - 0.5, int(random() % 40) - 20);
        const double max = axis.min + axis.period;
        for (const double x :
             {0.0, -0.0, axis.min, std::nextafter(axis.min, -kInfinity), std::nextafter(axis.min, kInfinity),
              max, std::nextafter(max, -kInfinity), std::nextafter(max, kInfinity),
              axis.min + uniform() * axis.period, axis.min + 10 * (uniform() - 0.5) * axis.period})
            ASSERT_EQ(std::bit_cast<std::uint64_t>(axis.wrapped(x)),
                      std::bit_cast<std::uint64_t>(wrapped_by_division(axis, x)))
                << "x " << x << " in " << axis.min << " + " << axis.period;
    }
}

}  // namespace
}  // namespace carom::detail
