// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace carom {

/// A file that cannot be written or read: one line that names the path and the reason.
class FileError : public std::runtime_error {
 public:
    FileError(const std::filesystem::path& path, const std::string& reason)
        : std::runtime_error(path.string() + ": " + reason) {}
};

/// A file written beside its target and put in its place by commit(): a reader sees the old file or the whole
/// new one. Destroyed without a commit, it leaves nothing behind. A target that is no regular file (a pipe, a
/// terminal, /dev/null) is written directly. All members throw FileError; one thread at a time.
class AtomicFile {
 public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;

    [[nodiscard]] const std::filesystem::path& target() const { return target_; }

    /// Where the bytes are until commit(), for another program that writes them in place of write().
    [[nodiscard]] const std::filesystem::path& written_path() const {
        return temporary_.empty() ? target_ : temporary_;
    }

    /// Appends. Large pieces are cheap, small ones cost a system call each.
    void write(std::string_view text);
    /// Forces the content to the disk, renames, and forces the folder. Nothing may be written afterwards.
    void commit();

 private:
    [[noreturn]] void fail(const char* action, int error_number);
    void discard() noexcept;

    std::filesystem::path target_;
    std::filesystem::path temporary_;  ///< empty where the target is written directly
    int descriptor_ = -1;
};

/// The whole of a file at once.
void write_file(const std::filesystem::path& target, std::string_view text);

}  // namespace carom
