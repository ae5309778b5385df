// The search among the balls listed around one: bounds decide which of them need the exact time.
#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "event_loop_of.hpp"

namespace carom {

/// Sets ball i as bounds see it.
template <Acceleration A>
void EventLoopOf<A>::sight(std::uint32_t i) {
    if constexpr (A != Acceleration::kPerBall) {
        const Anchor& a = records_[i].anchor;
        const double since = (sights_.time() - a.time.offset) +
                             clock_.epoch_length() * static_cast<double>(epoch_ - a.time.epoch);
        sights_.set(i, a, since, locals_[i].frame, acceleration_of(i));
    }
}

/// All of them, for a span from now on.
template <Acceleration A>
void EventLoopOf<A>::sight_all() {
    filters_ = A != Acceleration::kPerBall && sights_.are_of_use();
    if (!filters_) return;
    double squares = 0;
    for (const BallRecord& r : records_) squares += r.anchor.vx * r.anchor.vx + r.anchor.vy * r.anchor.vy;
    sights_.begin(now_, squares / std::max<double>(1, size()), clock_.epoch_length());
    for (std::uint32_t i = 0; i < size(); ++i) sight(i);
}

/// Bounds on when ball i meets each of the candidates. The likeliest will be looked at exactly.
template <Acceleration A>
void EventLoopOf<A>::look(std::uint32_t i, Candidates& found) const {
    const Indices self = Indices{} + i;
    std::memcpy(&found.ids[found.count], &self, sizeof(self));
    for (std::size_t first = 0; first < found.count; first += kLanes) {
        const Floats bounds = sights_.bounds(i, &found.ids[first], now_);
        const unsigned soonest = bits_of(bounds <= least_of(bounds));
        found.bounds[first / kLanes] = bounds;
        found.soonest[first / kLanes] = soonest;
        fetch(found.ids[first + static_cast<std::size_t>(std::countr_zero(soonest))]);
    }
}

/// Ball i against the candidates that it has looked at: exactly where the bounds leave it open who is first.
template <Acceleration A>
void EventLoopOf<A>::choose(std::uint32_t i, const Candidates& found, NextEvent& best) const {
    const auto latest = [&] {
        return best.time == kNever
                   ? std::numeric_limits<float>::max()
                   : sights_.in_spans(clock_.since_epoch(best.time, epoch_) - now_ + bodies_.time_margin);
    };
    for (std::size_t first = 0; first < found.count; first += kLanes) {
        const Floats& bounds = found.bounds[first / kLanes];
        const auto consider_lane = [&](unsigned bits) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
            consider_beside(i, found.ids[first + lane], found.reach, best);
        };
        unsigned open = bits_of(bounds <= latest());
        if (open == 0) continue;
        const unsigned soonest = found.soonest[first / kLanes];
        consider_lane(soonest);
        open &= bits_of(bounds <= latest()) & ~(soonest & -soonest);
        for (; open != 0; open &= open - 1) consider_lane(open);
    }
}

/// Calls f(place, cell) for the cells [first, last], given in ball i's frame, that lie in the region.
template <Acceleration A>
template <class F>
void EventLoopOf<A>::for_each_place(std::uint32_t i, CellCoordinates first, CellCoordinates last,
                                    F&& f) const {
    for (std::int32_t y = first.y; y <= last.y; ++y) {
        for (std::int32_t x = first.x; x <= last.x; ++x) {
            const std::int32_t place = place_of(i, {x, y});
            if (place >= 0) f(place, CellCoordinates{x, y});
        }
    }
}

/// Adds the balls of a cell but ball i; false where they are too many.
template <Acceleration A>
bool EventLoopOf<A>::gather_cell(std::uint32_t i, std::int32_t place, Candidates& found) const {
    for (const CellLists::Block* block = &cells_.first_block(place); block != nullptr;
         block = cells_.next(*block)) {
        if (found.count + CellLists::kBlockSize > kMostCandidates) return false;
        for (std::uint32_t k = 0; k < block->count(); ++k) {
            found.ids[found.count] = block->ids[k];
            found.count += block->ids[k] != i ? 1 : 0;
        }
    }
    return true;
}

/// The balls but ball i of some rows of three cells, `step` and `row` places apart.
template <Acceleration A>
bool EventLoopOf<A>::gather_more(std::uint32_t i, std::int32_t low, std::int32_t step, std::int32_t row,
                                 int rows, Candidates& found) const {
    found.count = 0;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 3; ++x)
            if (!gather_cell(i, low + y * row + x * step, found)) return false;
    return true;
}

/// Gathers the balls of the cells around ball i and of its own, without a branch as long as each holds one
/// block of ids; false where they are too many. Precondition: the ball is deep inside the region.
template <Acceleration A>
bool EventLoopOf<A>::gather_around(std::uint32_t i, Candidates& found) const {
    const std::int32_t row = region_.x.size();
    const std::int32_t low = records_[i].place - row - 1;
    const CellLists::Block* first = &cells_.first_block(low);
    Gathering gathering{found.ids.data()};
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k)
        if (k != 4) gathering.add(first[(k / 3) * row + k % 3]);
    gathering.add_all_but(i, first[row + 1]);
    gathering.finish(found);
    return gathering.is_all() || gather_more(i, low, 1, row, 3, found);
}

/// The same for a row of three cells, `step` places apart, beside ball i's.
template <Acceleration A>
bool EventLoopOf<A>::gather_row(std::int32_t middle, std::int32_t step, Candidates& found) const {
    const CellLists::Block* block = &cells_.first_block(middle);
    Gathering gathering{found.ids.data()};
    gathering.add(block[-step]);
    gathering.add(block[0]);
    gathering.add(block[step]);
    gathering.finish(found);
    return gathering.is_all() || gather_more(kNowhere, middle - step, step, 0, 1, found);
}

/// The same at the region's border, which cells are beyond or across.
template <Acceleration A>
bool EventLoopOf<A>::gather_at_border(std::uint32_t i, CellCoordinates side, Candidates& found) const {
    struct Places {
        std::array<std::int32_t, 3> each = {};
        int count = 0;
    };
    const auto places = [](const RegionAxis& axis, std::int32_t cell, std::int32_t towards) {
        Places of;
        const auto [first, last] = beside(cell, towards, 1);
        for (std::int32_t k = first; k <= last; ++k)
            if (const std::int32_t place = axis.place(k); place >= 0) of.each[of.count++] = place;
        return of;
    };
    const CellCoordinates& cell = records_[i].anchor.cell;
    const Places columns = places(region_.x, cell.x + locals_[i].frame.x, side.x);
    const Places rows = places(region_.y, cell.y + locals_[i].frame.y, side.y);
    const std::int32_t own = records_[i].place;
    Gathering gathering{found.ids.data()};
    for (int y = 0; y < rows.count; ++y)
        for (int x = 0; x < columns.count; ++x)
            if (const std::int32_t place = rows.each[y] * region_.x.size() + columns.each[x]; place != own)
                gathering.add(cells_.first_block(place));
    if ((side.x | side.y) == 0) gathering.add_all_but(i, cells_.first_block(own));
    gathering.finish(found);
    if (gathering.is_all()) return true;
    found.count = 0;
    for (int y = 0; y < rows.count; ++y)
        for (int x = 0; x < columns.count; ++x)
            if (!gather_cell(i, rows.each[y] * region_.x.size() + columns.each[x], found)) return false;
    return true;
}

/// Gathers all that are listed around ball i, in the row of cells on one side or everywhere where the side is
/// {0, 0}, and looks at them; false where this ball or place needs more care.
template <Acceleration A>
bool EventLoopOf<A>::look_beside(std::uint32_t i, CellCoordinates side, Candidates& found) const {
    const std::int32_t place = records_[i].place;
    if (!filters_ || is_large(i)) return false;
    const std::int32_t row = region_.x.size();
    const bool is_row = (side.x | side.y) != 0;
    const bool is_whole = !is_inside_[static_cast<std::size_t>(place)] ? gather_at_border(i, side, found)
                          : is_row ? gather_row(place + side.x + side.y * row, side.x != 0 ? row : 1, found)
                                   : gather_around(i, found);
    if (is_whole) look(i, found);
    return is_whole;
}

/// Ball i against all that are listed around it, anywhere.
template <Acceleration A>
void EventLoopOf<A>::scan_beside(std::uint32_t i, CellCoordinates side, NextEvent& best) const {
    const Anchor& a = records_[i].anchor;
    Candidates found;
    const Grid& grid = bodies_.grid;
    found.reach = {cell_reach(grid.x, i), cell_reach(grid.y, i)};
    if (reaches_all(found.reach.x, found.reach.y)) return scan_listed(i, best);
    // Beyond half the box the nearest image need not be the one in the cell.
    const auto is_clear = [](const GridAxis& axis, std::int32_t reach) {
        return !axis.periodic() || 2 * (std::int64_t{reach} + 1) < axis.count();
    };
    const bool filters = filters_ && is_clear(grid.x, found.reach.x) && is_clear(grid.y, found.reach.y);
    const auto [first_x, last_x] = beside(a.cell.x, side.x, found.reach.x);
    const auto [first_y, last_y] = beside(a.cell.y, side.y, found.reach.y);
    found.count = 0;
    for_each_place(i, {first_x, first_y}, {last_x, last_y}, [&](std::int32_t at, CellCoordinates cell) {
        cells_.for_each(at, [&](std::uint32_t j) {
            if (j == i) return;
            if (!filters) return consider_in_cell(i, j, cell, best);
            if (found.count == kMostCandidates) {
                look(i, found);
                choose(i, found, best);
                found.count = 0;
            }
            found.ids[found.count++] = j;
        });
    });
    look(i, found);
    choose(i, found, best);
}

}  // namespace carom
