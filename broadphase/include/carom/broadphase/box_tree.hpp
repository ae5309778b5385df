// A tree of boxes: which of many bodies of any size are near a place, or come first along a way, in
// logarithmic time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom {

/// Bodies are known by the boxes around them, and called by their index.
class BoxTree {
 public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<Box>& boxes);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }

    /// Calls visit(index) for all bodies of every leaf whose box touches `box`: every body whose own box
    /// does, and some others. In no particular order; visit returns whether to go on.
    template <class Visit>
    void for_each_near(const Box& box, Visit&& visit) const {
        if (empty()) return;
        Stack stack;
        stack.push(0);
        while (!stack.empty()) {
            const Node& node = nodes_[stack.pop()];
            if (box.max.x() < node.box.min.x() || box.min.x() > node.box.max.x() ||
                box.max.y() < node.box.min.y() || box.min.y() > node.box.max.y())
                continue;
            if (node.count == 0) {
                stack.push(node.first + 1);
                stack.push(node.first);
                continue;
            }
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
                if (!visit(order_[k])) return;
        }
    }

    /// Looks for the body with the least of some measure, by branch and bound. bound(box) is at most the
    /// measure of any body in the box; visit(index) looks at a body and returns the least measure so far.
    /// Only boxes whose bound is at most that, or `limit` at first, are opened.
    template <class Bound, class Visit>
    void search(double limit, Bound&& bound, Visit&& visit) const {
        if (empty()) return;
        std::vector<std::pair<double, std::uint32_t>> open = {{bound(nodes_[0].box), 0}};
        while (!open.empty()) {
            const auto [least, index] = open.back();
            open.pop_back();
            if (!(least <= limit)) continue;
            const Node& node = nodes_[index];
            if (node.count > 0) {
                for (std::uint32_t k = node.first; k < node.first + node.count; ++k) limit = visit(order_[k]);
                continue;
            }
            std::pair<double, std::uint32_t> near = {bound(nodes_[node.first].box), node.first};
            std::pair<double, std::uint32_t> far = {bound(nodes_[node.first + 1].box), node.first + 1};
            if (far.first < near.first) std::swap(near, far);
            open.push_back(far);
            open.push_back(near);
        }
    }

 private:
    struct Node {
        Box box;
        std::uint32_t first = 0;  // child nodes first and first + 1, or in a leaf the first place in order_
        std::uint32_t count = 0;  // bodies of a leaf; 0: an inner node
    };
    // As deep as the tree: the bodies of a node are halved, and an index has 32 bits.
    class Stack {
     public:
        void push(std::uint32_t node) { nodes_[size_++] = node; }
        std::uint32_t pop() { return nodes_[--size_]; }
        [[nodiscard]] bool empty() const { return size_ == 0; }

     private:
        std::array<std::uint32_t, 64> nodes_{};
        std::size_t size_ = 0;
    };

    void build(const std::vector<Box>& boxes, std::uint32_t node, std::uint32_t begin, std::uint32_t end);

    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace carom
