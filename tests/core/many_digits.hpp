// The scalar of the oracles: 100 digits, in which every input of a test is exact.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <carom/core/vector.hpp>

namespace carom::test {

using Big =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;
using BigVector = Vector2<Big>;

inline BigVector big(const Vec2& v) {
    return {Big(v.x()), Big(v.y())};
}

}  // namespace carom::test
