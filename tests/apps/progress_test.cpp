// Progress as text, the pace of slices and the multiples of a step.
#include "progress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "driver.hpp"
#include "movie.hpp"

namespace carom::app {
namespace {

// Columns of a text whose characters are one column each.
int columns(const std::string& text) {
    int count = 0;
    for (const char letter : text) count += (static_cast<unsigned char>(letter) & 0xC0U) != 0x80U;
    return count;
}

ProgressReading sample() {
    ProgressReading reading;
    reading.time = 4.25;
    reading.until = 10;
    reading.collisions = 1'234'567;
    reading.collisions_per_second = 1.1e6;
    reading.seconds_left = 3725;
    return reading;
}

TEST(ProgressBar, FitsEveryWidth) {
    for (int width = 0; width < 300; ++width) {
        for (const bool utf8 : {false, true}) {
            for (const double time : {0.0, 4.25, 9.9999, 10.0}) {
                ProgressReading reading = sample();
                reading.time = time;
                EXPECT_LE(columns(progress_bar(reading, width, utf8)), width) << width;
            }
        }
    }
}

TEST(ProgressBar, SaysEverythingWhereThereIsRoom) {
    const std::string bar = progress_bar(sample(), 120, false);
    for (const char* const part :
         {" 42 %", "1.23M collisions", "1.10M/s", "t = 4.25 of 10", "1:02:05 left", "[####"}) {
        EXPECT_NE(bar.find(part), std::string::npos) << part << " in " << bar;
    }
    for (const char letter : bar) EXPECT_LT(static_cast<unsigned char>(letter), 128);
    const std::string narrow = progress_bar(sample(), 40, false);
    EXPECT_NE(narrow.find("1:02:05 left"), std::string::npos) << narrow;
    EXPECT_EQ(narrow.find("collisions"), std::string::npos) << narrow;
}

TEST(ProgressBar, IsFullAtTheEndOnly) {
    ProgressReading reading = sample();
    reading.time = std::nextafter(10.0, 0.0);
    EXPECT_NE(progress_bar(reading, 80, false).find(" 99 %"), std::string::npos);
    EXPECT_NE(progress_bar(reading, 80, false).find('-'), std::string::npos);
    reading.time = 10;
    reading.seconds_taken = 65;
    const std::string bar = progress_bar(reading, 80, false);
    EXPECT_NE(bar.find("100 %"), std::string::npos);
    EXPECT_NE(bar.find("in 1:05"), std::string::npos);
    EXPECT_EQ(bar.find('-'), std::string::npos);
}

TEST(ProgressLine, ReadsInALog) {
    EXPECT_EQ(progress_line(sample()), "42 %, t = 4.25 of 10, 1.23M collisions, 1.10M/s, 1:02:05 left");
}

TEST(SlicePace, FindsTheSliceOfFiftyMilliseconds) {
    // A world that takes 3 s a unit of time, then a hundred times as much.
    SlicePace pace(1e-6);
    for (int i = 0; i < 30; ++i) pace.took(pace.slice(), 3 * pace.slice());
    EXPECT_NEAR(pace.slice(), 0.05 / 3, 1e-12);
    for (int i = 0; i < 30; ++i) pace.took(pace.slice(), 300 * pace.slice());
    EXPECT_NEAR(pace.slice(), 0.05 / 300, 1e-12);
}

TEST(SlicePace, StaysPositiveAndFinite) {
    SlicePace pace(1);
    for (int i = 0; i < 3000; ++i) pace.took(pace.slice(), 0);
    EXPECT_TRUE(std::isfinite(pace.slice()));
    for (int i = 0; i < 3000; ++i) pace.took(pace.slice(), 1e9);
    EXPECT_GT(pace.slice(), 0);
}

TEST(Multiples, AreProductsAndStopBeforeTheEnd) {
    Multiples multiples(0.1, 1);
    for (int k = 0; k < 10; ++k) {
        EXPECT_EQ(multiples.next(), std::optional<double>(k * 0.1));
        multiples.advance();
    }
    EXPECT_FALSE(multiples.next());
    EXPECT_FALSE(Multiples(0.1, 0).next());
    // 3 * 1.1 is above 3.3 in double, 3 * 0.7 below 2.1 by a rounding: each is the end, not a frame of its
    // own before it.
    for (const double step : {1.1, 0.7}) {
        Multiples rounded(step, step == 1.1 ? 3.3 : 2.1);
        int count = 0;
        for (; rounded.next(); rounded.advance()) ++count;
        EXPECT_EQ(count, 3);
    }
}

TEST(MovieTimes, FramesAreApartBySpeedOverRateAndTheTitleTellsThemApart) {
    EXPECT_EQ((MovieTimes{.from = 0, .until = 1, .frames_per_second = 8, .speed = 1.5}.step()), 0.1875);
    EXPECT_EQ(time_digits({.from = 0, .until = 10, .frames_per_second = 10, .speed = 1}), 6);
    // At 2.5 a step of 1e-6 shows in the 7th digit.
    EXPECT_GE(time_digits({.from = 2, .until = 2.5, .frames_per_second = 10, .speed = 1e-5}), 7);
}

// It follows a step smoothly, by a share of 2 / fps a frame, and begins where the first frame is.
TEST(ColourTop, FollowsSmoothly) {
    ColourTop top(20);
    EXPECT_EQ(top.next(10), 10);
    EXPECT_DOUBLE_EQ(top.next(20), 11);
    EXPECT_DOUBLE_EQ(top.next(20), 11.9);
    ColourTop slow(1);  // at less than two frames a second there is nothing to smooth
    EXPECT_EQ(slow.next(3), 3);
    EXPECT_EQ(slow.next(7), 7);
}

}  // namespace
}  // namespace carom::app
