// CRC-64/XZ, as in ECMA-182, reflected.
#pragma once

#include <cstdint>
#include <string_view>

namespace carom {

/// A checksum taken piece by piece. Any change of up to 64 bits in a row shows, any other but one in 2^64.
class Crc64 {
 public:
    void add(std::string_view bytes);
    [[nodiscard]] std::uint64_t value() const { return ~state_; }

 private:
    std::uint64_t state_ = ~std::uint64_t{0};
};

}  // namespace carom
