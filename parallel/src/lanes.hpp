// Eight floats or four doubles side by side, by the compilers' vector extension: plain arithmetic that every
// instruction set rounds alike.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace carom {

inline constexpr std::size_t kLanes = 8;
using Floats __attribute__((vector_size(kLanes * sizeof(float)))) = float;
using FloatMasks __attribute__((vector_size(kLanes * sizeof(float)))) = std::int32_t;
using Indices __attribute__((vector_size(kLanes * sizeof(float)))) = std::uint32_t;
using FourFloats __attribute__((vector_size(4 * sizeof(float)))) = float;

/// x and y of one ball, then of another.
using Doubles __attribute__((vector_size(4 * sizeof(double)))) = double;
using DoubleMasks __attribute__((vector_size(4 * sizeof(double)))) = std::int64_t;
using FourIntegers __attribute__((vector_size(4 * sizeof(std::int32_t)))) = std::int32_t;

/// The same for both balls.
[[nodiscard]] inline Doubles twice(double x, double y) {
    return Doubles{x, y, x, y};
}

[[nodiscard]] inline bool all_of(const DoubleMasks& masks) {
#ifdef __AVX__
    return _mm256_movemask_pd(std::bit_cast<__m256d>(masks)) == 15;
#else
    return (masks[0] & masks[1] & masks[2] & masks[3]) != 0;
#endif
}

/// One bit a lane: whether its mask is set.
[[nodiscard]] inline unsigned bits_of(const FloatMasks& masks) {
#ifdef __AVX__
    return static_cast<unsigned>(_mm256_movemask_ps(std::bit_cast<__m256>(masks)));
#else
    std::int32_t lanes[kLanes];  // GCC 12's bounds check goes astray in a vector that is passed by reference
    std::memcpy(lanes, &masks, sizeof(lanes));
    unsigned bits = 0;
    for (std::size_t k = 0; k < kLanes; ++k) bits |= (lanes[k] != 0 ? 1U : 0U) << k;
    return bits;
#endif
}

[[nodiscard]] inline Floats sqrt_of(const Floats& x) {
#ifdef __AVX__
    return std::bit_cast<Floats>(_mm256_sqrt_ps(std::bit_cast<__m256>(x)));
#else
    float lanes[kLanes];
    std::memcpy(lanes, &x, sizeof(lanes));
    for (float& lane : lanes) lane = std::sqrt(lane);
    Floats root;
    std::memcpy(&root, lanes, sizeof(root));
    return root;
#endif
}

/// The least lane; no lane may be NaN.
[[nodiscard]] inline float least_of(const Floats& x) {
    const Floats half = __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3);
    const Floats a = half < x ? half : x;
    const Floats quarter = __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5);
    const Floats b = quarter < a ? quarter : a;
    return b[1] < b[0] ? b[1] : b[0];
}

/// Four columns of eight rows of four.
struct Columns {
    Floats x, y, vx, vy;
};
[[nodiscard]] inline Columns columns_of(const FourFloats (&row)[kLanes]) {
    const auto side_by_side = [](const FourFloats& a, const FourFloats& b) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const Floats r04 = side_by_side(row[0], row[4]);
    const Floats r15 = side_by_side(row[1], row[5]);
    const Floats r26 = side_by_side(row[2], row[6]);
    const Floats r37 = side_by_side(row[3], row[7]);
    const Floats xy_01 = __builtin_shufflevector(r04, r15, 0, 8, 1, 9, 4, 12, 5, 13);
    const Floats xy_23 = __builtin_shufflevector(r26, r37, 0, 8, 1, 9, 4, 12, 5, 13);
    const Floats v_01 = __builtin_shufflevector(r04, r15, 2, 10, 3, 11, 6, 14, 7, 15);
    const Floats v_23 = __builtin_shufflevector(r26, r37, 2, 10, 3, 11, 6, 14, 7, 15);
    return {__builtin_shufflevector(xy_01, xy_23, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(xy_01, xy_23, 2, 3, 10, 11, 6, 7, 14, 15),
            __builtin_shufflevector(v_01, v_23, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(v_01, v_23, 2, 3, 10, 11, 6, 7, 14, 15)};
}

}  // namespace carom
