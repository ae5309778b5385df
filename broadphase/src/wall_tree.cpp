#include "wall_tree.hpp"

#include <algorithm>

namespace carom::detail {
namespace {

BoxTree tree_of(const std::vector<Wall>& walls) {
    std::vector<Box> boxes;
    boxes.reserve(walls.size());
    for (const Wall& wall : walls)
        boxes.push_back({wall.from.cwiseMin(wall.to), wall.from.cwiseMax(wall.to)});
    return BoxTree(boxes);
}

}  // namespace

double distance_squared_to(const Wall& wall, const Vec2& p) {
    const Vec2 along = wall.to - wall.from;
    const Vec2 offset = p - wall.from;
    const double share = std::clamp(dot<double>(offset, along) / length_squared<double>(along), 0.0, 1.0);
    const Vec2 apart(offset.x() - share * along.x(), offset.y() - share * along.y());
    return length_squared<double>(apart);
}

WallTree::WallTree(std::vector<Wall> walls) : walls_(std::move(walls)), tree_(tree_of(walls_)) {}

}  // namespace carom::detail
