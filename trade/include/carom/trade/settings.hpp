// The empirical method's settings for a scene, in the scene's own units of length and time.
#pragma once

#include <carom/core/scene.hpp>
#include <carom/trade/trace.hpp>

namespace carom::trade {

/// How many balls move at all.
[[nodiscard]] double moving_balls(const Scene& scene);

/// The smallest moving ball's. Precondition: some ball moves.
[[nodiscard]] double smallest_radius(const Scene& scene);

/// The unit of steps: the smallest moving radius over the root-mean-square speed at the start.
[[nodiscard]] double step_unit(const Scene& scene);

/// The scene by the empirical method with about the given step, so that a sample's time is a whole number of
/// steps, or where steps are longer a stretch is.
[[nodiscard]] Scene stepped(const Scene& scene, const Course& course, double step);

}  // namespace carom::trade
