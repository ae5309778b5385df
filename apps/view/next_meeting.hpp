// What a ball will hit next, if nobody comes between: all other bodies are asked, by core's times of impact.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <carom/core/scene.hpp>
#include <carom/parallel/world.hpp>

namespace carom::app {

struct Meeting {
    double delay = 0;  ///< from now
    CollisionKind kind = CollisionKind::kBall;
    std::uint32_t other = 0;  ///< numbered as in Collision
};

/// None where it would fly on for ever. Forces of attractors are left out. Costs a pass over all balls.
[[nodiscard]] std::optional<Meeting> next_meeting(const std::vector<Ball>& balls, std::uint32_t ball,
                                                  const Scene& scene);

}  // namespace carom::app
