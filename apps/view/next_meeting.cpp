#include "next_meeting.hpp"

#include <array>
#include <limits>

#include <carom/core/impact.hpp>

namespace carom::app {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();

Motion<double> motion_of(const Ball& ball, const Vec2& gravity) {
    if (ball.is_static) return {ball.position, Vec2::Zero(), Vec2::Zero()};
    return {ball.position, ball.velocity, gravity + ball.acceleration};
}

/// The domain's walled sides, in the order in which they are numbered; none where a side is no wall.
std::array<std::optional<Wall>, 4> sides_of(const std::optional<Domain>& domain) {
    std::array<std::optional<Wall>, 4> sides;
    if (!domain) return sides;
    const auto& [low, high] = domain->box;
    const std::array<Wall, 4> all = {Wall{low, {low.x(), high.y()}}, Wall{{high.x(), low.y()}, high},
                                     Wall{low, {high.x(), low.y()}}, Wall{{low.x(), high.y()}, high}};
    for (std::size_t side = 0; side < 4; ++side)
        if (domain->boundary[side / 2] == Boundary::kWall) sides[side] = all[side];
    return sides;
}

/// How far the images of a ball lie from it: itself, and across periodic sides.
std::vector<Vec2> image_offsets(const std::optional<Domain>& domain) {
    std::vector<Vec2> offsets;
    const auto periods = [&](std::size_t axis) {
        return domain && domain->boundary[axis] == Boundary::kPeriodic ? 1 : 0;
    };
    const Vec2 extent = domain ? Vec2(domain->box.max - domain->box.min) : Vec2::Zero();
    for (int x = -periods(0); x <= periods(0); ++x)
        for (int y = -periods(1); y <= periods(1); ++y) offsets.emplace_back(x * extent.x(), y * extent.y());
    return offsets;
}

}  // namespace

std::optional<Meeting> next_meeting(const std::vector<Ball>& balls, std::uint32_t ball, const Scene& scene) {
    Meeting first{kForEver, CollisionKind::kBall, 0};
    const auto offer = [&first](double delay, CollisionKind kind, std::size_t other) {
        if (delay < first.delay) first = {delay, kind, std::uint32_t(other)};
    };
    const Motion<double> own = motion_of(balls[ball], scene.gravity);
    const std::vector<Vec2> offsets = image_offsets(scene.domain);
    for (std::size_t j = 0; j < balls.size(); ++j) {
        if (j == ball || (balls[j].is_static && balls[ball].is_static)) continue;
        for (const Vec2& offset : offsets) {
            Motion<double> other = motion_of(balls[j], scene.gravity);
            other.position += offset;
            const double delay =
                detail::relative_time<double>(own, other, balls[ball].radius + balls[j].radius, first.delay);
            offer(delay, CollisionKind::kBall, j);
        }
    }
    const auto ask_wall = [&](const Wall& wall, std::size_t number) {
        offer(wall_time_of_impact<double>(own, balls[ball].radius, wall.from, wall.to).time,
              CollisionKind::kWall, number);
    };
    if (!balls[ball].is_static) {
        for (std::size_t w = 0; w < scene.walls.size(); ++w) ask_wall(scene.walls[w], w);
        const auto sides = sides_of(scene.domain);
        for (std::size_t side = 0; side < 4; ++side)
            if (const std::optional<Wall>& wall = sides[side]) ask_wall(*wall, scene.walls.size() + side);
    }
    if (first.delay == kForEver) return std::nullopt;
    return first;
}

}  // namespace carom::app
