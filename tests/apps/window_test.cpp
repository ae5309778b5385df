// carom view as a user starts it, on SDL's screen without a screen: the same drawing, by SDL's renderer in
// software, read back from a screenshot.
#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "cairo_handles.hpp"
#include "camera.hpp"
#include "colour_map.hpp"
#include "picture_palette.hpp"
#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

constexpr int kWidth = 800;
constexpr int kHeight = 500;
constexpr int kPanel = 300;

class Screen {
 public:
    Screen() {
        setenv("SDL_VIDEODRIVER", "dummy", 1);
        folder.write("s.json", kOneBall);
    }

    Result view(Words more) const {
        Words words = {"view", "s.json", "--size", "800x500"};
        words.insert(words.end(), more.begin(), more.end());
        return folder.run(words);
    }
    /// The screenshot after the frames, pixel for pixel.
    [[nodiscard]] std::vector<std::uint32_t> shot(Words more) const {
        more.insert(more.end(), {"--screenshot", "w.png"});
        const Result result = view(more);
        EXPECT_EQ(result.status, 0) << result.err;
        const app::CairoSurface image(cairo_image_surface_create_from_png(folder.path("w.png").c_str()));
        EXPECT_EQ(cairo_image_surface_get_width(image.get()), kWidth);
        EXPECT_EQ(cairo_image_surface_get_height(image.get()), kHeight);
        std::vector<std::uint32_t> pixels(std::size_t(kWidth) * kHeight);
        std::memcpy(pixels.data(), cairo_image_surface_get_data(image.get()), 4 * pixels.size());
        return pixels;
    }
    /// The pixel where a place of the scene is shown beside the panel.
    [[nodiscard]] static std::uint32_t at(const std::vector<std::uint32_t>& pixels, const Vec2& place) {
        app::Camera camera;
        camera.resize(kWidth, kHeight);
        camera.fit({{0, 0}, {10, 10}}, kPanel);
        const Vec2 pixel = camera.to_pixel(place);
        return pixels[std::size_t(pixel.y()) * kWidth + std::size_t(pixel.x())] & 0xffffffU;
    }

    Folder folder;
};

std::uint32_t rgb(const app::Colour& colour) {
    return app::pixel_of(colour) & 0xffffffU;
}

TEST(Window, ShowsTheBallWhereItIs) {
    const Screen screen;
    // 30 frames of a sixtieth at speed 2: t = 1, x = 8.
    const auto pixels = screen.shot({"--frames", "30", "--speed", "2"});
    EXPECT_EQ(Screen::at(pixels, {8, 5}), rgb(app::map_colour(1)));
    EXPECT_EQ(Screen::at(pixels, {8.3, 5.3}), rgb(app::map_colour(1)));
    EXPECT_EQ(Screen::at(pixels, {7.3, 5}), rgb(app::palette::kGround));
    EXPECT_EQ(Screen::at(pixels, {5, 5}), rgb(app::palette::kGround));
    EXPECT_THAT(screen.folder.names(), ElementsAre("s.json", "w.png"));  // no settings left behind
}

TEST(Window, ThePanelIsThereAndHasLetters) {
    const Screen screen;
    const auto pixels = screen.shot({"--frames", "3"});
    int bright = 0;
    int ground = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kPanel - 2; ++x) {
            const std::uint32_t pixel = pixels[std::size_t(y) * kWidth + std::size_t(x)] & 0xffffffU;
            bright += (pixel & 255U) > 200;
            ground += pixel == rgb(app::palette::kGround);
        }
    }
    EXPECT_GT(bright, 500);  // a letter has some 15 pixels, and there are a hundred
    EXPECT_EQ(ground, 0);
}

TEST(Window, PauseShowsTheSamePictureAgain) {
    const Screen screen;
    const auto one = screen.shot({"--frames", "2", "--paused", "--from", "1"});
    const auto many = screen.shot({"--frames", "20", "--paused", "--from", "1"});
    EXPECT_EQ(one, many);
    EXPECT_EQ(Screen::at(one, {8, 5}), rgb(app::map_colour(1)));
    EXPECT_NE(one, screen.shot({"--frames", "20", "--from", "1"}));
}

TEST(Window, AScreensaverHasNoPanelAndBeginsAnewAtTheEnd) {
    const Screen screen;
    // The end, 9, is reached in frame 9 of a sixtieth of 60; then all begins at x = 5.
    const auto pixels = screen.shot({"--frames", "9", "--speed", "60", "--screensaver"});
    app::Camera camera;
    camera.resize(kWidth, kHeight);
    camera.fit({{0, 0}, {10, 10}});
    const Vec2 place = camera.to_pixel({5, 5});
    EXPECT_EQ(pixels[std::size_t(place.y()) * kWidth + std::size_t(place.x())] & 0xffffffU,
              rgb(app::map_colour(1)));
    EXPECT_EQ(pixels[10 * kWidth + 10] & 0xffffffU, rgb(app::palette::kGround));
}

TEST(Window, MistakesAreOneLine) {
    const Screen screen;
    expect_one_error(screen.view({"--frames", "1", "--pick", "1"}), 1,
                     "--pick: must be below 1, the number of balls");
    expect_one_error(screen.view({"--screenshot", "w.png"}), 2, "--frames");
    expect_one_error(screen.view({"--frames", "1", "--screenshot", "s.json"}), 2, "overwrite the scene");
    expect_one_error(screen.folder.run({"view", "none.json", "--frames", "1"}), 1, "none.json");
    setenv("SDL_VIDEODRIVER", "x11", 1);
    const Result result = screen.folder.run_shell("unset DISPLAY; exec \"$0\" view s.json --frames 1");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("carom: error: cannot open a window: "));
}

}  // namespace
}  // namespace carom::testing_program
