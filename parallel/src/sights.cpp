// The bounds on when balls meet, and their margins.
//
// With u = 2^-24, P the farthest place and flight in a span that are seen, all in cells: two places and
// their difference are rounded by 4 u P together, two velocities and their difference by as much, the flight
// that follows by 9 u P, their sum by 4 u P, and the nearest image by 8 u P. A component of the offset r of
// two centres is so uncertain by 25 u P, and r by less than d = 2^-19 P = 32 u P, for |x| + |y| <= P bounds
// both components together; their velocity v by less than w = 2^-21 P.
//
// Let s be the sum of the radii, the margin m >= d / s, R^2 = r^2 + s^2 and U^2 = v^2 + (w / m)^2. Then d <=
// m R and w <= m U, and r . v and r x v are uncertain by less than 3 m R U, the gap r^2 - s^2 by 3 m R^2, and
// the discriminant s^2 v^2 - (r x v)^2 by 6 m R^2 U^2, the formulas' own roundings (some 8 u of each term, m
// >= 2^-17) included. With 13 m R^2 U^2 added to the discriminant its root also covers what r . v lacks:
// sqrt(D + 6 m Q) + 3 m sqrt(Q) <= sqrt(D + 13 m Q) for Q = R^2 U^2 and D <= Q.
#include "sights.hpp"

#include <cmath>
#include <cstring>

namespace carom {

void Sights::clear(const Bodies& bodies, const Region& region) {
    const Grid& grid = bodies.grid;
    rows_.clear();
    radius_.clear();
    per_unit_ = 1 / std::max(grid.x.width(), grid.y.width());
    cell_x_ = grid.x.width() * per_unit_;
    cell_y_ = grid.y.width() * per_unit_;
    middle_x_ = grid.x.min() * per_unit_ + region.x.middle() * cell_x_;
    middle_y_ = grid.y.min() * per_unit_ + region.y.middle() * cell_y_;
    const auto choose_period = [](const RegionAxis& axis, double cell, float& period, float& turns) {
        period = axis.is_whole_period() ? static_cast<float>(axis.size() * cell) : 0;
        turns = period > 0 ? 1 / period : 0;
    };
    choose_period(region.x, cell_x_, period_x_, turns_x_);
    choose_period(region.y, cell_y_, period_y_, turns_y_);
    has_one_radius_ = bodies.radius.is_one();
    diameter_ = static_cast<float>(2 * bodies.radius.of(0) * per_unit_);

    const double farthest = (region.x.size() * cell_x_ + region.y.size() * cell_y_) / 2 + 4 * kFlight;
    const double margin = 0x1p-17 + 0x1p-19 * farthest / (2 * bodies.smallest_radius * per_unit_);
    const double doubtful_speed = 0x1p-21 * farthest / margin;
    farthest_ = static_cast<float>(farthest);
    margin_ = static_cast<float>(margin);
    doubtful_speed_squared_ = static_cast<float>(doubtful_speed * doubtful_speed);
    are_of_use_ = bodies.has_clear_images && margin < 0x1p-6;
}

void Sights::begin(double now, double mean_square_speed, double longest_span) {
    const double flight = kFlight / per_unit_;
    const double span = flight / std::sqrt(mean_square_speed);
    const double used = span > 0 && span < longest_span ? span : longest_span;
    time_ = now;
    end_ = now + used;
    per_span_ = 1 / used;
    per_speed_ = used * per_unit_;
    too_fast_ = 0;
}

Floats Sights::bounds(std::uint32_t i, const std::uint32_t* others, double now) const {
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
    x -= period_x_ * ((x * turns_x_ + kRound) - kRound);
    y -= period_y_ * ((y * turns_y_ + kRound) - kRound);
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
    const Floats time = gap / (root + approach) * (1 - 2 * margin_);
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
