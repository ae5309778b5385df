// Movies as a user makes them, read back by ffmpeg: how many frames, and what is where in each. The one ball
// of the scene moves by a formula: x = 5 + 3 t until its edge is at the wall x = 10 at t = 1.5, then back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "picture_layout.hpp"
#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

using testing::ElementsAre;
using Words = std::vector<std::string>;

bool has_ffmpeg() {
    return std::system("ffmpeg -version >/dev/null 2>&1") == 0;
}

#define NEEDS_FFMPEG() \
    if (!has_ffmpeg()) GTEST_SKIP() << "needs the program ffmpeg"

double distance_to_wall(double t) {
    return 3 * std::abs(1.5 - t);  // of the ball's edge
}

/// The frames of a movie as ffmpeg decodes them, red, green and blue a byte each.
class Frames {
 public:
    Frames(const Folder& folder, const std::string& name, int width, int height)
        : width_(width), height_(height) {
        const std::string command = "ffmpeg -v error -i " + folder.path(name) +
                                    " -vsync passthrough -f rawvideo -pix_fmt rgb24 -y " + folder.path("raw");
        EXPECT_EQ(std::system(command.c_str()), 0);
        bytes_ = folder.read("raw");
        EXPECT_EQ(bytes_.size() % frame_size(), 0U);
    }
    [[nodiscard]] std::size_t count() const { return bytes_.size() / frame_size(); }

    /// The only ball is as fast as the fastest: yellow, far from all else in the frame.
    [[nodiscard]] bool is_ball(std::size_t frame, int x, int y) const {
        const std::size_t place =
            frame * frame_size() + 3 * (std::size_t(y) * std::size_t(width_) + std::size_t(x));
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes_[place + i]); };
        return byte(0) > 160 && byte(1) > 150 && byte(2) < 110;
    }

    struct Blob {
        double x = 0, y = 0, area = 0;
    };
    /// Of the ball's pixels within the layout's frame.
    [[nodiscard]] Blob blob(std::size_t frame, const app::PictureLayout& layout) const {
        Blob b;
        for (int y = int(layout.top); y < int(layout.bottom); ++y) {
            for (int x = int(layout.left); x < int(layout.right); ++x) {
                if (!is_ball(frame, x, y)) continue;
                b.x += x + 0.5, b.y += y + 0.5, b.area += 1;
            }
        }
        b.x /= b.area, b.y /= b.area;
        return b;
    }

 private:
    [[nodiscard]] std::size_t frame_size() const { return 3 * std::size_t(width_) * std::size_t(height_); }

    int width_, height_;
    std::string bytes_;
};

TEST(Movie, HasEveryFrameWithTheBallInItsPlace) {
    NEEDS_FFMPEG();
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result result = folder.run({"render", "s.json", "--out", "m.mp4", "--size", "400x300", "--from",
                                      "0.5", "--until", "3.5", "--fps", "8", "--speed", "1.5", "--quiet"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Frames frames(folder, "m.mp4", 400, 300);
    ASSERT_EQ(frames.count(), 16U);  // 3 / 1.5 seconds of 8 frames
    const app::PictureLayout layout({{0, 0}, {10, 10}}, {400, 300});
    const double radius = 0.5 * layout.scale;
    for (std::size_t k = 0; k < frames.count(); ++k) {
        SCOPED_TRACE(k);
        const Frames::Blob seen = frames.blob(k, layout);
        const Vec2 wanted = layout.to_pixel({9.5 - distance_to_wall(0.5 + double(k) * 1.5 / 8), 5});
        // The rim and the line of the heading are no part of the blob. The line reaches over a radius to one
        // side, a tenth of it wide: it moves the middle by 0.05 radii at most.
        EXPECT_NEAR(seen.x, wanted.x(), 0.05 * radius + 0.5);
        EXPECT_NEAR(seen.y, wanted.y(), 0.5);
        EXPECT_GT(seen.area, 0.5 * std::numbers::pi * radius * radius);
        EXPECT_LT(seen.area, 1.1 * std::numbers::pi * radius * radius);
    }
    EXPECT_THAT(folder.names(), ElementsAre("m.mp4", "raw", "s.json"));
}

// The ball's edge within 1e-3 of the wall, in steps of 20 microseconds: it comes, touches in frame 10, and
// leaves.
TEST(Movie, SlowMotionIsExact) {
    NEEDS_FFMPEG();
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result result =
        folder.run({"render", "s.json", "--out", "m.mp4", "--size", "500x400", "--from", "1.4998", "--until",
                    "1.5002", "--speed", "0.0002", "--fps", "10", "--view", "9.999,4.9995,10,5.0005"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Frames frames(folder, "m.mp4", 500, 400);
    ASSERT_EQ(frames.count(), 20U);
    const app::PictureLayout layout({{9.999, 4.9995}, {10, 5.0005}}, {500, 400});
    const int row = int((layout.top + layout.bottom) / 2);
    for (std::size_t k = 0; k < frames.count(); ++k) {
        SCOPED_TRACE(k);
        int edge = int(layout.right);
        while (edge > int(layout.left) && !frames.is_ball(k, edge - 1, row)) --edge;
        const double wanted = layout.to_pixel({10 - distance_to_wall(1.4998 + 2e-5 * double(k)), 5}).x();
        // The rim of a darker yellow is a line of at most a pixel; coding and the fraction of a pixel blur
        // one more each.
        EXPECT_NEAR(edge, wanted, 3);
    }
}

TEST(Movie, GifHasEveryFrame) {
    NEEDS_FFMPEG();
    const Folder folder;
    folder.write("s.json", kOneBall);
    ASSERT_EQ(
        folder.run({"render", "s.json", "--out", "m.gif", "--size", "301x201", "--until", "1", "--fps", "10"})
            .status,
        0);
    const Frames frames(folder, "m.gif", 301, 201);
    EXPECT_EQ(frames.count(), 10U);
    const app::PictureLayout layout({{0, 0}, {10, 10}}, {301, 201});
    EXPECT_NEAR(frames.blob(9, layout).x, layout.to_pixel({7.7, 5}).x(), 1.5);
}

TEST(Movie, WithoutFfmpegSaysWhatIsMissing) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    expect_one_error(folder.run_shell("PATH=/nowhere exec \"$0\" render s.json --out m.mp4"), 1,
                     "m.mp4: cannot be encoded: the program ffmpeg is not there (Debian's package: ffmpeg)");
    EXPECT_THAT(folder.names(), ElementsAre("s.json"));
}

// A limit on files' sizes stands for the full disk: ffmpeg is told so by its writes.
TEST(Movie, FullDiskLeavesNothing) {
    NEEDS_FFMPEG();
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    for (const char* const name : {"m.mp4", "m.gif"}) {
        const Result result = folder.run_shell(
            "ulimit -f 16; exec \"$0\" render s.json --quiet --until 1 --size 400x400 --out " +
            std::string(name));
        expect_one_error(result, 1, std::string(name) + ": cannot be encoded: ffmpeg says: ");
        EXPECT_THAT(folder.names(), ElementsAre("s.json"));
    }
}

TEST(Movie, StoppedOrKilledLeavesNoMovie) {
    NEEDS_FFMPEG();
    for (const int signal : {SIGINT, SIGKILL}) {
        const Folder folder;
        folder.write("s.json", busy_scene("periodic"));
        const pid_t process =
            folder.start({"render", "s.json", "--out", "m.mp4", "--until", "1e6", "--quiet"});
        usleep(300'000);
        kill(process, signal);
        EXPECT_EQ(folder.finish(process).status, signal == SIGINT ? 130 : 128 + SIGKILL);
        for (const std::string& name : folder.names()) EXPECT_NE(name, "m.mp4");
        if (signal == SIGINT) {
            EXPECT_THAT(folder.names(), ElementsAre("s.json"));
        }
        usleep(200'000);  // a killed program's ffmpeg ends with its pipe, and lets go of the folder
    }
}

TEST(Movie, WrongUsage) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const auto refused = [&](Words more, const std::string& message) {
        more.insert(more.begin(), {"render", "s.json", "--out"});
        expect_one_error(folder.run(more), 2, message);
    };
    refused({"m.mp4", "--time", "1"}, "--time: belongs to stills");
    refused({"p.png", "--fps", "10"}, "--fps: belongs to movies (.mp4, .gif)");
    refused({"m.mp4", "--from", "9"}, "--until: must be after --from, 9 is not after 9");
    refused({"m.mp4", "--fps", "0"}, "--fps");
    refused({"m.mp4", "--view", "1,2,3"}, "'1,2,3' is no view");
    refused({"m.mp4", "--view", "1,2,1,3"}, "is no view");
    refused({"m.mp4", "--colour-by", "taste"}, "--colour-by");
    expect_one_error(folder.run({"render", "s.json", "--out", "no/m.mp4", "--until", "1"}), 1, "no/m.mp4");
    EXPECT_THAT(folder.names(), ElementsAre("s.json"));
}

}  // namespace
}  // namespace carom::testing_program
