// The picture of a world at its present time.
#pragma once

#include <carom/core/scene.hpp>
#include <carom/parallel/world.hpp>

#include "picture.hpp"

namespace carom::app {

[[nodiscard]] inline PictureContent picture_of(const Scene& scene, const World& world) {
    return {scene.name, world.time(), scene.domain, world.balls(), scene.walls, scene.attractors};
}

}  // namespace carom::app
