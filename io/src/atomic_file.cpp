// AtomicFile on POSIX calls: the standard library can neither force a file to the disk nor refuse an existing
// name.
#include <carom/io/atomic_file.hpp>

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "posix_write.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

/// Opens a new file beside the target under a name that nobody has.
int open_beside(const fs::path& target, fs::path& temporary) {
    constexpr int kMostTries = 100;
    for (int i = 0; i < kMostTries; ++i) {
        temporary = target;
        temporary += fmt::format(".{}-{}.part", ::getpid(), i);
        const int descriptor =
            ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kReadWriteAll);
        if (descriptor >= 0 || errno != EEXIST) return descriptor;
    }
    return -1;
}

/// Forces the folder's list of names to the disk, so that a rename outlives a power cut; gives the errno. A
/// folder that must not be read, or that its file system does not force, is left to itself.
int sync_folder_of(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return 0;
    const int error = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
    ::close(descriptor);
    return error;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
    std::error_code ignored;
    // Through a link, so that the link stays and the file that it names is replaced.
    if (fs::is_symlink(target_, ignored)) {
        const fs::path real = fs::weakly_canonical(target_, ignored);
        if (!ignored) target_ = real;
    }
    const fs::file_status status = fs::status(target_, ignored);
    if (fs::is_directory(status)) throw FileError(target_, "cannot be written: is a directory");
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        descriptor_ = open_beside(target_, temporary_);
    }
    if (descriptor_ < 0) {
        const int error_number = errno;
        temporary_.clear();
        throw FileError(target_, "cannot be written: " + reason(error_number));
    }
    struct stat old_status{};
    if (!temporary_.empty() && ::stat(target_.c_str(), &old_status) == 0)
        (void)::fchmod(
            descriptor_,
            old_status.st_mode & 07777);  // a replaced file keeps its permissions where that is allowed
}

AtomicFile::~AtomicFile() {
    discard();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {
    other.temporary_.clear();
}

void AtomicFile::write(std::string_view text) {
    if (descriptor_ < 0) fail("written", EBADF);
    if (const int error = write_all(descriptor_, text); error != 0) fail("written", error);
}

void AtomicFile::commit() {
    if (descriptor_ < 0) fail("written", EBADF);
    // Pipes and terminals cannot be forced to a disk.
    if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail("written", errno);
    if (::close(std::exchange(descriptor_, -1)) != 0) fail("closed", errno);
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("put in its place", errno);
    temporary_.clear();
    if (const int error = sync_folder_of(target_); error != 0) fail("put in its place for good", error);
}

void AtomicFile::fail(const char* action, int error_number) {
    discard();
    throw FileError(target_, std::string("cannot be ") + action + ": " + reason(error_number));
}

void AtomicFile::discard() noexcept {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    if (temporary_.empty()) return;
    ::unlink(temporary_.c_str());
    temporary_.clear();
}

void write_file(const fs::path& target, std::string_view text) {
    AtomicFile file(target);
    file.write(text);
    file.commit();
}

}  // namespace carom
