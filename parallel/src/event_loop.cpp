// What all kernels of the event loop share: the tables of the balls, and the choice of the kernel.
#include "event_loop.hpp"

#include <limits>

#include "event_loop_of.hpp"

namespace carom {

EventLoop::EventLoop(const Physics& physics, std::span<const Ball> balls, std::span<const Wall> walls,
                     const Grid& grid, const Executor& executor)
    : physics_(physics),
      clock_(physics.clock),
      executor_(executor),
      grid_(grid),
      cells_(static_cast<std::size_t>(grid.cell_count())),
      queue_(balls.size()),
      walls_(walls.begin(), walls.end()) {
    const std::size_t n = balls.size();
    anchors_.resize(n);
    next_.resize(n);
    crossings_.resize(n);
    periods_.resize(n);
    const double widest = std::min(grid.x.width(), grid.y.width());
    double largest_radius = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Ball& b = balls[i];
        radius_.push_back(b.radius);
        mass_.push_back(b.mass);
        restitution_.push_back(b.restitution);
        is_static_.push_back(b.is_static ? 1 : 0);
        own_acceleration_.push_back(b.acceleration);
        Anchor& a = anchors_[i];
        std::int32_t periods_x = 0;
        std::int32_t periods_y = 0;
        const double x = grid_.x.wrapped(b.position.x(), periods_x);
        const double y = grid_.y.wrapped(b.position.y(), periods_y);
        periods_[i] = {periods_x, periods_y};
        a = {x, y, b.velocity.x(), b.velocity.y(), {}, 0, 0, grid_.coordinates({x, y})};
        a.storage = grid_.index(a.cell);
        if (b.is_static) continue;
        largest_radius = std::max(largest_radius, b.radius);
        if (2 * b.radius * (1 + kCellMargin) > widest) {
            large_.push_back(i);
        } else {
            largest_listed_radius_ = std::max(largest_listed_radius_, b.radius);
            cells_.insert(a.storage, i);
        }
    }
    obstacles_ = ObstacleMap(grid_, balls, walls, largest_listed_radius_);
    if (!large_.empty()) obstacles_of_large_ = ObstacleMap(grid_, balls, walls, largest_radius);
    if (physics.contact_time > 0) last_collision_.assign(n, {std::numeric_limits<std::int64_t>::min(), 0});
}

std::unique_ptr<EventLoop> make_event_loop(const Physics& physics, std::span<const Ball> balls,
                                           std::span<const Wall> walls, std::span<const Attractor> attractors,
                                           const Grid& grid, const Executor& executor) {
    const bool per_ball = !attractors.empty() ||
                          std::ranges::any_of(balls, [](const Ball& b) { return !b.acceleration.isZero(0); });
    if (per_ball)
        return std::make_unique<EventLoopOf<Acceleration::kPerBall>>(physics, balls, walls, attractors, grid,
                                                                     executor);
    if (!physics.gravity.isZero(0))
        return std::make_unique<EventLoopOf<Acceleration::kUniform>>(physics, balls, walls, attractors, grid,
                                                                     executor);
    return std::make_unique<EventLoopOf<Acceleration::kNone>>(physics, balls, walls, attractors, grid,
                                                              executor);
}

}  // namespace carom
