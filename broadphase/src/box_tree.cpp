// Builds the tree by halving the bodies along the longer side of their middles' box.
#include <carom/broadphase/box_tree.hpp>

#include <numeric>

namespace carom {
namespace {

constexpr std::uint32_t kLeafSize = 4;

// Twice the middle: only its order counts.
Vec2 middle(const Box& box) {
    return box.min + box.max;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    nodes_.emplace_back();
    build(boxes, 0, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(const std::vector<Box>& boxes, std::uint32_t node, std::uint32_t begin,
                    std::uint32_t end) {
    Box box = boxes[order_[begin]];
    Box middles{middle(box), middle(box)};
    for (std::uint32_t k = begin; k < end; ++k) {
        const Box& body = boxes[order_[k]];
        const Vec2 centre = middle(body);
        box.min = box.min.cwiseMin(body.min);
        box.max = box.max.cwiseMax(body.max);
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
    // A total order, ties by index, so that the boxes are the same with every library.
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double of_a = middle(boxes[a])[axis];
                         const double of_b = middle(boxes[b])[axis];
                         return of_a != of_b ? of_a < of_b : a < b;
                     });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first = children;
    build(boxes, children, begin, half);
    build(boxes, children + 1, half, end);
}

}  // namespace carom
