// Plots: what is measured, against counting all pairs and closed forms; tables; and that curves are drawn
// where their numbers are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cairo.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <carom/io/atomic_file.hpp>

#include "cairo_handles.hpp"
#include "parallel/scenes.hpp"
#include "plot/draw_plot.hpp"
#include "plot/plot_csv.hpp"
#include "plot/statistics.hpp"
#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::app {
namespace {

using testing::ElementsAre;
using testing_program::expect_one_error;
using testing_program::Folder;

Domain box(double width, double height, Boundary x, Boundary y) {
    return {{{0, 0}, {width, height}}, {x, y}, 1};
}

std::vector<Ball> points_at_random(std::uint64_t seed, std::size_t count, double width, double height) {
    std::mt19937_64 random(seed);
    std::vector<Ball> balls(count);
    for (Ball& ball : balls) {
        const double x = test::uniform(random, 0, width);
        ball.position = {x, test::uniform(random, 0, height)};
    }
    return balls;
}

// Every ordered pair, by the nearest of the images, without a grid.
TEST(RadialDistribution, CountsThePairsThatAreThere) {
    constexpr double kReach = 2;
    constexpr std::size_t kBins = 16;
    for (const auto& [x, y, width] : {std::tuple(Boundary::kPeriodic, Boundary::kPeriodic, 4.0),
                                      std::tuple(Boundary::kPeriodic, Boundary::kWall, 7.0),
                                      std::tuple(Boundary::kOpen, Boundary::kWall, 21.0)}) {
        const double height = 11;
        const std::vector<Ball> balls = points_at_random(5, 300, width, height);
        RadialDistribution g(box(width, height, x, y), kReach, kBins);
        g.add(balls);
        std::vector<double> pairs(kBins, 0);
        double asked = 0;
        for (const Ball& a : balls) {
            const Vec2& p = a.position;
            const bool is_in = (x == Boundary::kPeriodic || (p.x() >= kReach && p.x() <= width - kReach)) &&
                               (y == Boundary::kPeriodic || (p.y() >= kReach && p.y() <= height - kReach));
            asked += is_in;
            for (const Ball& b : balls) {
                double nearest = 1e9;
                for (int i = -1; i <= 1; ++i)
                    for (int j = -1; j <= 1; ++j)
                        if ((i == 0 || x == Boundary::kPeriodic) && (j == 0 || y == Boundary::kPeriodic))
                            nearest =
                                std::min(nearest, (b.position + Vec2{i * width, j * height} - p).norm());
                if (is_in && &a != &b && nearest < kReach) pairs[std::size_t(nearest / kReach * kBins)] += 1;
            }
        }
        const std::vector<Vec2> seen = g.points();
        ASSERT_EQ(seen.size(), kBins);
        for (std::size_t bin = 0; bin < kBins; ++bin) {
            const double r = (double(bin) + 0.5) * kReach / kBins;
            const double ring = 2 * std::numbers::pi * r * kReach / kBins;
            EXPECT_DOUBLE_EQ(seen[bin].x(), r);
            EXPECT_NEAR(seen[bin].y(), pairs[bin] / (asked * 299 / (width * height) * ring), 1e-12);
        }
    }
}

// Points without order: g = 1. A bin of expected count n scatters by sqrt(2 n) over n: each pair counts
// twice.
TEST(RadialDistribution, IsOneForPointsWithoutOrder) {
    RadialDistribution g(box(100, 100, Boundary::kPeriodic, Boundary::kPeriodic), 5, 10);
    g.add(points_at_random(6, 5000, 100, 100));
    for (const Vec2& point : g.points()) {
        const double expected = 5000 * 4999 / 1e4 * 2 * std::numbers::pi * point.x() * 0.5;
        EXPECT_NEAR(point.y(), 1, 5 * std::sqrt(2 / expected)) << point.x();
    }
    RadialDistribution narrow(box(8, 8, Boundary::kWall, Boundary::kWall), 5, 10);
    narrow.add(points_at_random(6, 50, 8, 8));
    EXPECT_TRUE(narrow.points().empty());  // no ball is 5 away from all walls
}

TEST(SpeedHistogram, MaxwellHasAreaOneAndItsMeanAndNormalVelocitiesFollowIt) {
    double area = 0;
    double mean = 0;
    constexpr double kStep = 1e-3;
    for (double u = kStep / 2; u < 12; u += kStep) {
        area += maxwell_speed_density(u) * kStep;
        mean += u * maxwell_speed_density(u) * kStep;
    }
    EXPECT_NEAR(area, 1, 1e-6);
    EXPECT_NEAR(mean, std::sqrt(std::numbers::pi / 2), 1e-6);

    // Box and Muller: normal components of variance T / m with T = 3, masses 1 and 4.
    std::mt19937_64 random(9);
    std::vector<Ball> balls(40'000);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        balls[i].mass = i % 2 == 0 ? 1 : 4;
        const double speed = std::sqrt(-2 * 3 / balls[i].mass * std::log(1 - test::uniform(random, 0, 1)));
        const double angle = test::uniform(random, 0, 2 * std::numbers::pi);
        balls[i].velocity = {speed * std::cos(angle), speed * std::sin(angle)};
    }
    SpeedHistogram histogram(45);
    histogram.add(balls);
    for (const Vec2& point : histogram.points()) {
        const double width = 0.1;
        const double low = point.x() - width / 2;
        const double share = std::exp(-low * low / 2) - std::exp(-(low + width) * (low + width) / 2);
        // Binomial, 5 sigma; the temperature, measured to 1/sqrt(N), shifts the curve by less than as much.
        const double sigma = std::sqrt(share / 40'000) / width;
        EXPECT_NEAR(point.y(), share / width, 5 * sigma + 2.0 / 40'000 / width + 0.005) << point.x();
    }
}

TEST(PlotTables, ColumnsBecomePanelsAndFilesShareThem) {
    const Folder folder;
    const std::string one = folder.write("one.csv", "time,pressure,note\r\n0,1,x\r\n1,2.5,\r\n2,,y\r\n");
    const std::string two = folder.write("two.csv", "time,energy,pressure\n0,7,3\n");
    const std::vector<PlotPanel> panels = panels_of({one, two}, {});
    ASSERT_EQ(panels.size(), 2U);  // "note" has no number
    EXPECT_EQ(panels[0].y_label, "pressure");
    ASSERT_EQ(panels[0].curves.size(), 2U);
    EXPECT_THAT(panels[0].curves[0].points, ElementsAre(Vec2{0, 1}, Vec2{1, 2.5}));
    EXPECT_EQ(panels[0].curves[1].label, "two");
    EXPECT_EQ(panels[1].y_label, "energy");
    EXPECT_EQ(panels_of({two}, {"energy"}).size(), 1U);
}

// A straight line from corner to corner of the range: its colour at the middle, and at no place beside it.
TEST(DrawPlot, CurvesAreWhereTheirNumbersAre) {
    Plot plot{"a <plot> & more", {{"t", "y", false, {{"", {{0, 0}, {10, 4}}}}}, {"t", "z", false, {}}}};
    const PictureSize size{900, 400};
    const std::string png = render_plot(plot, PictureFormat::kPng, size);
    const Folder folder;
    folder.write("p.png", png);
    const CairoSurface image(cairo_image_surface_create_from_png(folder.path("p.png").c_str()));
    ASSERT_EQ(cairo_image_surface_get_width(image.get()), 900);
    const PanelLayout layout = panel_layout(plot, 0, size);
    const auto at = [&](const Vec2& value) {
        const Vec2 pixel = layout.to_pixel(value);
        std::uint32_t colour = 0;
        std::memcpy(&colour,
                    cairo_image_surface_get_data(image.get()) +
                        std::ptrdiff_t(pixel.y()) * cairo_image_surface_get_stride(image.get()) +
                        4 * std::ptrdiff_t(pixel.x()),
                    4);
        return int(colour >> 8U & 255U);  // green
    };
    const int green = int(std::lround(255 * curve_colour(0).green));
    for (const double t : {2.0, 5.0, 9.0}) {
        EXPECT_NEAR(at({t, 0.4 * t}), green, 70) << t;  // 1.8 pixels wide: a pixel may be covered in part
        EXPECT_LT(at({t, 0.4 * t - 0.3}), 60) << t;
        EXPECT_LT(at({t, 0.4 * t + 0.3}), 60) << t;
    }
    EXPECT_EQ(render_plot(plot, PictureFormat::kSvg).substr(0, 5), "<?xml");
}

TEST(PlotCommand, RunsASceneDrawsTablesAndNamesMistakes) {
    const Folder folder;
    folder.write("s.json", testing_program::busy_scene("periodic"));
    folder.write("t.csv", "time,a,b\n0,1,2\n1,2,3\n");
    folder.write("bad.csv", "time,a\n0,1\n1\n");
    folder.write("words.csv", "time,a\n0,x\n");
    const auto run = [&](std::vector<std::string> words) {
        words.insert(words.begin(), "plot");
        return folder.run(words);
    };
    EXPECT_EQ(run({"s.json", "--out", "s.svg", "--until", "2", "--quiet"}).status, 0);
    EXPECT_EQ(run({"t.csv", "--columns", "b", "--out", "t.png"}).status, 0);
    EXPECT_EQ(run({"t.csv", "--columns", "a,b", "--out", "t.svg"}).status, 0);
    EXPECT_THAT(folder.read("t.svg"), testing::HasSubstr("<svg"));
    EXPECT_THAT(folder.read("s.svg"), testing::StartsWith("<?xml"));
    expect_one_error(run({"bad.csv", "--out", "x.svg"}), 1, "bad.csv: line 3 has 1 cells, the header 2");
    expect_one_error(run({"words.csv", "--out", "x.svg"}), 1, "words.csv: has no numbers to plot");
    std::filesystem::create_symlink("/dev/zero", folder.path("zero.csv"));
    expect_one_error(run({"zero.csv", "--out", "x.svg"}), 1, "zero.csv: cannot be read: is a device");
    expect_one_error(run({"t.csv", "--columns", "c", "--out", "x.svg"}), 1, "has no column 'c' (has: a, b)");
    expect_one_error(run({"none.csv", "--out", "x.svg"}), 1, "none.csv: cannot be read");
    expect_one_error(run({"t.csv", "s.json", "--out", "x.svg"}), 2, "one scene, or one or more tables");
    expect_one_error(run({"t.csv", "--out", "t.csv"}), 2, "unknown picture format '.csv'");
    expect_one_error(run({"s.json", "--columns", "a", "--out", "x.svg"}), 2, "belongs to tables");
    EXPECT_THAT(folder.names(), ElementsAre("bad.csv", "s.json", "s.svg", "t.csv", "t.png", "t.svg",
                                            "words.csv", "zero.csv"));
}

}  // namespace
}  // namespace carom::app
