// Bits folded into a number of 64: equal only where all that went in is equal, but for a chance of 2^-64.
#pragma once

#include <bit>
#include <cstdint>

#include <carom/core/clock.hpp>
#include <carom/core/vector.hpp>

namespace carom {

/// A mixing step of 64 bits (the finaliser of MurmurHash3).
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t h) {
    h ^= h >> 33;
    h *= 0xff51afd7ed558ccdULL;
    h ^= h >> 33;
    h *= 0xc4ceb9fe1a85ec53ULL;
    return h ^ (h >> 33);
}

struct Hash {
    std::uint64_t value = 0;

    Hash& operator<<(std::uint64_t bits) {
        value = mix(value ^ bits) + value;
        return *this;
    }
    Hash& operator<<(double x) { return *this << std::bit_cast<std::uint64_t>(x); }
    Hash& operator<<(const Vec2& v) { return *this << v.x() << v.y(); }
    Hash& operator<<(const Time& t) { return *this << static_cast<std::uint64_t>(t.epoch) << t.offset; }
};

}  // namespace carom
