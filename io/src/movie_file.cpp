// ffmpeg as a child process: started without a shell, fed through a pipe, ended with the movie.
#include <carom/io/movie_file.hpp>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "posix_write.hpp"

namespace carom {
namespace {

using Words = std::vector<std::string>;

void append(Words& words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
}

Words encoder_words(MovieFormat format) {
    if (format == MovieFormat::kGif) {
        // The palette is the first frame's, so that ffmpeg need not keep the whole movie to make one. A
        // picture holds its colours' whole range from the start, in its legend.
        return {"-filter_complex",
                "split[a][b];[a]trim=end_frame=1,palettegen[p];[b][p]paletteuse=dither=none", "-f", "gif"};
    }
    // Sides padded to even ones and colours that every player knows; the index first, so that a browser can
    // begin before it has all.
    return {"-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
            "-c:v",
            "libx264",
            "-crf",
            "18",
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "bt709",
            "-movflags",
            "+faststart",
            "-f",
            "mp4"};
}

Words command_of(const MovieShape& shape, const std::string& path) {
    // Without -xerror a full disk is no failure to it.
    Words words = {"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-xerror", "-y"};
    const char* const pixels = std::endian::native == std::endian::little ? "bgr0" : "0rgb";
    append(words, {"-f", "rawvideo", "-pixel_format", pixels, "-video_size",
                   fmt::format("{}x{}", shape.width, shape.height), "-framerate",
                   fmt::format("{}", shape.frames_per_second), "-i", "pipe:0"});
    append(words, encoder_words(shape.format));
    words.push_back("file:" + path);  // a path with a colon in it is no protocol
    return words;
}

/// posix_spawn's settings, freed with the scope.
struct SpawnSettings {
    SpawnSettings() {
        posix_spawn_file_actions_init(&actions);
        posix_spawnattr_init(&attributes);
    }
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};
};

/// Starts a program with the given standard input, and one file for both of its outputs; gives the errno.
int spawn(Words& words, int in, int out, pid_t& process) {
    SpawnSettings settings;
    posix_spawn_file_actions_adddup2(&settings.actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&settings.actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&settings.actions, out, STDERR_FILENO);
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    posix_spawnattr_setsigdefault(&settings.attributes, &defaults);
    posix_spawnattr_setpgroup(&settings.attributes, 0);
    posix_spawnattr_setflags(&settings.attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return ::posix_spawnp(&process, pointers[0], &settings.actions, &settings.attributes, pointers.data(),
                          environ);
}

/// Waits for a child's end; whether it said that all went well.
bool ended_well(pid_t process) {
    int status = 0;
    pid_t ended = 0;
    do ended = ::waitpid(process, &status, 0);
    while (ended < 0 && errno == EINTR);
    return ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void close_once(int& descriptor) {
    if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

}  // namespace

MovieFile::MovieFile(const std::filesystem::path& target, const MovieShape& shape) : file_(target) {
    start(shape);
}

void MovieFile::start(const MovieShape& shape) {
    int ends[2];
    words_ = ::memfd_create("what ffmpeg says", MFD_CLOEXEC);
    if (words_ < 0 || ::pipe2(ends, O_CLOEXEC) != 0) {
        const int error = errno;
        close_once(words_);
        throw FileError(file_.target(), "cannot be encoded: " + reason(error));
    }
    frames_ = ends[1];
    Words words = command_of(shape, file_.written_path().string());
    const int error = spawn(words, ends[0], words_, process_);
    ::close(ends[0]);
    if (error == 0) return;
    process_ = -1;
    close_once(frames_);
    close_once(words_);
    const std::string why = error == ENOENT ? "the program ffmpeg is not there (Debian's package: ffmpeg)"
                                            : "ffmpeg cannot be started: " + reason(error);
    throw FileError(file_.target(), "cannot be encoded: " + why);
}

MovieFile::~MovieFile() {
    close_once(frames_);
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        (void)ended_well(process_);
    }
    close_once(words_);
}

void MovieFile::write_frame(std::string_view pixels) {
    if (write_all(frames_, pixels) != 0) fail();
}

void MovieFile::finish() {
    close_once(frames_);
    if (!ended_well(std::exchange(process_, -1))) fail();
    file_.commit();
}

void MovieFile::fail() {
    close_once(frames_);
    // It has closed its end of the pipe: it is about to end by itself, and says why before.
    if (process_ > 0) (void)ended_well(std::exchange(process_, -1));
    throw FileError(file_.target(), "cannot be encoded: ffmpeg says: " + last_words());
}

std::string MovieFile::last_words() const {
    constexpr off_t kEnough = 4096;
    struct stat status{};
    if (::fstat(words_, &status) != 0) return "nothing";
    std::string text(std::size_t(std::min(status.st_size, kEnough)), '\0');
    const ssize_t length = ::pread(words_, text.data(), text.size(), status.st_size - off_t(text.size()));
    text.resize(length > 0 ? std::size_t(length) : 0);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    if (text.empty()) return "nothing";
    return text.substr(text.rfind('\n') + 1);
}

}  // namespace carom
