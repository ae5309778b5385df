#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace carom {

Property::Property(std::span<const Ball> balls, double Ball::* member) {
    if (balls.empty()) return;
    one_ = balls.front().*member;
    if (std::ranges::all_of(balls, [&](const Ball& b) { return b.*member == one_; })) return;
    each_.reserve(balls.size());
    for (const Ball& b : balls) each_.push_back(b.*member);
}

Bodies::Bodies(const Physics& scene_physics, std::span<const Ball> balls, std::span<const Wall> scene_walls,
               std::span<const Attractor> scene_attractors, const Grid& scene_grid)
    : physics(scene_physics),
      grid(scene_grid),
      walls(scene_walls.begin(), scene_walls.end()),
      attractors(scene_attractors.begin(), scene_attractors.end()),
      count(static_cast<std::uint32_t>(balls.size())) {
    radius = {balls, &Ball::radius};
    mass = {balls, &Ball::mass};
    restitution = {balls, &Ball::restitution};
    if (std::ranges::any_of(balls, &Ball::is_static)) {
        for (const Ball& b : balls) {
            is_static.push_back(b.is_static ? 1 : 0);
            std::int32_t ignored = 0;
            fixed.emplace_back(grid.x.wrapped(b.position.x(), ignored),
                               grid.y.wrapped(b.position.y(), ignored));
        }
    }
    if (std::ranges::any_of(balls, [](const Ball& b) { return !b.is_static && !b.acceleration.isZero(0); }))
        for (const Ball& b : balls) own_acceleration.push_back(b.acceleration);

    const auto is_filtered = [](const auto& body) { return body.filter != CollisionFilter{}; };
    if (std::ranges::any_of(balls, is_filtered) || std::ranges::any_of(walls, is_filtered)) {
        for (const Ball& b : balls) filters.push_back(b.filter);
        for (const Wall& w : walls) filters.push_back(w.filter);
    }

    const double widest = std::min(grid.x.width(), grid.y.width());
    double largest_radius = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Ball& b = balls[i];
        if (b.is_static) continue;
        ++moving;
        largest_radius = std::max(largest_radius, b.radius);
        if (2 * b.radius * (1 + kCellMargin) > widest)
            large.push_back(i);
        else
            largest_listed_radius = std::max(largest_listed_radius, b.radius);
    }
    obstacles = ObstacleMap(grid, balls, walls, largest_listed_radius);
    if (!large.empty()) obstacles_of_large = ObstacleMap(grid, balls, walls, largest_radius);
    has_obstacles = !obstacles.empty() || !obstacles_of_large.empty() ||
                    std::ranges::count(physics.domain.boundary, Boundary::kWall) > 0;
    choose_margins();
}

/// Rounding may reach the upper side, which is the lower one of the next period.
Vec2 Bodies::rounded_position(const Vec2& inside, Periods& away) const {
    return {rounded_to_float(grid.x.wrapped(rounded_to_float(inside.x()), away.x)),
            rounded_to_float(grid.y.wrapped(rounded_to_float(inside.y()), away.y))};
}

Vec2 Bodies::acceleration_at(std::uint32_t id, const Vec2& place) const {
    const Vec2 a = physics.gravity + own_acceleration_of(id) + field_at(attractors, place);
    if (!std::isfinite(length_squared(a)))
        throw std::runtime_error(ball_name(id) + ": the attractors' pull on it is too large for a number");
    return a;
}

void Bodies::choose_margins() {
    smallest_radius = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < count; ++i)
        if (!fixes(i)) smallest_radius = std::min(smallest_radius, radius.of(i));
    time_margin = 0x1p-46 * physics.clock.epoch_length();
    constexpr std::int32_t kFewest =
        6;  // cells; with fewer the nearest image need not be the one in the cell
    const auto images_are_clear = [](const GridAxis& axis) {
        return !axis.periodic() || axis.count() >= kFewest;
    };
    has_clear_images = images_are_clear(grid.x) && images_are_clear(grid.y);
}

}  // namespace carom
