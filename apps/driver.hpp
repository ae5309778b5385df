// Moves a world forward in slices short enough to look up in between: for progress, for Ctrl-C.
#pragma once

#include <cmath>
#include <exception>
#include <functional>
#include <optional>

#include <carom/parallel/world.hpp>

#include "progress.hpp"

namespace carom::app {

/// Chooses slices of simulated time that take about 50 ms each by the clock on the wall. They change no bit
/// of the result, so the clock may choose them.
class SlicePace {
 public:
    explicit SlicePace(double first_slice) : slice_(first_slice) {}
    /// The slice's length, simulated, > 0.
    [[nodiscard]] double slice() const { return slice_; }
    /// The last slice covered `simulated` and took `seconds`. Shorter slices than asked for (before a stop)
    /// count by their proportion.
    void took(double simulated, double seconds);

 private:
    double slice_;
};

/// 0, step, 2 step, ... below `until`, each computed as a product, so that they do not drift; `until` itself
/// is the caller's. A multiple within a billionth of a step of `until` is `until` with rounding, and is left
/// out.
class Multiples {
 public:
    /// From the `first` on: 0 for all.
    Multiples(double step, double until, double first = 0) : step_(step), until_(until), count_(first) {}
    /// Those after `time` only.
    [[nodiscard]] static Multiples after(double time, double step, double until) {
        return {step, until, std::floor(time / step) + 1};
    }
    /// The next multiple; none when the rest lies at or beyond `until`.
    [[nodiscard]] std::optional<double> next() const;
    void advance() { count_ += 1; }
    /// The multiple that is `until` but for rounding, where it lies before it.
    [[nodiscard]] std::optional<double> left_out() const;

 private:
    double step_;
    double until_;
    double count_;
};

class Driver {
 public:
    Driver(World& world, Progress& progress, double until);

    /// Advances to the time exactly, or less far when an interrupt came before: then false. Rethrows what
    /// `failure` holds after a slice.
    bool advance_to(double time);

    /// Set by a collision listener that failed: the engine is not to be left by an exception from within.
    std::exception_ptr failure;

 private:
    World& world_;
    Progress& progress_;
    SlicePace pace_;
};

}  // namespace carom::app
