// A tree of boxes over walls: the walls near a disc in logarithmic time, for walls of any length and balls of
// any size.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::detail {

/// The squared distance from point p to the wall, ends included.
[[nodiscard]] double distance_squared_to(const Wall& wall, const Vec2& p);

class WallTree {
 public:
    WallTree() = default;
    explicit WallTree(std::vector<Wall> walls);

    [[nodiscard]] bool empty() const { return walls_.empty(); }
    [[nodiscard]] const std::vector<Wall>& walls() const { return walls_; }

    /// Calls visit(index of the wall) for every wall whose bounding box is less than `reach` from p on both
    /// axes. The order is fixed, but not that of the indices. visit returns whether to go on.
    template <class Visit>
    void for_each_near(const Vec2& p, double reach, Visit&& visit) const {
        if (empty()) return;
        std::array<std::uint32_t, 64> stack;  // depth: the walls of a node are halved, 32 bits of index
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (p.x() + reach < node.box.min.x() || p.x() - reach > node.box.max.x() ||
                p.y() + reach < node.box.min.y() || p.y() - reach > node.box.max.y())
                continue;
            if (node.count == 0) {
                stack[top++] = node.first + 1;
                stack[top++] = node.first;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
                if (!visit(order_[k])) return;
        }
    }

 private:
    struct Node {
        Box box;
        std::uint32_t first = 0;  // child nodes first and first + 1, or in a leaf the first place in order_
        std::uint32_t count = 0;  // walls of a leaf; 0: an inner node
    };
    void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

    std::vector<Wall> walls_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace carom::detail
