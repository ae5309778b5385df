#include <carom/trade/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::trade {
namespace {

constexpr double kMoved = 1e-12;

double radius_of(const Scene& scene) {
    return std::ranges::find(scene.balls, false, &Ball::is_static)->radius;
}

double norm_of(const std::vector<double>& distances) {
    double sum = 0;
    for (const double d : distances) sum += d * d;
    return std::sqrt(sum);
}

/// Collisions of each ball up to the `first`th and the time, a window before the end at the latest.
Matching matching(const Scene& scene, const Course& course, const Trace& reference, const Trace& other,
                  std::uint32_t first, double until) {
    std::vector<bool> moves(scene.balls.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = !scene.balls[i].is_static;
    const double window = course.stretch / 20;
    return match(reference.meetings, other.meetings, moves,
                 {.first = first, .window = window, .until = std::min(until, course.duration() - window)});
}

}  // namespace

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

Matching matching_of(const Scene& scene, const Course& course, const Trace& reference, const Trace& other) {
    return matching(scene, course, reference, other, 2, 2 * course.stretch);
}

std::optional<double> divergence_time(const Scene& scene, const Course& course, const Trace& reference,
                                      const Trace& other) {
    constexpr auto kAll = std::numeric_limits<std::uint32_t>::max();
    return matching(scene, course, reference, other, kAll, course.duration()).first_fault;
}

double Errors::largest() const {
    return std::max({energy, collisions, overlap, places});
}

Errors errors_of(const Scene& scene, const Course& course, const Trace& reference, const Trace& other) {
    Errors errors;
    const double energy = std::abs(other.energy_after_stretch - reference.energy_after_stretch);
    if (energy > 0) errors.energy = energy / reference.most_kinetic_energy;
    const Matching m = matching_of(scene, course, reference, other);
    const auto faults = static_cast<double>(m.missed + m.invented);
    if (faults > 0) errors.collisions = faults / static_cast<double>(std::max<std::size_t>(m.compared, 1));
    errors.overlap = other.max_overlap;
    errors.places = place_error(distances(reference.after_stretch, other.after_stretch, scene), scene);
    return errors;
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

}  // namespace carom::trade
