// Whole files as text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace carom {

/// At most so much is read of a pipe; a file has a size of its own.
inline constexpr std::uint64_t kMostOfPipe = std::uint64_t{2} << 30;

/// Everything in the file. Throws FileError when it is missing, cannot be read, or is a folder, device, FIFO
/// or socket: some of these have no end. What the program has been given open may be a pipe or a terminal:
/// /dev/stdin, /dev/fd/N, /proc/self/fd/N; of a pipe no more is read than that.
[[nodiscard]] std::string read_file(const std::filesystem::path& path,
                                    std::uint64_t most_of_pipe = kMostOfPipe);

}  // namespace carom
