// read_file in large blocks; the size is not asked for, because pipes have none.
#include <carom/io/read_file.hpp>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include <carom/io/atomic_file.hpp>

#include "posix_write.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

/// Whether the path names what the program was given open, which its user knows to end.
bool is_given_open(const fs::path& path) {
    const std::string text = path.lexically_normal().string();
    return text == "/dev/stdin" || text.starts_with("/dev/fd/") || text.starts_with("/proc/self/fd/");
}

FileError failure(const fs::path& path, const std::string& why) {
    return {path, "cannot be read: " + why};
}

/// Throws before the file is opened: to open a FIFO waits for who writes to it.
void check_kind(const fs::path& path) {
    std::error_code ignored;
    const fs::file_type type = fs::status(path, ignored).type();
    const bool is_pipe = type == fs::file_type::fifo || type == fs::file_type::socket;
    if (is_pipe && !is_given_open(path))
        throw failure(path,
                      "is a FIFO or a socket, no regular file; what comes through a pipe is /dev/stdin");
    const bool is_device = type == fs::file_type::character || type == fs::file_type::block;
    const bool is_terminal = is_given_open(path) && ::isatty(STDIN_FILENO) != 0;
    if (is_device && !is_terminal) throw failure(path, "is a device, no regular file");
}

}  // namespace

std::string read_file(const fs::path& path, std::uint64_t most_of_pipe) {
    check_kind(path);
    const auto close = [](std::FILE* file) { std::fclose(file); };
    const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
    if (!file) throw failure(path, reason(errno));

    constexpr std::size_t kBlock = std::size_t{1} << 20;
    const bool has_end = fs::is_regular_file(path);
    std::string text;
    std::size_t size = 0;
    while (std::feof(file.get()) == 0 && std::ferror(file.get()) == 0) {
        if (text.size() - size < kBlock) text.resize(text.size() + std::max(kBlock, text.size() / 2));
        size += std::fread(text.data() + size, 1, text.size() - size, file.get());
        if (!has_end && size > most_of_pipe)
            throw failure(path, "the pipe has brought " + std::to_string(most_of_pipe) +
                                    " bytes and no end; longer input must be a regular file");
    }
    if (std::ferror(file.get()) != 0)
        throw failure(path, reason(errno));  // a directory opens, but does not read
    text.resize(size);
    return text;
}

}  // namespace carom
