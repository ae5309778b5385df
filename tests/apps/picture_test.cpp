// Pictures: what is where in them, and in which colour. The expected places come from the layout's definition
// and from symmetry.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "cairo_handles.hpp"
#include "colour_map.hpp"
#include "picture.hpp"
#include "picture_file.hpp"
#include "picture_palette.hpp"

namespace carom::app {
namespace {

struct Bytes {
    int red, green, blue;
};

Bytes to_bytes(const Colour& colour) {
    return {int(std::lround(255 * colour.red)), int(std::lround(255 * colour.green)),
            int(std::lround(255 * colour.blue))};
}

// An image read back from the bytes of a PNG.
class Image {
 public:
    explicit Image(const std::string& png) : rest_(png) {
        surface_.reset(cairo_image_surface_create_from_png_stream(read, this));
        EXPECT_EQ(cairo_surface_status(surface_.get()), CAIRO_STATUS_SUCCESS);
    }

    [[nodiscard]] int width() const { return cairo_image_surface_get_width(surface_.get()); }
    [[nodiscard]] int height() const { return cairo_image_surface_get_height(surface_.get()); }

    [[nodiscard]] Bytes at(const Vec2& pixel) const {
        const int stride = cairo_image_surface_get_stride(surface_.get());
        const unsigned char* const data = cairo_image_surface_get_data(surface_.get());
        std::uint32_t value = 0;
        std::memcpy(&value, data + std::ptrdiff_t(pixel.y()) * stride + 4 * std::ptrdiff_t(pixel.x()), 4);
        return {int(value >> 16U & 255U), int(value >> 8U & 255U), int(value & 255U)};
    }

 private:
    static cairo_status_t read(void* self, unsigned char* data, unsigned int length) {
        std::string& rest = static_cast<Image*>(self)->rest_;
        if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
        std::memcpy(data, rest.data(), length);
        rest.erase(0, length);
        return CAIRO_STATUS_SUCCESS;
    }

    std::string rest_;
    CairoSurface surface_;
};

// A colour passes through 8 bits and, at a soft edge, through a blend: a few steps are no error.
void expect_colour(const Bytes& seen, const Colour& wanted, int tolerance = 2) {
    const Bytes expected = to_bytes(wanted);
    EXPECT_NEAR(seen.red, expected.red, tolerance);
    EXPECT_NEAR(seen.green, expected.green, tolerance);
    EXPECT_NEAR(seen.blue, expected.blue, tolerance);
}

Ball ball_at(double x, double y, double vx = 0, double radius = 0.5) {
    Ball ball;
    ball.position = {x, y};
    ball.velocity = {vx, 0};
    ball.radius = radius;
    return ball;
}

PictureContent box_content(double width, double height, Boundary boundary = Boundary::kWall) {
    PictureContent content;
    content.title = "Box";
    content.domain = Domain{{{0, 0}, {width, height}}, {boundary, boundary}, 1};
    return content;
}

Image png_of(const PictureContent& content, PictureSize size) {
    return Image(render_picture(content, PictureFormat::kPng, size));
}

TEST(ColourMap, EndsAndOrder) {
    const Bytes slow = to_bytes(map_colour(0));
    const Bytes fast = to_bytes(map_colour(1));
    // Rows 30 and 255 of the published table, times 255.
    EXPECT_EQ(slow.red, 71);
    EXPECT_EQ(slow.green, 42);
    EXPECT_EQ(slow.blue, 122);
    EXPECT_EQ(fast.red, 253);
    EXPECT_EQ(fast.green, 231);
    EXPECT_EQ(fast.blue, 37);
    expect_colour(to_bytes(map_colour(-3)), map_colour(0), 0);
    expect_colour(to_bytes(map_colour(7)), map_colour(1), 0);
    expect_colour(to_bytes(map_colour(std::nan(""))), map_colour(0), 0);
    double last = -1;
    for (int i = 0; i <= 1000; ++i) {  // brighter all the way, by the luma weights of Rec. 709
        const Colour colour = map_colour(i / 1000.0);
        const double luma = 0.2126 * colour.red + 0.7152 * colour.green + 0.0722 * colour.blue;
        EXPECT_GT(luma, last);
        last = luma;
    }
}

TEST(PictureLayout, KeepsTheAspectPointsUpAndFits) {
    for (const PictureSize size : {PictureSize{1200, 900}, {300, 1000}, {160, 160}, {4000, 500}}) {
        const PictureLayout layout({{-3, 2}, {13, 11}}, size);
        SCOPED_TRACE(size.width);
        const Vec2 low = layout.to_pixel({-3, 2});
        const Vec2 high = layout.to_pixel({13, 11});
        EXPECT_NEAR((high.x() - low.x()) / 16, (low.y() - high.y()) / 9, 1e-9);
        EXPECT_GT(low.y(), high.y());
        EXPECT_GE(low.x(), 0);
        EXPECT_GE(high.y(), 0);
        EXPECT_LE(high.x(), size.width);
        EXPECT_LE(low.y(), size.height);
    }
}

TEST(PictureLayout, DefaultSizeLeavesNoEmptyBands) {
    const PictureSize size = default_size({{0, 0}, {16, 9}});
    const PictureLayout layout({{0, 0}, {16, 9}}, size);
    EXPECT_NEAR(layout.right - layout.left, 1000, 3);
    EXPECT_NEAR(layout.bottom - layout.top, 562.5, 3);
    const PictureSize needle = default_size({{0, 0}, {1e6, 1}});
    EXPECT_GE(needle.height, kSmallestSide);
}

TEST(Ticks, AreNiceAndInside) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 2000; ++i) {
        const double middle = std::ldexp(double(random() >> 11U), -53) * 200 - 100;
        const double extent = std::pow(10.0, int(random() % 12U) - 5) * (1 + double(random() % 900U) / 100);
        const Ticks ticks = nice_ticks(middle, middle + extent, 6);
        SCOPED_TRACE(testing::Message() << middle << " + " << extent);
        ASSERT_GE(ticks.values.size(), 2U);
        ASSERT_LE(ticks.values.size(), 11U);
        EXPECT_GE(ticks.values.front(), middle - 1e-6 * extent);
        EXPECT_LE(ticks.values.back(), middle + extent * (1 + 1e-6));
        const double leading = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step) + 1e-9));
        const double nearest = leading < 1.5 ? 1 : leading < 3.5 ? 2 : 5;
        EXPECT_NEAR(leading, nearest, 1e-9);
    }
}

TEST(Ticks, Labels) {
    EXPECT_EQ(tick_label(0.30000000000000004, 0.1), "0.3");
    EXPECT_EQ(tick_label(1, 0.5), "1.0");
    EXPECT_EQ(tick_label(-20, 10), "\u221220");
    EXPECT_EQ(tick_label(-1e-17, 0.2), "0");
    EXPECT_EQ(tick_label(3e7, 1e7), "3e+07");
    EXPECT_EQ(with_thousands(0), "0");
    EXPECT_EQ(with_thousands(999), "999");
    EXPECT_EQ(with_thousands(1000), "1,000");
    EXPECT_EQ(with_thousands(1234567), "1,234,567");
}

TEST(Picture, TopSpeedIsThe99thPercentileOfMovingBalls) {
    std::vector<Ball> balls;
    for (int i = 1; i <= 200; ++i) balls.push_back(ball_at(i, 0, 201 - i));
    EXPECT_EQ(top_speed(balls), 198);
    Ball fixed = ball_at(0, 0, 1e6);
    fixed.is_static = true;
    balls.push_back(fixed);
    EXPECT_EQ(top_speed(balls), 198);
    EXPECT_EQ(top_speed({}), 0);
    EXPECT_EQ(top_speed({fixed}), 0);
}

TEST(Colouring, RangesFollowWhatTheColoursShow) {
    std::vector<Ball> balls = {ball_at(0, 0, 3, 1), ball_at(0, 0, -1, 2), ball_at(0, 0, 0, 4),
                               ball_at(0, 0, 9, 9)};
    balls[3].is_static = true;
    const Colouring speed = colouring_of(balls, ColourBy::kSpeed);
    EXPECT_EQ(speed.fraction_of(speed.values[0]), 1);
    EXPECT_EQ(speed.fraction_of(speed.values[2]), 0);
    EXPECT_FALSE(speed.has_more);
    const Colouring fixed = colouring_of(balls, ColourBy::kSpeed, {}, 2);
    EXPECT_EQ(fixed.fraction_of(1), 0.5);
    EXPECT_TRUE(fixed.has_more);
    const Colouring size = colouring_of(balls, ColourBy::kSize);
    EXPECT_EQ(size.low, 1);
    EXPECT_EQ(size.high, 4);
    const Colouring hits = colouring_of(balls, ColourBy::kCollisions, {5, 15, 10, 0});
    EXPECT_EQ(hits.fraction_of(hits.values[0]), 0);
    EXPECT_EQ(hits.fraction_of(hits.values[2]), 0.5);
    EXPECT_EQ(hits.fraction_of(hits.values[1]), 1);
    // All alike, or nothing there: still a range.
    for (const ColourBy by : kAllColourBy) {
        const Colouring none = colouring_of({}, by);
        EXPECT_LT(none.low, none.high);
        const Colouring alike = colouring_of({balls[1], balls[1]}, by, {7, 7});
        EXPECT_LT(alike.low, alike.high);
    }
    // Neighbouring domains differ.
    const Colouring domain = colouring_of(balls, ColourBy::kDomain, {0, 1, 2, 3});
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GT(std::abs(domain.fraction_of(domain.values[i]) - domain.fraction_of(domain.values[j])),
                      0.1);
}

TEST(Picture, BallsHaveTheirPlaceAndColourWithYUp) {
    PictureContent content = box_content(20, 10);
    content.balls = {ball_at(4, 8, 2, 1), ball_at(15, 2.5, 1, 1), ball_at(10, 5, 0, 1)};
    const PictureSize size{1000, 600};
    const PictureLayout layout(view_of(content), size);
    const Image image = png_of(content, size);
    EXPECT_EQ(image.width(), 1000);
    EXPECT_EQ(image.height(), 600);
    // Off the centre, where the line of the heading is.
    const Vec2 aside{-0.5, 0.4};
    expect_colour(image.at(layout.to_pixel(content.balls[0].position + aside)), map_colour(1));
    expect_colour(image.at(layout.to_pixel(content.balls[1].position + aside)), map_colour(0.5));
    expect_colour(image.at(layout.to_pixel(content.balls[2].position + aside)), map_colour(0));
    EXPECT_LT(layout.to_pixel({4, 8}).y(), layout.to_pixel({15, 2.5}).y());
    // Just outside of each is ground; mirrored places are ground, too.
    expect_colour(image.at(layout.to_pixel({5.1, 8})), palette::kGround);
    expect_colour(image.at(layout.to_pixel({4, 6.9})), palette::kGround);
    expect_colour(image.at(layout.to_pixel({4, 2})), palette::kGround);
    expect_colour(image.at({2, 2}), palette::kPage);
}

TEST(Picture, DiscsAreRoundWithTheirArea) {
    PictureContent content = box_content(10, 10);
    content.balls = {ball_at(5, 5, 0, 2)};
    const PictureSize size{700, 500};
    const PictureLayout layout(view_of(content), size);
    const Image image = png_of(content, size);
    int covered = 0;
    const Bytes ground = to_bytes(palette::kGround);
    for (int y = int(layout.top) + 4; y < int(layout.bottom) - 4; ++y) {
        for (int x = int(layout.left) + 4; x < int(layout.right) - 4; ++x) {
            covered += image.at(Vec2(x, y)).red > ground.red + 5;
        }
    }
    const double radius = 2 * layout.scale;
    // Counted pixels miss the area by at most half the rim's length, in pixels.
    EXPECT_NEAR(covered, std::numbers::pi * radius * radius, std::numbers::pi * radius);
}

TEST(Picture, PeriodicBallsShowOnBothSidesAndNotBeyondTheFrame) {
    PictureContent content = box_content(10, 10, Boundary::kPeriodic);
    content.balls = {ball_at(0.1, 9.9, 0, 1)};
    const PictureSize size{700, 600};
    const PictureLayout layout(view_of(content), size);
    const Image image = png_of(content, size);
    for (const Vec2& place : {Vec2{0.5, 9.5}, Vec2{9.5, 9.5}, Vec2{0.5, 0.5}, Vec2{9.5, 0.5}}) {
        expect_colour(image.at(layout.to_pixel(place)), map_colour(0));
    }
    expect_colour(image.at(layout.to_pixel({5, 9.5})), palette::kGround);
    expect_colour(image.at(layout.to_pixel({10.5, 9.5})), palette::kPage);

    PictureContent without = box_content(10, 10, Boundary::kOpen);
    without.balls = content.balls;
    const Image open = png_of(without, size);
    expect_colour(open.at(layout.to_pixel({9.5, 0.5})), palette::kGround);
}

TEST(Picture, ManyBallsShowTheirMeanSpeedAndArea) {
    // Two halves of a lattice of sub-pixel balls, slow and fast: a pixel inside each has that half's colour
    // over the ground.
    PictureContent content = box_content(200, 200, Boundary::kPeriodic);
    constexpr int kSide = 800;
    const double spacing = 200.0 / kSide;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            content.balls.push_back(
                ball_at((i + 0.5) * spacing, (j + 0.5) * spacing, i < kSide / 2 ? 1 : 4, 0.4 * spacing));
        }
    }
    ASSERT_GT(content.balls.size(), kVectorBalls);
    const PictureSize size{400, 340};
    const PictureLayout layout(view_of(content), size);
    ASSERT_LT(0.4 * spacing * layout.scale, 0.5);
    const Image image = png_of(content, size);
    const double covered = std::numbers::pi * 0.16;
    const double strength = std::pow(covered, 0.75);
    // The discs' soft edges spread a pixel's share over its neighbours unevenly: a mean over a patch, not one
    // pixel.
    const auto patch = [&](const Vec2& middle) {
        double red = 0, green = 0, blue = 0;
        for (int dx = -8; dx < 8; ++dx) {
            for (int dy = -8; dy < 8; ++dy) {
                const Bytes seen = image.at(layout.to_pixel(middle) + Vec2(dx, dy));
                red += seen.red, green += seen.green, blue += seen.blue;
            }
        }
        return Bytes{int(red / 256), int(green / 256), int(blue / 256)};
    };
    expect_colour(patch({50, 100}), mix(palette::kGround, map_colour(0.25), strength), 5);
    expect_colour(patch({150, 100}), mix(palette::kGround, map_colour(1), strength), 5);
}

TEST(Picture, GatheredAndSingleBallsAgree) {
    // The same large ball, alone and among many specks in a far corner.
    PictureContent content = box_content(100, 100);
    content.balls = {ball_at(60, 70, 3, 10)};
    const PictureSize size{600, 500};
    const PictureLayout layout(view_of(content), size);
    const Image single = png_of(content, size);
    for (std::size_t i = 0; i < kVectorBalls; ++i)
        content.balls.push_back(ball_at(1 + 1e-3 * double(i % 141), 1, 3, 1e-4));
    const Image gathered = png_of(content, size);
    for (const Vec2& place :
         {Vec2{54, 70}, Vec2{60, 76}, Vec2{49, 70}, Vec2{60, 81}, Vec2{71, 70}, Vec2{60, 64}}) {
        const Bytes wanted = single.at(layout.to_pixel(place));
        const Bytes seen = gathered.at(layout.to_pixel(place));
        EXPECT_NEAR(seen.red, wanted.red, 2);
        EXPECT_NEAR(seen.green, wanted.green, 2);
        EXPECT_NEAR(seen.blue, wanted.blue, 2);
    }
}

TEST(Picture, StaticBallsWallsAndAttractors) {
    PictureContent content = box_content(20, 10);
    content.balls = {ball_at(5, 5, 1, 1), ball_at(15, 5, 0, 0.1)};
    content.balls[1].is_static = true;
    content.walls = {{{2, 2}, {18, 2}, 1}};
    content.attractors = {{{10, 8}, 5, 0.5}};
    const PictureSize size{2000, 1200};  // lines are wider than two pixels: one is full
    const PictureLayout layout(view_of(content), size);
    const Image image = png_of(content, size);
    expect_colour(image.at(layout.to_pixel({10, 2})), palette::kWall, 6);
    expect_colour(image.at(layout.to_pixel({10, 8})), {0, 0, 0});
    const Bytes glow = image.at(layout.to_pixel({10.7, 8}));
    EXPECT_GT(glow.red, glow.blue + 40);  // warm: it pulls
    const Bytes fixed = image.at(layout.to_pixel({15, 5}));
    EXPECT_NEAR(fixed.red, fixed.blue, 40);  // grey
    EXPECT_GT(fixed.red, 60);
}

TEST(Picture, AViewShowsAPartOfThePeriodicBox) {
    PictureContent content = box_content(10, 10, Boundary::kPeriodic);
    content.balls = {ball_at(0.1, 5, 0, 1)};  // its other half shows at the right
    content.view = Box{{8, 4}, {10, 6}};
    const PictureSize size{700, 600};
    const PictureLayout layout(view_of(content), size);
    const Image image = png_of(content, size);
    expect_colour(image.at(layout.to_pixel({9.8, 5.1})), map_colour(0));
    expect_colour(image.at(layout.to_pixel({8.5, 5})), palette::kGround);
}

TEST(Picture, ViewWithoutDomainHoldsEverything) {
    PictureContent content;
    content.balls = {ball_at(-5, 0, 0, 2), ball_at(7, 1, 0, 0.5)};
    content.walls = {{{0, -9}, {1, 3}, 1}};
    const Box view = view_of(content);
    EXPECT_LT(view.min.x(), -7);
    EXPECT_GT(view.max.x(), 7.5);
    EXPECT_LT(view.min.y(), -9);
    EXPECT_GT(view.max.y(), 3);
    EXPECT_EQ(count_outside(content.balls, view), 0U);
    EXPECT_EQ(count_outside(content.balls, {{0, 0}, {7, 7}}), 1U);
    EXPECT_GT(view_of({}).max.x(), view_of({}).min.x());
}

TEST(PictureFile, FormatsAndSizes) {
    EXPECT_EQ(picture_format("a/b.PNG"), PictureFormat::kPng);
    EXPECT_EQ(picture_format("b.svg"), PictureFormat::kSvg);
    EXPECT_THROW((void)picture_format("b"), std::invalid_argument);
    try {
        (void)picture_format("film.mp4");
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "unknown picture format '.mp4' (known: .png, .svg)");
    }
    EXPECT_EQ(parse_picture_size("640x480").width, 640);
    EXPECT_EQ(parse_picture_size("640x480").height, 480);
    for (const char* const bad :
         {"", "640", "640x", "x480", "640X480", "640x480 ", "-640x480", "640x48", "99999x480", "6e2x480"}) {
        EXPECT_THROW((void)parse_picture_size(bad), std::invalid_argument) << bad;
    }
}

// Every tag opened is closed in order, and attributes' quotes match: what a strict XML reader refuses first.
void expect_balanced_tags(const std::string& xml) {
    std::vector<std::string> open;
    for (std::size_t place = xml.find('<'); place != std::string::npos; place = xml.find('<', place + 1)) {
        std::size_t end = place;
        for (bool quoted = false; end < xml.size() && (quoted || xml[end] != '>'); ++end)
            quoted ^= xml[end] == '"';
        ASSERT_LT(end, xml.size());
        const std::string tag = xml.substr(place + 1, end - place - 1);
        const std::string name = tag.substr(0, tag.find_first_of(" \n"));
        if (tag.front() == '?' || tag.front() == '!' || tag.back() == '/') {
        } else if (tag.front() == '/') {
            ASSERT_FALSE(open.empty());
            ASSERT_EQ(name, "/" + open.back());
            open.pop_back();
        } else {
            open.push_back(name);
        }
        place = end;
    }
    EXPECT_TRUE(open.empty());
}

TEST(PictureFile, SvgIsWellFormedWhateverTheTitle) {
    PictureContent content = box_content(16, 9);
    content.title = "a < b & \"c\" \xc3\xa9 \u2192";
    content.balls = {ball_at(4, 4, 1), ball_at(8, 4, 2)};
    const std::string svg = render_picture(content, PictureFormat::kSvg);
    EXPECT_EQ(svg.substr(0, 5), "<?xml");
    expect_balanced_tags(svg);
    for (std::size_t i = 0; i < kVectorBalls; ++i)
        content.balls.push_back(ball_at(1 + 1e-3 * double(i % 997), 1, 1, 0.01));
    const std::string many = render_picture(content, PictureFormat::kSvg, PictureSize{400, 300});
    expect_balanced_tags(many);
    EXPECT_LT(many.size(), 2'000'000U);  // an image, not a path a ball
}

TEST(PictureFile, BadTitlesAndStrangeBallsDoNotBreakIt) {
    PictureContent content = box_content(16, 9);
    content.title = std::string(3000, 'x') + "\xff\xfe";
    content.balls = {ball_at(1e300, 4, 1), ball_at(8, -1e9, 1e200), ball_at(4, 4, 1, 1e-9)};
    EXPECT_GT(render_picture(content, PictureFormat::kPng).size(), 1000U);
    EXPECT_GT(render_picture(content, PictureFormat::kSvg).size(), 1000U);
}

}  // namespace
}  // namespace carom::app
