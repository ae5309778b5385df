// Files that grow as a run goes, can be read while they do, and can be gone on with later.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include <carom/io/atomic_file.hpp>

namespace carom {

/// A file that is appended to. All members throw FileError; one thread at a time.
class GrowingFile {
 public:
    /// Empties the file, or makes it.
    explicit GrowingFile(std::filesystem::path path);
    /// Goes on after the first `kept` bytes of a file and drops the rest. Refuses a file that has fewer: it
    /// is not the one that was left. What is no regular file (a pipe, /dev/null) is only written to.
    GrowingFile(std::filesystem::path path, std::uint64_t kept);
    ~GrowingFile();
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    void write(std::string_view text);
    /// Forces what has been written to the disk.
    void sync();
    /// Bytes from the file's start to its end, those that were kept included.
    [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
    struct OpenFlags {
        int value;
    };
    GrowingFile(std::filesystem::path path, OpenFlags flags);
    [[noreturn]] void fail(int error_number) const;

    std::filesystem::path path_;
    std::uint64_t size_ = 0;
    int descriptor_ = -1;
    bool is_regular_ = true;
};

}  // namespace carom
