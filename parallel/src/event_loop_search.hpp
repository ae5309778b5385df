// What a ball meets next: the prediction for one partner, and the search among those that the grid offers.
#pragma once

#include <array>
#include <tuple>
#include <utility>

#include <carom/core/disc_time.hpp>
#include <carom/core/wall_time.hpp>

#include "event_loop_of.hpp"

namespace carom {

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

}  // namespace carom
