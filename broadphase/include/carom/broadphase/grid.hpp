// The uniform grid's geometry: which cell a point is in, where its borders are, when a moving point leaves.
//
// Cell coordinates are unbounded integers; an axis of n cells folds them modulo n into storage. On a periodic
// axis the fold is the physics: coordinate k + n is the same place one period on. On any other axis it only
// saves memory: what shares a storage cell without sharing the coordinate is somewhere else, and whoever
// scans the cell skips it. So balls may fly as far as they like out of an open domain; further out than its
// length each cell is twice as wide as the one before, so that flying off costs few crossings.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <carom/core/scene.hpp>

namespace carom {

/// Cells of one width along one axis.
class GridAxis {
 public:
    GridAxis() = default;
    /// `count` >= 1 cells over [min, min + length].
    GridAxis(double min, double length, std::int32_t count, bool periodic)
        : min_(min),
          length_(length),
          width_(length / count),
          inverse_(count / length),
          count_(count),
          periodic_(periodic) {}

    /// No coordinate is further from 0 than this.
    static constexpr std::int32_t kFarthest = 1 << 30;

    [[nodiscard]] bool periodic() const { return periodic_; }
    [[nodiscard]] std::int32_t count() const { return count_; }
    [[nodiscard]] double min() const { return min_; }
    [[nodiscard]] double length() const { return length_; }
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double inverse_width() const { return inverse_; }

    /// The cell coordinate of x.
    [[nodiscard]] std::int32_t coordinate(double x) const {
        const double inside = (x - min_) * inverse_;
        if (inside >= 0 && inside < count_) return static_cast<std::int32_t>(inside);
        const double k = std::floor(inside);
        if (k >= -count_ && k < 2 * count_) return static_cast<std::int32_t>(k);
        if (periodic_) return static_cast<std::int32_t>(std::clamp(k, -double(kFarthest), double(kFarthest)));
        return k < 0 ? -count_ - outer_cells(-count_ - (x - min_) * inverse_) - 1
                     : 2 * count_ + outer_cells((x - min_) * inverse_ - 2 * count_);
    }
    /// The lower border of the cell at coordinate k; that of k + 1 is the upper one.
    [[nodiscard]] double border(std::int32_t k) const {
        if (periodic_ || (k >= -count_ && k <= 2 * count_)) return min_ + k * width_;
        if (k < 0) return min_ - (count_ + outer_distance(-count_ - k)) * width_;
        return min_ + (2 * count_ + outer_distance(k - 2 * count_)) * width_;
    }
    /// Storage index in [0, count) of coordinate k.
    [[nodiscard]] std::int32_t fold(std::int32_t k) const {
        if (static_cast<std::uint32_t>(k) < static_cast<std::uint32_t>(count_)) return k;
        const std::int32_t rest = k % count_;
        return rest < 0 ? rest + count_ : rest;
    }
    /// How many periods coordinate k is from the box; 0 on an axis that has none.
    [[nodiscard]] std::int32_t turns(std::int32_t k) const { return periodic_ ? (k - fold(k)) / count_ : 0; }
    /// Wraps x into [min, min + length) on a periodic axis and adds to `periods` how many lengths that took
    /// away; leaves it alone on any other axis. A function of x alone.
    [[nodiscard]] double wrapped(double x, std::int32_t& periods) const {
        if (!periodic_ || (x >= min_ && x < min_ + length_)) return x;
        const auto n = static_cast<std::int32_t>(std::floor((x - min_) / length_));
        const double inside = x - n * length_;
        if (inside >= min_ && inside < min_ + length_) {
            periods += n;
            return inside;
        }
        // Rounding has put it on a side: the upper side is the lower one of the next period.
        periods += inside < min_ ? n : n + 1;
        return min_;
    }

 private:
    static constexpr std::int32_t kOuterCells = std::numeric_limits<double>::max_exponent;

    /// Complete outer cells within `distance` >= 0, in widths: the m-th ends at 2^m - 1.
    [[nodiscard]] static std::int32_t outer_cells(double distance) {
        return std::isfinite(distance) ? std::ilogb(distance + 1) : kOuterCells;
    }
    [[nodiscard]] static double outer_distance(std::int32_t cells) {
        return cells < kOuterCells ? std::ldexp(1.0, cells) - 1 : std::numeric_limits<double>::infinity();
    }

    double min_ = 0;
    double length_ = 1;
    double width_ = 1;
    double inverse_ = 1;
    std::int32_t count_ = 1;
    bool periodic_ = false;
};

/// A cell's coordinates, unfolded.
struct CellCoordinates {
    std::int32_t x = 0;
    std::int32_t y = 0;
    friend bool operator==(const CellCoordinates&, const CellCoordinates&) = default;
};

/// Two axes; storage cells are numbered row by row.
struct Grid {
    GridAxis x;
    GridAxis y;

    [[nodiscard]] std::int32_t cell_count() const { return x.count() * y.count(); }
    [[nodiscard]] CellCoordinates coordinates(const Vec2& p) const {
        return {x.coordinate(p.x()), y.coordinate(p.y())};
    }
    [[nodiscard]] std::int32_t index(const CellCoordinates& c) const {
        return y.fold(c.y) * x.count() + x.fold(c.x);
    }
};

/// How much wider than the largest diameter a cell is at least, so that a pair is seen well before it
/// touches.
inline constexpr double kCellMargin = 1.0 / 64;

/// A grid over `domain` for `count` moving balls of at most the given diameter. `cell_size` > 0 asks for a
/// width; what is used is at least the largest diameter with its margin, fits a whole number of times, and
/// keeps the cells to a few a ball. 0 lets the scene choose: about one ball a cell where it is dilute, the
/// smallest allowed cell where it is dense.
[[nodiscard]] Grid choose_grid(const Domain& domain, std::size_t count, double largest_diameter,
                               double cell_size = 0);

/// When a point leaves through a border that lies `distance` ahead, moving with `speed` and `acceleration`
/// towards it, all at time 0: the first time from `since` on at which it passes outwards, infinity when it
/// never does. A point that rounding has put beyond the border leaves at `since`. Consistent for the two
/// sides of a border: a point that comes and goes at one instant cannot be lost or be sent to and fro,
/// because both crossings are compared with the one turning time.
[[nodiscard]] inline double time_to_leave(double distance, double speed, double acceleration, double since) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (acceleration == 0) return speed > 0 ? std::max(distance / speed, since) : kInfinity;
    const double discriminant = speed * speed + 2 * acceleration * distance;
    const double turning = -speed / acceleration;
    const double root = std::sqrt(std::max(discriminant, 0.0));
    if (acceleration > 0) {  // pulled outwards: it passes at the later root, after the turning point
        double t = turning;
        if (speed < 0)
            t = (root - speed) / acceleration;
        else if (speed + root > 0)
            t = 2 * distance / (speed + root);
        return std::max({t, turning, since});
    }
    // pulled back: it passes at the earlier root, before the turning point, or not at all
    if (speed <= 0 || discriminant <= 0 || since >= turning) return kInfinity;
    return std::max(std::min(2 * distance / (speed + root), turning), since);
}

}  // namespace carom
