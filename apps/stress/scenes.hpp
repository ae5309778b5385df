// Scenes drawn at random from all that a scene can have, the adverse more often than the usual.
#pragma once

#include <cstddef>
#include <cstdint>

#include <carom/core/scene.hpp>

namespace carom::stress {

/// A sound scene of at most about `most_balls`, its fills placed; the same for the same seed. Its end leaves
/// a ball some tens of collisions.
[[nodiscard]] Scene draw_scene(std::uint64_t seed, std::size_t most_balls);

}  // namespace carom::stress
