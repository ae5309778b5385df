// Lines of text that come one after the other: into a file that appears when it is whole, or one that grows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <carom/io/atomic_file.hpp>
#include <carom/io/growing_file.hpp>

namespace carom {

/// Lines are buffered. All members throw FileError; one thread at a time.
class RowFile {
 public:
    /// A file that appears under its name with commit(), with this line first.
    RowFile(const std::filesystem::path& path, std::string_view header);
    /// A file that grows, from the start or, where `kept` is not 0, after its first `kept` bytes: see
    /// GrowingFile.
    RowFile(const std::filesystem::path& path, std::string_view header, std::uint64_t kept);

    /// To append a whole line to; end_row() is to follow.
    [[nodiscard]] std::string& row() { return buffer_; }
    void end_row();
    void commit();
    /// Of a file that grows: forces the lines to the disk and gives the bytes that they take.
    std::uint64_t sync();

 private:
    void flush();

    std::optional<AtomicFile> whole_;
    std::unique_ptr<GrowingFile> growing_;  // where that is not
    std::string buffer_;
};

}  // namespace carom
