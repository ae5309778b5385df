#include "study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace carom::bench {
namespace {

double seconds_of(const Scene& scene, double duration) {
    World world(scene, {.threads = 1, .count_missed = false});
    const auto start = std::chrono::steady_clock::now();
    world.advance_to(duration);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double count_of(const Trace& t) {
    return static_cast<double>(t.counts.ball_collisions + t.counts.wall_collisions);
}

double energy_change(const Trace& t) {
    return (t.energy_1 - t.energy_0) / std::abs(t.energy_0);
}

std::string text(double value) {
    return fmt::format("{:.6g}", value);
}

template <class T>
std::string text(const std::optional<T>& value) {
    return value ? text(static_cast<double>(*value)) : "";
}

std::string joined(const Record& record, std::string Field::* part) {
    std::string line;
    for (const Field& f : record) {
        const std::string& t = f.*part;
        const bool is_quoted = t.find(',') != std::string::npos;
        line += (line.empty() && &f == &record.front() ? "" : ",") + (is_quoted ? "\"" + t + "\"" : t);
    }
    return line;
}

/// There for half a stretch, all velocities turned, and back.
double reversal_of(const StudyScene& s) {
    const double there = s.course.stretch / 2;
    Scene scene = s.scene;
    World forth(scene, {.threads = 1});
    const PlaneVectors start = forth.positions();
    forth.advance_to(there);
    scene.balls = forth.balls();
    for (Ball& b : scene.balls) b.velocity = -b.velocity;
    World back(scene, {.threads = 1});
    back.advance_to(there);
    return place_error(distances(start, back.positions(), scene), scene);
}

}  // namespace

std::string names_of(const Record& record) {
    return joined(record, &Field::name);
}

std::string values_of(const Record& record) {
    return joined(record, &Field::value);
}

TimeRatio time_ratio(const Scene& setting, const Scene& reference, const Course& course, int rounds) {
    std::vector<double> ratios;
    for (int round = 0; round < rounds; ++round) {
        double of_reference = 0;
        if (round % 2 == 0) of_reference = seconds_of(reference, course.duration());
        const double of_setting = seconds_of(setting, course.duration());
        if (round % 2 != 0) of_reference = seconds_of(reference, course.duration());
        ratios.push_back(of_setting / of_reference);
    }
    std::ranges::sort(ratios);
    const std::size_t n = ratios.size();
    return {(ratios[(n - 1) / 2] + ratios[n / 2]) / 2, ratios.front(), ratios.back()};
}

Reference reference_of(const StudyScene& s) {
    Reference r;
    r.trace = trace(s.scene, s.course);
    r.lyapunov = lyapunov_exponent(r.trace, trace(moved_a_little(s.scene), s.course), s.scene, s.course);
    r.is_same_on_domains = trace(s.scene, s.course, 4).hash == r.trace.hash;
    if (s.is_reversible()) r.reversal = reversal_of(s);
    const auto moving = static_cast<double>(std::ranges::count(s.scene.balls, false, &Ball::is_static));
    r.collisions_a_ball =
        static_cast<double>(2 * r.trace.counts.ball_collisions + r.trace.counts.wall_collisions) / moving;
    return r;
}

Matching matching_of(const StudyScene& s, const Trace& reference, const Trace& other) {
    std::vector<bool> moves;
    for (const Ball& b : s.scene.balls) moves.push_back(!b.is_static);
    return match(reference.meetings, other.meetings, moves,
                 {.window = s.course.stretch / 20, .until = 2 * s.course.stretch});
}

Record record_of(const StudyScene& s, const Reference& r) {
    const double duration = s.course.duration();
    std::optional<double> a_collision;
    if (r.lyapunov) a_collision = *r.lyapunov * duration / r.collisions_a_ball;
    return {{"scene", s.name},
            {"balls", std::to_string(s.scene.balls.size())},
            {"duration", text(duration)},
            {"collisions_a_ball", text(r.collisions_a_ball)},
            {"step_unit", text(s.unit)},
            {"lyapunov_exponent", text(r.lyapunov)},
            {"lyapunov_a_collision", text(a_collision)},
            {"same_hash_on_domains", r.is_same_on_domains ? "yes" : "no"},
            {"reversal_error", text(r.reversal)},
            {"energy_change", text(energy_change(r.trace))}};
}

Record record_of(const StudyScene& s, const Reference& r, const Setting& setting, const TimeRatio& time) {
    const Scene& scene = setting.scene;
    const Trace t = trace(scene, s.course);
    const Matching m = matching_of(s, r.trace, t);
    const std::optional<double> apart = separation_time(r.trace, t, s.scene, s.course);
    std::optional<double> in_lyapunov_times, momentum_error, pressure_error;
    if (apart && r.lyapunov) in_lyapunov_times = *apart * *r.lyapunov;
    if (s.keeps_momentum())
        momentum_error = std::sqrt(length_squared<double>(t.momentum_1 - t.momentum_0)) / t.speeds;
    if (t.pressure && r.trace.pressure) pressure_error = *t.pressure / *r.trace.pressure - 1;
    return {{"scene", s.name},
            {"setting", setting.name},
            {"method", scene.method == Method::kEvent ? "event" : "empirical"},
            {"precision", scene.precision == Precision::kDouble ? "double" : "float"},
            {"step", text(scene.step)},
            {"max_travel", text(scene.max_travel)},
            {"tolerance", text(scene.tolerance)},
            {"field_interval", s.scene.attractors.empty() ? "" : text(scene.field_interval)},
            {"contact_time", text(scene.contact_time)},
            {"steps", text(t.counts.steps)},
            {"time_ratio", text(time.median)},
            {"time_ratio_least", text(time.least)},
            {"time_ratio_most", text(time.most)},
            {"place_error",
             text(place_error(
                 distances(r.trace.places[Course::kSamples], t.places[Course::kSamples], s.scene), s.scene))},
            {"separation_time", text(apart)},
            {"separation_lyapunov_times", text(in_lyapunov_times)},
            {"compared", std::to_string(m.compared)},
            {"missed", std::to_string(m.missed)},
            {"invented", std::to_string(m.invented)},
            {"collisions", text(count_of(t))},
            {"engine_missed", text(t.counts.missed_collisions)},
            {"collision_count_error", text(count_of(t) / count_of(r.trace) - 1)},
            {"energy_change", text(energy_change(t))},
            {"energy_error", text(energy_change(t) - energy_change(r.trace))},
            {"momentum_error", text(momentum_error)},
            {"max_overlap", text(t.max_overlap)},
            {"pressure_error", text(pressure_error)}};
}

}  // namespace carom::bench
