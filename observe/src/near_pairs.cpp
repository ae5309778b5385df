// Sorting points into cells.
#include "near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::observe {

std::int64_t NearPairs::Axis::cell(double x) const {
    const double inside = (x - min) * inverse;
    return static_cast<std::int64_t>(std::clamp(inside, 0.0, double(count - 1)));
}

int NearPairs::Axis::around(std::int64_t cell, std::array<std::int64_t, 3>& out) const {
    int found = 0;
    for (std::int64_t k = cell - 1; k <= cell + 1; ++k) {
        if (period == 0 && (k < 0 || k >= count)) continue;
        const std::int64_t folded = (k + count) % count;
        if (std::find(out.begin(), out.begin() + found, folded) == out.begin() + found) out[found++] = folded;
    }
    return found;
}

NearPairs::NearPairs(std::span<const Vec2> points, const Domain& domain, double reach)
    : reach_squared_(reach * reach) {
    // Balls may fly far out of an open domain; cells grow rather than become many more than the balls.
    const double most = 2 * std::ceil(std::sqrt(double(points.size()))) + 1;
    for (int axis = 0; axis < 2; ++axis) {
        double low = domain.box.min[axis];
        double high = domain.box.max[axis];
        const bool periodic = domain.boundary[axis] == Boundary::kPeriodic;
        if (!periodic) {
            low = std::numeric_limits<double>::infinity();
            high = -low;
            for (const Vec2& p : points) {
                low = std::min(low, p[axis]);
                high = std::max(high, p[axis]);
            }
        }
        const double length = high - low;
        // A little wider than the reach, so that rounding never puts a near pair two cells apart.
        const double count = std::clamp(std::floor(length / (1.001 * reach)), 1.0, most);
        axes_[axis] = {low, periodic ? length : 0, length > 0 ? count / length : 0,
                       static_cast<std::int64_t>(count)};
    }
    const auto cell_of = [this](const Vec2& p) {
        return static_cast<std::size_t>(axes_[1].cell(p.y()) * axes_[0].count + axes_[0].cell(p.x()));
    };
    begin_.assign(static_cast<std::size_t>(axes_[0].count * axes_[1].count) + 1, 0);
    for (const Vec2& p : points) ++begin_[cell_of(p) + 1];
    for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    points_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        points_[next[cell_of(points[i])]++] = {points[i], static_cast<std::uint32_t>(i)};
}

double longest_reach(const Domain& domain) {
    double reach = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 2; ++axis)
        if (domain.boundary[axis] == Boundary::kPeriodic)
            reach = std::min(reach, (domain.box.max[axis] - domain.box.min[axis]) / 2);
    return reach;
}

}  // namespace carom::observe
