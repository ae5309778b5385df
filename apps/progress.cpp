// Progress as text, and when to show it.
#include "progress.hpp"

#include <fmt/format.h>
#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace carom::app {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kBarInterval = 0.1;         // seconds between two drawings
constexpr double kLineInterval = 10;         // seconds between two lines at most,
constexpr double kLineShare = 0.1;           // or such a part of the run,
constexpr double kShortestLineInterval = 2;  // but never more lines than this allows
constexpr int kSmallestBar = 10;
constexpr int kLargestBar = 40;

double share_of(const ProgressReading& reading) {
    return reading.until > 0 ? std::clamp(reading.time / reading.until, 0.0, 1.0) : 1.0;
}

// 1234567 as 1.23M: three digits that do not jump about.
std::string short_count(double count) {
    constexpr const char* kSuffixes[] = {"", "k", "M", "G", "T"};
    std::size_t suffix = 0;
    while (count >= 999.5 && suffix + 1 < std::size(kSuffixes)) {
        count /= 1000;
        ++suffix;
    }
    const int decimals = suffix == 0 || count >= 99.95 ? 0 : count >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f}{}", count, decimals, kSuffixes[suffix]);
}

std::string clock_text(double seconds) {
    constexpr double kLongest = 99 * 3600.0;
    if (!(seconds < kLongest)) return "more than 99 h";
    const long whole = std::lround(std::ceil(seconds));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string rest_text(const ProgressReading& reading) {
    if (reading.seconds_taken) return fmt::format("in {}", clock_text(*reading.seconds_taken));
    return fmt::format("{} left", reading.seconds_left ? clock_text(*reading.seconds_left) : "-:--");
}

std::string bar_of(double share, int columns, bool utf8) {
    if (!utf8) {
        const int full = int(share * columns);
        return fmt::format("[{:#>{}}{:->{}}]", "", full, "", columns - full);
    }
    constexpr const char* kEighths[] = {" ",      "\u258f", "\u258e", "\u258d",
                                        "\u258c", "\u258b", "\u258a", "\u2589"};
    const int eighths = int(share * columns * 8);
    std::string bar = "\u2595";
    for (int column = 0; column < columns; ++column) {
        const int filled = eighths - 8 * column;
        bar += filled >= 8 ? "\u2588" : kEighths[std::max(filled, 0)];
    }
    return bar + "\u258f";
}

// Every part but the bar is plain ASCII: bytes are columns.
std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text.append("  ").append(part);
    return text;
}

int terminal_width() {
    winsize size = {};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

bool locale_has_utf8() {
    std::setlocale(LC_CTYPE, "");
    return std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}

}  // namespace

bool can_draw_bar() {
    const char* const terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) != 0 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
}

std::string progress_bar(const ProgressReading& reading, int width, bool utf8) {
    const std::string percent = fmt::format("{:3.0f} %", std::floor(100 * share_of(reading)));
    // In the order in which they are shown; the most important last.
    std::vector<std::string> parts = {
        fmt::format("{} collisions", short_count(double(reading.collisions))),
        fmt::format("{}/s", short_count(reading.collisions_per_second)),
        fmt::format("t = {:.4g} of {:.4g}", reading.time, reading.until),
        rest_text(reading),
    };
    const auto columns_left = [&] { return width - int(percent.size() + 1 + joined(parts).size()) - 2; };
    while (!parts.empty() && columns_left() < kSmallestBar) parts.erase(parts.begin());
    const int columns = std::min(columns_left(), kLargestBar);
    if (columns < 1) return percent.substr(0, std::size_t(std::max(width, 0)));
    return percent + " " + bar_of(share_of(reading), columns, utf8) + joined(parts);
}

std::string progress_line(const ProgressReading& reading) {
    std::string line =
        fmt::format("{:.0f} %, t = {:.6g} of {:.6g}, {} collisions, {}/s",
                    std::floor(100 * share_of(reading)), reading.time, reading.until,
                    short_count(double(reading.collisions)), short_count(reading.collisions_per_second));
    if (reading.seconds_left) line += fmt::format(", {}", rest_text(reading));
    return line;
}

Progress::Progress(bool enabled, double from, double until, std::uint64_t collisions)
    : enabled_(enabled),
      is_terminal_(enabled && can_draw_bar()),
      utf8_(is_terminal_ && locale_has_utf8()),
      from_(from),
      until_(until),
      time_(from),
      collisions_before_(collisions),
      collisions_(collisions),
      start_(std::chrono::steady_clock::now()),
      last_shown_(start_) {}

Progress::~Progress() {
    // An error's message must not start in the bar's line.
    if (bar_shown_) std::fputc('\n', stderr);
}

void Progress::update(double time, std::uint64_t collisions) {
    if (!enabled_) return;
    time_ = time;
    collisions_ = collisions;
    const Instant now = std::chrono::steady_clock::now();
    const double waited = Seconds(now - last_shown_).count();
    if (is_terminal_) {
        if (waited >= kBarInterval) draw_bar(reading(now));
        return;
    }
    const bool far_enough = time_ - from_ >= (last_line_share_ + kLineShare) * (until_ - from_);
    if (waited >= kLineInterval || (far_enough && waited >= kShortestLineInterval)) print_line(now);
}

void Progress::finish() {
    if (!bar_shown_) return;
    const Instant now = std::chrono::steady_clock::now();
    ProgressReading last = reading(now);
    last.seconds_taken = Seconds(now - start_).count();
    draw_bar(last);
    std::fputc('\n', stderr);
    bar_shown_ = false;
}

ProgressReading Progress::reading(Instant now) const {
    const double elapsed = Seconds(now - start_).count();
    ProgressReading result{time_, until_, collisions_, 0, std::nullopt, std::nullopt};
    if (elapsed > 0) result.collisions_per_second = double(collisions_ - collisions_before_) / elapsed;
    if (time_ > from_) result.seconds_left = elapsed * (until_ - time_) / (time_ - from_);
    return result;
}

void Progress::draw_bar(const ProgressReading& now) {
    // The last column stays free: some terminals wrap on it.
    const std::string bar = progress_bar(now, terminal_width() - 1, utf8_);
    fmt::print(stderr, "\r{}\x1b[K", bar);
    std::fflush(stderr);
    bar_shown_ = true;
}

void Progress::print_line(Instant now) {
    fmt::print(stderr, "carom: {}\n", progress_line(reading(now)));
    last_shown_ = now;
    last_line_share_ = std::floor((time_ - from_) / (until_ - from_) / kLineShare) * kLineShare;
}

}  // namespace carom::app
