// What happens at an event, and the loop that takes them in order.
#pragma once

#include <sstream>
#include <stdexcept>
#include <utility>

#include <carom/core/response.hpp>
#include <carom/core/wall_time.hpp>

#include "event_loop_of.hpp"

namespace carom {

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
    for (;;) {
        std::uint32_t i = queue_.first();
        const double key = queue_.key(i);
        if (!(key < end || (inclusive && key == end))) return;
        if (key > now_) {
            now_ = key;
            events_at_once_ = 0;
            simultaneous_ = false;
        } else if (++events_at_once_ > most_events_at_once()) {
            refuse_wedged(i);
        }
        if (!simultaneous_ && queue_.may_be_tied()) {
            order_ties();
            i = queue_.first();
        }
        ++counts_.events;
        if (asleep_[i] || crossings_[i].time <= clock_.since_epoch(next_[i].time, epoch_))
            cross(i);
        else
            collide_first(i);
    }
}

/// Several events share this instant: lets the smaller id of each pair know of its event, so that the
/// smallest id with an event now holds the first one.
template <Acceleration A>
void EventLoopOf<A>::order_ties() {
    std::vector<std::uint32_t> tied;
    queue_.for_each_first([&](std::uint32_t i) { tied.push_back(i); });
    if (tied.size() < 2) return;
    simultaneous_ = true;
    for (const std::uint32_t i : tied) tell_lower(i);
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
    const Anchor& a = anchors_[i];
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
        scan_listed(i, best);
    } else if (crossing.dx != 0) {
        const std::int32_t x = a.cell.x + crossing.dx * reach_x;
        scan_cells(i, {x, a.cell.y - reach_y}, {x, a.cell.y + reach_y}, best);
    } else {
        const std::int32_t y = a.cell.y + crossing.dy * reach_y;
        scan_cells(i, {a.cell.x - reach_x, y}, {a.cell.x + reach_x, y}, best);
    }
    scan_large(i, best);
    scan_obstacles(i, best);
    predict_crossing(i);
    expect(i, best);
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
    expect(i, search(i));  // the partner has gone another way
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
    double pressure = 0;  // -f'' / 2 of the squared distance f: positive where the pair is pressed together
    if constexpr (A == Acceleration::kPerBall)
        pressure = -(length_squared<double>(va - vb) + dot<double>(r, acceleration_[i] - acceleration_[j]));
    const double separation = parting_speed(pressure, r);
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
        expect(k, search(k));
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
    double pressure = 0;
    if constexpr (A != Acceleration::kNone) {
        const bool is_round = is_ball || (event.partner < first_side() &&
                                          static_cast<WallFeature>(event.stamp) != WallFeature::kFace);
        pressure = -(dot(normal, acceleration_of(i)) + (is_round ? length_squared(before) : 0.0));
    }
    const double separation = parting_speed(pressure, normal);
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
    expect(i, search(i));
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

}  // namespace carom
