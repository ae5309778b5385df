// Builds a world from a scene or a snapshot, keeps its time and the field's schedule, reads its balls.
#include "world_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <ranges>
#include <sstream>
#include <stdexcept>

#include <carom/broadphase/overlap.hpp>
#include <carom/broadphase/placement.hpp>

#include "physics.hpp"
#include "scene_hash.hpp"

namespace carom {
namespace {

/// All balls of the scene, in `placed` where they are not its own as they are: many would be long to copy.
const std::vector<Ball>& place_checked(const Scene& scene, std::vector<Ball>& placed) {
    check(scene);
    if (!scene.allows_overlap) check_overlaps(scene.balls, scene);  // those of fills are placed clear of all
    const bool in_double = scene.precision == Precision::kDouble;
    if (scene.fills.empty() && in_double) return scene.balls;
    placed = place_balls(scene);
    if (!in_double) std::ranges::for_each(placed, round_to_float);
    return placed;
}

/// The diameter that the cells follow: the largest, but for a few balls that may be larger than a cell.
double listed_diameter(const std::vector<Ball>& balls) {
    constexpr std::size_t kMostLarge = 16;
    const auto moves = [](const Ball& b) { return !b.is_static; };
    std::array<double, kMostLarge + 1> radii{};
    std::ranges::partial_sort_copy(balls | std::views::filter(moves) | std::views::transform(&Ball::radius),
                                   radii, std::greater<>());
    return 2 * (std::ranges::count_if(balls, moves) > 4 * std::ptrdiff_t{kMostLarge} ? radii.back()
                                                                                     : radii.front());
}

bool is_free(const Scene& scene, const std::vector<Ball>& balls) {
    return scene.gravity.isZero(0) && scene.attractors.empty() &&
           std::ranges::all_of(balls, [](const Ball& b) { return b.acceleration.isZero(0); });
}

/// A scene without its balls.
Scene rules_of(const Scene& scene) {
    Scene rules;
    rules.domain = scene.domain;
    rules.gravity = scene.gravity;
    rules.restitution_rule = scene.restitution_rule;
    rules.contact_time = scene.contact_time;
    rules.speed_factor = scene.speed_factor;
    rules.precision = scene.precision;
    rules.method = scene.method;
    rules.step = scene.step;
    rules.max_travel = scene.max_travel;
    rules.tolerance = scene.tolerance;
    rules.allows_overlap = scene.allows_overlap;
    rules.walls = scene.walls;
    rules.attractors = scene.attractors;
    rules.field_interval = scene.field_interval;
    rules.until = scene.until;
    return rules;
}

}  // namespace

void round_to_float(Ball& ball) {
    ball.position = rounded_to_float(ball.position);
    ball.velocity = rounded_to_float(ball.velocity);
}

std::string shown(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
}

Cast::Cast(Scene scene, const Physics& physics, const std::vector<Ball>& balls, double cell_size)
    : rules(std::move(scene)),
      bodies(physics, balls, rules.walls, rules.attractors,
             choose_grid(physics.domain, balls.size(), listed_diameter(balls), cell_size)),
      in_equilibrium(!physics.loses_energy && is_free(rules, balls)) {
    for (std::uint32_t i = 0; i < bodies.count; ++i)
        if (bodies.fixes(i))
            fixed_states.emplace_back(i, BallState{bodies.fixed[i], balls[i].velocity, bodies.fixed[i]});
    if (rules.allows_overlap) deepest_overlap = max_overlap(balls, rules);
}

World::State::State(const Scene& scene, const WorldOptions& options, const Snapshot* snapshot)
    : wanted(options), executor(options.threads), sensors(scene.sensors) {
    std::vector<Ball> placed;
    const std::vector<Ball>& balls = place_checked(scene, placed);
    const Physics physics = derive_physics(scene, balls);
    auto first = std::make_shared<Cast>(rules_of(scene), physics, balls, options.cell_size);
    hash = first->scene_hash = carom::scene_hash(first->rules, physics, balls, executor);
    cast = scene_cast = first;
    if (snapshot != nullptr)
        restore(*snapshot);
    else
        engine = make_engine(bodies(), start_at_zero(bodies(), balls), executor, options);
}

Snapshot World::State::snapshot_of(const Engine& e) const {
    Snapshot s;
    s.scene_hash = hash;
    s.time = seconds;
    s.field_updates = field_updates;
    s.counts = e.counts();
    s.virial = e.saved_virial();
    if (is_edited) s.edited = cast;
    e.save(now, s);
    return s;
}

World::State::Telling::Telling(State& state, bool moves) : state_(state) {
    if (state.is_telling_)
        throw std::logic_error("a listener must not change the world; do it after the step");
    state.is_telling_ = true;
    state.is_moving_ = moves;
}

void World::State::require_rest() const {
    if (is_moving_)
        throw std::logic_error(
            "a listener must not look at the world's balls, which are on their way; what it is told holds "
            "there "
            "and then");
}

void World::State::restore(const Snapshot& s) {
    const Telling telling(*this);
    check(s);
    const std::shared_ptr<const Cast> next = s.edited ? s.edited : scene_cast;
    continue_with(next, make_from(*next, s), s);
    watch_anew();
}

void World::State::check(const Snapshot& s) const {
    const Physics& physics = bodies().physics;
    if (s.method != (physics.empirical ? "empirical" : "event"))
        throw SnapshotError("is of the method '" + s.method + "'");
    const Cast& of = s.edited ? *s.edited : *scene_cast;
    if ((s.edited ? of.scene_hash : s.scene_hash) != scene_cast->scene_hash)
        throw SnapshotError("is of another scene");
    if (!(s.time >= 0) || physics.clock.from_seconds(s.time) == kNever)
        throw SnapshotError("is at no time that the scene comes to");
    const bool fits = of.rules.attractors.empty()
                          ? s.field_updates == 0
                          : double(s.field_updates) * of.rules.field_interval <= s.time &&
                                s.time < double(s.field_updates + 1) * of.rules.field_interval;
    if (!fits) throw SnapshotError("has another number of field updates than its time");
}

void World::State::continue_with(std::shared_ptr<const Cast> next, std::unique_ptr<Engine> made,
                                 const Snapshot& s) {
    if (listener) made->listen(listener);
    engine = std::move(made);
    has_stopped_midway_ = false;
    if (watch_) follow_flights();
    cast = std::move(next);
    hash = s.scene_hash;
    is_edited = s.edited != nullptr;
    field_updates = s.field_updates;
    seconds = s.time;
    now = bodies().physics.clock.from_seconds(seconds);
    forget();
    // Events, and what they have rounded, are counted from here on.
    inherited_overlap = bodies().physics.in_float ? max_overlap() : 0;
}

void World::State::watch_anew() {
    engine->follow(nullptr);
    watch_.reset();
    if (!sensing || sensors.empty()) return;
    watch_ = std::make_unique<SensorWatch>(bodies(), sensors, *engine, now);
    follow_flights();
}

void World::State::follow_flights() {
    engine->follow([this](const Stop& stop) { watch_->take(*engine, stop, sensing); });
}

void World::State::forget() {
    is_read_ = was_asked_ = false;
    places_.reset();
}

const std::vector<BallState>& World::State::states() const {
    require_rest();
    const std::lock_guard lock(reading_);
    if (!is_read_) {
        read(*engine, states_);
        is_read_ = was_asked_ = true;
    }
    return states_;
}

void World::State::read(const Engine& e, std::vector<BallState>& all) const {
    all.resize(size());
    visit_states(e, [&all](std::uint32_t index, const BallState& state) { all[index] = state; });
}

/// Those of static balls too.
void World::State::visit_states(const Engine& e, const Engine::VisitState& visit) const {
    for (const auto& [index, state] : cast->fixed_states) visit(index, state);
    e.visit_states(now, visit);
}

/// One vector of each ball's state. Who asks but once at a time, as whoever draws frames does, gets it
/// without all the states.
PlaneVectors World::State::vectors(Vec2 BallState::* part) const {
    require_rest();
    PlaneVectors out(size());
    if (was_asked_.exchange(true)) {
        std::ranges::transform(states(), out.begin(), part);
        return out;
    }
    visit_states(*engine,
                 [&out, part](std::uint32_t index, const BallState& state) { out[index] = state.*part; });
    return out;
}

const PlaceIndex& World::State::places() const {
    const std::vector<Ball> all = balls();
    const std::lock_guard lock(reading_);
    if (!places_) places_ = std::make_unique<PlaceIndex>(all, cast->rules);
    return *places_;
}

Ball World::State::ball(std::uint32_t index, const BallState& s) const {
    const Bodies& b = bodies();
    return {s.position,
            s.velocity,
            b.own_acceleration_of(index),
            b.radius.of(index),
            b.mass.of(index),
            b.restitution.of(index),
            b.fixes(index),
            b.filters.empty() ? CollisionFilter{} : b.filters[index]};
}

std::vector<Ball> World::State::balls() const {
    const std::vector<BallState>& all = states();
    std::vector<Ball> out(size());
    executor.for_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out[i] = ball(static_cast<std::uint32_t>(i), all[i]);
    });
    return out;
}

std::uint32_t World::State::index_of_ball(std::uint32_t id) const {
    const std::vector<std::uint32_t>& ids = bodies().ball_ids;
    const auto at = std::ranges::lower_bound(ids, id);
    const bool is_there = ids.empty() ? id < size() : at != ids.end() && *at == id;
    if (!is_there) throw std::out_of_range("balls[" + std::to_string(id) + "]: is not there");
    return ids.empty() ? id : static_cast<std::uint32_t>(at - ids.begin());
}

std::vector<std::uint32_t> World::State::named(std::vector<std::uint32_t> indices) const {
    for (std::uint32_t& i : indices) i = bodies().ball_id(i);
    return indices;
}

void World::State::advance_to(double time) {
    const Clock& clock = bodies().physics.clock;
    const Time end = clock.from_seconds(time);
    if (end == kNever)
        throw std::invalid_argument("time " + shown(time) + " is beyond what this scene's clock can tell");
    const double field_interval = cast->rules.field_interval;
    if (!bodies().attractors.empty() && time > kMostFieldUpdates * field_interval)
        throw std::invalid_argument("time " + shown(time) +
                                    " is more than a thousand million of the scene's field_interval away");
    const Telling telling(*this, true);
    forget();
    has_stopped_midway_ = true;
    Time horizon = kNever;
    if (!bodies().attractors.empty()) {
        for (;; ++field_updates) {
            const double next = double(field_updates + 1) * field_interval;
            horizon = clock.from_seconds(next);
            if (!(next <= time)) break;
            engine->advance_to(horizon, horizon);
            engine->renew_field(horizon);
        }
    }
    engine->advance_to(end, horizon);
    has_stopped_midway_ = false;
    now = end;
    seconds = time;
}

std::vector<Vector2<float>> World::State::in_float(Vec2 BallState::* part) const {
    const std::vector<BallState>& all = states();
    std::vector<Vector2<float>> out(all.size());
    executor.for_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out[i] = (all[i].*part).cast<float>();
    });
    return out;
}

double World::State::rounding_of_overlaps() const {
    constexpr double kInDouble = 1e-9;
    if (!bodies().physics.in_float) return kInDouble;
    double smallest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (std::uint32_t i = 0; i < size(); ++i) {
        smallest = std::min(smallest, bodies().radius.of(i));
        farthest = std::max(farthest, states()[i].position.cwiseAbs().maxCoeff());
    }
    // Each of two centres is rounded by up to half an ulp along either axis, anew at each event. Two that lie
    // on each other and move along together bounce in steps as like as their errors: these add up.
    const double roundings = 16 + std::numbers::sqrt2 * engine->most_events();
    return kInDouble + roundings * double(std::numeric_limits<float>::epsilon()) * farthest / (2 * smallest);
}

}  // namespace carom
