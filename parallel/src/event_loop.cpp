// Sets up the tables of the event loop, reads its state, and chooses the kernel.
#include "event_loop.hpp"

#include <limits>

#include "event_loop_events.hpp"
#include "event_loop_of.hpp"
#include "event_loop_search.hpp"

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
    asleep_.resize(n);
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
    choose_margins();
}

/// Margins within which bound_times() and the exact prediction agree.
///
/// Both round coordinates and flights of up to `farthest_`, a handful of times each: 16 roundings bound the
/// difference d of the centres' offsets r. The squared gap then differs by at most 2 |r| d <= (d / s) (r^2 +
/// s^2) for any radii's sum s, the discriminant by 2 |r x v| |v| d <= (d / s) v^2 (r^2 + s^2) and r . v by
/// d |v|; hence the margin 4 d / s for the smallest s, on top of the 2^-38 that leave the formulas' own
/// roundings far behind. Under gravity the velocities are rounded as well, by 2^-49 of themselves: against
/// 2^-38 that is a share of 2^-11 of the speed, squared kDoubtfulShare (and a factor 4).
void EventLoop::choose_margins() {
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < radius_.size(); ++i)
        if (!is_static_[i]) smallest = std::min(smallest, radius_[i]);
    one_radius_ = smallest == largest_listed_radius_ && large_.empty();
    const Box& box = physics_.domain.box;
    farthest_ = std::max(box.min.cwiseAbs().sum(), box.max.cwiseAbs().sum()) +
                8 * (grid_.x.length() + grid_.y.length());
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * 4 * farthest_;
    margin_ = 0x1p-38 + 4 * rounding / (2 * smallest);
    time_margin_ = 0x1p-46 * clock_.epoch_length();
    constexpr std::int32_t kFewest =
        6;  // cells; with fewer the nearest image need not be the one in the cell
    const auto images_are_clear = [](const GridAxis& axis) {
        return !axis.periodic() || axis.count() >= kFewest;
    };
    filters_ = margin_ < 0x1p-20 && images_are_clear(grid_.x) && images_are_clear(grid_.y);
}

template <Acceleration A>
EventLoopOf<A>::EventLoopOf(const Physics& physics, std::span<const Ball> balls, std::span<const Wall> walls,
                            std::span<const Attractor> attractors, const Grid& grid, const Executor& executor)
    : EventLoop(physics, balls, walls, grid, executor) {
    if constexpr (A == Acceleration::kPerBall) {
        acceleration_.assign(balls.size(), Vec2::Zero());
        update_field({}, attractors);
    } else {
        predict_all();
    }
}

template <Acceleration A>
void EventLoopOf<A>::update_field(const Time& t, std::span<const Attractor> attractors) {
    now_ = std::max(now_, clock_.since_epoch(t, epoch_));
    if constexpr (A == Acceleration::kPerBall) {
        for (std::uint32_t i = 0; i < ball_total(); ++i) {
            if (is_static_[i]) continue;
            advance(i, t);
            settle(i);
            ++counts_.events;
        }
        executor_.for_ranges(ball_total(), 1024, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                if (!is_static_[i])
                    acceleration_[i] = physics_.gravity + own_acceleration_[i] +
                                       field_at(attractors, {anchors_[i].x, anchors_[i].y});
        });
        for (std::uint32_t i = 0; i < ball_total(); ++i)
            if (!std::isfinite(length_squared(acceleration_[i])))
                throw std::runtime_error("balls[" + std::to_string(i) +
                                         "]: the attractors' pull on it is too large for a number");
    }
    predict_all();
}

template <Acceleration A>
Ball EventLoopOf<A>::ball_at(std::uint32_t id, const Time& t) const {
    const Motion<double> m = motion_of(id);
    const double since = clock_.difference(t, anchors_[id].time);
    const Vec2 x = position_at(m, since);
    std::int32_t ignored = 0;
    return {{grid_.x.wrapped(x.x(), ignored), grid_.y.wrapped(x.y(), ignored)},
            velocity_at(m, since),
            own_acceleration_[id],
            radius_[id],
            mass_[id],
            restitution_[id],
            is_static_[id] != 0};
}

template <Acceleration A>
Vec2 EventLoopOf<A>::unwrapped_position_at(std::uint32_t id, const Time& t) const {
    const Vec2 x = position_at(motion_of(id), clock_.difference(t, anchors_[id].time));
    return {x.x() + double(periods_[id].x) * grid_.x.length(),
            x.y() + double(periods_[id].y) * grid_.y.length()};
}

template <Acceleration A>
void EventLoopOf<A>::audit(std::vector<Violation>& found) const {
    for (std::uint32_t i = 0; i < ball_total(); ++i) {
        if (is_static_[i]) continue;
        const auto report_fault = [&found, i](const std::string& what) {
            found.push_back({"balls[" + std::to_string(i) + "]: " + what});
        };
        const Anchor& a = anchors_[i];
        if (!std::isfinite(a.x + a.y + a.vx + a.vy)) report_fault("state is not finite");
        if (queue_.key(i) != key_of(i)) report_fault("the queue holds another time than its next event's");
        if (queue_.key(i) < now_) report_fault("next event lies in the past");
        bool listed = false;
        cells_.for_each(grid_.index(a.cell), [&](std::uint32_t j) { listed = listed || j == i; });
        if (listed == is_large(i) || a.storage != grid_.index(a.cell))
            report_fault("is not listed in its cell");
        const NextEvent best = search(i);
        const bool partner_knows = best.partner < ball_total() && next_[best.partner].time <= best.time;
        if (best.time < next_[i].time && !partner_knows)
            report_fault("has an event before the one in the queue");
    }
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
