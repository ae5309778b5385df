// Overlaps among balls, walls and the domain's sides: found in linear time, refused in a scene, measured in a
// world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom {

/// Two bodies that reach into each other: by ids i < j among balls (i == j: a ball and its own periodic
/// image), by ball i and wall j among balls and walls. `depth` > 0 is the radii's sum (the ball's radius, at
/// a wall) less the distance, a length.
struct Overlap {
    std::size_t i = 0;
    std::size_t j = 0;
    double depth = 0;
};

/// Every pair of overlapping balls, in the order of (i, j); empty where there is none. Two static balls may
/// overlap and are left out. An overlap of less than 1e-12 of the radii's sum, or of a few units in the last
/// place of the coordinates, is a touch and left out: balls in contact are written in decimals. Periodic
/// sides of the scene's domain are crossed; of the scene nothing else is read. Linear in balls and overlaps,
/// for radii and distances of any ratio.
[[nodiscard]] std::vector<Overlap> find_overlaps(const std::vector<Ball>& balls, const Scene& scene);

/// Every overlap of a ball that is not static with a wall, in the order of (i, j), with the same tolerance.
/// The walled sides of the domain are half-planes, numbered after the scene's walls: left, right, bottom,
/// top. In a periodic domain a wall that ends at or beyond a side is met from the other side too, up to one
/// period away.
[[nodiscard]] std::vector<Overlap> find_wall_overlaps(const std::vector<Ball>& balls, const Scene& scene);

/// Throws SceneError at the overlap with the smallest (i, j), balls before walls:
/// `balls[3]: overlaps balls[7] by 0.25 (distance 0.75, radii's sum 1)`. Linear even where everything
/// overlaps.
void check_overlaps(const std::vector<Ball>& balls, const Scene& scene);

/// What of balls and walls is looked at, and how it is called.
struct Selection {
    std::vector<std::uint8_t> balls = {};  ///< one a ball: whether its overlaps count
    std::vector<std::uint8_t> walls = {};  ///< one a wall
    std::vector<std::uint32_t> ball_ids =
        {};  ///< instead of the index, one a ball; empty where it is the index
    std::vector<std::uint32_t> wall_ids = {};
};

/// The same of the overlaps of at least one selected body.
void check_overlaps(const std::vector<Ball>& balls, const Scene& scene, const Selection& selection);

/// The deepest penetration: of two balls (not both static) in units of their radii's sum, of a ball (not
/// static) into a wall or a walled side in units of its radius; 0 where nothing overlaps. No tolerance: balls
/// in contact may show rounding, about 1e-16.
[[nodiscard]] double max_overlap(const std::vector<Ball>& balls, const Scene& scene);

}  // namespace carom
