// Where bodies are at one time: what lies at a point, in a box, nearest, or first along a ray.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <carom/broadphase/box_tree.hpp>
#include <carom/parallel/queries.hpp>

#include "bodies.hpp"

namespace carom {

/// Bodies go by their indices. On a periodic axis every place is looked at with all its images.
class PlaceIndex {
 public:
    PlaceIndex(const std::vector<Ball>& balls, const Scene& rules);

    /// Balls whose discs touch a disc about `centre`, in rising order.
    [[nodiscard]] std::vector<std::uint32_t> within(const Vec2& centre, double radius) const;
    /// Balls whose discs touch the box, in rising order.
    [[nodiscard]] std::vector<std::uint32_t> within(const Box& box) const;
    /// The ball whose surface is nearest; of equals the lowest. One may be left out.
    static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
    [[nodiscard]] std::optional<NearestBall> nearest(const Vec2& p, std::uint32_t left_out = kNobody) const;
    /// `direction` is of length 1.
    [[nodiscard]] std::optional<RayHit> first_along(const Vec2& from, const Vec2& direction,
                                                    double length) const;

 private:
    struct Disc {
        Vec2 centre;
        double radius;
    };
    /// What of the plane one period on, or back, has to be looked at as well.
    template <class Visit>
    void for_each_image(const Box& box, Visit&& visit) const;
    [[nodiscard]] Vec2 wrapped(const Vec2& p) const;
    void meet(const Vec2& from, const Vec2& direction, std::optional<RayHit>& first, double& length) const;

    std::vector<Disc> discs_;
    std::vector<Wall> walls_;
    std::optional<Domain> domain_;
    Vec2 period_ = Vec2::Zero();  // 0 where an axis has none
    double largest_radius_ = 0;
    BoxTree balls_;
    BoxTree segments_;
};

}  // namespace carom
