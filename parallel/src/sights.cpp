// The margins of the bounds on when balls meet.
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
    is_periodic_ = period_x_ > 0 || period_y_ > 0;
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

}  // namespace carom
