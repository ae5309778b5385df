// Random numbers that are the same everywhere: the standard's distributions are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <carom/core/vector.hpp>

namespace carom::test {

class Random {
 public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    /// A power of ten with a uniform exponent.
    double decades(double low, double high) { return std::pow(10, uniform(low, high)); }
    double sign() { return (bits_() & 1) != 0 ? 1 : -1; }
    Vec2 vector(double reach) {
        const double x = uniform(-reach, reach);
        return {x, uniform(-reach, reach)};
    }
    /// A vector of that length in any direction.
    Vec2 direction(double length) {
        const double angle = uniform(0, 6.283185307179586);
        return {length * std::cos(angle), length * std::sin(angle)};
    }

 private:
    std::mt19937_64 bits_;
};

}  // namespace carom::test
