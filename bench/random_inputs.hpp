// Inputs for the benchmarks: the same numbers on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <carom/core/vector.hpp>

namespace carom::bench {

/// Uniform numbers from the generator's top 53 bits; the standard's distributions differ between libraries.
class Uniform {
 public:
    explicit Uniform(std::uint64_t seed) : bits_(seed) {}
    [[nodiscard]] double operator()(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    /// A vector of uniform direction and uniform length.
    [[nodiscard]] Vec2 vector(double shortest, double longest) {
        const double angle = (*this)(0, 2 * std::numbers::pi), length = (*this)(shortest, longest);
        return {length * std::cos(angle), length * std::sin(angle)};
    }

 private:
    std::mt19937_64 bits_;
};

}  // namespace carom::bench
