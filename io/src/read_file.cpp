// read_file in large blocks; the size is not asked for, because pipes have none.
#include "read_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>

#include <carom/io/atomic_file.hpp>

#include "posix_write.hpp"

namespace carom {

std::string read_file(const std::filesystem::path& path) {
    const auto fail = [&path](int error_number) {
        return FileError(path, "cannot be read: " + reason(error_number));
    };
    const auto close = [](std::FILE* file) { std::fclose(file); };
    const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
    if (!file) throw fail(errno);

    constexpr std::size_t kBlock = std::size_t{1} << 20;
    std::string text;
    std::size_t size = 0;
    while (std::feof(file.get()) == 0 && std::ferror(file.get()) == 0) {
        if (text.size() - size < kBlock) text.resize(text.size() + std::max(kBlock, text.size() / 2));
        size += std::fread(text.data() + size, 1, text.size() - size, file.get());
    }
    if (std::ferror(file.get()) != 0) throw fail(errno);  // a directory opens, but does not read
    text.resize(size);
    return text;
}

}  // namespace carom
