// What a ball meets next: the prediction for one partner, and the search among those that the grid offers.
#pragma once

#include <array>
#include <tuple>
#include <utility>

#include <carom/core/disc_time.hpp>
#include <carom/core/wall_time.hpp>

#include "event_loop_of.hpp"
#include "fault.hpp"

namespace carom {

template <Acceleration A>
Time EventLoopOf<A>::predict_pair(std::uint32_t i, std::uint32_t j, Image image,
                                  [[maybe_unused]] const Time& limit) const {
    put_in_order(i, j, image);  // one for a pair, whoever asks
    const Anchor& a = records_[i].anchor;
    const Anchor& b = records_[j].anchor;
    const double from_b = clock_.difference(a.time, b.time);
    // Who is the later cannot be guessed either.
    const std::array<const Time*, 2> times = {&a.time, &b.time};
    const Time& reference = *times[from_b < 0 ? 1 : 0];
    const double since_a = std::max(-from_b, 0.0);
    const double since_b = std::max(from_b, 0.0);
    const double sum = radius_of(i) + radius_of(j);
    if constexpr (A == Acceleration::kNone) {
        const GridAxis& axis_x = bodies_.grid.x;
        const GridAxis& axis_y = bodies_.grid.y;
        const Vec2 r = {(a.x + since_a * a.vx) - (b.x + since_b * b.vx) - image.x * axis_x.length(),
                        (a.y + since_a * a.vy) - (b.y + since_b * b.vy) - image.y * axis_y.length()};
        return clock_.after(reference, disc_time_of_impact<double>(r, {a.vx - b.vx, a.vy - b.vy}, sum));
    } else {
        const Motion<double> ma = motion_of(i);
        const Motion<double> mb = motion_of(j);
        const Vec2 r = position_at(ma, since_a) - position_at(mb, since_b) - offset_of(image);
        const Vec2 v = velocity_at(ma, since_a) - velocity_at(mb, since_b);
        if (A == Acceleration::kUniform)
            return clock_.after(reference, disc_time_of_impact<double>(r, v, sum));
        const Vec2 acceleration = ma.acceleration - mb.acceleration;
        if (limit != kNever) {
            // A pair comes no nearer by then than its speed and its acceleration can bring it. That spares
            // the quartic for most; the margin is far more than the rounding of this and of the quartic's
            // root.
            constexpr double kMargin = 1 + 1e-6;
            const double time = std::max(clock_.difference(limit, reference), 0.0);
            const double speed = std::sqrt(length_squared(v));
            const double reach = sum + time * (speed + std::sqrt(length_squared(acceleration)) * time / 2);
            if (length_squared(r) > reach * reach * kMargin) return kNever;
        }
        return clock_.after(reference, disc_time_of_impact<double>(r, v, acceleration, sum));
    }
}

/// Ball i against a static ball; the offset of the centres counted from the smaller id, as for any pair.
template <Acceleration A>
Time EventLoopOf<A>::predict_fixed(std::uint32_t i, std::uint32_t id, Image image) const {
    const Motion<double> m = motion_of(i);
    const double sum = radius_of(i) + bodies_.radius.of(id);
    Vec2 r = m.position - bodies_.fixed[id] - offset_of(image);
    Vec2 v = m.velocity;
    Vec2 acceleration = m.acceleration;
    if (id < records_[i].id()) {
        r = bodies_.fixed[id] - m.position - offset_of(-image);
        v = -v;
        acceleration = -acceleration;
    }
    const double t = A == Acceleration::kNone ? disc_time_of_impact<double>(r, v, sum)
                                              : disc_time_of_impact<double>(r, v, acceleration, sum);
    return clock_.after(records_[i].anchor.time, t);
}

template <Acceleration A>
NextEvent EventLoopOf<A>::predict_obstacle(std::uint32_t i, std::uint32_t obstacle, Image image) const {
    if (obstacle < bodies_.count)
        return {predict_fixed(i, obstacle, image), obstacle, 0, image.x, image.y, kNowhere};
    Motion<double> centre = motion_of(i);
    centre.position -= offset_of(image);
    const Wall& wall = bodies_.walls[obstacle - bodies_.count];
    const WallHit<double> hit = wall_time_of_impact<double>(centre, radius_of(i), wall.from, wall.to);
    return {clock_.after(records_[i].anchor.time, hit.time),
            obstacle,
            static_cast<std::uint32_t>(hit.feature),
            image.x,
            image.y,
            kNowhere};
}

template <Acceleration A>
auto EventLoopOf<A>::gap_to_side(std::uint32_t i, Side side) const -> Gap {
    const Motion<double> m = motion_of(i);
    const Box& box = bodies_.physics.domain.box;
    if (side.upper)
        return {(box.max[side.axis] - radius_of(i)) - m.position[side.axis], -m.velocity[side.axis],
                -m.acceleration[side.axis]};
    return {m.position[side.axis] - (box.min[side.axis] + radius_of(i)), m.velocity[side.axis],
            m.acceleration[side.axis]};
}

template <Acceleration A>
NextEvent EventLoopOf<A>::predict_side(std::uint32_t i, std::uint32_t side) const {
    const Gap gap = gap_to_side(i, Side(side));
    return {
        clock_.after(records_[i].anchor.time, side_time_of_impact(gap.distance, gap.speed, gap.acceleration)),
        bodies_.first_side() + side,
        0,
        0,
        0,
        kNowhere};
}

/// The total order of the events of one ball.
template <Acceleration A>
bool EventLoopOf<A>::precedes(const NextEvent& a, const NextEvent& b, std::uint32_t i) const {
    if (a.time != b.time) return a.time < b.time;
    if (a.time == kNever) return false;
    const auto key = [id = records_[i].id()](const NextEvent& e) {
        const int sign = e.partner < id ? -1 : 1;  // the image as seen from the smaller id
        return std::tuple(in_order(id, e.partner), sign * e.image_x, sign * e.image_y);
    };
    return key(a) < key(b);
}

// ---- Search
/// Predicts ball i against ball j and keeps the better event.
template <Acceleration A>
void EventLoopOf<A>::consider(std::uint32_t i, std::uint32_t j, Image image, NextEvent& best) const {
    if (!bodies_.may_meet(records_[i].id(), records_[j].id())) return;
    const Time t = predict_pair(i, j, image, best.time);
    if (best.time < t) return;
    const NextEvent event{t, records_[j].id(), records_[j].anchor.stamp, image.x, image.y, j};
    if (t < best.time || precedes(event, best, i)) best = event;
}

/// The same for a ball j from the list of the storage cell of `cell`.
template <Acceleration A>
void EventLoopOf<A>::consider_in_cell(std::uint32_t i, std::uint32_t j, CellCoordinates cell,
                                      NextEvent& best) const {
    const Anchor& b = records_[j].anchor;
    Image image;
    if (b.cell != cell) {  // the same place, some turns of the fold or periods between the frames away
        const Grid& grid = bodies_.grid;
        const std::int32_t dx = cell.x - b.cell.x;
        const std::int32_t dy = cell.y - b.cell.y;
        if ((dx != 0 && !grid.x.periodic()) || (dy != 0 && !grid.y.periodic())) return;
        image = {dx / grid.x.count(), dy / grid.y.count()};
    }
    consider(i, j, image, best);
}

/// The same for a ball j whose list was found at most `reach` cells away, less than half the box.
template <Acceleration A>
void EventLoopOf<A>::consider_beside(std::uint32_t i, std::uint32_t j, CellCoordinates reach,
                                     NextEvent& best) const {
    const CellCoordinates& a = records_[i].anchor.cell;
    const CellCoordinates& b = records_[j].anchor.cell;
    const auto is_beside = [](const GridAxis& axis, std::int32_t cells, std::int32_t most,
                              std::int32_t& periods) {
        if (std::abs(cells) <= most) return true;
        if (!axis.periodic()) return false;
        const std::int32_t half = axis.count() / 2;
        periods = (cells + (cells < 0 ? -half : half)) / axis.count();
        return true;
    };
    Image image;
    if (is_beside(bodies_.grid.x, a.x - b.x, reach.x, image.x) &&
        is_beside(bodies_.grid.y, a.y - b.y, reach.y, image.y))
        consider(i, j, image, best);
}

/// Ball j in all its images that lie so near that a contact could come before either centre crosses a border.
template <Acceleration A>
void EventLoopOf<A>::consider_images(std::uint32_t i, std::uint32_t j, NextEvent& best) const {
    if (j == i) return;
    // One reach for a pair, whoever asks: as far as a large one looks when it crosses a border. A small ball
    // that looked less far would not see the large one after an event in between, and nobody would later.
    const auto counted = [this](std::uint32_t k) {
        return is_large(k) ? radius_of(k) : bodies_.largest_listed_radius;
    };
    const double sum = counted(i) + counted(j);
    const Grid& grid = bodies_.grid;
    const CellCoordinates& a = records_[i].anchor.cell;
    const CellCoordinates& b = records_[j].anchor.cell;
    const auto [first_x, last_x] = images_within(grid.x, a.x - b.x, reach(grid.x, sum));
    const auto [first_y, last_y] = images_within(grid.y, a.y - b.y, reach(grid.y, sum));
    for (std::int32_t x = first_x; x <= last_x; ++x)
        for (std::int32_t y = first_y; y <= last_y; ++y) consider(i, j, {x, y}, best);
}

/// The large balls, which are in no cell's list.
template <Acceleration A>
void EventLoopOf<A>::scan_each_large(std::uint32_t i, NextEvent& best) const {
    if (is_active(Fault::kUnseenLarge)) return;
    for (const std::uint32_t j : large_) consider_images(i, j, best);
}

/// All other balls, for a ball so large that the cells within its reach are more than there are.
template <Acceleration A>
void EventLoopOf<A>::scan_listed(std::uint32_t i, NextEvent& best) const {
    for (std::uint32_t j = 0; j < size(); ++j)
        if (!is_large(j)) consider_images(i, j, best);
}

template <Acceleration A>
void EventLoopOf<A>::scan_each_obstacle(std::uint32_t i, NextEvent& best) const {
    const Anchor& a = records_[i].anchor;
    const auto consider = [&](const NextEvent& event) {
        if (precedes(event, best, i)) best = event;
    };
    const Grid& grid = bodies_.grid;
    const bool large = is_large(i);
    const ObstacleMap& obstacles = large ? bodies_.obstacles_of_large : bodies_.obstacles;
    if (!obstacles.empty()) {
        for (const ObstacleEntry& entry : obstacles.at(grid.index(a.cell)))
            if (bodies_.may_meet(records_[i].id(), entry.id))
                consider(predict_obstacle(
                    i, entry.id,
                    {grid.x.turns(a.cell.x) + entry.shift_x, grid.y.turns(a.cell.y) + entry.shift_y}));
    }
    const std::array<Boundary, 2>& boundary = bodies_.physics.domain.boundary;
    if (boundary[0] == Boundary::kWall) {
        if (large || a.cell.x <= 0) consider(predict_side(i, 0));
        if (large || a.cell.x >= grid.x.count() - 1) consider(predict_side(i, 1));
    }
    if (boundary[1] == Boundary::kWall) {
        if (large || a.cell.y <= 0) consider(predict_side(i, 2));
        if (large || a.cell.y >= grid.y.count() - 1) consider(predict_side(i, 3));
    }
}

/// Ball i's next event from all that is around it; what the grid offers is among `found` where it has looked.
template <Acceleration A>
NextEvent EventLoopOf<A>::search_among(std::uint32_t i, const Candidates& found, bool has_looked) const {
    NextEvent best;
    if (has_looked)
        choose(i, found, best);
    else
        scan_beside(i, {0, 0}, best);
    scan_large(i, best);
    scan_obstacles(i, best);
    return best;
}

/// Enters ball i's next event. Its partner is not told: of two balls that meet next, the one that was
/// predicted last knows. Where both do, either's entry will do.
template <Acceleration A>
void EventLoopOf<A>::expect(std::uint32_t i, const NextEvent& event) {
    records_[i].next = event;
    schedule(i);
    if (simultaneous_) tell_lower(i);
}

/// What ball i does from now on cannot be known here.
template <Acceleration A>
void EventLoopOf<A>::lose(std::uint32_t i) {
    if (is_owned(i)) failed_ = true;
    locals_[i].end = -std::numeric_limits<double>::infinity();
    schedule(i);
}

/// Where many events share one instant their order counts: then every event that ball i has now is known to
/// the smaller id of its pair, not the first one only.
template <Acceleration A>
void EventLoopOf<A>::tell_lower(std::uint32_t i) {
    const auto tell = [this, i](std::uint32_t j, const NextEvent& event) {
        const NextEvent theirs{event.time,     records_[i].id(), records_[i].anchor.stamp,
                               -event.image_x, -event.image_y,   i};
        if (!precedes(theirs, records_[j].next, j)) return;
        records_[j].next = theirs;
        schedule(j);
    };
    const auto tell_if_now = [this, &tell](std::uint32_t j, const NextEvent& event) {
        if (event.local == j && clock_.since_epoch(event.time, epoch_) == now_) tell(j, event);
    };
    if (const NextEvent event = records_[i].next;
        event.local != kNowhere && event.partner < records_[i].id() && is_current(event))
        tell(event.local, event);
    // What comes later is not asked for, which spares most pairs the search for a root.
    const NextEvent now{.time = time_now()};
    const auto is_told = [this, i](std::uint32_t j) { return records_[j].id() < records_[i].id(); };
    const CellCoordinates c = records_[i].anchor.cell;
    const std::int32_t across = cell_reach(bodies_.grid.x, i);
    const std::int32_t along = cell_reach(bodies_.grid.y, i);
    const bool is_everywhere = reaches_all(across, along);
    const auto tell_anywhere = [&](std::uint32_t j) {
        if (!is_told(j)) return;
        NextEvent event = now;
        consider_images(i, j, event);
        tell_if_now(j, event);
    };
    for (std::uint32_t j = 0; is_everywhere && j < size(); ++j)
        if (!is_large(j)) tell_anywhere(j);
    if (!is_everywhere)
        for_each_place(i, {c.x - across, c.y - along}, {c.x + across, c.y + along},
                       [&](std::int32_t place, CellCoordinates cell) {
                           cells_.for_each(place, [&](std::uint32_t j) {
                               if (!is_told(j)) return;
                               NextEvent event = now;
                               consider_in_cell(i, j, cell, event);
                               tell_if_now(j, event);
                           });
                       });
    for (const std::uint32_t j : large_) tell_anywhere(j);
}

template <Acceleration A>
void EventLoopOf<A>::predict_crossing(std::uint32_t i) {
    const Anchor& a = records_[i].anchor;
    [[maybe_unused]] const Vec2 acceleration = acceleration_of(i);
    const double anchored = clock_.since_epoch(a.time, epoch_);
    const double since = std::max(0.0, now_ - anchored);
    Crossing first;
    const Grid& grid = bodies_.grid;
    const CellCoordinates& c = a.cell;
    const auto consider = [&](double time, int dx, int dy) {
        if (time < first.time) first = {time, static_cast<std::int8_t>(dx), static_cast<std::int8_t>(dy)};
    };
    if constexpr (A == Acceleration::kNone) {  // only one side of each axis lies ahead
        const auto leave = [](double distance, double speed) {
            return speed != 0 ? distance / speed : std::numeric_limits<double>::infinity();
        };
        const bool right = a.vx > 0;
        const bool up = a.vy > 0;
        const double x = leave(grid.x.border(c.x + right) - a.x, a.vx);
        const double y = leave(grid.y.border(c.y + up) - a.y, a.vy);
        const bool is_x = x <= y;
        first.time = std::max(std::min(y, x), since);
        first.dx = static_cast<std::int8_t>(is_x * (2 * right - 1));
        first.dy = static_cast<std::int8_t>(!is_x * (2 * up - 1));
    } else {
        consider(time_to_leave(grid.x.border(c.x + 1) - a.x, a.vx, acceleration.x(), since), 1, 0);
        consider(time_to_leave(a.x - grid.x.border(c.x), -a.vx, -acceleration.x(), since), -1, 0);
        consider(time_to_leave(grid.y.border(c.y + 1) - a.y, a.vy, acceleration.y(), since), 0, 1);
        consider(time_to_leave(a.y - grid.y.border(c.y), -a.vy, -acceleration.y(), since), 0, -1);
    }
    first.time = std::max(anchored + first.time, now_);
    records_[i].crossing_time = first.time;
    records_[i].crossing_dx = first.dx;
    records_[i].crossing_dy = first.dy;
}

/// All balls at once, side by side where there is an executor: each finds its own next event and tells
/// nobody.
template <Acceleration A>
void EventLoopOf<A>::predict_all(const Executor* executor) {
    sight_all();
    const auto predict = [this](std::size_t first, std::size_t last) {
        for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
            records_[i].next = search(i);
            predict_crossing(i);
        }
    };
    if (executor != nullptr)
        executor->for_ranges(records_.size(), 512, predict);
    else
        predict(0, records_.size());
    begin();
}

}  // namespace carom
