// Balls as the search for partners sees them: where each would be at one common time, in float. From these
// come bounds on when two meet, which decide whose meeting is worth the exact time.
//
// Lengths are in cells, from the middle of the region, and times in spans since the common time, so that all
// numbers are small whatever the scene's units. A common uniform acceleration leaves relative motions
// straight and so is left out. A ball too far out or too fast for the bounds' margins has NaN for a place:
// its bounds are 0 then, and it is always looked at exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "bodies.hpp"
#include "fault.hpp"
#include "lanes.hpp"
#include "region.hpp"

namespace carom {

class Sights {
 public:
    /// Empties the table for a region.
    void clear(const Bodies& bodies, const Region& region);
    /// Adds a ball; set() is to follow begin().
    void add(double radius) {
        rows_.emplace_back();
        if (!has_one_radius_) radius_.push_back(static_cast<float>(radius * per_unit_));
    }
    /// Ball i is another one now; set() is to follow.
    void replace(std::uint32_t i, double radius) {
        if (!has_one_radius_) radius_[i] = static_cast<float>(radius * per_unit_);
    }
    /// Whether the margins are small enough for bounds to be of use, and images are clear.
    [[nodiscard]] bool are_of_use() const { return are_of_use_; }

    /// Starts a span at `now`, as long as balls of a mean square speed take for kFlight cells. All are to be
    /// set.
    void begin(double now, double mean_square_speed, double longest_span);
    /// Whether it is time to begin anew: the span has passed, or many balls were too fast for it.
    [[nodiscard]] bool are_worn(double now) const { return now > end_ || too_fast_ > 64 + rows_.size(); }
    /// What bounds count from: since the start of the epoch.
    [[nodiscard]] double time() const { return time_; }

    /// Ball i, anchored `since` before time(), after it where negative; `frame` leads to the region's.
    void set(std::uint32_t i, const Anchor& a, double since, const CellCoordinates& frame,
             const Vec2& acceleration) {
        const Vec2 place = {a.x + since * (a.vx + since / 2 * acceleration.x()),
                            a.y + since * (a.vy + since / 2 * acceleration.y())};
        const auto x = static_cast<float>(place.x() * per_unit_ + (frame.x * cell_x_ - middle_x_));
        const auto y = static_cast<float>(place.y() * per_unit_ + (frame.y * cell_y_ - middle_y_));
        const auto vx = static_cast<float>((a.vx + since * acceleration.x()) * per_speed_);
        const auto vy = static_cast<float>((a.vy + since * acceleration.y()) * per_speed_);
        const FourFloats row = {x, y, vx, vy};
        std::memcpy(&rows_[i], &row, sizeof(row));  // at once, as it is read
        if (!is_seen(row)) hide(i);
    }

    /// Balls i and j, both `since` before time() at these places and velocities; `frames` lead to the
    /// region's.
    void set_both(std::uint32_t i, std::uint32_t j, const Doubles& place, const Doubles& velocity,
                  double since, const FourIntegers& frames, const Vec2& acceleration) {
        const Doubles pull = twice(acceleration.x(), acceleration.y());
        const Doubles shift =
            __builtin_convertvector(frames, Doubles) * twice(cell_x_, cell_y_) - twice(middle_x_, middle_y_);
        const Doubles then = place + since * (velocity + since / 2 * pull);
        const FourFloats places = __builtin_convertvector(then * per_unit_ + shift, FourFloats);
        const FourFloats speeds = __builtin_convertvector((velocity + since * pull) * per_speed_, FourFloats);
        const FourFloats row_i = __builtin_shufflevector(places, speeds, 0, 1, 4, 5);
        const FourFloats row_j = __builtin_shufflevector(places, speeds, 2, 3, 6, 7);
        std::memcpy(&rows_[i], &row_i, sizeof(row_i));
        std::memcpy(&rows_[j], &row_j, sizeof(row_j));
        if (!is_seen(row_i)) [[unlikely]]
            hide(i);
        if (!is_seen(row_j)) [[unlikely]]
            hide(j);
    }

    /// For ball i among eight others: times, in spans from `now` on, before which it certainly does not meet
    /// each; infinity where it never does, and for itself.
    [[nodiscard]] Floats bounds(std::uint32_t i, const std::uint32_t* others, double now) const;
    /// A duration from now on to compare bounds with: rounding takes nothing off.
    [[nodiscard]] float in_spans(double duration) const {
        return static_cast<float>(std::max(duration, 0.0) * (per_span_ * (1 + 0x1p-20)));
    }

 private:
    struct alignas(16) Row {
        float x, y, vx, vy;
    };
    static constexpr double kFlight = 16;

    /// Whether neither place nor velocity is too far from zero.
    [[nodiscard]] bool is_seen(const FourFloats& row) const {
        return std::abs(row[0]) + std::abs(row[1]) <= farthest_ &&
               std::abs(row[2]) + std::abs(row[3]) <= farthest_;
    }
    void hide(std::uint32_t i) {
        rows_[i].x = std::numeric_limits<float>::quiet_NaN();
        ++too_fast_;
    }

    bool are_of_use_ = false;
    bool has_one_radius_ = true;
    float diameter_ = 1;  // where it is one
    float farthest_ = 0;  // place, and flight in a span, of a ball that is seen
    float margin_ = 0;
    float doubtful_speed_squared_ = 0;
    float period_x_ = 0, period_y_ = 0;  // 0 where the region holds each place once
    float turns_x_ = 0, turns_y_ = 0;    // 1 / period
    bool is_periodic_ = false;
    double per_unit_ = 1, per_span_ = 1, per_speed_ = 1;
    double cell_x_ = 1, cell_y_ = 1;
    double middle_x_ = 0, middle_y_ = 0;
    double time_ = 0, end_ = 0;
    std::uint64_t too_fast_ = 0;
    std::vector<Row> rows_;
    std::vector<float> radius_;
};

inline Floats Sights::bounds(std::uint32_t i, const std::uint32_t* others, double now) const {
    constexpr float kRound = 0x1.8p23F;  // adding and subtracting it rounds to a whole number
    const Floats zero{};
    const Floats never = zero + std::numeric_limits<float>::infinity();
    const auto t = static_cast<float>((now - time_) * per_span_);
    const Row& own = rows_[i];
    FourFloats rows[kLanes];
    const std::uint32_t* each = others;
    __asm__(""
            : "+r"(each));  // or they would be read as one vector, before what was written in parts is there
    for (std::size_t k = 0; k < kLanes; ++k) std::memcpy(&rows[k], &rows_[each[k]], sizeof(Row));
    const Columns other = columns_of(rows);
    Floats sum = zero + diameter_;
    if (!has_one_radius_) {
        float sums[kLanes];
        for (std::size_t k = 0; k < kLanes; ++k) sums[k] = radius_[i] + radius_[others[k]];
        std::memcpy(&sum, sums, sizeof(sum));
    }

    const Floats vx = own.vx - other.vx;
    const Floats vy = own.vy - other.vy;
    Floats x = (own.x - other.x) + vx * t;
    Floats y = (own.y - other.y) + vy * t;
    if (is_periodic_) {
        x -= period_x_ * ((x * turns_x_ + kRound) - kRound);
        y -= period_y_ * ((y * turns_y_ + kRound) - kRound);
    }
    const Floats distance_squared = x * x + y * y;
    const Floats speed_squared = vx * vx + vy * vy;
    const Floats sum_squared = sum * sum;
    const Floats scale = distance_squared + sum_squared;
    const Floats approach = -(x * vx + y * vy);
    const Floats moment = x * vy - y * vx;
    const Floats doubt = margin_ * (speed_squared + doubtful_speed_squared_) * scale;
    const Floats gap = distance_squared - sum_squared - 4 * margin_ * scale;
    const Floats discriminant = sum_squared * speed_squared - moment * moment + 13 * doubt;
    const Floats root = sqrt_of(discriminant > 0 ? discriminant : zero);
    const float early = is_active(Fault::kLateBound) ? 1.3F : 1 - 2 * margin_;
    const Floats time = gap / (root + approach) * early;
    const Floats sooner = ((gap > 0) & (approach > 0)) ? time : zero;
    // Every comparison with NaN is false: what is not seen does not miss.
    const FloatMasks misses =
        (discriminant < 0) | ((approach <= 0) & (approach * approach > 16 * margin_ * doubt));
    Indices numbers;
    std::memcpy(&numbers, others, sizeof(numbers));
    const FloatMasks is_self = numbers == i;
    return (misses | is_self) ? never : sooner;
}

}  // namespace carom
