#include <carom/io/growing_file.hpp>

#include <cerrno>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix_write.hpp"

namespace carom {

GrowingFile::GrowingFile(std::filesystem::path path, OpenFlags flags) : path_(std::move(path)) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | flags.value, kReadWriteAll);
    if (descriptor_ < 0) fail(errno);
    struct stat status{};
    is_regular_ = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
}

GrowingFile::GrowingFile(std::filesystem::path path)
    : GrowingFile(std::move(path), OpenFlags{O_CREAT | O_TRUNC}) {}

GrowingFile::GrowingFile(std::filesystem::path path, std::uint64_t kept)
    : GrowingFile(std::move(path), OpenFlags{0}) {
    size_ = kept;
    if (!is_regular_) return;
    struct stat status{};
    if (::fstat(descriptor_, &status) != 0) fail(errno);
    const auto length = static_cast<std::uint64_t>(status.st_size);
    if (length < kept)
        throw FileError(path_, "cannot be gone on with: has " + std::to_string(length) +
                                   " bytes, the checkpoint was made after " + std::to_string(kept));
    if (::ftruncate(descriptor_, static_cast<off_t>(kept)) != 0) fail(errno);
}

GrowingFile::~GrowingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void GrowingFile::write(std::string_view text) {
    if (const int error = write_all(descriptor_, text); error != 0) fail(error);
    size_ += text.size();
}

void GrowingFile::sync() {
    // Pipes and terminals cannot be forced to a disk.
    if (is_regular_ && ::fsync(descriptor_) != 0) fail(errno);
}

void GrowingFile::fail(int error_number) const {
    throw FileError(path_, "cannot be written: " + reason(error_number));
}

}  // namespace carom
