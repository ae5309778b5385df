// Tries settings on a scene for a bounded time and says which is the fastest that keeps an error.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>
#include <carom/trade/cost.hpp>
#include <carom/trade/errors.hpp>

namespace carom::trade {

struct AdviceOptions {
    double error = 1e-3;
    double seconds = 30;  ///< by the clock, for all that is tried
    int threads = 0;
    /// Told what is tried next.
    std::function<void(const std::string& name)> on_trial = [](const std::string&) {};
    /// Asked now and then; false ends it with what is known.
    std::function<bool()> goes_on = [] { return true; };
};

/// One setting that was tried.
struct Trial {
    std::string name;
    Scene scene;
    std::optional<Errors> errors;   ///< none where it took too long to be worth its end
    std::optional<TimeRatio> time;  ///< over the event method's as the scene has it; none as above
    double error = 0;               ///< the largest of its errors and what the reference is uncertain by
    bool keeps = false;
};

struct Advice {
    double until = 0;              ///< simulated time of the stretch that settings were compared on
    double collisions_a_ball = 0;  ///< in it
    std::size_t compared = 0;      ///< collisions of the reference that settings could miss
    double reference_error = 0;    ///< what the reference is uncertain by; 0 without attractors
    std::vector<Trial> trials;     ///< in the order in which they were tried; the first is the scene's own
    std::optional<std::size_t> choice;  ///< index of the fastest that keeps the error, if any does
    bool is_cut_short = false;          ///< whether time ended before all was tried
};

/// The reference is the event method in double. Where attractors pull, their field is renewed more often
/// until that changes no place by more than a part of the error, or a part of the time is gone.
///
/// Settings are compared on the stretch from the start in which a ball has two collisions on the mean,
/// shorter where the scene ends before or that takes too long: later, chaos parts any two runs. The scene's
/// own method, step and tolerance are not looked at. Precondition: fills are placed, and some ball moves or
/// will. Throws what World throws.
[[nodiscard]] Advice advise(const Scene& scene, const AdviceOptions& options);

}  // namespace carom::trade
