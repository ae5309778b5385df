// How far a point is from a sensor's shape, the plain way.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <carom/core/scene.hpp>

namespace carom::test {

inline double distance_to_segment(const Vec2& p, const Vec2& from, const Vec2& to) {
    const Vec2 side = to - from;
    const double length2 = side.squaredNorm();
    const double share = length2 > 0 ? std::clamp((p - from).dot(side) / length2, 0.0, 1.0) : 0.0;
    return (p - from - share * side).norm();
}

/// To the corners' polygon, segment or point; 0 inside a polygon, which a ray to the right leaves an odd
/// number of times.
inline double distance_to_shape(const Vec2& p, const Sensor& s) {
    double least = std::numeric_limits<double>::infinity();
    bool is_inside = false;
    const std::size_t n = s.corners.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2& a = s.corners[k];
        const Vec2& b = s.corners[(k + 1) % n];
        least = std::min(least, distance_to_segment(p, a, b));
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
            is_inside = !is_inside;
    }
    return n > 2 && is_inside ? 0 : least;
}

}  // namespace carom::test
