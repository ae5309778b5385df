// Scales of a scene: how long an epoch is, when a contact counts as lasting, and the box where the scene
// names none.
#include "physics.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace carom {
namespace {

// An epoch is so many times what a ball needs to cross its own diameter: long enough that its end costs
// nothing, short enough that the last bit of an offset is far below the last bit of a position.
constexpr double kEpochCrossings = 16;

// The TC model's default contact time: so much of the time in which a ball at the root-mean-square speed
// crosses a diameter...
constexpr double kContactCrossings = 1e-3;
// ... and of the time in which it falls a diameter, up to a factor sqrt(2), whichever is less.
constexpr double kContactFalls = 1e-2;
// Elastic scenes have no contact time; a ball laid down at rest then hops for so much of the time of falling
// a diameter.
constexpr double kRestFalls = 1e-4;

struct Scales {
    double diameter = 1;      // mean of the moving balls
    double speed = 0;         // root mean square
    double acceleration = 0;  // largest
    double mass = 1;          // mean
};

Scales scales_of(const Scene& scene, std::span<const Ball> balls) {
    Scales s;
    double diameters = 0;
    double speeds_squared = 0;
    double masses = 0;
    double count = 0;
    for (const Ball& b : balls) {
        if (b.is_static) continue;
        ++count;
        diameters += 2 * b.radius;
        speeds_squared += length_squared(b.velocity);
        masses += b.mass;
        const Vec2 a = scene.gravity + b.acceleration + field_at(scene.attractors, b.position);
        s.acceleration = std::max(s.acceleration, std::sqrt(length_squared(a)));
    }
    if (count == 0) return s;
    s.diameter = diameters / count;
    s.mass = masses / count;
    s.speed = std::sqrt(speeds_squared / count);
    return s;
}

bool loses_energy(const Scene& scene, std::span<const Ball> balls) {
    const auto lossy = [](const auto& body) { return body.restitution < 1; };
    return scene.speed_factor < 1 || (scene.domain && scene.domain->restitution < 1) ||
           std::ranges::any_of(balls, lossy) || std::ranges::any_of(scene.walls, lossy);
}

// Around everything that is there, with a diameter to spare so that no side has length 0.
Domain bounding_domain(const Scene& scene, std::span<const Ball> balls) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Box box{Vec2::Constant(kInfinity), Vec2::Constant(-kInfinity)};
    const auto include = [&box](const Vec2& p, double margin) {
        box.min = box.min.cwiseMin((p.array() - margin).matrix());
        box.max = box.max.cwiseMax((p.array() + margin).matrix());
    };
    for (const Ball& b : balls) include(b.position, 2 * b.radius);
    for (const Wall& w : scene.walls) {
        include(w.from, 0);
        include(w.to, 0);
    }
    if (balls.empty() && scene.walls.empty()) include(Vec2::Zero(), 1);
    // A lone vertical or horizontal wall spans no area.
    const double extent =
        std::max({box.max.x() - box.min.x(), box.max.y() - box.min.y(), std::numeric_limits<double>::min()});
    for (int axis = 0; axis < 2; ++axis)
        if (!(box.max[axis] - box.min[axis] > 1e-6 * extent)) box.max[axis] = box.min[axis] + extent;
    return {box, {Boundary::kOpen, Boundary::kOpen}, 1};
}

EmpiricalSteps empirical_steps(const Scene& scene, std::span<const Ball> balls) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Ball& b : balls)
        if (!b.is_static) smallest = std::min(smallest, b.radius);
    if (scene.tolerance && !(*scene.tolerance < smallest)) {
        std::ostringstream rule;
        rule << "must be less than the smallest moving ball's radius, " << smallest << ", is "
             << *scene.tolerance;
        throw SceneError("tolerance", rule.str());
    }
    // Beyond that steps no longer differ in the last digit of a double.
    if (scene.step && !(*scene.step >= 1e-15 * scene.until))
        throw SceneError("step", "must be at least 1e-15 of until");
    const double travel = scene.max_travel.value_or(scene.step ? 0 : Scene::kUsualTravel);
    EmpiricalSteps steps;
    if (scene.step) steps.longest = *scene.step;
    if (travel > 0) steps.travel = travel * smallest;
    steps.tolerance = scene.tolerance.value_or(Scene::kUsualTolerance * smallest);
    return steps;
}

}  // namespace

Vec2 field_at(std::span<const Attractor> attractors, const Vec2& p) {
    Vec2 sum = Vec2::Zero();
    for (const Attractor& a : attractors) {
        const Vec2 d = a.position - p;
        const double softened_squared = length_squared(d) + a.softening * a.softening;
        if (softened_squared > 0) sum += (a.strength / (softened_squared * std::sqrt(softened_squared))) * d;
    }
    return sum;
}

Physics derive_physics(const Scene& scene, std::span<const Ball> balls) {
    const Scales s = scales_of(scene, balls);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double crossing_time = s.speed > 0 ? s.diameter / s.speed : kInfinity;
    const double falling_time = s.acceleration > 0 ? std::sqrt(s.diameter / s.acceleration) : kInfinity;

    if (!scene.attractors.empty() && scene.until > kMostFieldUpdates * scene.field_interval)
        throw SceneError("field_interval", "must be at least 1e-9 of until");

    Physics p;
    p.domain = scene.domain ? *scene.domain : bounding_domain(scene, balls);
    p.gravity = scene.gravity;
    p.restitution_rule = scene.restitution_rule;
    p.speed_factor = scene.speed_factor;
    p.in_float = scene.precision == Precision::kFloat;
    if (scene.method == Method::kEmpirical) p.empirical = empirical_steps(scene, balls);
    const double natural = std::min(crossing_time, falling_time);
    if (!(natural > 0)) throw SceneError("attractors", "pull so hard on a ball that no time is short enough");
    p.clock = Clock(kEpochCrossings * (std::isfinite(natural) ? natural : 1.0));
    p.loses_energy = loses_energy(scene, balls);
    const double virial = s.mass * s.diameter * s.diameter / (std::isfinite(natural) ? natural : 1.0);
    if (std::isnormal(virial)) p.typical_virial = virial;
    const double derived = std::min(kContactCrossings * crossing_time, kContactFalls * falling_time);
    p.contact_time = scene.contact_time.value_or(p.loses_energy && std::isfinite(derived) ? derived : 0.0);
    p.rest_time =
        p.contact_time > 0 ? p.contact_time : (std::isfinite(falling_time) ? kRestFalls * falling_time : 0.0);
    return p;
}

}  // namespace carom
