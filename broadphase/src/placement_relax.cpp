// Moves of many discs: overlapping ones pushed apart, clear ones shaken.
#include <algorithm>
#include <cmath>

#include "placement_methods.hpp"

namespace carom::detail {
namespace {

// Effort: sweeps of both are bounded, and fewer the more discs there are.
constexpr double kMovesOfRelaxing = 2e7;
constexpr double kMovesOfShaking = 2e6;
// The share of an overlap that is taken away at each of the two visits a sweep (one from either disc); 1/2
// would just end it, more carries the push on to the neighbours sooner.
constexpr double kPush = 0.9;
// Jammed: over so many sweeps the sum of overlaps has not fallen to this share.
constexpr int kPatience = 100;
constexpr double kProgress = 0.9;
// Random discs of one or of mixed sizes jam near this packing.
constexpr double kJammed = 0.84;

/// Pushes by discs a little too large, so that it ends with gaps.
class Relaxation {
 public:
    Relaxation(Space& space, Random& random) : space_(space), random_(random) {
        const double room = std::sqrt(kJammed / space.packing()) - 1;
        inflation_ = 1 + std::clamp(0.25 * room, 1e-4, 0.03);
    }

    /// One visit of every disc; returns the sum of the overlaps met, in units of the radii's sums, and sets
    /// clear().
    double sweep() {
        clear_ = true;
        double sum = 0;
        for (std::uint32_t id = 0; id < space_.count(); ++id) sum += visit(id);
        return sum;
    }
    [[nodiscard]] bool clear() const { return clear_; }

 private:
    double visit(std::uint32_t id) {
        const Space::Body body = space_.body(id);
        const Vec2 p(body.x, body.y);
        Vec2 push = Vec2::Zero();
        double sum = 0;
        space_.for_each_near(
            p, inflation_ * body.radius + (inflation_ - 1) * space_.largest_radius(), [&](std::uint32_t k) {
                if (k == id) return true;
                const Space::Body& other = space_.body(k);
                const double radius_sum = body.radius + other.radius;
                const Vec2 offset = space_.offset(p, other);
                const double distance_squared = length_squared(offset);
                const double reach =
                    space_.is_fixed(k) ? body.radius * inflation_ + other.radius : radius_sum * inflation_;
                if (distance_squared < reach * reach)
                    sum += add_push(offset, distance_squared, reach, space_.is_fixed(k) ? 1 : kPush, push);
                return true;
            });
        sum += push_off_walls(p, body.radius * inflation_, push);
        if (sum == 0) return 0;
        if (!space_.is_clear(p, body.radius, id)) clear_ = false;
        move(id, body, p + push);
        return sum;
    }

    double add_push(Vec2 offset, double distance_squared, double reach, double share, Vec2& push) {
        if (distance_squared == 0) {
            const auto [x, y] = random_.symmetric_pair();
            offset = Vec2(x, y) * (1e-3 * reach);
            distance_squared = length_squared(offset);
            if (distance_squared == 0) return 1;
        }
        const double distance = std::sqrt(distance_squared);
        const double depth = std::max(0.0, reach - distance);
        push += offset * (share * depth / distance);
        return depth / reach;
    }

    double push_off_walls(const Vec2& p, double reach, Vec2& push) {
        double sum = 0;
        space_.walls().for_each_near(p, reach, [&](std::uint32_t k) {
            const Wall& wall = space_.walls().walls()[k];
            const Vec2 along = wall.to - wall.from;
            const double share =
                std::clamp(dot<double>(p - wall.from, along) / length_squared(along), 0.0, 1.0);
            const Vec2 offset = p - (wall.from + share * along);
            const double distance_squared = length_squared(offset);
            if (distance_squared < reach * reach) sum += add_push(offset, distance_squared, reach, 1, push);
            return true;
        });
        return sum;
    }

    void move(std::uint32_t id, const Space::Body& body, Vec2 p) {
        for (int axis = 0; axis < 2; ++axis) {
            if (space_.wraps(axis)) continue;
            // At the sides too a gap is left, where the region is wide enough for one.
            const double radius =
                std::min(body.radius * inflation_, std::max(body.radius, space_.width(axis) / 2));
            const double low = space_.low(axis, std::min(radius, space_.width(axis) / 2));
            p[axis] = std::clamp(p[axis], low,
                                 std::max(low, space_.high(axis, std::min(radius, space_.width(axis) / 2))));
        }
        space_.move(id, space_.wrapped(p));
    }

    Space& space_;
    Random& random_;
    double inflation_ = 1;
    bool clear_ = true;
};

bool all_clear(const Space& space) {
    for (std::uint32_t id = 0; id < space.count(); ++id)
        if (!space.is_clear({space.body(id).x, space.body(id).y}, space.body(id).radius, id)) return false;
    return true;
}

}  // namespace

bool relax(Space& space, Random& random) {
    Relaxation relaxation(space, random);
    const int sweeps = static_cast<int>(std::clamp(kMovesOfRelaxing / space.count(), 300.0, 3000.0));
    double before = 0;
    for (int k = 0; k < sweeps; ++k) {
        const double overlaps = relaxation.sweep();
        if (relaxation.clear() && all_clear(space)) return true;
        if (k % kPatience != 0) continue;
        if (k > 0 && overlaps > kProgress * before) break;
        before = overlaps;
    }
    return all_clear(space);
}

void shake(Space& space, Random& random) {
    // The mean gap to begin with; then the step is led to an acceptance of one half.
    const double radius = space.largest_radius();
    double step = std::clamp(std::sqrt(0.9 / space.packing()) - 1, 1e-3, 1.0) * radius;
    const int sweeps = static_cast<int>(std::clamp(kMovesOfShaking / space.count(), 12.0, 400.0));
    for (int k = 0; k < sweeps; ++k) {
        std::uint32_t accepted = 0;
        for (std::uint32_t id = 0; id < space.count(); ++id) {
            const Space::Body& body = space.body(id);
            const auto [x, y] = random.symmetric_pair();
            const Vec2 p = space.wrapped({body.x + step * x, body.y + step * y});
            if (!space.is_clear(p, body.radius, id)) continue;
            space.move(id, p);
            ++accepted;
        }
        if (2 * std::uint64_t{accepted} > space.count())
            step = std::min(1.1 * step, radius);
        else
            step *= 0.9;
    }
}

}  // namespace carom::detail
