// The empirical method's grid: points sorted into cells by counting, anew in every step.
//
// The cells are those of a Grid. A cell's neighbours are seen with a shift, the periods by which what is in
// them must be moved to be near: 0 on axes without period, where the fold only saves memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <carom/broadphase/grid.hpp>

#include "executor.hpp"

namespace carom {

/// One axis: cell numbers [0, count()).
class CellAxis {
 public:
    explicit CellAxis(const GridAxis& axis)
        // Three at least without period, so that the cells beside one are different ones.
        : axis_(axis), count_(axis.periodic() ? axis.count() : std::max(3, axis.count())) {}

    [[nodiscard]] std::int32_t count() const { return count_; }
    /// The cell of x, which on a periodic axis lies in the box.
    [[nodiscard]] std::int32_t cell(double x) const {
        const std::int32_t k = axis_.coordinate(x);
        return axis_.periodic() ? std::clamp(k, 0, count_ - 1) : fold(k);
    }
    struct Seen {
        std::int32_t cell;
        std::int32_t shift;
    };
    /// A cell by its unfolded coordinate.
    [[nodiscard]] Seen seen(std::int32_t k) const {
        const std::int32_t cell = fold(k);
        return {cell, axis_.turns(k)};
    }
    struct Range {
        std::int32_t first, last;
    };
    /// Unfolded coordinates that cover [low, high], each storage cell once on an axis without period.
    [[nodiscard]] Range between(double low, double high) const {
        const std::int32_t first = axis_.coordinate(low);
        const std::int32_t last = axis_.coordinate(high);
        return {first, axis_.periodic() ? last : std::min(last, first + count_ - 1)};
    }

 private:
    [[nodiscard]] std::int32_t fold(std::int32_t k) const {
        if (static_cast<std::uint32_t>(k) < static_cast<std::uint32_t>(count_)) return k;
        const std::int32_t rest = k % count_;
        return rest < 0 ? rest + count_ : rest;
    }

    GridAxis axis_;
    std::int32_t count_;
};

class EmpiricalGrid {
 public:
    explicit EmpiricalGrid(const Grid& grid) : x_(grid.x), y_(grid.y) {}

    [[nodiscard]] std::int32_t cell_count() const { return x_.count() * y_.count(); }
    [[nodiscard]] const CellAxis& x() const { return x_; }
    [[nodiscard]] const CellAxis& y() const { return y_; }
    [[nodiscard]] std::int32_t cell(double x, double y) const { return y_.cell(y) * x_.count() + x_.cell(x); }

    /// Sorts points, on periodic axes in the box; those flagged in `left_out`, where it is not empty, are in
    /// no cell.
    void sort(std::span<const double> xs, std::span<const double> ys, std::span<const std::uint8_t> left_out,
              const Executor& executor);

    /// The points in the order of the cells, and what numbers they had.
    [[nodiscard]] std::span<const double> xs() const { return sorted_x_; }
    [[nodiscard]] std::span<const double> ys() const { return sorted_y_; }
    [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }
    /// Cell c holds [first(c), first(c + 1)).
    [[nodiscard]] std::uint32_t first(std::int32_t c) const { return first_[static_cast<std::size_t>(c)]; }

    /// A cell near another, `shift_x` and `shift_y` periods off.
    struct Near {
        std::int32_t cell;
        std::int32_t shift_x, shift_y;
    };
    /// The cell itself first, then those of its eight neighbours that lie ahead: of two neighbours each is
    /// ahead of the other once. Then the four behind.
    [[nodiscard]] std::array<Near, 9> around(std::int32_t c) const;
    /// Calls visit(Near) for the cells that a box covers.
    template <class Visit>
    void for_each_in(const Vec2& low, const Vec2& high, Visit&& visit) const {
        const CellAxis::Range xs = x_.between(low.x(), high.x());
        const CellAxis::Range ys = y_.between(low.y(), high.y());
        for (std::int32_t ky = ys.first; ky <= ys.last; ++ky) {
            const CellAxis::Seen y = y_.seen(ky);
            for (std::int32_t kx = xs.first; kx <= xs.last; ++kx) {
                const CellAxis::Seen x = x_.seen(kx);
                visit(Near{y.cell * x_.count() + x.cell, x.shift, y.shift});
            }
        }
    }

 private:
    CellAxis x_, y_;
    std::vector<std::int32_t> cell_;    // of each point, -1 where left out
    std::vector<std::uint32_t> first_;  // of each cell, and the end
    std::vector<std::uint32_t> numbers_;
    std::vector<double> sorted_x_, sorted_y_;
};

}  // namespace carom
