#include "place_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace carom {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostPieces = 1e6;

Vec2 nearest_of(const Box& box, const Vec2& p) {
    return p.cwiseMax(box.min).cwiseMin(box.max);
}

double distance(const Vec2& a, const Vec2& b) {
    return std::sqrt(length_squared<double>(a - b));
}

/// When a ray comes to a box; infinity where it never does.
double time_to_enter(const Box& box, const Vec2& from, const Vec2& direction) {
    double enter = 0;
    double leave = kInfinity;
    for (int axis = 0; axis < 2; ++axis) {
        if (direction[axis] == 0) {
            if (from[axis] < box.min[axis] || from[axis] > box.max[axis]) return kInfinity;
            continue;
        }
        const double a = (box.min[axis] - from[axis]) / direction[axis];
        const double b = (box.max[axis] - from[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    // The box's corners may be rounded to where the ray just misses them.
    return enter <= leave * (1 + 1e-12) ? enter * (1 - 1e-12) : kInfinity;
}

double time_to_disc(const Vec2& from, const Vec2& direction, const Vec2& centre, double radius) {
    const Vec2 r = from - centre;
    const double c = length_squared(r) - radius * radius;
    if (c <= 0) return 0;
    const double b = dot(r, direction);
    const double across = r.x() * direction.y() - r.y() * direction.x();
    const double discriminant = radius * radius - across * across;
    return b < 0 && discriminant >= 0 ? c / (-b + std::sqrt(discriminant)) : kInfinity;
}

double time_to_wall(const Vec2& from, const Vec2& direction, const Wall& wall) {
    const Vec2 along = wall.to - wall.from;
    const Vec2 r = wall.from - from;
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
    const double determinant = cross(direction, along);
    if (determinant == 0) return kInfinity;
    const double t = cross(r, along) / determinant;
    const double share = cross(r, direction) / determinant;
    return t >= 0 && share >= 0 && share <= 1 ? t : kInfinity;
}

Vec2 normal_of(const Wall& wall, const Vec2& direction) {
    const Vec2 along = wall.to - wall.from;
    const Vec2 normal = Vec2(-along.y(), along.x()) / std::sqrt(length_squared(along));
    return dot(normal, direction) > 0 ? Vec2(-normal) : normal;
}

}  // namespace

PlaceIndex::PlaceIndex(const std::vector<Ball>& balls, const Scene& rules)
    : walls_(rules.walls), domain_(rules.domain) {
    std::vector<Box> boxes;
    boxes.reserve(balls.size());
    discs_.reserve(balls.size());
    for (const Ball& b : balls) {
        const Vec2 margin = Vec2::Constant(b.radius);
        boxes.push_back({b.position - margin, b.position + margin});
        discs_.push_back({b.position, b.radius});
        largest_radius_ = std::max(largest_radius_, b.radius);
    }
    balls_ = BoxTree(boxes);
    boxes.clear();
    for (const Wall& w : walls_) boxes.push_back({w.from.cwiseMin(w.to), w.from.cwiseMax(w.to)});
    segments_ = BoxTree(boxes);
    for (int axis = 0; domain_ && axis < 2; ++axis)
        if (domain_->boundary[axis] == Boundary::kPeriodic)
            period_[axis] = domain_->box.max[axis] - domain_->box.min[axis];
}

Vec2 PlaceIndex::wrapped(const Vec2& p) const {
    Vec2 inside = p;
    for (int axis = 0; axis < 2; ++axis) {
        if (period_[axis] == 0) continue;
        const double low = domain_->box.min[axis];
        inside[axis] -= period_[axis] * std::floor((p[axis] - low) / period_[axis]);
        if (!(inside[axis] >= low && inside[axis] < domain_->box.max[axis])) inside[axis] = low;
    }
    return inside;
}

/// Calls visit(shift) for every whole number of periods by which the balls may be moved to touch the box,
/// which starts less than a period outside of the domain and is not wider than one.
template <class Visit>
void PlaceIndex::for_each_image(const Box& box, Visit&& visit) const {
    const auto is_near = [&](int axis, int k) {
        if (k == 0) return true;
        if (period_[axis] == 0) return false;
        const double shift = k * period_[axis];
        return box.max[axis] >= domain_->box.min[axis] - largest_radius_ + shift &&
               box.min[axis] <= domain_->box.max[axis] + largest_radius_ + shift;
    };
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            if (is_near(0, x) && is_near(1, y)) visit(Vec2(x * period_.x(), y * period_.y()));
}

std::vector<std::uint32_t> PlaceIndex::within(const Box& box) const {
    Box clipped = box;
    for (int axis = 0; axis < 2; ++axis) {
        if (period_[axis] == 0) continue;
        // A period, from wherever it starts, is all there is.
        const double width = std::min(box.max[axis] - box.min[axis], period_[axis]);
        clipped.min[axis] = wrapped(box.min)[axis];
        clipped.max[axis] = clipped.min[axis] + width;
    }
    std::vector<std::uint32_t> found;
    for_each_image(clipped, [&](const Vec2& shift) {
        const Box moved{clipped.min - shift, clipped.max - shift};
        balls_.for_each_near(moved, [&](std::uint32_t i) {
            const Disc& d = discs_[i];
            if (distance(nearest_of(moved, d.centre), d.centre) <= d.radius) found.push_back(i);
            return true;
        });
    });
    std::ranges::sort(found);
    const auto repeated = std::ranges::unique(found);
    found.erase(repeated.begin(), repeated.end());
    return found;
}

std::vector<std::uint32_t> PlaceIndex::within(const Vec2& centre, double radius) const {
    const Vec2 margin = Vec2::Constant(radius);
    std::vector<std::uint32_t> found = within(Box{centre - margin, centre + margin});
    std::erase_if(found, [&](std::uint32_t i) {
        Vec2 offset = wrapped(centre) - discs_[i].centre;
        for (int axis = 0; axis < 2; ++axis)
            if (period_[axis] > 0) offset[axis] = std::remainder(offset[axis], period_[axis]);
        return !(std::sqrt(length_squared(offset)) <= radius + discs_[i].radius);
    });
    return found;
}

std::optional<NearestBall> PlaceIndex::nearest(const Vec2& p, std::uint32_t left_out) const {
    std::optional<NearestBall> best;
    const auto limit = [&best] { return best ? best->distance : kInfinity; };
    const Vec2 home = wrapped(p);
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            if ((x != 0 && period_.x() == 0) || (y != 0 && period_.y() == 0)) continue;
            const Vec2 place = home - Vec2(x * period_.x(), y * period_.y());
            const auto bound = [&](const Box& box) {
                const double outside = distance(nearest_of(box, place), place);
                return outside > 0 ? outside : -largest_radius_;
            };
            balls_.search(limit(), bound, [&](std::uint32_t i) {
                const double d = distance(discs_[i].centre, place) - discs_[i].radius;
                const bool is_nearer = !best || d < best->distance || (d == best->distance && i < best->id);
                if (is_nearer && i != left_out) best = NearestBall{i, d};
                return limit();
            });
        }
    }
    return best;
}

/// Takes what lies on the ray before `length`, in the plane without images.
void PlaceIndex::meet(const Vec2& from, const Vec2& direction, std::optional<RayHit>& first,
                      double& length) const {
    const auto take = [&](CollisionKind kind, std::uint32_t id, double t) {
        if (!(t <= length) || t == kInfinity) return false;
        const bool ties = first && first->distance == t;
        if (ties && (first->kind < kind || (first->kind == kind && first->id <= id))) return false;
        length = t;
        first = RayHit{kind, id, t, from + t * direction, -direction};
        return true;
    };
    const auto bound = [&](const Box& box) { return time_to_enter(box, from, direction); };
    balls_.search(length, bound, [&](std::uint32_t i) {
        const Disc& d = discs_[i];
        if (take(CollisionKind::kBall, i, time_to_disc(from, direction, d.centre, d.radius)) && length > 0)
            first->normal = (first->point - d.centre) / d.radius;
        return length;
    });
    segments_.search(length, bound, [&](std::uint32_t w) {
        if (take(CollisionKind::kWall, w, time_to_wall(from, direction, walls_[w])))
            first->normal = normal_of(walls_[w], direction);
        return length;
    });
    for (int axis = 0; domain_ && axis < 2; ++axis) {
        if (domain_->boundary[axis] != Boundary::kWall || direction[axis] == 0) continue;
        const bool upper = direction[axis] > 0;
        const double gap = (upper ? domain_->box.max : domain_->box.min)[axis] - from[axis];
        if ((gap < 0) == upper && gap != 0) continue;  // it leaves from outside
        const auto side = static_cast<std::uint32_t>(2 * axis + (upper ? 1 : 0));
        if (take(CollisionKind::kWall, static_cast<std::uint32_t>(walls_.size()) + side,
                 gap / direction[axis])) {
            first->normal = Vec2::Zero();
            first->normal[axis] = upper ? -1 : 1;
        }
    }
}

std::optional<RayHit> PlaceIndex::first_along(const Vec2& from, const Vec2& direction, double length) const {
    std::optional<RayHit> first;
    const bool is_plain = period_.isZero(0);
    if (is_plain) {
        meet(from, direction, first, length);
        return first;
    }
    // Pieces shorter than a period, each with the images around.
    double piece = kInfinity;
    for (int axis = 0; axis < 2; ++axis)
        if (period_[axis] > 0) piece = std::min(piece, period_[axis]);
    if (!(length <= kMostPieces * piece))
        throw std::invalid_argument("a ray in a periodic box must not be longer than a million periods");
    for (double begun = 0; !first && begun <= length; begun += piece) {
        const Vec2 start = wrapped(from + begun * direction);
        double rest = std::min(piece, length - begun);
        const Vec2 end = start + rest * direction;
        for_each_image({start.cwiseMin(end), start.cwiseMax(end)}, [&](const Vec2& shift) {
            const std::optional<RayHit> before = first;
            meet(start - shift, direction, first, rest);
            // A piece that is known to be met is not met again from another image, but earlier.
            if (first && before && first->distance == before->distance) first = before;
        });
        if (first) {
            first->distance += begun;
            first->point = wrapped(first->point);
        }
    }
    return first;
}

}  // namespace carom
