#include <carom/trade/trace.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::trade {
namespace {

// Of a sample's time, from its start: no simple fraction, so that steps seldom end there.
constexpr double kBetween = 0.381966;
// Steps end at the samples, but for rounding: look a little later, in every run.
constexpr double kLater = 1e-9;
constexpr double kNear = 1e-6;  // of a step, within which a time is its end

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

/// With steps of one length these are its multiples; without, the time is as good as any.
bool is_end_of_step(const Scene& scene, double time) {
    if (scene.method == Method::kEvent || !scene.step) return true;
    return std::abs(std::remainder(time, *scene.step)) < kNear * *scene.step;
}

/// Overlaps between two samples: at the end of a step, where steps are longer than samples, and at a time
/// that is none's end, where the course is detailed.
void look_between(World& world, const Scene& scene, const Course& course, std::size_t k, Trace& t) {
    const double from = course.time_of(k - 1);
    const double to = course.time_of(k);
    const double sample = to - from;
    std::vector<std::pair<double, double Trace::*>> looks;
    if (course.is_detailed) looks.emplace_back(from + kBetween * sample, &Trace::overlap_between);
    if (scene.method == Method::kEmpirical && scene.step && *scene.step > sample) {
        const double end = std::floor(to / *scene.step * (1 - kNear)) * *scene.step;
        if (end > from * (1 + kNear)) looks.emplace_back(end + kLater * sample, &Trace::max_overlap);
    }
    std::ranges::sort(looks, {}, [](const auto& look) { return look.first; });
    for (const auto& [time, deepest] : looks) {
        world.advance_to(time);
        t.*deepest = std::max(t.*deepest, world.max_overlap());
    }
}

double energy_of(const World& world, const Scene& scene) {
    return world.energy() + energy_in_field(world, scene);
}

}  // namespace

Trace trace(const Scene& scene, const Course& course, const TraceOptions& options) {
    World world(scene, {.threads = options.threads, .domains = options.domains});
    const auto balls = static_cast<std::uint32_t>(world.ball_count());
    Trace t;
    t.energy_0 = energy_of(world, scene);
    t.momentum_0 = world.momentum();
    for (const Ball& b : world.balls()) t.speeds += b.mass * std::sqrt(length_squared(b.velocity));
    world.on_collision([&](const Collision& c) {
        t.meetings.push_back({c.time, c.i, c.kind == CollisionKind::kBall ? c.j : balls + c.j});
    });
    const auto samples = static_cast<std::size_t>(course.stretches) * Course::kSamples;
    const double sample = course.time_of(1);
    for (std::size_t k = 0; k <= samples; ++k) {
        if (!options.goes_on()) return t;
        if (k > 0) look_between(world, scene, course, k, t);
        if (k > 0) world.advance_to(course.time_of(k) + kLater * sample);
        t.most_kinetic_energy = std::max(t.most_kinetic_energy, world.kinetic_energy());
        if (is_end_of_step(scene, course.time_of(k)))
            t.max_overlap = std::max(t.max_overlap, world.max_overlap());
        if (course.is_detailed) t.places.push_back(world.positions());
        if (k == Course::kSamples) {
            t.after_stretch = world.positions();
            t.energy_after_stretch = energy_of(world, scene);
        }
    }
    t.is_whole = true;
    t.counts = world.counts();
    t.energy_1 = energy_of(world, scene);
    t.momentum_1 = world.momentum();
    t.pressure = world.compressibility_factor();
    t.hash = world.state_hash();
    return t;
}

}  // namespace carom::trade
