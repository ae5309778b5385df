// In which floating-point type a ball's state is held.
#pragma once

#include <cstdint>

#include <carom/core/vector.hpp>

namespace carom {

/// kFloat: a ball's position and velocity are rounded to float at each of its events, as in a program that
/// stores them so; times, and the arithmetic from one event to the next, stay in double.
enum class Precision : std::uint8_t { kDouble, kFloat };

/// Through memory: where two of them stand side by side, GCC 12 at -O2 makes a vector of the conversion there
/// and back and then drops both.
[[nodiscard]] inline double rounded_to_float(double x) {
    const volatile float rounded = static_cast<float>(x);
    return static_cast<double>(rounded);
}

[[nodiscard]] inline Vec2 rounded_to_float(const Vec2& v) {
    return {rounded_to_float(v.x()), rounded_to_float(v.y())};
}

}  // namespace carom
