// How far a run is, on standard error: a bar on a terminal, a line now and then in a log.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace carom::app {

/// What the progress is made of at one moment.
struct ProgressReading {
    double time = 0;   ///< simulated
    double until = 0;  ///< simulated, at the end
    std::uint64_t collisions = 0;
    double collisions_per_second = 0;
    std::optional<double> seconds_left;   ///< none while nothing is known of it
    std::optional<double> seconds_taken;  ///< at the end only, in place of what is left
};

/// One line of at most `width` columns for a terminal: share, bar, time, collisions, rate, time left. What
/// does not fit is left out, least important first. `utf8`: the bar moves by eighths of a column.
[[nodiscard]] std::string progress_bar(const ProgressReading& reading, int width, bool utf8);

/// The same for a log.
[[nodiscard]] std::string progress_line(const ProgressReading& reading);

/// Whether standard error is a terminal that moves its cursor.
[[nodiscard]] bool can_draw_bar();

/// Shows progress at a fitting pace. Nothing is shown of runs that are over at once.
class Progress {
 public:
    /// `enabled` false: shows nothing, ever. `from`: simulated time at the start; `collisions` so far.
    Progress(bool enabled, double from, double until, std::uint64_t collisions = 0);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// To be called often; draws when it is time to.
    void update(double time, std::uint64_t collisions);
    /// Draws the last state and ends the bar's line.
    void finish();

 private:
    using Instant = std::chrono::steady_clock::time_point;

    [[nodiscard]] ProgressReading reading(Instant now) const;
    void draw_bar(const ProgressReading& now);
    void print_line(Instant now);

    bool enabled_;
    bool is_terminal_;
    bool utf8_;
    bool bar_shown_ = false;
    double from_;
    double until_;
    double time_;
    std::uint64_t collisions_before_;
    std::uint64_t collisions_;
    Instant start_;
    Instant last_shown_;
    double last_line_share_ = 0;
};

}  // namespace carom::app
