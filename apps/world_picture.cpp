// From a world to what is drawn of it.
#include "world_picture.hpp"

namespace carom::app {

CollisionTally::CollisionTally(World& world) : counts_(world.ball_count(), 0) {
    world.on_collision([this](const Collision& c) {
        ++counts_[c.i];
        if (c.kind == CollisionKind::kBall) ++counts_[c.j];
    });
}

std::vector<std::uint32_t> numbers_of(const World& world, ColourBy by,
                                      const std::optional<CollisionTally>& tally) {
    if (by == ColourBy::kDomain) return world.domains_of_balls();
    if (by == ColourBy::kCollisions && tally) return tally->counts();
    return {};
}

PictureContent picture_of(const Scene& scene, const World& world, const PictureLook& look,
                          const std::optional<CollisionTally>& tally) {
    PictureContent content;
    content.title = scene.name;
    content.time = world.time();
    content.domain = scene.domain;
    content.balls = world.balls();
    content.walls = scene.walls;
    content.attractors = scene.attractors;
    content.sensors = scene.sensors;
    content.colour_by = look.colour_by;
    content.numbers = numbers_of(world, look.colour_by, tally);
    content.colour_top = look.colour_top;
    content.view = look.view;
    return content;
}

}  // namespace carom::app
