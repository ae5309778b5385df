// Which scene a state belongs to.
#pragma once

#include <cstdint>
#include <span>

#include <carom/core/scene.hpp>

#include "executor.hpp"
#include "physics.hpp"

namespace carom {

/// Of everything that the course of a scene depends on, with the balls as placed and the scales as derived;
/// its name and its end are left out.
[[nodiscard]] std::uint64_t scene_hash(const Scene& scene, const Physics& physics,
                                       std::span<const Ball> balls, const Executor& executor);

}  // namespace carom
