// check(Scene): every rule of a scene that needs no search among its balls.
#include <carom/core/scene.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace carom {
namespace {

// Squares of lengths and speeds, and their products, stay finite and normal within these.
constexpr double kLargest = 1e100;
constexpr double kSmallest = 1e-100;
// Ids are 32 bits, and this many balls already take some ten gigabytes.
constexpr double kMostBalls = 1e8;
// Within this range float does not overflow on the way of a simulation.
constexpr double kLargestInFloat = 1e30;
// A position computed as side + radius is off by an ulp or two of the side.
constexpr double kSideTolerance = 1e-12;
// Shorter ways in a step, in radii, would leave no digits to tell them.
constexpr double kLeastTravel = 1e-9;
constexpr std::size_t kMostCorners = 64;  // of a sensor; nobody needs more
// Packing of equal discs in the triangular lattice, the densest there is: pi / (2 sqrt 3).
constexpr double kDensestPacking = std::numbers::pi / (2 * std::numbers::sqrt3);
constexpr std::array<std::string_view, 2> kAxisName = {"x", "y"};

std::string text(double value) {
    std::array<char, 32> digits;
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general);
    return {digits.data(), end.ptr};
}

std::string text(const Vec2& v) {
    return "[" + text(v.x()) + ", " + text(v.y()) + "]";
}

/// An element of one of the scene's lists, or the scene itself; becomes a string only when something is wrong
/// there.
struct Place {
    std::string_view list;
    std::size_t index = 0;

    [[nodiscard]] std::string of(std::string_view field) const {
        if (list.empty()) return std::string(field);
        std::string place = std::string(list) + "[" + std::to_string(index) + "]";
        if (!field.empty()) place += "." + std::string(field);
        return place;
    }
};

constexpr Place kScene{};

void require_finite(double value, const Place& at, std::string_view field) {
    if (!std::isfinite(value)) throw SceneError(at.of(field), "must be finite, is " + text(value));
    if (!(std::abs(value) <= kLargest))
        throw SceneError(at.of(field), "must lie within -1e100 and 1e100, is " + text(value));
}

void require_finite(const Vec2& v, const Place& at, std::string_view field) {
    if (!std::isfinite(v.x()) || !std::isfinite(v.y()))
        throw SceneError(at.of(field), "must be finite, is " + text(v));
    if (!(std::abs(v.x()) <= kLargest && std::abs(v.y()) <= kLargest))
        throw SceneError(at.of(field), "must lie within -1e100 and 1e100, is " + text(v));
}

void require_positive(double value, const Place& at, std::string_view field) {
    require_finite(value, at, field);
    if (!(value > 0)) throw SceneError(at.of(field), "must be > 0, is " + text(value));
    if (value < kSmallest) throw SceneError(at.of(field), "must be at least 1e-100, is " + text(value));
}

void require_not_negative(double value, const Place& at, std::string_view field) {
    require_finite(value, at, field);
    if (!(value >= 0)) throw SceneError(at.of(field), "must be >= 0, is " + text(value));
}

void require_restitution(double value, const Place& at, std::string_view field = "restitution") {
    if (!(value >= 0 && value <= 1)) throw SceneError(at.of(field), "must lie in [0, 1], is " + text(value));
}

void require_area(const Box& box, const Place& at, const std::string& field) {
    require_finite(box.min, at, field + ".min");
    require_finite(box.max, at, field + ".max");
    for (int axis = 0; axis < 2; ++axis) {
        if (box.max[axis] - box.min[axis] >= kSmallest) continue;
        throw SceneError(at.of(field + ".max"), "must be greater than min on both axes, is " + text(box.max) +
                                                    " with min " + text(box.min));
    }
}

double side_tolerance(const Domain& domain, int axis) {
    return kSideTolerance * std::max(std::abs(domain.box.min[axis]), std::abs(domain.box.max[axis]));
}

/// "x from 0 to 10", the stretch of an axis that the domain leaves.
std::string stretch(const Domain& domain, int axis) {
    return std::string(kAxisName[axis]) + " from " + text(domain.box.min[axis]) + " to " +
           text(domain.box.max[axis]);
}

void check_inside(const Ball& ball, const Domain& domain, const Place& at) {
    for (int axis = 0; axis < 2; ++axis) {
        const double low = domain.box.min[axis];
        const double high = domain.box.max[axis];
        const double centre = ball.position[axis];
        if (domain.boundary[axis] == Boundary::kPeriodic && !(centre >= low && centre < high)) {
            throw SceneError(at.of("position"), "must lie inside the periodic sides, " +
                                                    stretch(domain, axis) + " (excluded), is " +
                                                    text(ball.position));
        }
        const double tolerance = side_tolerance(domain, axis);
        if (domain.boundary[axis] == Boundary::kWall &&
            !(centre - ball.radius >= low - tolerance && centre + ball.radius <= high + tolerance)) {
            throw SceneError(at.of("position"), "must lie a radius (" + text(ball.radius) +
                                                    ") or more inside the walled sides, " +
                                                    stretch(domain, axis) + ", is " + text(ball.position));
        }
    }
}

void check_ball(const Ball& ball, const Place& at) {
    require_finite(ball.position, at, "position");
    require_finite(ball.velocity, at, "velocity");
    require_finite(ball.acceleration, at, "acceleration");
    require_positive(ball.radius, at, "radius");
    require_positive(ball.mass, at, "mass");
    require_restitution(ball.restitution, at);
    if (!ball.is_static) return;
    if (ball.velocity != Vec2::Zero())
        throw SceneError(at.of("velocity"), "must be [0, 0] for a static ball, is " + text(ball.velocity));
    if (ball.acceleration != Vec2::Zero())
        throw SceneError(at.of("acceleration"),
                         "must be [0, 0] for a static ball, is " + text(ball.acceleration));
}

void check_wall(const Wall& wall, const std::optional<Domain>& domain, const Place& at) {
    require_finite(wall.from, at, "from");
    require_finite(wall.to, at, "to");
    require_restitution(wall.restitution, at);
    if (wall.from == wall.to)
        throw SceneError(at.of(""), "must have a length, from and to are both " + text(wall.from));
    if (!(length_squared<double>(wall.to - wall.from) >= kSmallest * kSmallest))
        throw SceneError(at.of(""), "must be at least 1e-100 long");
    if (!domain) return;
    for (int axis = 0; axis < 2; ++axis) {
        if (domain->boundary[axis] != Boundary::kPeriodic) continue;
        const double tolerance = side_tolerance(*domain, axis);
        const auto outside = [&](const Vec2& end) {
            return end[axis] < domain->box.min[axis] - tolerance ||
                   end[axis] > domain->box.max[axis] + tolerance;
        };
        const bool from_outside = outside(wall.from);
        if (!from_outside && !outside(wall.to)) continue;
        throw SceneError(at.of(from_outside ? "from" : "to"), "must lie inside the periodic sides, " +
                                                                  stretch(*domain, axis) + ", is " +
                                                                  text(from_outside ? wall.from : wall.to));
    }
}

void check_attractor(const Attractor& attractor, const Place& at) {
    require_finite(attractor.position, at, "position");
    require_finite(attractor.strength, at, "strength");
    require_not_negative(attractor.softening, at, "softening");
}

/// Whether all corners lie to the same side of each side's line.
bool is_convex(const std::vector<Vec2>& corners) {
    const std::size_t n = corners.size();
    bool is_left = false;
    bool is_right = false;
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 side = corners[(k + 1) % n] - corners[k];
        for (std::size_t j = 2; j < n; ++j) {
            const double distance = cross<double>(side, corners[(k + j) % n] - corners[k]);
            is_left = is_left || !(distance <= 0);
            is_right = is_right || !(distance >= 0);
            if (distance == 0) return false;
        }
    }
    return is_left != is_right;
}

void check_sensor(const Sensor& sensor, const Place& at) {
    if (sensor.corners.empty() || sensor.corners.size() > kMostCorners)
        throw SceneError(at.of("corners"), "must be 1 to " + std::to_string(kMostCorners) + ", are " +
                                               std::to_string(sensor.corners.size()));
    for (const Vec2& corner : sensor.corners) require_finite(corner, at, "corners");
    require_not_negative(sensor.radius, at, "radius");
    if (sensor.corners.size() == 2 &&
        !(length_squared<double>(sensor.corners[1] - sensor.corners[0]) >= kSmallest * kSmallest))
        throw SceneError(at.of("corners"), "must be at least 1e-100 apart");
    if (sensor.corners.size() > 2 && !is_convex(sensor.corners))
        throw SceneError(at.of("corners"),
                         "must go once around a convex polygon, no three of them on one line");
}

void check_radii(const Fill& fill, const Place& at) {
    const bool equal = fill.radius_min == fill.radius_max;
    require_positive(fill.radius_min, at, equal ? "radius" : "radius.min");
    require_positive(fill.radius_max, at, equal ? "radius" : "radius.max");
    if (fill.radius_min > fill.radius_max)
        throw SceneError(at.of("radius.min"),
                         "must be at most max (" + text(fill.radius_max) + "), is " + text(fill.radius_min));
}

/// The box that the fill fills.
const Box& region_of(const Fill& fill, const std::optional<Domain>& domain, const Place& at) {
    if (!fill.region) {
        if (!domain) throw SceneError(at.of("region"), "is required where the scene has no domain");
        return domain->box;
    }
    require_area(*fill.region, at, "region");
    for (int axis = 0; domain && axis < 2; ++axis) {
        if (domain->boundary[axis] == Boundary::kOpen) continue;
        const double tolerance = side_tolerance(*domain, axis);
        if (fill.region->min[axis] >= domain->box.min[axis] - tolerance &&
            fill.region->max[axis] <= domain->box.max[axis] + tolerance)
            continue;
        throw SceneError(at.of("region"), "must lie inside the domain, " + stretch(*domain, axis) + ", is " +
                                              text(fill.region->min) + " to " + text(fill.region->max));
    }
    return *fill.region;
}

/// The number of balls asked for must fit, in the region and in memory.
void check_amount(const Fill& fill, const Box& region, const Place& at) {
    if (!fill.count && !fill.packing_fraction)
        throw SceneError(at.of(""), "must have a count or a packing_fraction");
    if (fill.count && *fill.count == 0) throw SceneError(at.of("count"), "must be at least 1, is 0");
    if (fill.count && static_cast<double>(*fill.count) > kMostBalls)
        throw SceneError(at.of("count"), "must be at most 100000000 (a ball takes some hundred bytes), is " +
                                             std::to_string(*fill.count));
    if (fill.packing_fraction && !(*fill.packing_fraction > 0 && *fill.packing_fraction <= kDensestPacking))
        throw SceneError(at.of("packing_fraction"),
                         "must be > 0 and at most 0.9069 (pi / (2 sqrt 3), the limit for equal discs), is " +
                             text(*fill.packing_fraction));
    if (fill.count && fill.packing_fraction) return;  // the radius follows

    const double area = (region.max - region.min).prod();
    // Mean of the square of a radius that is uniform between the two.
    const double mean_square = (fill.radius_min * fill.radius_min + fill.radius_min * fill.radius_max +
                                fill.radius_max * fill.radius_max) /
                               3;
    if (fill.count) {
        const double packing = static_cast<double>(*fill.count) * std::numbers::pi * mean_square / area;
        if (packing > kDensestPacking)
            throw SceneError(at.of("count"),
                             "is too many: the balls would cover " + text(packing) +
                                 " of the region's area, the limit for equal discs is 0.9069");
        return;
    }
    const double count = *fill.packing_fraction * area / (std::numbers::pi * mean_square);
    if (count <= kMostBalls) return;
    const std::string count_text = count < 1e18 ? std::to_string(std::llround(count)) : text(count);
    throw SceneError(at.of("packing_fraction"),
                     "asks for " + count_text + " balls, must be at most 100000000");
}

void check_fill(const Fill& fill, const std::optional<Domain>& domain, const Place& at) {
    check_radii(fill, at);
    if (fill.mass && fill.density)
        throw SceneError(at.of("density"), "must not stand beside mass: give one of the two");
    if (fill.mass) require_positive(*fill.mass, at, "mass");
    if (fill.density) require_positive(*fill.density, at, "density");
    require_restitution(fill.restitution, at);
    require_not_negative(fill.temperature, at, "temperature");
    check_amount(fill, region_of(fill, domain, at), at);
}

/// A ball wider than a periodic box would meet itself.
void check_widths(const Scene& scene, const Domain& domain) {
    double widest = 0;
    for (const Ball& ball : scene.balls) widest = std::max(widest, 2 * ball.radius);
    for (const Fill& fill : scene.fills)
        if (!(fill.count && fill.packing_fraction)) widest = std::max(widest, 2 * fill.radius_max);
    for (int axis = 0; axis < 2; ++axis) {
        const double width = domain.box.max[axis] - domain.box.min[axis];
        if (domain.boundary[axis] != Boundary::kPeriodic || width >= widest) continue;
        throw SceneError("domain", "must be at least as wide as its largest ball (" + text(widest) +
                                       ") on the periodic axis " + std::string(kAxisName[axis]) + ", is " +
                                       text(width));
    }
}

void require_range_of_float(const Vec2& v, const Place& at, std::string_view field) {
    if (!(v.cwiseAbs().maxCoeff() <= kLargestInFloat))
        throw SceneError(at.of(field),
                         "must lie within -1e30 and 1e30 where precision is float, is " + text(v));
}

/// What the empirical method is told, also where the method is another.
void check_steps(const Scene& scene) {
    if (scene.step) require_positive(*scene.step, kScene, "step");
    if (scene.tolerance) require_positive(*scene.tolerance, kScene, "tolerance");
    if (!scene.max_travel) return;
    require_not_negative(*scene.max_travel, kScene, "max_travel");
    if (*scene.max_travel > 0 && *scene.max_travel < kLeastTravel)
        throw SceneError("max_travel", "must be 0 or at least 1e-9, is " + text(*scene.max_travel));
    if (*scene.max_travel == 0 && !scene.step)
        throw SceneError("max_travel", "must be > 0 where no step is given, is 0");
}

void check_rules(const Scene& scene) {
    if (scene.domain) {
        require_area(scene.domain->box, kScene, "domain");
        require_restitution(scene.domain->restitution, kScene, "domain.restitution");
        if (scene.precision == Precision::kFloat) {
            require_range_of_float(scene.domain->box.min, kScene, "domain.min");
            require_range_of_float(scene.domain->box.max, kScene, "domain.max");
        }
    }
    check_gravity(scene.gravity);
    if (scene.contact_time) require_not_negative(*scene.contact_time, kScene, "contact_time");
    if (!(scene.speed_factor > 0 && scene.speed_factor <= 1))
        throw SceneError("speed_factor", "must be > 0 and at most 1, is " + text(scene.speed_factor));
    require_positive(scene.field_interval, kScene, "field_interval");
    require_not_negative(scene.until, kScene, "until");
    check_steps(scene);
}

}  // namespace

void check(const Ball& ball, const Scene& scene, std::size_t index) {
    const Place at{"balls", index};
    check_ball(ball, at);
    if (scene.domain) check_inside(ball, *scene.domain, at);
    if (scene.precision != Precision::kFloat) return;
    require_range_of_float(ball.position, at, "position");
    require_range_of_float(ball.velocity, at, "velocity");
}

void check(const Wall& wall, const Scene& scene, std::size_t index) {
    check_wall(wall, scene.domain, {"walls", index});
}

void check(const Attractor& attractor, std::size_t index) {
    check_attractor(attractor, {"attractors", index});
}

void check(const Sensor& sensor, std::size_t index) {
    check_sensor(sensor, {"sensors", index});
}

void check_gravity(const Vec2& gravity) {
    require_finite(gravity, kScene, "gravity");
}

void check(const Scene& scene) {
    check_rules(scene);
    if (static_cast<double>(scene.balls.size()) > kMostBalls)
        throw SceneError("balls", "must be at most 100000000, are " + std::to_string(scene.balls.size()));
    for (std::size_t i = 0; i < scene.balls.size(); ++i) check(scene.balls[i], scene, i);
    for (std::size_t i = 0; i < scene.fills.size(); ++i)
        check_fill(scene.fills[i], scene.domain, {"fill", i});
    for (std::size_t i = 0; i < scene.walls.size(); ++i) check(scene.walls[i], scene, i);
    for (std::size_t i = 0; i < scene.attractors.size(); ++i) check(scene.attractors[i], i);
    for (std::size_t i = 0; i < scene.sensors.size(); ++i) check(scene.sensors[i], i);
    if (!scene.sensors.empty() && scene.method == Method::kEmpirical)
        throw SceneError("sensors", "must be none where method is empirical, which does not know them");
    if (scene.domain) check_widths(scene, *scene.domain);
}

}  // namespace carom
