// Random numbers for drawn scenes: the same everywhere, which the standard's distributions are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <carom/core/scene.hpp>
#include <carom/core/vector.hpp>

namespace carom::stress {

class Draw {
 public:
    explicit Draw(std::uint64_t seed) : bits_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    /// A power of ten with a uniform exponent.
    double decades(double low, double high) { return std::pow(10, uniform(low, high)); }
    /// 0 .. count - 1.
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }
    /// True once in `n`, in the mean.
    bool one_in(std::size_t n) { return below(n) == 0; }
    Vec2 in_box(const Vec2& low, const Vec2& high) {
        const double x = uniform(low.x(), high.x());
        return {x, uniform(low.y(), high.y())};
    }
    /// A vector of that length in any direction.
    Vec2 direction(double length) {
        const double angle = uniform(0, 6.283185307179586);
        return {length * std::cos(angle), length * std::sin(angle)};
    }
    /// One of three kinds, that meets all or some of them.
    CollisionFilter filter() {
        constexpr std::uint32_t kKinds = 3;
        const std::uint32_t category = 1U << below(kKinds);
        return {category, one_in(3) ? CollisionFilter().mask : std::uint32_t(below(1U << kKinds))};
    }
    std::uint64_t bits() { return bits_(); }

 private:
    std::mt19937_64 bits_;
};

}  // namespace carom::stress
