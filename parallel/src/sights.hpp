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
        if (!(std::abs(x) + std::abs(y) <= farthest_ && std::abs(vx) + std::abs(vy) <= farthest_)) hide(i);
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
    double per_unit_ = 1, per_span_ = 1, per_speed_ = 1;
    double cell_x_ = 1, cell_y_ = 1;
    double middle_x_ = 0, middle_y_ = 0;
    double time_ = 0, end_ = 0;
    std::uint64_t too_fast_ = 0;
    std::vector<Row> rows_;
    std::vector<float> radius_;
};

}  // namespace carom
