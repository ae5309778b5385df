// Numbers of 113 bits, the fast half of the oracle. A product of two doubles is exact in them, so that the
// error of every decision taken in them can be bounded by hand.
#pragma once

#include <cfloat>
#include <cmath>

namespace carom::accuracy {

#if LDBL_MANT_DIG == 113
using Quad = long double;
#else
__extension__ typedef __float128 Quad;
#endif

/// For times and bounds, which need the range of Quad but not its digits.
using Wide = long double;

/// Half an ulp of 1 in Quad, and in Wide.
inline constexpr Wide kQuadUnit = 0x1p-113L;
inline constexpr Wide kWideUnit = LDBL_EPSILON / 2;

inline Quad magnitude(Quad x) {
    return x < 0 ? -x : x;
}

/// To two units: one step of Newton doubles the 64 bits of a Wide.
inline Quad square_root(Quad x) {
    if (!(x > 0)) return 0;
    const Quad guess = std::sqrt(static_cast<Wide>(x));
    return guess + (x - guess * guess) / (2 * guess);
}

/// Half an ulp of x, by which reading x from a decimal may have changed it; 0 for 0, which is meant.
inline double half_ulp(double x) {
    return x == 0 ? 0 : std::ldexp(1.0, std::ilogb(x) - DBL_MANT_DIG);
}

}  // namespace carom::accuracy
