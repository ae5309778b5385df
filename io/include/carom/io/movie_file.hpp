// Movies: frames of pixels, encoded by the ffmpeg program.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <carom/io/atomic_file.hpp>

namespace carom {

enum class MovieFormat : std::uint8_t { kMp4, kGif };

struct MovieShape {
    MovieFormat format = MovieFormat::kMp4;
    int width = 0;  ///< pixels; H.264 has even sides only, an odd one gets a line of black more
    int height = 0;
    double frames_per_second = 30;
};

/// A movie that appears under its name when finish() has come to its end, whole or not at all. The frames go
/// to ffmpeg through a pipe; no shell is between. It runs in a process group of its own, so that Ctrl-C on a
/// terminal is the caller's alone. All members throw FileError, with the last line that ffmpeg said; one
/// thread at a time. SIGPIPE must be ignored by the program while frames are written.
class MovieFile {
 public:
    /// Starts ffmpeg, which is looked up in PATH. Throws FileError that names the package where there is
    /// none.
    MovieFile(const std::filesystem::path& target, const MovieShape& shape);
    /// Without finish() ffmpeg is ended and nothing is left behind.
    ~MovieFile();
    MovieFile(const MovieFile&) = delete;
    MovieFile& operator=(const MovieFile&) = delete;

    /// One frame: rows from the top, a pixel a native 32-bit number 0x00RRGGBB, no gaps.
    void write_frame(std::string_view pixels);
    void finish();

 private:
    void start(const MovieShape& shape);
    [[noreturn]] void fail();
    [[nodiscard]] std::string last_words() const;

    AtomicFile file_;
    pid_t process_ = -1;
    int frames_ = -1;  ///< the pipe's end that is written to
    int words_ = -1;   ///< the file without a name that takes what ffmpeg says
};

}  // namespace carom
