// The event loop as a template on how balls accelerate. Instantiated in event_loop.cpp alone.
#pragma once

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <carom/core/disc_time.hpp>
#include <carom/core/motion.hpp>
#include <carom/core/response.hpp>
#include <carom/core/wall_time.hpp>

#include "event_loop.hpp"

namespace carom {

/// How accelerations differ from ball to ball. Pairs under one common acceleration move straight relative to
/// each other.
enum class Acceleration : std::uint8_t { kNone, kUniform, kPerBall };

template <Acceleration kAcceleration>
class EventLoopOf final : public EventLoop {
 public:
    EventLoopOf(const Physics& physics, std::span<const Ball> balls, std::span<const Wall> walls,
                std::span<const Attractor> attractors, const Grid& grid, const Executor& executor);

    void advance_to(const Time& end) override;
    void update_field(const Time& t, std::span<const Attractor> attractors) override;
    void audit(std::vector<Violation>& found) const override;
    [[nodiscard]] Ball ball_at(std::uint32_t id, const Time& t) const override;
    [[nodiscard]] Vec2 unwrapped_position_at(std::uint32_t id, const Time& t) const override;

 private:
    /// Periods between the frames of a ball and its partner.
    struct Image {
        std::int32_t x = 0;
        std::int32_t y = 0;
        Image operator-() const { return {-x, -y}; }
    };
    struct Side {
        int axis;
        bool upper;
    };

    [[nodiscard]] std::uint32_t ball_total() const { return static_cast<std::uint32_t>(anchors_.size()); }
    [[nodiscard]] std::uint32_t first_side() const {
        return ball_total() + static_cast<std::uint32_t>(walls_.size());
    }

    [[nodiscard]] Vec2 acceleration_of(std::uint32_t i) const {
        if constexpr (kAcceleration == Acceleration::kNone) return Vec2::Zero();
        if constexpr (kAcceleration == Acceleration::kUniform)
            return is_static_[i] ? Vec2(Vec2::Zero()) : physics_.gravity;
        return acceleration_[i];
    }
    [[nodiscard]] Motion<double> motion_of(std::uint32_t i) const {
        const Anchor& a = anchors_[i];
        return {{a.x, a.y}, {a.vx, a.vy}, acceleration_of(i)};
    }
    [[nodiscard]] Vec2 offset_of(const Image& image) const {
        return {image.x * grid_.x.length(), image.y * grid_.y.length()};
    }
    /// A side of the domain as a half-plane: how far ball i is inside, and the motion of that gap.
    struct Gap {
        double distance, speed, acceleration;
    };
    [[nodiscard]] Gap gap_to_side(std::uint32_t i, Side side) const;
    [[nodiscard]] static Side side_of(std::uint32_t index) {
        return {static_cast<int>(index / 2), index % 2 == 1};
    }

    // Prediction: pure functions of the anchors.
    [[nodiscard]] Time predict_pair(std::uint32_t i, std::uint32_t j, Image image) const;
    [[nodiscard]] NextEvent predict_obstacle(std::uint32_t i, std::uint32_t obstacle, Image image) const;
    [[nodiscard]] NextEvent predict_side(std::uint32_t i, std::uint32_t side) const;
    [[nodiscard]] bool precedes(const NextEvent& a, const NextEvent& b, std::uint32_t i) const;

    // Search: what ball i can meet from the cells around it.
    [[nodiscard]] bool is_large(std::uint32_t i) const { return radius_[i] > largest_listed_radius_; }
    /// How many cells away a ball may be and yet be touched before either centre crosses a border.
    [[nodiscard]] static std::int32_t reach(const GridAxis& axis, double radius_sum) {
        constexpr double kMost = 1 << 28;
        return 1 + static_cast<std::int32_t>(std::min(kMost, radius_sum * (1 + kCellMargin) / axis.width()));
    }
    [[nodiscard]] std::int32_t cell_reach(const GridAxis& axis, std::uint32_t i) const {
        return is_large(i) ? reach(axis, radius_[i] + largest_listed_radius_) : 1;
    }
    [[nodiscard]] bool reaches_all(std::int32_t reach_x, std::int32_t reach_y) const {
        return reach_x > 1 && (2.0 * reach_x + 1) * (2.0 * reach_y + 1) > grid_.cell_count();
    }
    /// The images of a ball `offset` cells behind that lie within `reach` cells: first and last, none when
    /// the first is greater.
    [[nodiscard]] static std::pair<std::int32_t, std::int32_t> images_within(const GridAxis& axis,
                                                                             std::int32_t offset,
                                                                             std::int32_t reach) {
        if (!axis.periodic()) return std::abs(offset) <= reach ? std::pair(0, 0) : std::pair(1, 0);
        const auto floor_divided = [&axis](std::int32_t k) { return (k - axis.fold(k)) / axis.count(); };
        return {-floor_divided(reach - offset), floor_divided(offset + reach)};
    }
    template <bool kTellNeighbours>
    void consider(std::uint32_t i, std::uint32_t j, Image image, NextEvent& best);
    template <bool kTellNeighbours>
    void scan_large(std::uint32_t i, NextEvent& best);
    template <bool kTellNeighbours>
    void scan_listed(std::uint32_t i, NextEvent& best);
    template <bool kTellNeighbours>
    void consider_images(std::uint32_t i, std::uint32_t j, NextEvent& best);
    void relist(std::uint32_t i, CellCoordinates cell);
    template <bool kTellNeighbours>
    void scan_cell(std::uint32_t i, CellCoordinates cell, NextEvent& best);
    void scan_obstacles(std::uint32_t i, NextEvent& best) const;
    template <bool kTellNeighbours>
    [[nodiscard]] NextEvent search(std::uint32_t i);
    void predict_crossing(std::uint32_t i);
    void predict_all();

    // Events.
    void run_until(double end, bool inclusive);
    void start_next_epoch(std::int64_t epoch);
    [[nodiscard]] std::uint64_t most_events_at_once() const {
        return 2'000'000 + 64 * std::uint64_t{ball_total()};
    }
    [[noreturn]] void refuse_wedged(std::uint32_t i) const;
    void cross(std::uint32_t i);
    void collide_first(std::uint32_t i);
    void collide_pair(std::uint32_t i, std::uint32_t j, Image image, const Time& t);
    void collide_obstacle(std::uint32_t i, const NextEvent& event);
    Image advance(std::uint32_t i, const Time& t);
    void settle(std::uint32_t i);
    [[nodiscard]] Vec2 centres_offset(std::uint32_t i, std::uint32_t j, Image image) const;
    void schedule(std::uint32_t i) { queue_.set(i, key_of(i)); }
    [[nodiscard]] double key_of(std::uint32_t i) const {
        return std::min(clock_.since_epoch(next_[i].time, epoch_), crossings_[i].time);
    }
    [[nodiscard]] Time time_now() const { return clock_.after({epoch_, 0}, now_); }
    [[nodiscard]] double restitution_at(double restitution, std::uint32_t i, std::uint32_t j,
                                        const Time& t) const;
    void report(const Time& t, CollisionKind kind, std::uint32_t i, std::uint32_t j, const Vec2& normal,
                double impulse) const;
};

// ---- Prediction
// ----------------------------------------------------------------------------------------------------------------

template <Acceleration A>
Time EventLoopOf<A>::predict_pair(std::uint32_t i, std::uint32_t j, Image image) const {
    if (j < i) {  // one order for a pair, whoever asks
        std::swap(i, j);
        image = -image;
    }
    const Anchor& a = anchors_[i];
    const Anchor& b = anchors_[j];
    double since_a = 0;
    double since_b = 0;
    const Time& reference = a.time < b.time ? b.time : a.time;
    if (a.time < b.time)
        since_a = clock_.difference(b.time, a.time);
    else
        since_b = clock_.difference(a.time, b.time);
    const double sum = radius_[i] + radius_[j];
    if constexpr (A == Acceleration::kNone) {
        const Vec2 r = {(a.x + since_a * a.vx) - (b.x + since_b * b.vx) - image.x * grid_.x.length(),
                        (a.y + since_a * a.vy) - (b.y + since_b * b.vy) - image.y * grid_.y.length()};
        return clock_.after(reference, disc_time_of_impact<double>(r, {a.vx - b.vx, a.vy - b.vy}, sum));
    } else {
        const Motion<double> ma = motion_of(i);
        const Motion<double> mb = motion_of(j);
        const Vec2 r = position_at(ma, since_a) - position_at(mb, since_b) - offset_of(image);
        const Vec2 v = velocity_at(ma, since_a) - velocity_at(mb, since_b);
        if (A == Acceleration::kUniform && !is_static_[i] && !is_static_[j])
            return clock_.after(reference, disc_time_of_impact<double>(r, v, sum));
        return clock_.after(reference,
                            disc_time_of_impact<double>(r, v, ma.acceleration - mb.acceleration, sum));
    }
}

template <Acceleration A>
NextEvent EventLoopOf<A>::predict_obstacle(std::uint32_t i, std::uint32_t obstacle, Image image) const {
    if (obstacle < ball_total())
        return {predict_pair(i, obstacle, image), obstacle, anchors_[obstacle].stamp, image.x, image.y};
    Motion<double> centre = motion_of(i);
    centre.position -= offset_of(image);
    const Wall& wall = walls_[obstacle - ball_total()];
    const WallHit<double> hit = wall_time_of_impact<double>(centre, radius_[i], wall.from, wall.to);
    return {clock_.after(anchors_[i].time, hit.time), obstacle, static_cast<std::uint32_t>(hit.feature),
            image.x, image.y};
}

template <Acceleration A>
auto EventLoopOf<A>::gap_to_side(std::uint32_t i, Side side) const -> Gap {
    const Motion<double> m = motion_of(i);
    const Box& box = physics_.domain.box;
    if (side.upper)
        return {(box.max[side.axis] - radius_[i]) - m.position[side.axis], -m.velocity[side.axis],
                -m.acceleration[side.axis]};
    return {m.position[side.axis] - (box.min[side.axis] + radius_[i]), m.velocity[side.axis],
            m.acceleration[side.axis]};
}

template <Acceleration A>
NextEvent EventLoopOf<A>::predict_side(std::uint32_t i, std::uint32_t side) const {
    const Gap gap = gap_to_side(i, side_of(side));
    return {clock_.after(anchors_[i].time, side_time_of_impact(gap.distance, gap.speed, gap.acceleration)),
            first_side() + side, 0, 0, 0};
}

/// The total order of the events of one ball.
template <Acceleration A>
bool EventLoopOf<A>::precedes(const NextEvent& a, const NextEvent& b, std::uint32_t i) const {
    if (a.time != b.time) return a.time < b.time;
    if (a.time == kNever) return false;
    const auto key = [i](const NextEvent& e) {
        const int sign = e.partner < i ? -1 : 1;  // the image as seen from the smaller id
        return std::tuple(std::min(i, e.partner), std::max(i, e.partner), sign * e.image_x, sign * e.image_y);
    };
    return key(a) < key(b);
}

// ---- Search
// --------------------------------------------------------------------------------------------------------------------

/// Predicts ball i against ball j, keeps the better event for i and, where asked, tells j.
template <Acceleration A>
template <bool kTellNeighbours>
void EventLoopOf<A>::consider(std::uint32_t i, std::uint32_t j, Image image, NextEvent& best) {
    const NextEvent event{predict_pair(i, j, image), j, anchors_[j].stamp, image.x, image.y};
    if (precedes(event, best, i)) best = event;
    if constexpr (kTellNeighbours) {
        const NextEvent theirs{event.time, i, anchors_[i].stamp, -image.x, -image.y};
        if (precedes(theirs, next_[j], j)) {
            next_[j] = theirs;
            schedule(j);
        }
    }
}

template <Acceleration A>
template <bool kTellNeighbours>
void EventLoopOf<A>::scan_cell(std::uint32_t i, CellCoordinates cell, NextEvent& best) {
    cells_.for_each(grid_.index(cell), [&](std::uint32_t j) {
        if (j == i) return;
        const Anchor& b = anchors_[j];
        Image image;
        if (b.cell != cell) {  // the same storage cell, some turns of the fold away
            const std::int32_t dx = cell.x - b.cell.x;
            const std::int32_t dy = cell.y - b.cell.y;
            if ((dx != 0 && !grid_.x.periodic()) || (dy != 0 && !grid_.y.periodic())) return;
            image = {dx / grid_.x.count(), dy / grid_.y.count()};
        }
        consider<kTellNeighbours>(i, j, image, best);
    });
}

/// Ball j in all its images that lie so near that a contact could come before either centre crosses a border.
template <Acceleration A>
template <bool kTellNeighbours>
void EventLoopOf<A>::consider_images(std::uint32_t i, std::uint32_t j, NextEvent& best) {
    if (j == i) return;
    const double sum = radius_[i] + radius_[j];
    const CellCoordinates& a = anchors_[i].cell;
    const CellCoordinates& b = anchors_[j].cell;
    const auto [first_x, last_x] = images_within(grid_.x, a.x - b.x, reach(grid_.x, sum));
    const auto [first_y, last_y] = images_within(grid_.y, a.y - b.y, reach(grid_.y, sum));
    for (std::int32_t x = first_x; x <= last_x; ++x)
        for (std::int32_t y = first_y; y <= last_y; ++y) consider<kTellNeighbours>(i, j, {x, y}, best);
}

/// The large balls, which are in no cell's list.
template <Acceleration A>
template <bool kTellNeighbours>
void EventLoopOf<A>::scan_large(std::uint32_t i, NextEvent& best) {
    for (const std::uint32_t j : large_) consider_images<kTellNeighbours>(i, j, best);
}

/// All other balls, for a ball so large that the cells within its reach are more than there are.
template <Acceleration A>
template <bool kTellNeighbours>
void EventLoopOf<A>::scan_listed(std::uint32_t i, NextEvent& best) {
    for (std::uint32_t j = 0; j < ball_total(); ++j)
        if (!is_static_[j] && !is_large(j)) consider_images<kTellNeighbours>(i, j, best);
}

template <Acceleration A>
void EventLoopOf<A>::scan_obstacles(std::uint32_t i, NextEvent& best) const {
    const Anchor& a = anchors_[i];
    const auto consider = [&](const NextEvent& event) {
        if (precedes(event, best, i)) best = event;
    };
    const bool large = is_large(i);
    for (const ObstacleEntry& entry : (large ? obstacles_of_large_ : obstacles_).at(a.storage)) {
        const auto turns = [](const GridAxis& axis, std::int32_t k) {
            return axis.periodic() ? (k - axis.fold(k)) / axis.count() : 0;
        };
        consider(predict_obstacle(
            i, entry.id,
            {turns(grid_.x, a.cell.x) + entry.shift_x, turns(grid_.y, a.cell.y) + entry.shift_y}));
    }
    const std::array<Boundary, 2>& boundary = physics_.domain.boundary;
    if (boundary[0] == Boundary::kWall) {
        if (large || a.cell.x <= 0) consider(predict_side(i, 0));
        if (large || a.cell.x >= grid_.x.count() - 1) consider(predict_side(i, 1));
    }
    if (boundary[1] == Boundary::kWall) {
        if (large || a.cell.y <= 0) consider(predict_side(i, 2));
        if (large || a.cell.y >= grid_.y.count() - 1) consider(predict_side(i, 3));
    }
}

/// Ball i's next event from all that is around it.
template <Acceleration A>
template <bool kTellNeighbours>
NextEvent EventLoopOf<A>::search(std::uint32_t i) {
    NextEvent best;
    const CellCoordinates c = anchors_[i].cell;
    const std::int32_t reach_x = cell_reach(grid_.x, i);
    const std::int32_t reach_y = cell_reach(grid_.y, i);
    if (reaches_all(reach_x, reach_y)) {
        scan_listed<kTellNeighbours>(i, best);
    } else {
        for (std::int32_t y = c.y - reach_y; y <= c.y + reach_y; ++y)
            for (std::int32_t x = c.x - reach_x; x <= c.x + reach_x; ++x)
                scan_cell<kTellNeighbours>(i, {x, y}, best);
    }
    scan_large<kTellNeighbours>(i, best);
    scan_obstacles(i, best);
    return best;
}

template <Acceleration A>
void EventLoopOf<A>::predict_crossing(std::uint32_t i) {
    const Anchor& a = anchors_[i];
    const Vec2 acceleration = acceleration_of(i);
    const double anchored = clock_.since_epoch(a.time, epoch_);
    const double since = std::max(0.0, now_ - anchored);
    Crossing first{std::numeric_limits<double>::infinity(), 0, 0};
    const auto consider = [&](double time, std::int8_t dx, std::int8_t dy) {
        if (time < first.time) first = {time, dx, dy};
    };
    consider(time_to_leave(grid_.x.border(a.cell.x + 1) - a.x, a.vx, acceleration.x(), since), 1, 0);
    consider(time_to_leave(a.x - grid_.x.border(a.cell.x), -a.vx, -acceleration.x(), since), -1, 0);
    consider(time_to_leave(grid_.y.border(a.cell.y + 1) - a.y, a.vy, acceleration.y(), since), 0, 1);
    consider(time_to_leave(a.y - grid_.y.border(a.cell.y), -a.vy, -acceleration.y(), since), 0, -1);
    first.time = std::max(anchored + first.time, now_);
    crossings_[i] = first;
}

/// All balls at once, side by side: each finds its own next event and tells nobody.
template <Acceleration A>
void EventLoopOf<A>::predict_all() {
    executor_.for_ranges(anchors_.size(), 512, [this](std::size_t first, std::size_t last) {
        for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
            if (is_static_[i]) continue;
            next_[i] = search<false>(i);
            predict_crossing(i);
            queue_.put(i, key_of(i));
        }
    });
    queue_.rebuild();
}

// ---- Events
// --------------------------------------------------------------------------------------------------------------------

template <Acceleration A>
void EventLoopOf<A>::advance_to(const Time& end) {
    while (epoch_ < end.epoch) {
        run_until(clock_.epoch_length(), false);
        const double epochs = std::floor(queue_.first_key() / clock_.epoch_length());
        start_next_epoch(epochs < double(end.epoch - epoch_)
                             ? epoch_ + std::max(std::int64_t{1}, static_cast<std::int64_t>(epochs))
                             : end.epoch);
    }
    run_until(end.offset, true);
    now_ = std::max(now_, end.offset);
}

template <Acceleration A>
void EventLoopOf<A>::run_until(double end, bool inclusive) {
    while (queue_.first_key() < end || (inclusive && queue_.first_key() == end)) {
        const std::uint32_t i = queue_.first();
        if (queue_.first_key() > now_) {
            now_ = queue_.first_key();
            events_at_once_ = 0;
        } else if (++events_at_once_ > most_events_at_once()) {
            refuse_wedged(i);
        }
        ++counts_.events;
        if (crossings_[i].time <= clock_.since_epoch(next_[i].time, epoch_))
            cross(i);
        else
            collide_first(i);
    }
}

/// Many balls may meet at one instant, in a row of touching balls (N / 2)^2 times; what goes on has no end.
template <Acceleration A>
void EventLoopOf<A>::refuse_wedged(std::uint32_t i) const {
    std::ostringstream what;
    what << "balls[" << i << "]: is wedged: more than " << most_events_at_once() << " events at time "
         << clock_.to_seconds(time_now())
         << " (it has no room to move, or loses energy without a contact_time)";
    throw std::runtime_error(what.str());
}

template <Acceleration A>
void EventLoopOf<A>::start_next_epoch(std::int64_t epoch) {
    const double passed = clock_.epoch_length() * (double(epoch) - double(epoch_));
    epoch_ = epoch;
    now_ = 0;
    executor_.for_ranges(anchors_.size(), 4096, [this, passed](std::size_t first, std::size_t last) {
        for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
            if (is_static_[i]) continue;
            crossings_[i].time -= passed;
            queue_.put(i, key_of(i));
        }
    });
    queue_.rebuild();
}

template <Acceleration A>
void EventLoopOf<A>::cross(std::uint32_t i) {
    Anchor& a = anchors_[i];
    const Crossing crossing = crossings_[i];
    relist(i, {a.cell.x + crossing.dx, a.cell.y + crossing.dy});
    if (std::max(std::abs(a.cell.x), std::abs(a.cell.y)) >= GridAxis::kFarthest)
        throw std::runtime_error("balls[" + std::to_string(i) +
                                 "]: flies more than a thousand million cells without an event");
    NextEvent best = next_[i];
    // The row of cells that comes into view.
    const std::int32_t reach_x = cell_reach(grid_.x, i);
    const std::int32_t reach_y = cell_reach(grid_.y, i);
    if (reaches_all(reach_x, reach_y)) {
        scan_listed<true>(i, best);
    } else if (crossing.dx != 0) {
        for (std::int32_t k = -reach_y; k <= reach_y; ++k)
            scan_cell<true>(i, {a.cell.x + crossing.dx * reach_x, a.cell.y + k}, best);
    } else {
        for (std::int32_t k = -reach_x; k <= reach_x; ++k)
            scan_cell<true>(i, {a.cell.x + k, a.cell.y + crossing.dy * reach_y}, best);
    }
    scan_large<true>(i, best);
    scan_obstacles(i, best);
    next_[i] = best;
    predict_crossing(i);
    schedule(i);
}

template <Acceleration A>
void EventLoopOf<A>::collide_first(std::uint32_t i) {
    const NextEvent event = next_[i];
    if (event.partner >= ball_total() || is_static_[event.partner]) {
        collide_obstacle(i, event);
        return;
    }
    if (anchors_[event.partner].stamp == event.stamp) {
        collide_pair(i, event.partner, {event.image_x, event.image_y}, event.time);
        return;
    }
    next_[i] = search<true>(i);  // the partner has gone another way
    schedule(i);
}

/// Anchors a ball at `t`, wrapped into the box. Gives the periods that the wrapping took away.
template <Acceleration A>
auto EventLoopOf<A>::advance(std::uint32_t i, const Time& t) -> Image {
    Anchor& a = anchors_[i];
    const double since = clock_.difference(t, a.time);
    const Motion<double> m = motion_of(i);
    const Vec2 x = position_at(m, since);
    const Vec2 v = velocity_at(m, since);
    Image wrapped;
    const Vec2 inside = {grid_.x.wrapped(x.x(), wrapped.x), grid_.y.wrapped(x.y(), wrapped.y)};
    a.x = inside.x();
    a.y = inside.y();
    a.vx = v.x();
    a.vy = v.y();
    a.time = t;
    periods_[i].x += wrapped.x;
    periods_[i].y += wrapped.y;
    return wrapped;
}

/// After an event: finds the ball's cell anew and marks every prediction about the ball as stale.
template <Acceleration A>
void EventLoopOf<A>::settle(std::uint32_t i) {
    Anchor& a = anchors_[i];
    ++a.stamp;
    relist(i, grid_.coordinates({a.x, a.y}));
}

/// Puts a ball into another cell's list; a large ball is in none.
template <Acceleration A>
void EventLoopOf<A>::relist(std::uint32_t i, CellCoordinates cell) {
    Anchor& a = anchors_[i];
    a.cell = cell;
    const std::int32_t storage = grid_.index(cell);
    if (storage == a.storage) return;
    if (!is_large(i)) {
        cells_.remove(a.storage, i);
        cells_.insert(storage, i);
    }
    a.storage = storage;
}

/// Centre i less centre j's image, both anchored at one time; the same bits as the prediction's, computed
/// from the smaller id.
template <Acceleration A>
Vec2 EventLoopOf<A>::centres_offset(std::uint32_t i, std::uint32_t j, Image image) const {
    if (j < i) return -centres_offset(j, i, -image);
    return Vec2(anchors_[i].x, anchors_[i].y) - Vec2(anchors_[j].x, anchors_[j].y) - offset_of(image);
}

/// The TC model: a body that has collided a moment ago loses nothing. `j` == i where the other body has no
/// past.
template <Acceleration A>
double EventLoopOf<A>::restitution_at(double restitution, std::uint32_t i, std::uint32_t j,
                                      const Time& t) const {
    if (physics_.contact_time == 0) return restitution;
    const double since = clock_.difference(t, std::max(last_collision_[i], last_collision_[j]));
    return tc_restitution(restitution, since, physics_.contact_time);
}

template <Acceleration A>
void EventLoopOf<A>::collide_pair(std::uint32_t i, std::uint32_t j, Image image, const Time& t) {
    if (j < i) {
        std::swap(i, j);
        image = -image;
    }
    const Image wrapped_i = advance(i, t);
    const Image wrapped_j = advance(j, t);
    image = {image.x - wrapped_i.x + wrapped_j.x, image.y - wrapped_i.y + wrapped_j.y};
    Anchor& a = anchors_[i];
    Anchor& b = anchors_[j];
    const Vec2 va = {a.vx, a.vy};
    const Vec2 vb = {b.vx, b.vy};
    const Vec2 r = centres_offset(i, j, image);
    const double restitution = restitution_at(
        pair_restitution(physics_.restitution_rule, restitution_[i], restitution_[j]), i, j, t);
    double separation = 0;
    if constexpr (A == Acceleration::kPerBall) {
        // f'' / 2 of the squared distance f: negative where the pair is pressed together.
        const double pressure =
            -(length_squared<double>(va - vb) + dot<double>(r, acceleration_[i] - acceleration_[j]));
        if (pressure > 0) separation = pressure / std::sqrt(length_squared(r)) * physics_.rest_time / 2;
    }
    double impulse = 0;  // along the unit normal
    const PairVelocities<double> after =
        collide(va, vb, r, mass_[i], mass_[j], restitution, separation, &impulse);
    a.vx = after.a.x();
    a.vy = after.a.y();
    b.vx = after.b.x();
    b.vy = after.b.y();
    const double distance = std::sqrt(length_squared(r));
    virial_ += impulse * distance;
    ++counts_.ball_collisions;
    if (listener) report(t, CollisionKind::kBall, i, j, r / distance, impulse);
    if (physics_.contact_time > 0) last_collision_[i] = last_collision_[j] = t;
    settle(i);
    settle(j);
    for (const std::uint32_t k : {i, j}) {
        predict_crossing(k);
        next_[k] = search<true>(k);
        schedule(k);
    }
}

template <Acceleration A>
void EventLoopOf<A>::collide_obstacle(std::uint32_t i, const NextEvent& event) {
    const Image wrapped = advance(i, event.time);
    const Image image = {event.image_x - wrapped.x, event.image_y - wrapped.y};
    Anchor& a = anchors_[i];
    const bool is_ball = event.partner < ball_total();
    Vec2 normal;  // from the obstacle to the ball, of any length
    double restitution = physics_.domain.restitution;
    if (is_ball) {
        normal = centres_offset(i, event.partner, image);
        restitution = restitution_[event.partner];
    } else if (event.partner < first_side()) {
        const Wall& wall = walls_[event.partner - ball_total()];
        const Vec2 centre = Vec2(a.x, a.y) - offset_of(image);
        normal = contact_normal<double>(centre, static_cast<WallFeature>(event.stamp), wall.from, wall.to);
        restitution = wall.restitution;
    } else {
        const Side side = side_of(event.partner - first_side());
        normal = Vec2::Zero();
        normal[side.axis] = side.upper ? -1 : 1;
    }
    restitution = pair_restitution(physics_.restitution_rule, restitution_[i], restitution);
    const double lasting = restitution_at(restitution, i, i, event.time);
    const Vec2 before = {a.vx, a.vy};
    const double length = std::sqrt(length_squared(normal));
    double separation = 0;
    if constexpr (A != Acceleration::kNone) {
        const bool is_round = is_ball || (event.partner < first_side() &&
                                          static_cast<WallFeature>(event.stamp) != WallFeature::kFace);
        const double pressure =
            -(dot(normal, acceleration_of(i)) + (is_round ? length_squared(before) : 0.0));
        if (pressure > 0) separation = pressure / length * physics_.rest_time / 2;
    }
    const double factor = physics_.contact_time > 0 && lasting != restitution ? 1 : physics_.speed_factor;
    Vec2 after = bounce<double>(before, normal, lasting, separation / factor);
    if (factor != 1) after *= factor;
    a.vx = after.x();
    a.vy = after.y();
    const double impulse = mass_[i] * dot<double>(after - before, normal) / length;
    ++(is_ball ? counts_.ball_collisions : counts_.wall_collisions);
    if (is_ball) virial_ += impulse * length;
    if (listener)
        report(event.time, is_ball ? CollisionKind::kBall : CollisionKind::kWall, i,
               is_ball ? event.partner : event.partner - ball_total(), normal / length, impulse);
    if (physics_.contact_time > 0) last_collision_[i] = event.time;
    settle(i);
    predict_crossing(i);
    next_[i] = search<true>(i);
    schedule(i);
}

template <Acceleration A>
void EventLoopOf<A>::report(const Time& t, CollisionKind kind, std::uint32_t i, std::uint32_t j,
                            const Vec2& normal, double impulse) const {
    const Vec2 point = Vec2(anchors_[i].x, anchors_[i].y) - radius_[i] * normal;
    std::int32_t ignored = 0;
    listener({clock_.to_seconds(t),
              kind,
              i,
              j,
              {grid_.x.wrapped(point.x(), ignored), grid_.y.wrapped(point.y(), ignored)},
              normal,
              impulse});
}

// ---- Setting up and reading
// ----------------------------------------------------------------------------------------------------

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
        const NextEvent best = const_cast<EventLoopOf*>(this)->template search<false>(i);
        if (best.time < next_[i].time) report_fault("has an event before the one in the queue");
    }
}

}  // namespace carom
