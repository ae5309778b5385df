// The limits of double that the tests compare with.
#pragma once

#include <limits>

namespace carom::test {

/// From 1 to the next number: twice what one rounding changes at most.
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// The time of what never happens.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace carom::test
