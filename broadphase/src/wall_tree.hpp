// The walls near a disc in logarithmic time, for walls of any length and balls of any size.
#pragma once

#include <cstdint>
#include <vector>

#include <carom/broadphase/box_tree.hpp>
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

    /// Calls visit(index of the wall) for every wall whose bounding box is at most `reach` from p on both
    /// axes, and for some others near, in no particular order. visit returns whether to go on.
    template <class Visit>
    void for_each_near(const Vec2& p, double reach, Visit&& visit) const {
        const Vec2 margin = Vec2::Constant(reach);
        tree_.for_each_near({p - margin, p + margin}, visit);
    }

 private:
    std::vector<Wall> walls_;
    BoxTree tree_;
};

}  // namespace carom::detail
