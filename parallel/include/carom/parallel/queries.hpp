// What World answers about places.
#pragma once

#include <cstdint>

#include <carom/core/vector.hpp>

namespace carom {

enum class CollisionKind : std::uint8_t { kBall, kWall };

/// What a ray meets first. `id` is a ball's or, for kWall, a wall's; the domain's walled sides follow the
/// last wall: left, right, bottom, top.
struct RayHit {
    CollisionKind kind = CollisionKind::kBall;
    std::uint32_t id = 0;
    double distance = 0;         ///< from where the ray starts; 0 inside a ball
    Vec2 point = Vec2::Zero();   ///< in the box, where an axis is periodic
    Vec2 normal = Vec2::Zero();  ///< unit vector against the ray; against its direction inside a ball
};

struct NearestBall {
    std::uint32_t id = 0;
    double distance = 0;  ///< to its surface; negative inside
};

}  // namespace carom
