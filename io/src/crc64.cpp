// Eight bytes at a time with eight tables (Kounavis and Berry 2008, "slicing by 8").
#include "crc64.hpp"

#include <array>

#include "little_endian.hpp"

namespace carom {
namespace {

constexpr std::size_t kSlices = 8;
using Tables = std::array<std::array<std::uint64_t, 256>, kSlices>;

constexpr Tables make_tables() {
    constexpr std::uint64_t kPolynomial = 0xc96c5795d7870f42;  // 0x42f0e1eba9ea3693, its bits reversed
    Tables tables{};
    for (std::uint64_t byte = 0; byte < 256; ++byte) {
        std::uint64_t rest = byte;
        for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? kPolynomial : 0);
        tables[0][byte] = rest;
    }
    for (std::size_t slice = 1; slice < kSlices; ++slice)
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint64_t before = tables[slice - 1][byte];
            tables[slice][byte] = (before >> 8) ^ tables[0][before & 255];
        }
    return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

void Crc64::add(std::string_view bytes) {
    std::uint64_t state = state_;
    for (; bytes.size() >= kSlices; bytes.remove_prefix(kSlices)) {
        const std::uint64_t mixed = state ^ first_little_endian<std::uint64_t>(bytes);
        state = 0;
        for (std::size_t k = 0; k < kSlices; ++k) state ^= kTables[kSlices - 1 - k][(mixed >> (8 * k)) & 255];
    }
    for (const char byte : bytes)
        state = (state >> 8) ^ kTables[0][(state ^ static_cast<unsigned char>(byte)) & 255];
    state_ = state;
}

}  // namespace carom
