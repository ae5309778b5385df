// Random numbers that are the same with every library: the generator is the standard's, what is made of it is
// ours.
#pragma once

#include <array>
#include <cstdint>
#include <random>

namespace carom::detail {

/// What a stream of random numbers is for. Each has its own, so that a change of temperature leaves every
/// place as it was.
enum class Stream : std::uint8_t { kRadii = 1, kPlaces = 2, kVelocities = 3 };

class Random {
 public:
    /// `fill` is the index of the fill: two fills of one seed differ.
    Random(std::uint64_t seed, std::uint64_t fill, Stream stream);

    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    /// Two that are uniform in [-1, 1), multiples of 2^-31, from one draw.
    std::array<double, 2> symmetric_pair() {
        const std::uint64_t bits = engine_();
        return {static_cast<double>(static_cast<std::int64_t>(bits >> 32) - 0x80000000LL) * 0x1p-31,
                static_cast<double>(static_cast<std::int64_t>(bits & 0xffffffffU) - 0x80000000LL) * 0x1p-31};
    }
    /// Uniform in 0 .. n - 1, but for a bias of n / 2^64.
    std::uint64_t below(std::uint64_t n) { return engine_() % n; }
    /// Two independent standard normal numbers.
    std::array<double, 2> normal_pair();

 private:
    std::mt19937_64 engine_;
};

/// The natural logarithm of a positive normal number to a few ulp, by exact operations and a fixed series
/// alone.
[[nodiscard]] double portable_log(double x);

}  // namespace carom::detail
