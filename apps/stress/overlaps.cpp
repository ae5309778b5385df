#include "overlaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom::stress {
namespace {

// All pairs of more balls than this take longer than what they are to check.
constexpr std::size_t kMostBalls = 300;

/// By how much a centre may be off, as a length. A contact in double is met to a few ulps of the places and
/// of the time. What rounds to float is off by up to half an ulp along either axis at each event, and errors
/// of like steps add up: two balls that lie on each other and move along.
double tolerance(const Scene& scene, double events, const PlaneVectors& positions) {
    double farthest = 0;
    double widest = 0;
    for (const Vec2& x : positions) farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
    for (const Ball& b : scene.balls) widest = std::max(widest, b.radius);
    const double in_double = 0x1p-46 * (farthest + widest) + 1e-9 * widest;
    if (scene.precision == Precision::kDouble) return in_double;
    return in_double + 0x1p-24 * (farthest + widest) * (16 + 2 * std::numbers::sqrt2 * events);
}

double depth(const Scene& scene, const PlaneVectors& positions, std::size_t i, std::size_t j) {
    Vec2 offset = positions[i] - positions[j];
    for (int axis = 0; scene.domain && axis < 2; ++axis) {
        if (scene.domain->boundary[std::size_t(axis)] != Boundary::kPeriodic) continue;
        const double period = scene.domain->box.max[axis] - scene.domain->box.min[axis];
        offset[axis] -= period * std::round(offset[axis] / period);
    }
    return scene.balls[i].radius + scene.balls[j].radius - std::sqrt(length_squared<double>(offset));
}

std::string find_outside(const Scene& scene, const PlaneVectors& positions, double allowed) {
    if (!scene.domain) return {};
    const Domain& domain = *scene.domain;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
            if (domain.boundary[std::size_t(axis)] != Boundary::kWall) continue;
            const double r = scene.balls[i].radius;
            const double beyond = std::max(domain.box.min[axis] + r - positions[i][axis],
                                           positions[i][axis] + r - domain.box.max[axis]);
            if (!(beyond <= allowed))
                return fmt::format("ball {} is beyond a walled side by {:.3g}", i, beyond);
        }
    }
    return {};
}

}  // namespace

std::string find_misplaced(const Scene& scene, const World& world, double events) {
    if (scene.method == Method::kEmpirical) return {};
    const PlaneVectors positions = world.positions();
    const double allowed = tolerance(scene, events, positions);
    if (scene.domain)
        if (std::string found = find_outside(scene, positions, allowed); !found.empty()) return found;
    if (scene.allows_overlap || positions.size() > kMostBalls) return {};
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (std::size_t j = i + 1; j < positions.size(); ++j) {
            if (scene.balls[i].is_static && scene.balls[j].is_static) continue;
            if (!may_collide(scene.balls[i].filter, scene.balls[j].filter)) continue;
            if (const double d = depth(scene, positions, i, j); !(d <= allowed))
                return fmt::format("balls {} and {} overlap by {:.3g} at time {}", i, j, d, world.time());
        }
    }
    return {};
}

}  // namespace carom::stress
