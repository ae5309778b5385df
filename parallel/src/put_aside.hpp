// Copies of records that are not read again soon.
#pragma once

#include <cstddef>
#include <type_traits>

#include "ball_record.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace carom {

static_assert(std::is_trivially_copyable_v<BallRecord> && sizeof(BallRecord) % 16 == 0);

/// Copies a record to memory without a place in the caches, where the machine can: they hold what is worked
/// on. Other threads may read it after finish_aside().
inline void put_aside(BallRecord& to, const BallRecord& from) {
#if defined(__SSE2__)
    auto* target = reinterpret_cast<__m128i*>(&to);
    const auto* source = reinterpret_cast<const __m128i*>(&from);
    for (std::size_t k = 0; k < sizeof(BallRecord) / sizeof(__m128i); ++k)
        _mm_stream_si128(target + k, _mm_load_si128(source + k));
#else
    to = from;
#endif
}

/// Such stores are in no order with others until this has been called.
inline void finish_aside() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

}  // namespace carom
