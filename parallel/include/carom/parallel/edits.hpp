// What a user changes in a running world: balls, walls and forces that come, go and change, all at one time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom {

/// What becomes of a ball; all else of it stays. `Edits{.changed_balls = {{.id = 7, .velocity = Vec2(1,
/// 0)}}}`
struct BallChange {
    std::uint32_t id = 0;
    std::optional<Vec2> position = {};  ///< in the box, where the axis is periodic
    std::optional<Vec2> velocity = {};
    std::optional<Vec2> acceleration = {};  ///< its own, beside the scene's gravity
    std::optional<double> radius = {};
    std::optional<double> mass = {};
    std::optional<double> restitution = {};
    std::optional<CollisionFilter> filter = {};
};

/// Edits that take place together, at a world's time: World::apply(). Changes come before removals, removals
/// before what is added; of two changes of one ball the later one counts.
struct Edits {
    std::vector<BallChange> changed_balls = {};
    std::vector<std::uint32_t> removed_balls = {};  ///< ids
    std::vector<Ball> added_balls = {};
    std::vector<std::uint32_t> removed_walls = {};  ///< ids
    std::vector<Wall> added_walls = {};
    std::optional<std::vector<Attractor>> attractors = {};  ///< instead of those that are there
    std::optional<Vec2> gravity = {};
};

/// The ids of what was added, in the order in which it was given: the least that nobody has. So the ids of
/// removed bodies are given again.
struct Added {
    std::vector<std::uint32_t> balls = {};
    std::vector<std::uint32_t> walls = {};
};

}  // namespace carom
