// Random values for property tests: the same on every platform, because only the generator comes from the
// standard library.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include <carom/core/vector.hpp>

namespace carom::testing_values {

using Generator = std::mt19937_64;

inline std::uint64_t below(Generator& generator, std::uint64_t limit) {
    return generator() % limit;
}

/// In [0, 1).
inline double unit(Generator& generator) {
    return static_cast<double>(generator() >> 11U) * 0x1p-53;
}

/// Any finite double, all bit patterns alike: huge, tiny, denormal; now and then a zero of either sign.
inline double any_finite(Generator& generator) {
    constexpr std::uint64_t kSpecial = 16;
    switch (below(generator, kSpecial)) {
        case 0:
            return 0.0;
        case 1:
            return -0.0;
        case 2:
            return std::bit_cast<double>(generator() >> 12U);  // denormal
        case 3:
            return static_cast<double>(static_cast<std::int64_t>(below(generator, 2001)) - 1000);
        default:
            break;
    }
    double value = std::bit_cast<double>(generator());
    while (!std::isfinite(value)) value = std::bit_cast<double>(generator());
    return value;
}

/// The same up to the largest size that a scene allows.
inline double any_allowed(Generator& generator) {
    double value = any_finite(generator);
    while (std::abs(value) > 1e100) value = any_finite(generator);
    return value;
}

inline double any_positive(Generator& generator) {
    double value = std::abs(any_allowed(generator));
    while (value < 1e-100) value = std::abs(any_allowed(generator));
    return value;
}

inline Vec2 any_vector(Generator& generator) {
    const double x = any_allowed(generator);
    return {x, any_allowed(generator)};
}

inline bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const Vec2& a, const Vec2& b) {
    return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y());
}

}  // namespace carom::testing_values
