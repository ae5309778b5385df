// Slices of a run.
#include "driver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "interrupt.hpp"

namespace carom::app {
namespace {

constexpr double kSliceSeconds = 0.05;
constexpr double kLargestChange = 4;  // of a slice to the next
// Of the run. So little that even of a run for years the first slice is over at once; from there slices grow.
constexpr double kFirstSlice = 1e-12;

}  // namespace

void SlicePace::took(double simulated, double seconds) {
    // The pace is in simulated time per second; clocks may stand still for a slice.
    const double fitting = simulated * kSliceSeconds / std::max(seconds, 1e-9);
    slice_ = std::clamp(fitting, slice_ / kLargestChange, slice_ * kLargestChange);
    slice_ = std::clamp(slice_, std::numeric_limits<double>::min(), std::numeric_limits<double>::max());
}

std::optional<double> Multiples::next() const {
    const double time = count_ * step_;
    if (time >= until_ - 1e-9 * step_) return std::nullopt;
    return time;
}

std::optional<double> Multiples::left_out() const {
    const double time = count_ * step_;
    return !next() && time < until_ ? std::optional(time) : std::nullopt;
}

Driver::Driver(World& world, Progress& progress, double until)
    : world_(world),
      progress_(progress),
      pace_(std::max(until * kFirstSlice, std::numeric_limits<double>::min())) {}

bool Driver::advance_to(double time) {
    double from = world_.time();
    while (from < time) {
        if (interrupt_requested()) return false;
        // A slice that vanishes beside the time still moves it.
        const double shortest = std::nextafter(from, std::numeric_limits<double>::max());
        const double to = std::min(std::max(from + pace_.slice(), shortest), time);
        const auto start = std::chrono::steady_clock::now();
        world_.advance_to(to);
        if (failure) std::rethrow_exception(failure);
        const auto end = std::chrono::steady_clock::now();
        pace_.took(to - from, std::chrono::duration<double>(end - start).count());
        const Counts counts = world_.counts();
        progress_.update(to, counts.ball_collisions + counts.wall_collisions);
        from = to;
    }
    return true;
}

}  // namespace carom::app
