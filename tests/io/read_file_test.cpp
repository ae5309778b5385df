// What is read as a file: regular files and what the program was given open; nothing that has no end.
#include <carom/io/read_file.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <carom/io/atomic_file.hpp>
#include <carom/io/scene_file.hpp>
#include <carom/io/xyz.hpp>

#include "temporary_folder.hpp"

namespace carom {
namespace {

using testing::HasSubstr;

template <class Read>
std::string message_of(Read&& read) {
    try {
        read();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "accepted";
}

std::string reading(const std::filesystem::path& path, std::uint64_t most = kMostOfPipe) {
    return message_of([&] { static_cast<void>(read_file(path, most)); });
}

/// A pipe with a thread that writes into one end and closes it; the other end has a path.
class Pipe {
 public:
    explicit Pipe(std::string text) {
        if (::pipe(ends_) != 0) throw std::runtime_error("no pipe");
        writer_ = std::thread([fd = ends_[1], text = std::move(text)] {
            std::size_t done = 0;
            while (done < text.size()) {
                const ssize_t n = ::write(fd, text.data() + done, text.size() - done);
                if (n <= 0) break;
                done += static_cast<std::size_t>(n);
            }
            ::close(fd);
        });
    }
    ~Pipe() {
        for (char rest[4096]; ::read(ends_[0], rest, sizeof rest) > 0;) {
        }
        writer_.join();
        ::close(ends_[0]);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    [[nodiscard]] std::string path() const { return "/dev/fd/" + std::to_string(ends_[0]); }

 private:
    int ends_[2] = {};
    std::thread writer_;
};

TEST(ReadFile, RefusesWhatHasNoEnd) {
    const TemporaryFolder folder;
    const std::filesystem::path fifo = folder / "fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_THAT(reading(fifo), HasSubstr("fifo: cannot be read: is a FIFO or a socket, no regular file"));
    EXPECT_EQ(reading("/dev/zero"), "/dev/zero: cannot be read: is a device, no regular file");
    std::filesystem::create_symlink("/dev/zero", folder / "link");
    EXPECT_THAT(reading(folder / "link"), HasSubstr("link: cannot be read: is a device"));
    EXPECT_THAT(reading(folder.path()), HasSubstr("cannot be read: Is a directory"));
}

TEST(ReadFile, SceneSaysThatItsBallsHaveNoEnd) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
    const auto parse = [&](const std::string& file) {
        return message_of([&] {
            static_cast<void>(parse_scene(R"({"balls_file": ")" + file + R"(", "until": 1})", folder.path()));
        });
    };
    EXPECT_EQ(parse("/dev/zero"), "balls_file: /dev/zero: cannot be read: is a device, no regular file");
    EXPECT_THAT(parse("fifo"), HasSubstr("fifo: cannot be read: is a FIFO"));
}

TEST(ReadFile, TakesAPipeThatItWasGivenOpen) {
    const std::string text(300'000, 'x');
    const Pipe pipe(text);
    EXPECT_EQ(read_file(pipe.path()), text);
}

TEST(ReadFile, GivesUpOnAPipeThatBringsTooMuch) {
    const Pipe shorter(std::string(1000, 'x'));
    EXPECT_EQ(read_file(shorter.path(), 1000).size(), 1000);
    const Pipe longer(std::string(3'000'000, 'x'));
    EXPECT_THAT(reading(longer.path(), 1000), HasSubstr("has brought 1000 bytes and no end"));
}

TEST(ReadFile, LinesHaveALongestLength) {
    const auto parse = [](std::size_t words) {
        std::string line;
        for (std::size_t k = 0; k < words; ++k) line += "0 ";
        return message_of([&] { static_cast<void>(parse_xyz("1\n\nC 0 0 0 " + line + "\n", "some.xyz")); });
    };
    constexpr std::size_t kLongest = std::size_t{1} << 20;
    EXPECT_THAT(parse(kLongest / 2 - 10), HasSubstr("some.xyz:3: must have 4 columns, has "));
    EXPECT_EQ(parse(kLongest / 2), "some.xyz:3: a line may have 1048576 characters, this one has 1048584");
}

}  // namespace
}  // namespace carom
