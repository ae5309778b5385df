// Numbers as bytes, the lowest first, on any machine.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace carom {

/// From the first bytes; there must be enough of them.
template <class Unsigned>
[[nodiscard]] inline Unsigned first_little_endian(std::string_view bytes) {
    static_assert(std::is_unsigned_v<Unsigned>);
    Unsigned value = 0;
    if constexpr (std::endian::native == std::endian::little) {
        bytes.copy(reinterpret_cast<char*>(&value), sizeof(value));
    } else {
        for (std::size_t k = sizeof(value); k > 0; --k)
            value = static_cast<Unsigned>((value << 8) | static_cast<unsigned char>(bytes[k - 1]));
    }
    return value;
}

template <class Unsigned>
inline void append_little_endian(std::string& bytes, Unsigned value) {
    static_assert(std::is_unsigned_v<Unsigned>);
    char text[sizeof(value)];
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(text, &value, sizeof(value));
    } else {
        for (std::size_t k = 0; k < sizeof(value); ++k) text[k] = static_cast<char>((value >> (8 * k)) & 255);
    }
    bytes.append(text, sizeof(text));
}

}  // namespace carom
