// All pairs of points nearer than a reach, through periodic sides too. A plain counting sort into cells: the
// observer's own, for the engine's grid knows diameters and no longer reach.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::observe {

class NearPairs {
 public:
    /// Precondition: reach > 0, and at most half of each period.
    NearPairs(std::span<const Vec2> points, const Domain& domain, double reach);

    /// Calls visit(i, j, offset, distance squared) once for each pair; offset leads from i to j the shorter
    /// way round. The order depends on the points alone.
    template <class Visit>
    void for_each(Visit&& visit) const {
        for (std::int64_t row = 0; row < axes_[1].count; ++row)
            for (std::int64_t column = 0; column < axes_[0].count; ++column) visit_cell(column, row, visit);
    }

 private:
    struct Axis {
        double min = 0;
        double period = 0;  ///< 0: none
        double inverse = 0;
        std::int64_t count = 1;

        [[nodiscard]] std::int64_t cell(double x) const;
        /// The distinct cells at most one away; returns how many.
        int around(std::int64_t cell, std::array<std::int64_t, 3>& out) const;
        [[nodiscard]] double nearest(double difference) const {
            if (period == 0) return difference;
            if (difference > period / 2) return difference - period;
            return difference < -period / 2 ? difference + period : difference;
        }
    };
    struct Point {
        Vec2 position;
        std::uint32_t id;
    };

    [[nodiscard]] std::span<const Point> cell(std::int64_t column, std::int64_t row) const {
        const auto k = static_cast<std::size_t>(row * axes_[0].count + column);
        return std::span(points_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
    }

    template <class Visit>
    void visit_cell(std::int64_t column, std::int64_t row, Visit& visit) const {
        const std::span<const Point> centre = cell(column, row);
        if (centre.empty()) return;
        std::array<std::int64_t, 3> columns;
        std::array<std::int64_t, 3> rows;
        const int column_count = axes_[0].around(column, columns);
        const int row_count = axes_[1].around(row, rows);
        for (int r = 0; r < row_count; ++r)
            for (int c = 0; c < column_count; ++c) visit_two(centre, cell(columns[c], rows[r]), visit);
    }

    template <class Visit>
    void visit_two(std::span<const Point> centre, std::span<const Point> others, Visit& visit) const {
        for (const Point& a : centre) {
            for (const Point& b : others) {
                if (b.id <= a.id) continue;
                const Vec2 plain = b.position - a.position;
                const Vec2 offset(axes_[0].nearest(plain.x()), axes_[1].nearest(plain.y()));
                const double distance_squared = length_squared(offset);
                if (distance_squared < reach_squared_) visit(a.id, b.id, offset, distance_squared);
            }
        }
    }

    std::array<Axis, 2> axes_;
    double reach_squared_;
    std::vector<Point> points_;       // in the order of their cells
    std::vector<std::size_t> begin_;  // one more than cells
};

/// The longest reach that NearPairs may have in a domain: half the shortest period, infinity where there is
/// none.
[[nodiscard]] double longest_reach(const Domain& domain);

}  // namespace carom::observe
