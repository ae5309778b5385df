// Moves a world forward in slices short enough to look up in between: for progress, for Ctrl-C.
#pragma once

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
    Multiples(double step, double until) : step_(step), until_(until) {}
    /// The next multiple; none when the rest lies at or beyond `until`.
    [[nodiscard]] std::optional<double> next() const;
    void advance() { count_ += 1; }

 private:
    double step_;
    double until_;
    double count_ = 0;
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
