// Builds the tree of boxes by halving the walls along the longer side of their middles' box.
#include "wall_tree.hpp"

#include <algorithm>
#include <numeric>

namespace carom::detail {
namespace {

constexpr std::uint32_t kLeafSize = 4;

// Twice the wall's middle: only its order counts.
double middle(const Wall& wall, int axis) {
    return wall.from[axis] + wall.to[axis];
}

}  // namespace

double distance_squared_to(const Wall& wall, const Vec2& p) {
    const Vec2 along = wall.to - wall.from;
    const Vec2 offset = p - wall.from;
    const double share = std::clamp(dot<double>(offset, along) / length_squared<double>(along), 0.0, 1.0);
    const Vec2 apart(offset.x() - share * along.x(), offset.y() - share * along.y());
    return length_squared<double>(apart);
}

WallTree::WallTree(std::vector<Wall> walls) : walls_(std::move(walls)), order_(walls_.size()) {
    if (walls_.empty()) return;
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    nodes_.emplace_back();
    build(0, 0, static_cast<std::uint32_t>(walls_.size()));
}

void WallTree::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    Box box{walls_[order_[begin]].from, walls_[order_[begin]].from};
    Box middles{Vec2(middle(walls_[order_[begin]], 0), middle(walls_[order_[begin]], 1)), Vec2::Zero()};
    middles.max = middles.min;
    for (std::uint32_t k = begin; k < end; ++k) {
        const Wall& wall = walls_[order_[k]];
        const Vec2 centre(middle(wall, 0), middle(wall, 1));
        box.min = box.min.cwiseMin(wall.from).cwiseMin(wall.to);
        box.max = box.max.cwiseMax(wall.from).cwiseMax(wall.to);
        middles.min = middles.min.cwiseMin(centre);
        middles.max = middles.max.cwiseMax(centre);
    }
    nodes_[node].box = box;
    if (end - begin <= kLeafSize) {
        nodes_[node].first = begin;
        nodes_[node].count = end - begin;
        return;
    }
    const Vec2 extent = middles.max - middles.min;
    const int axis = extent.x() >= extent.y() ? 0 : 1;
    const std::uint32_t half = begin + (end - begin) / 2;
    // The whole order is given, ties by index, so that the tree is the same with every library.
    std::sort(order_.begin() + begin, order_.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
        const double of_a = middle(walls_[a], axis);
        const double of_b = middle(walls_[b], axis);
        return of_a != of_b ? of_a < of_b : a < b;
    });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first = children;
    build(children, begin, half);
    build(children + 1, half, end);
}

}  // namespace carom::detail
