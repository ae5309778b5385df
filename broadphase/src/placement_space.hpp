// The region that is being filled: its sides, what was there before, and the discs that are in place so far.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <carom/core/scene.hpp>

#include "pair_search.hpp"
#include "wall_tree.hpp"

namespace carom::detail {

/// Discs 0 .. count() - 1 are the fill's: they come, move and go. After them stand the balls that were there
/// before. Bodies lie in dense grids of linked lists, one grid for each octave of radii, so that a move costs
/// a few operations.
class Space {
 public:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    struct Body {
        double x;
        double y;
        double radius;
        std::uint32_t next = kNone;  ///< of its cell
    };

    /// `radii` are the fill's; at least one. Balls and walls out of reach of the region are left out.
    Space(const Scene& scene, const std::vector<Ball>& present, const Box& region,
          const std::vector<double>& radii);

    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(full_radius_.size()); }
    [[nodiscard]] std::uint32_t body_count() const { return static_cast<std::uint32_t>(bodies_.size()); }
    [[nodiscard]] const Body& body(std::uint32_t id) const { return bodies_[id]; }
    [[nodiscard]] double full_radius(std::uint32_t id) const { return full_radius_[id]; }
    [[nodiscard]] double smallest_radius() const { return smallest_radius_; }
    [[nodiscard]] double smallest_scaled_radius() const { return scale_ * smallest_radius_; }
    [[nodiscard]] double largest_radius() const { return largest_radius_; }
    [[nodiscard]] double packing() const { return packing_; }
    [[nodiscard]] bool wraps(int axis) const { return axes_[axis].period > 0; }
    [[nodiscard]] double width(int axis) const { return region_.max[axis] - region_.min[axis]; }
    [[nodiscard]] const Box& region() const { return region_; }
    [[nodiscard]] const WallTree& walls() const { return walls_; }
    [[nodiscard]] bool is_fixed(std::uint32_t id) const { return id >= count(); }

    /// The lowest and highest coordinate for the centre of a disc: at least a radius inside, in double.
    [[nodiscard]] double low(int axis, double radius) const;
    [[nodiscard]] double high(int axis, double radius) const;
    /// The place nearest to p between them. A region as wide as the disc may have none, for rounding.
    [[nodiscard]] Vec2 moved_inside(Vec2 p, double radius) const {
        for (int axis = 0; axis < 2; ++axis)
            p[axis] = std::min(std::max(p[axis], low(axis, radius)), high(axis, radius));
        return p;
    }
    /// Whether a disc at p, with coordinates from wrapped(), would lie inside the region and clear of
    /// everything but `self`.
    [[nodiscard]] bool is_clear(const Vec2& p, double radius, std::uint32_t self = kNone) const;
    [[nodiscard]] Vec2 wrapped(const Vec2& p) const {
        return {axes_[0].wrapped(p.x()), axes_[1].wrapped(p.y())};
    }
    /// The offset from body b to p by the shorter way round.
    [[nodiscard]] Vec2 offset(const Vec2& p, const Body& b) const {
        double dx = p.x() - b.x;
        double dy = p.y() - b.y;
        if (axes_[0].period > 0) dx = axes_[0].nearest(dx);
        if (axes_[1].period > 0) dy = axes_[1].nearest(dy);
        return {dx, dy};
    }

    /// Asks for the memory of the bodies between two places, ahead of its use.
    void fetch(const Vec2& low, const Vec2& high) const;
    void insert(std::uint32_t id, const Vec2& p);
    void remove(std::uint32_t id);
    void move(std::uint32_t id, const Vec2& p);
    void clear();
    /// Discs of the fill have `scale` times their full radius, at most 1.
    void set_scale(double scale);
    /// The fill's discs, which must be in place, from row to row of cells of the region and from cell to cell
    /// of a row; those of a cell by their ids.
    [[nodiscard]] std::vector<std::uint32_t> order_by_place() const;
    /// Gives them new ids in that order, so that neighbours in space become neighbours in memory.
    void sort_by_place();

    /// Calls visit(id) for every body whose surface may be less than `reach` from p; none that is, is left
    /// out. visit returns whether to go on.
    template <class Visit>
    void for_each_near(const Vec2& p, double reach, Visit&& visit) const {
        for (const Level& level : levels_)
            if (!visit_level(level, p, reach + level.largest_radius, visit)) return;
    }

 private:
    struct Level {
        int octave = 0;
        double largest_radius = 0;
        std::size_t size = 0;
        std::array<std::int64_t, 2> count{};
        std::array<double, 2> inverse{};
        std::size_t first_cell = 0;
    };

    void add_obstacles(const std::vector<Ball>& present, const std::array<Axis, 2>& periodic);
    void add_walls(const std::vector<Wall>& walls, const std::array<Axis, 2>& periodic);
    void lay_out_levels();
    [[nodiscard]] std::size_t cell_of(const Body& body, std::uint32_t id) const;
    [[nodiscard]] std::int64_t index(const Level& level, int axis, double x) const;
    /// The cells from x - reach to x + reach: the first one and how many.
    [[nodiscard]] std::array<std::int64_t, 2> range(const Level& level, int axis, double x,
                                                    double reach) const;

    template <class Visit>
    bool visit_level(const Level& level, const Vec2& p, double reach, Visit& visit) const {
        const auto [first_column, columns] = range(level, 0, p.x(), reach);
        const auto [first_row, rows] = range(level, 1, p.y(), reach);
        std::int64_t row = first_row;
        for (std::int64_t r = 0; r < rows; ++r) {
            std::int64_t column = first_column;
            for (std::int64_t c = 0; c < columns; ++c) {
                for (std::uint32_t id = head_[level.first_cell + row * level.count[0] + column]; id != kNone;
                     id = bodies_[id].next)
                    if (!visit(id)) return false;
                if (++column == level.count[0]) column = 0;
            }
            if (++row == level.count[1]) row = 0;
        }
        return true;
    }

    Box region_;
    std::array<Axis, 2> axes_;  // periods of the axes that wrap within the region
    std::vector<Body> bodies_;
    std::vector<double> full_radius_;
    std::vector<std::uint8_t> level_of_;
    double smallest_radius_ = 0;
    double largest_radius_ = 0;
    double packing_ = 0;
    double scale_ = 1;
    WallTree walls_;
    std::vector<Level> levels_;
    std::vector<std::uint32_t> head_;
};

}  // namespace carom::detail
