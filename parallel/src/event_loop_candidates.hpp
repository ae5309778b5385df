// The search among the balls listed around one: bounds on vectors decide which of them need the exact time.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "event_loop_of.hpp"

namespace carom {

/// Where ball i is now and how fast, in the frame of its anchor.
template <Acceleration A>
auto EventLoopOf<A>::present(std::uint32_t i) const -> Present {
    const Anchor& a = records_[i].anchor;
    const double since =
        (now_ - a.time.offset) + clock_.epoch_length() * static_cast<double>(epoch_ - a.time.epoch);
    Present p{a.x + since * a.vx,
              a.y + since * a.vy,
              a.vx,
              a.vy,
              std::abs(since * a.vx) + std::abs(since * a.vy),
              0};
    if constexpr (A == Acceleration::kUniform) {
        const Vec2 fall = since * bodies_.physics.gravity;
        p.x += since / 2 * fall.x();
        p.y += since / 2 * fall.y();
        p.vx += fall.x();
        p.vy += fall.y();
        p.rounded_speed_squared = a.vx * a.vx + a.vy * a.vy + p.vx * p.vx + p.vy * p.vy;
    }
    return p;
}

/// For each candidate a time, counted from now, before which it certainly does not meet ball i; infinity
/// where it never does. Returns the least. All are taken to be in their nearest image; plain arithmetic on
/// vectors without branches. Its margins cover the rounding here and in the exact prediction, see
/// choose_margins().
template <Acceleration A>
double EventLoopOf<A>::bound_times(std::uint32_t i, const Present& a, Candidates& found) const {
    constexpr std::size_t kLanes = 4;
    using Doubles __attribute__((vector_size(kLanes * sizeof(double)))) = double;
    using Masks __attribute__((vector_size(kLanes * sizeof(double)))) = std::int64_t;
    using Indices __attribute__((vector_size(kLanes * sizeof(std::uint32_t)))) = std::uint32_t;
    using SmallMasks __attribute__((vector_size(kLanes * sizeof(std::int32_t)))) = std::int32_t;
    constexpr double kNeverTime = std::numeric_limits<double>::infinity();
    const Doubles zero{};
    const Doubles never = zero + kNeverTime;
    const Masks magnitude = Masks{} + std::numeric_limits<std::int64_t>::max();

    const std::size_t padded = (found.count + kLanes - 1) / kLanes * kLanes;
    for (std::size_t k = 0; k < kLanes; ++k) found.ids[found.count + k] = i;
    const double now = now_;
    const std::int64_t epoch = epoch_;
    const double epoch_length = clock_.epoch_length();
    const double radius = radius_of(i);
    const double period_x = bodies_.period.x();
    const double period_y = bodies_.period.y();
    const double turns_x = bodies_.turns.x();
    const double turns_y = bodies_.turns.y();
    const double gx = A == Acceleration::kUniform ? bodies_.physics.gravity.x() : 0;
    const double gy = A == Acceleration::kUniform ? bodies_.physics.gravity.y() : 0;
    const double margin = bodies_.margin;
    const double farthest = bodies_.farthest;
    constexpr double kRound = 0x1.8p52;  // adding and subtracting it rounds to a whole number
    Doubles sum = zero + 2 * radius;
    Doubles least = never;
    for (std::size_t first = 0; first < padded; first += kLanes) {
        const std::uint32_t* ids = &found.ids[first];
        Doubles rows[kLanes];  // x, y, vx, vy of a ball each
        Doubles since;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const Anchor& b = records_[ids[k]].anchor;
            std::memcpy(&rows[k], &b.x, sizeof(Doubles));
            since[k] = (now - b.time.offset) + epoch_length * static_cast<double>(epoch - b.time.epoch);
        }
        if (!bodies_.radius.is_one())
            for (std::size_t k = 0; k < kLanes; ++k) sum[k] = radius + radius_[ids[k]];
        const Doubles x_01 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
        const Doubles y_01 = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
        const Doubles x_23 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
        const Doubles y_23 = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
        const Doubles bvx = __builtin_shufflevector(x_01, x_23, 2, 3, 6, 7);
        const Doubles bvy = __builtin_shufflevector(y_01, y_23, 2, 3, 6, 7);

        const Doubles way_x = since * bvx;
        const Doubles way_y = since * bvy;
        Doubles x = a.x - __builtin_shufflevector(x_01, x_23, 0, 1, 4, 5) - way_x;
        Doubles y = a.y - __builtin_shufflevector(y_01, y_23, 0, 1, 4, 5) - way_y;
        // NOLINTBEGIN(misc-const-correctness): gravity changes them
        Doubles vx = a.vx - bvx;
        Doubles vy = a.vy - bvy;
        Doubles doubtful_speed_squared = zero;
        // NOLINTEND(misc-const-correctness)
        if constexpr (A == Acceleration::kUniform) {
            const Doubles fall_x = since * gx;
            const Doubles fall_y = since * gy;
            x -= since / 2 * fall_x;
            y -= since / 2 * fall_y;
            vx -= fall_x;
            vy -= fall_y;
            doubtful_speed_squared =
                Bodies::kDoubtfulShare * (a.rounded_speed_squared + bvx * bvx + bvy * bvy +
                                          (a.vx - vx) * (a.vx - vx) + (a.vy - vy) * (a.vy - vy));
        }
        Doubles flight = zero;
        for (const Doubles& way : {way_x, way_y, x, y})
            flight += reinterpret_cast<Doubles>(reinterpret_cast<Masks>(way) & magnitude);
        x -= period_x * ((x * turns_x + kRound) - kRound);
        y -= period_y * ((y * turns_y + kRound) - kRound);
        const Doubles distance_squared = x * x + y * y;
        const Doubles speed_squared = vx * vx + vy * vy;
        const Doubles sum_squared = sum * sum;
        const Doubles scale = distance_squared + sum_squared;
        const Doubles approach = -(x * vx + y * vy);
        const Doubles moment = x * vy - y * vx;
        const Doubles gap = distance_squared - sum_squared - margin * scale;
        const Doubles doubt = margin * (speed_squared + doubtful_speed_squared) * scale;
        const Doubles discriminant = sum_squared * speed_squared - moment * moment + 4 * doubt;
        Doubles root = discriminant > 0 ? discriminant : zero;
        for (std::size_t k = 0; k < kLanes; ++k) root[k] = std::sqrt(root[k]);
        const Doubles t = gap / (root + approach) * (1 - margin);
        const Doubles sooner = ((gap > 0) & (approach > 0)) ? t : zero;
        const Masks meets = (discriminant >= 0) & ((approach > 0) | (approach * approach <= margin * doubt));
        Indices numbers;
        std::memcpy(&numbers, ids, sizeof(numbers));
        const Masks is_self = __builtin_convertvector(static_cast<SmallMasks>(numbers == i), Masks);
        Doubles bound = meets ? sooner : never;
        bound = flight > farthest ? zero : bound;
        bound = is_self ? never : bound;
        least = bound < least ? bound : least;
        std::memcpy(&found.earliest[first], &bound, sizeof(bound));
    }
    return std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
}

/// Ball i against the candidates: exactly where the bounds leave it open who is first.
template <Acceleration A>
void EventLoopOf<A>::consider_all(std::uint32_t i, const Present& place, Candidates& found,
                                  NextEvent& best) const {
    if (found.count == 0) return;
    const double least = bound_times(i, place, found);
    const auto latest = [&] {
        return best.time == kNever ? std::numeric_limits<double>::max()
                                   : clock_.since_epoch(best.time, epoch_) - now_ + bodies_.time_margin;
    };
    if (!(least <= latest())) return;
    const auto place_bits = [&](double limit) {
        std::uint64_t bits = 0;
        for (std::size_t k = 0; k < found.count; ++k)
            bits |= std::uint64_t{found.earliest[k] <= limit ? 1U : 0U} << k;
        return bits;
    };
    const auto consider_at = [&](std::size_t k) {
        const int from = found.from[k];
        const CellCoordinates cell = found.width == 0 ? found.cells[static_cast<std::size_t>(from)]
                                                      : CellCoordinates{found.first.x + from % found.width,
                                                                        found.first.y + from / found.width};
        consider_listed(i, found.ids[k], cell, best);
    };
    const auto soonest = static_cast<std::size_t>(std::countr_zero(place_bits(least)));
    consider_at(soonest);
    std::uint64_t open = place_bits(latest()) & ~(std::uint64_t{1} << soonest);
    for (; open != 0; open &= open - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(open));
        if (found.earliest[k] <= latest()) consider_at(k);
    }
}

/// Calls f(place, cell) for the cells [first, last], given in ball i's frame, that lie in the region.
template <Acceleration A>
template <class F>
void EventLoopOf<A>::for_each_place(std::uint32_t i, CellCoordinates first, CellCoordinates last,
                                    F&& f) const {
    const std::int32_t low = place_of_block(i, first, last);
    const std::int32_t row = region_.x.size();
    for (std::int32_t y = first.y; y <= last.y; ++y) {
        for (std::int32_t x = first.x; x <= last.x; ++x) {
            const std::int32_t place =
                low >= 0 ? low + (y - first.y) * row + (x - first.x) : place_of(i, {x, y});
            if (place >= 0) f(place, CellCoordinates{x, y});
        }
    }
}

/// Gathers the balls of at most three by three cells without a branch, where the cells lie in the region as
/// they do in the plane and none holds more than one block of ids; false where it is not so.
template <Acceleration A>
bool EventLoopOf<A>::gather_block(std::uint32_t i, CellCoordinates first, CellCoordinates last,
                                  Candidates& found) const {
    const std::int32_t width = last.x - first.x + 1;
    const std::int32_t height = last.y - first.y + 1;
    const std::int32_t low = place_of_block(i, first, last);
    const std::int32_t row = region_.x.size();
    if (width > 3 || height > 3 || low < 0) return false;
    std::size_t count = 0;
    bool overflows = false;
    std::uint64_t from = 0;
    const auto take = [&](std::int32_t at) {
        const CellLists::Block& block = cells_.first_block(at);
        std::memcpy(&found.ids[count], block.ids.data(), sizeof(block.ids));
        std::memcpy(&found.from[count], &from, sizeof(from));
        from += 0x0101010101010101U;  // the next cell's number, for all of its balls
        count += static_cast<std::size_t>(block.count);
        overflows = overflows || block.next >= 0;
    };
    for (std::int32_t at = low, y = 0; y < height; ++y, at += row) {
        take(at);
        if (width == 3) {
            take(at + 1);
            take(at + 2);
        } else if (width == 2) {
            take(at + 1);
        }
    }
    found.count = count;
    found.first = first;
    found.width = width;
    if (overflows) found.width = 0;
    return !overflows;
}

/// Ball i against all that are listed in a block of cells.
template <Acceleration A>
void EventLoopOf<A>::scan_cells(std::uint32_t i, CellCoordinates first, CellCoordinates last,
                                NextEvent& best) const {
    const Present place = present(i);
    const bool filters = A != Acceleration::kPerBall && bodies_.filters &&
                         std::abs(place.x) + std::abs(place.y) + place.flight <= bodies_.farthest;
    if (!filters) {
        for_each_place(i, first, last, [&](std::int32_t at, CellCoordinates cell) {
            cells_.for_each(at, [&](std::uint32_t j) {
                if (j != i) consider_listed(i, j, cell, best);
            });
        });
        return;
    }
    Candidates found;
    if (gather_block(i, first, last, found)) return consider_all(i, place, found, best);
    found.count = 0;
    for_each_place(i, first, last, [&](std::int32_t at, CellCoordinates cell) {
        if (found.cell_count == found.cells.size()) {
            consider_all(i, place, found, best);
            found.count = found.cell_count = 0;
        }
        found.cells[found.cell_count] = cell;
        cells_.for_each_block(at, [&](std::span<const std::uint32_t, CellLists::kBlockSize> block,
                                      std::size_t used) {
            if (found.count + used > kMostCandidates) {
                consider_all(i, place, found, best);
                found.count = 0;
            }
            std::memcpy(&found.ids[found.count], block.data(), sizeof(std::uint32_t) * CellLists::kBlockSize);
            std::memset(&found.from[found.count], static_cast<int>(found.cell_count),
                        CellLists::kBlockSize + 2);
            found.count += used;
        });
        ++found.cell_count;
    });
    consider_all(i, place, found, best);
}

}  // namespace carom
