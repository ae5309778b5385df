// What libFuzzer calls with each input.
#include <cstddef>
#include <cstdint>

#include "inputs.hpp"

// libFuzzer's names, not ours.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    carom::fuzz::CAROM_FUZZ_TAKE({reinterpret_cast<const char*>(data), size});
    return 0;
}
