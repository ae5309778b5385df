#include "study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <carom/trade/errors.hpp>
#include <carom/trade/settings.hpp>

namespace carom::bench {
namespace {

using trade::Course;
using trade::TimeRatio;
using trade::Trace;

double count_of(const Trace& t) {
    return static_cast<double>(t.counts.ball_collisions + t.counts.wall_collisions);
}

/// Over the most kinetic energy that the reference has had: the zero of the potential does not matter.
double energy_change(const Trace& t, const Trace& reference) {
    return (t.energy_1 - t.energy_0) / reference.most_kinetic_energy;
}

/// Of the places after a stretch.
double place_error_of(const StudyScene& s, const Trace& reference, const Trace& other) {
    return trade::place_error(trade::distances(reference.after_stretch, other.after_stretch, s.scene),
                              s.scene);
}

/// In Lyapunov times, where there is such a time and an exponent.
std::optional<double> in_lyapunov_times(std::optional<double> time, const Reference& r) {
    if (!time || !r.lyapunov) return std::nullopt;
    return *time * *r.lyapunov;
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
    return trade::place_error(trade::distances(start, back.positions(), scene), scene);
}

}  // namespace

std::string names_of(const Record& record) {
    return joined(record, &Field::name);
}

std::string values_of(const Record& record) {
    return joined(record, &Field::value);
}

Reference reference_of(const StudyScene& s) {
    Reference r;
    r.trace = trade::trace(s.reference, s.course);
    const Trace moved = trade::trace(trade::moved_a_little(s.reference), s.course);
    r.lyapunov = trade::lyapunov_exponent(r.trace, moved, s.scene, s.course);
    r.is_same_on_domains = trade::trace(s.reference, s.course, {.domains = 4}).hash == r.trace.hash;
    if (s.is_reversible()) r.reversal = reversal_of(s);
    if (!s.scene.attractors.empty()) {
        Scene rougher = s.reference;
        rougher.field_interval *= 2;
        const Course first{.stretch = s.course.stretch, .is_detailed = false};
        r.field = place_error_of(s, r.trace, trade::trace(rougher, first));
    }
    r.collisions_a_ball =
        static_cast<double>(2 * r.trace.counts.ball_collisions + r.trace.counts.wall_collisions) /
        trade::moving_balls(s.scene);
    return r;
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
            {"field_error", text(r.field)},
            {"energy_change", text(energy_change(r.trace, r.trace))}};
}

Record record_of(const StudyScene& s, const Reference& r, const Setting& setting,
                 const std::optional<trade::TimeRatio>& time) {
    const Scene& scene = setting.scene;
    const Trace t = trade::trace(scene, s.course);
    const trade::Matching m = trade::matching_of(s.scene, s.course, r.trace, t);
    const std::optional<double> diverges = trade::divergence_time(s.scene, s.course, r.trace, t);
    const std::optional<double> apart = trade::separation_time(r.trace, t, s.scene, s.course);
    const auto of_time = [&](double TimeRatio::* part) {
        return time ? std::optional(*time.*part) : std::nullopt;
    };
    std::optional<double> momentum_error, pressure_error, overlap_at_steps;
    if (scene.method == Method::kEmpirical && scene.step) overlap_at_steps = t.max_overlap;
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
            {"time_ratio", text(of_time(&TimeRatio::median))},
            {"time_ratio_least", text(of_time(&TimeRatio::least))},
            {"time_ratio_most", text(of_time(&TimeRatio::most))},
            {"time_rounds", time ? std::to_string(time->rounds) : ""},
            {"event_seconds", text(of_time(&TimeRatio::seconds))},
            {"place_error", text(place_error_of(s, r.trace, t))},
            {"first_fault_lyapunov_times", text(in_lyapunov_times(diverges, r))},
            {"separation_time", text(apart)},
            {"separation_lyapunov_times", text(in_lyapunov_times(apart, r))},
            {"compared", std::to_string(m.compared)},
            {"missed", std::to_string(m.missed)},
            {"invented", std::to_string(m.invented)},
            {"collisions", text(count_of(t))},
            {"engine_missed", text(t.counts.missed_collisions)},
            {"collision_count_error", text(count_of(t) / count_of(r.trace) - 1)},
            {"energy_change", text(energy_change(t, r.trace))},
            {"energy_error", text(energy_change(t, r.trace) - energy_change(r.trace, r.trace))},
            {"momentum_error", text(momentum_error)},
            {"overlap_at_steps", text(overlap_at_steps)},
            {"overlap_between", text(std::max(t.max_overlap, t.overlap_between))},
            {"pressure_error", text(pressure_error)}};
}

}  // namespace carom::bench
