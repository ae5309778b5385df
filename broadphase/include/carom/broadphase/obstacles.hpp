// What does not move, entered in the cells from which a ball could touch it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <carom/broadphase/grid.hpp>
#include <carom/core/scene.hpp>

namespace carom {

/// An obstacle as seen from a storage cell: the obstacle moved by (shift_x, shift_y) periods is the one near
/// the cell. Shifts are 0 on axes without period.
struct ObstacleEntry {
    std::uint32_t id;  ///< below the number of balls: a static ball; else that number plus the wall's index
    std::int16_t shift_x;
    std::int16_t shift_y;
};

/// For every storage cell the walls and static balls that a ball with its centre in the cell could touch.
class ObstacleMap {
 public:
    ObstacleMap() = default;
    /// `largest_radius` is that of the moving balls. Cost: the cells that the obstacles pass.
    ObstacleMap(const Grid& grid, std::span<const Ball> balls, std::span<const Wall> walls,
                double largest_radius);

    [[nodiscard]] bool empty() const { return entries_.empty(); }
    [[nodiscard]] std::span<const ObstacleEntry> at(std::int32_t cell) const {
        if (first_.empty()) return {};
        return std::span(entries_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
    }

 private:
    std::vector<std::uint32_t> first_;  // of each cell; empty when there is nothing at all
    std::vector<ObstacleEntry> entries_;
};

}  // namespace carom
