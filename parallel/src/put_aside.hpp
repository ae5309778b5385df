// Copies of records that are not read again soon.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace carom {

/// Copies a record to memory without a place in the caches, where the machine can: they hold what is worked
/// on. Other threads may read it after finish_aside(). Whole cache lines, or the caches are asked after all.
template <class T>
inline void put_aside(T& to, const T& from) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) >= 64 && sizeof(T) % 64 == 0);
#if defined(__SSE2__)
    auto* target = reinterpret_cast<__m128i*>(&to);
    const auto* source = reinterpret_cast<const __m128i*>(&from);
    for (std::size_t k = 0; k < sizeof(T) / sizeof(__m128i); ++k)
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

/// A table that grows at its end, aside or not.
template <class T>
class AsideTable {
 public:
    void push_aside(const T& entry) { put_aside(next(), entry); }
    void push_back(const T& entry) { next() = entry; }
    void clear() { size_ = 0; }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const T& operator[](std::size_t k) const { return memory_[k]; }
    [[nodiscard]] const T* begin() const { return memory_.data(); }
    [[nodiscard]] const T* end() const { return memory_.data() + size_; }

 private:
    T& next() {
        if (size_ == memory_.size()) [[unlikely]]
            grow();
        return memory_[size_++];
    }
    [[gnu::noinline]] void grow() { memory_.resize(std::max<std::size_t>(64, 2 * size_)); }

    std::vector<T> memory_;  // with what was there and will be
    std::size_t size_ = 0;
};

}  // namespace carom
