// The two balls of a collision side by side: advanced, anchored and found in the grid by vectors of four, x
// and y of each. The operations and their order are those of one ball alone (event_loop_events.hpp), and so
// the bits.
#pragma once

#include <bit>
#include <cstring>

#include "event_loop_of.hpp"

namespace carom {

/// Where both balls are at `t`.
template <Acceleration A>
auto EventLoopOf<A>::pair_at(std::uint32_t i, std::uint32_t j, const Time& t) const -> Pair {
    const Anchor& a = records_[i].anchor;
    const Anchor& b = records_[j].anchor;
    const double since_a = clock_.difference(t, a.time);
    const double since_b = clock_.difference(t, b.time);
    const Doubles since = {since_a, since_a, since_b, since_b};
    const Doubles place = {a.x, a.y, b.x, b.y};
    const Doubles velocity = {a.vx, a.vy, b.vx, b.vy};
    Doubles pull{};  // NOLINT(misc-const-correctness): not where there is one
    if constexpr (A == Acceleration::kUniform)
        pull = twice(bodies_.physics.gravity.x(), bodies_.physics.gravity.y());
    return {place + since * (velocity + since * (pull / 2)), velocity + since * pull};
}

/// Whether they are held as they are there: in the box, and in double.
template <Acceleration A>
bool EventLoopOf<A>::is_plain(const Pair& pair) const {
    return all_of((pair.place >= axes_.low) & (pair.place < axes_.high)) && !bodies_.physics.in_float;
}

/// Anchors both at `t`.
template <Acceleration A>
void EventLoopOf<A>::anchor_pair(std::uint32_t i, std::uint32_t j, const Pair& pair, const Time& t) {
    const auto anchor = [&t](Anchor& a, const Doubles& state) {
        std::memcpy(&a.x, &state, sizeof(state));  // at once, as it is read
        a.time = t;
    };
    anchor(records_[i].anchor, __builtin_shufflevector(pair.place, pair.velocity, 0, 1, 4, 5));
    anchor(records_[j].anchor, __builtin_shufflevector(pair.place, pair.velocity, 2, 3, 6, 7));
}

/// After an event that has anchored both at `t`: their cells, when they leave these, and what bounds see.
template <Acceleration A>
void EventLoopOf<A>::settle_pair(std::uint32_t i, std::uint32_t j, const Pair& pair, const Time& t) {
    const CellCoordinates& a = records_[i].anchor.cell;
    const CellCoordinates& b = records_[j].anchor.cell;
    ++records_[i].anchor.stamp;
    ++records_[j].anchor.stamp;
    const Doubles cells = __builtin_convertvector((FourIntegers{a.x, a.y, b.x, b.y}), Doubles);
    const Doubles inside = (pair.place - axes_.min) * axes_.inverse_width;
    const Doubles zero{};
    // As a rule they have not left them: those are events of their own.
    if (all_of((inside >= cells) & (inside < cells + 1) & (cells >= zero) & (cells < axes_.count)))
        [[likely]] {
        if constexpr (A == Acceleration::kNone) predict_crossings(i, j, pair, cells);
    } else {
        for (const std::uint32_t k : {i, j}) {
            const Anchor& anchor = records_[k].anchor;
            relist(k, bodies_.grid.coordinates({anchor.x, anchor.y}));
            if constexpr (A == Acceleration::kNone) predict_crossing(k);
        }
    }
    if constexpr (A != Acceleration::kNone) {
        predict_crossing(i);
        predict_crossing(j);
    }
    if (!filters_) return;
    const double since =
        (sights_.time() - t.offset) + clock_.epoch_length() * static_cast<double>(epoch_ - t.epoch);
    const CellCoordinates& frame_i = locals_[i].frame;
    const CellCoordinates& frame_j = locals_[j].frame;
    sights_.set_both(i, j, pair.place, pair.velocity, since,
                     FourIntegers{frame_i.x, frame_i.y, frame_j.x, frame_j.y}, acceleration_of(i));
}

/// When both, anchored now, leave the cells that they are in. Precondition: no acceleration.
template <Acceleration A>
void EventLoopOf<A>::predict_crossings(std::uint32_t i, std::uint32_t j, const Pair& pair,
                                       const Doubles& cells) {
    const Doubles& v = pair.velocity;
    const Doubles zero{};
    const DoubleMasks ahead = v > zero;  // only one side of each axis lies ahead
    const Doubles border = axes_.min + (cells + (ahead ? zero + 1 : zero)) * axes_.width;
    const Doubles never = zero + std::numeric_limits<double>::infinity();
    const Doubles time = v != zero ? (border - pair.place) / v : never;
    const double anchored = clock_.since_epoch(records_[i].anchor.time, epoch_);
    const double since = std::max(0.0, now_ - anchored);
    const auto enter = [&](BallRecord& r, double x, double y, bool right, bool up) {
        const bool is_x = x <= y;
        r.crossing_time = std::max(anchored + std::max(std::min(y, x), since), now_);
        r.crossing_dx = static_cast<std::int8_t>(is_x * (2 * right - 1));
        r.crossing_dy = static_cast<std::int8_t>(!is_x * (2 * up - 1));
    };
    enter(records_[i], time[0], time[1], ahead[0] != 0, ahead[1] != 0);
    enter(records_[j], time[2], time[3], ahead[2] != 0, ahead[3] != 0);
}

}  // namespace carom
