// Enters walls and static balls in the cells from which a moving ball could touch them, row of cells by row
// of cells.
#include <carom/broadphase/obstacles.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace carom {
namespace {

struct Range {
    double low;
    double high;
};

// The x-range of the part of a segment whose y lies in the band; empty (low > high) when none does.
Range segment_in_band(const Wall& wall, Range band) {
    const Vec2 d = wall.to - wall.from;
    double t0 = 0;
    double t1 = 1;
    if (d.y() != 0) {
        const double ta = (band.low - wall.from.y()) / d.y();
        const double tb = (band.high - wall.from.y()) / d.y();
        t0 = std::max(t0, std::min(ta, tb));
        t1 = std::min(t1, std::max(ta, tb));
    } else if (wall.from.y() < band.low || wall.from.y() > band.high) {
        return {1, 0};
    }
    if (t0 > t1) return {1, 0};
    const double xa = wall.from.x() + t0 * d.x();
    const double xb = wall.from.x() + t1 * d.x();
    return {std::min(xa, xb), std::max(xa, xb)};
}

// The x-range of the part of a disc whose y lies in the band.
Range disc_in_band(const Vec2& centre, double radius, Range band) {
    const double dy = std::max({0.0, band.low - centre.y(), centre.y() - band.high});
    if (dy > radius) return {1, 0};
    const double half = std::sqrt((radius - dy) * (radius + dy));
    return {centre.x() - half, centre.x() + half};
}

struct CoordinateRange {
    std::int32_t first;
    std::int32_t last;
};

CoordinateRange cells_between(const GridAxis& axis, Range r) {
    return {axis.coordinate(r.low), axis.coordinate(r.high)};
}

std::int16_t shift_of(const GridAxis& axis, std::int32_t coordinate) {
    return axis.periodic() ? static_cast<std::int16_t>((axis.fold(coordinate) - coordinate) / axis.count())
                           : std::int16_t{0};
}

// Calls enter(cell, shift_x, shift_y) for each cell that a shape comes within `reach` of. `in_band` gives the
// shape's x-range in a band of y.
template <class InBand, class Enter>
void for_each_cell(const Grid& grid, Range rows, double reach, InBand&& in_band, Enter&& enter) {
    const CoordinateRange ys = cells_between(grid.y, {rows.low - reach, rows.high + reach});
    for (std::int32_t y = ys.first; y <= ys.last; ++y) {
        const Range x = in_band(Range{grid.y.border(y) - reach, grid.y.border(y + 1) + reach});
        if (x.low > x.high) continue;
        CoordinateRange xs = cells_between(grid.x, {x.low - reach, x.high + reach});
        // On an axis without period the fold meets every storage cell of the row once in `count` steps.
        if (!grid.x.periodic()) xs.last = std::min(xs.last, xs.first + grid.x.count() - 1);
        for (std::int32_t k = xs.first; k <= xs.last; ++k)
            enter(grid.index({k, y}), shift_of(grid.x, k), shift_of(grid.y, y));
    }
}

}  // namespace

ObstacleMap::ObstacleMap(const Grid& grid, std::span<const Ball> balls, std::span<const Wall> walls,
                         double largest_radius) {
    struct Placed {
        std::int32_t cell;
        ObstacleEntry entry;
    };
    std::vector<Placed> placed;
    const double reach =
        largest_radius * (1 + kCellMargin) + kCellMargin * std::min(grid.x.width(), grid.y.width());
    const auto enter = [&](std::uint32_t id) {
        return [&placed, id](std::int32_t cell, std::int16_t sx, std::int16_t sy) {
            placed.push_back({cell, {id, sx, sy}});
        };
    };
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
        if (!balls[i].is_static) continue;
        const Vec2& c = balls[i].position;
        const double r = balls[i].radius;
        for_each_cell(
            grid, {c.y() - r, c.y() + r}, reach, [&](Range band) { return disc_in_band(c, r, band); },
            enter(i));
    }
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
        const Wall& wall = walls[w];
        const auto [low, high] = std::minmax(wall.from.y(), wall.to.y());
        for_each_cell(
            grid, {low, high}, reach, [&](Range band) { return segment_in_band(wall, band); },
            enter(static_cast<std::uint32_t>(balls.size()) + w));
    }
    if (placed.empty()) return;
    // Rows that fold into one another enter a cell twice.
    const auto key = [](const Placed& p) {
        return std::tuple(p.cell, p.entry.id, p.entry.shift_x, p.entry.shift_y);
    };
    std::ranges::sort(placed, {}, key);
    const auto repeated = std::ranges::unique(placed, {}, key);
    placed.erase(repeated.begin(), repeated.end());
    first_.assign(static_cast<std::size_t>(grid.cell_count()) + 1, 0);
    for (const Placed& p : placed) {
        ++first_[p.cell + 1];
        entries_.push_back(p.entry);
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
}

}  // namespace carom
