// The picture of a world at its present time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <carom/core/scene.hpp>
#include <carom/parallel/world.hpp>

#include "picture.hpp"

namespace carom::app {

/// How a world is looked at.
struct PictureLook {
    ColourBy colour_by = ColourBy::kSpeed;
    std::optional<double> colour_top;  ///< none: follows the balls
    std::optional<Box> view;           ///< none: the whole domain
};

/// How often each ball has collided since the tally began to listen. Takes the world's one listener.
class CollisionTally {
 public:
    explicit CollisionTally(World& world);
    CollisionTally(const CollisionTally&) = delete;
    CollisionTally& operator=(const CollisionTally&) = delete;

    [[nodiscard]] const std::vector<std::uint32_t>& counts() const { return counts_; }

 private:
    std::vector<std::uint32_t> counts_;
};

/// What colours need beside the balls: counts of collisions or numbers of domains. Empty for the others.
[[nodiscard]] std::vector<std::uint32_t> numbers_of(const World& world, ColourBy by,
                                                    const std::optional<CollisionTally>& tally);

[[nodiscard]] PictureContent picture_of(const Scene& scene, const World& world, const PictureLook& look = {},
                                        const std::optional<CollisionTally>& tally = std::nullopt);

}  // namespace carom::app
