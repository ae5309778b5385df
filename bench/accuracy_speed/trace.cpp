#include "trace.hpp"

#include <algorithm>
#include <cmath>

namespace carom::bench {
namespace {

constexpr double kMoved = 1e-12;
// Steps end at the samples, but for rounding: look a little later, in every run.
constexpr double kLater = 1e-9;

/// Energy of the balls in the attractors' field, which World leaves out: -k / sqrt(d^2 + s^2) a unit of mass.
double energy_in_field(const World& world, const Scene& scene) {
    double energy = 0;
    for (const Ball& b : world.balls())
        for (const Attractor& a : scene.attractors)
            if (!b.is_static)
                energy -=
                    b.mass * a.strength /
                    std::sqrt(length_squared<double>(b.position - a.position) + a.softening * a.softening);
    return energy;
}

double radius_of(const Scene& scene) {
    return std::ranges::find(scene.balls, false, &Ball::is_static)->radius;
}

double norm_of(const std::vector<double>& distances) {
    double sum = 0;
    for (const double d : distances) sum += d * d;
    return std::sqrt(sum);
}

}  // namespace

Trace trace(const Scene& scene, const Course& course, int domains) {
    World world(scene, {.threads = 1, .domains = domains});
    const auto balls = static_cast<std::uint32_t>(world.ball_count());
    Trace t;
    t.energy_0 = world.energy() + energy_in_field(world, scene);
    t.momentum_0 = world.momentum();
    for (const Ball& b : world.balls()) t.speeds += b.mass * std::sqrt(length_squared(b.velocity));
    world.on_collision([&](const Collision& c) {
        if (c.time > 3 * course.stretch) return;
        t.meetings.push_back({c.time, c.i, c.kind == CollisionKind::kBall ? c.j : balls + c.j});
    });
    const auto samples = static_cast<std::size_t>(course.stretches) * Course::kSamples;
    for (std::size_t k = 0; k <= samples; ++k) {
        if (k > 0) world.advance_to(course.time_of(k) + kLater * course.time_of(1));
        t.places.push_back(world.positions());
        if (k % Course::kSamples == 0) t.max_overlap = std::max(t.max_overlap, world.max_overlap());
    }
    t.counts = world.counts();
    t.energy_1 = world.energy() + energy_in_field(world, scene);
    t.momentum_1 = world.momentum();
    t.pressure = world.compressibility_factor();
    t.hash = world.state_hash();
    return t;
}

std::vector<double> distances(const PlaneVectors& x, const PlaneVectors& y, const Scene& scene) {
    std::vector<double> result;
    for (std::size_t i = 0; i < x.size(); ++i) {
        Vec2 d = x[i] - y[i];
        for (int axis = 0; axis < 2; ++axis)
            if (scene.domain && scene.domain->boundary[std::size_t(axis)] == Boundary::kPeriodic)
                d[axis] = std::remainder(d[axis], scene.domain->box.max[axis] - scene.domain->box.min[axis]);
        result.push_back(std::sqrt(length_squared(d)));
    }
    return result;
}

double place_error(const std::vector<double>& distances, const Scene& scene) {
    double sum = 0;
    double balls = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        if (scene.balls[i].is_static) continue;
        sum += std::min(distances[i] / scene.balls[i].radius, 1.0);
        ++balls;
    }
    return sum / balls;
}

std::optional<double> separation_time(const Trace& reference, const Trace& other, const Scene& scene,
                                      const Course& course) {
    std::vector<bool> apart(scene.balls.size(), false);
    const auto moving = std::ranges::count(scene.balls, false, &Ball::is_static);
    std::ptrdiff_t count = 0;
    for (std::size_t k = 0; k < reference.places.size(); ++k) {
        const std::vector<double> d = distances(reference.places[k], other.places[k], scene);
        for (std::size_t i = 0; i < d.size(); ++i) {
            if (apart[i] || d[i] <= scene.balls[i].radius) continue;
            apart[i] = true;
            ++count;
        }
        if (2 * count >= moving) return course.time_of(k);
    }
    return std::nullopt;
}

std::optional<double> growth_of(const std::vector<double>& times, const std::vector<double>& norms,
                                double low, double high) {
    double n = 0, sum_t = 0, sum_l = 0, sum_tt = 0, sum_tl = 0;
    for (std::size_t k = 0; k < times.size() && norms[k] < high; ++k) {
        if (norms[k] <= low) continue;
        const double t = times[k];
        const double l = std::log(norms[k]);
        ++n;
        sum_t += t;
        sum_l += l;
        sum_tt += t * t;
        sum_tl += t * l;
    }
    if (n < 3) return std::nullopt;
    return (n * sum_tl - sum_t * sum_l) / (n * sum_tt - sum_t * sum_t);
}

std::optional<double> lyapunov_exponent(const Trace& reference, const Trace& moved, const Scene& scene,
                                        const Course& course) {
    std::vector<double> times;
    std::vector<double> norms;
    for (std::size_t k = 0; k < reference.places.size(); ++k) {
        times.push_back(course.time_of(k));
        norms.push_back(norm_of(distances(reference.places[k], moved.places[k], scene)));
    }
    const double radius = radius_of(scene);
    return growth_of(times, norms, 1e-10 * radius, 1e-2 * radius);
}

Scene moved_a_little(Scene scene) {
    const auto ball = std::ranges::find(scene.balls, false, &Ball::is_static);
    ball->position.x() += kMoved * ball->radius;
    return scene;
}

}  // namespace carom::bench
