// World: who is there and where, and edits of one thing.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "world_state.hpp"

namespace carom {
namespace {

void require_finite(double value, const char* what) {
    if (!std::isfinite(value)) throw std::invalid_argument(std::string(what) + " must be finite");
}

void require_finite(const Vec2& v, const char* what) {
    require_finite(v.x(), what);
    require_finite(v.y(), what);
}

/// Ids that may be the indices.
std::vector<std::uint32_t> all_ids(const std::vector<std::uint32_t>& ids, std::size_t count) {
    if (!ids.empty()) return ids;
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), std::uint32_t{0});
    return indices;
}

}  // namespace

std::vector<std::uint32_t> World::ball_ids() const {
    return all_ids(state_->bodies().ball_ids, ball_count());
}
std::vector<std::uint32_t> World::wall_ids() const {
    return all_ids(state_->bodies().wall_ids, wall_count());
}
const std::vector<Wall>& World::walls() const {
    return state_->bodies().walls;
}
const std::vector<Attractor>& World::attractors() const {
    return state_->bodies().attractors;
}
const Vec2& World::gravity() const {
    return state_->bodies().physics.gravity;
}

bool World::has_ball(std::uint32_t id) const {
    const Bodies& bodies = state_->bodies();
    return bodies.ball_ids.empty() ? id < bodies.count : std::ranges::binary_search(bodies.ball_ids, id);
}

Ball World::ball(std::uint32_t id) const {
    const std::uint32_t index = state_->index_of_ball(id);
    return state_->ball(index, state_->states()[index]);
}

const std::vector<Sensor>& World::sensors() const {
    return state_->sensors;
}

void World::set_sensors(std::vector<Sensor> sensors) {
    for (std::size_t k = 0; k < sensors.size(); ++k) check(sensors[k], k);
    if (state_->bodies().physics.empirical && !sensors.empty())
        throw std::logic_error("the empirical method knows no sensors");
    const State::Telling telling(*state_);
    state_->sensors = std::move(sensors);
    state_->watch_anew();
}

std::vector<std::uint32_t> World::balls_in_sensor(std::uint32_t sensor) const {
    if (sensor >= state_->sensors.size())
        throw std::out_of_range("sensors[" + std::to_string(sensor) + "]: is not there");
    state_->require_rest();
    const std::vector<Sensor> one = {state_->sensors[sensor]};
    const SensorWatch watch(state_->bodies(), one, *state_->engine, state_->now);
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < ball_count(); ++i)
        if (!watch.inside()[i].empty()) found.push_back(state_->bodies().ball_id(i));
    return found;
}

void World::on_sensing(std::function<void(const Sensing&)> listener) {
    if (state_->bodies().physics.empirical && listener)
        throw std::logic_error("the empirical method knows no sensors");
    const State::Telling telling(*state_);
    state_->sensing = std::move(listener);
    state_->watch_anew();
}

std::uint64_t World::user_data(std::uint32_t id) const {
    static_cast<void>(state_->index_of_ball(id));
    return id < state_->user_data.size() ? state_->user_data[id] : 0;
}

void World::set_user_data(std::uint32_t id, std::uint64_t data) {
    static_cast<void>(state_->index_of_ball(id));
    if (id >= state_->user_data.size()) state_->user_data.resize(std::size_t{id} + 1);
    state_->user_data[id] = data;
}

Added World::apply(const Edits& edits) {
    return state_->apply(edits);
}
std::uint32_t World::add_ball(const Ball& ball) {
    return apply({.added_balls = {ball}}).balls.front();
}
void World::remove_ball(std::uint32_t id) {
    apply({.removed_balls = {id}});
}
void World::set_position(std::uint32_t id, const Vec2& position) {
    apply({.changed_balls = {{.id = id, .position = position}}});
}
void World::set_velocity(std::uint32_t id, const Vec2& velocity) {
    apply({.changed_balls = {{.id = id, .velocity = velocity}}});
}
void World::set_acceleration(std::uint32_t id, const Vec2& acceleration) {
    apply({.changed_balls = {{.id = id, .acceleration = acceleration}}});
}
void World::set_radius(std::uint32_t id, double radius) {
    apply({.changed_balls = {{.id = id, .radius = radius}}});
}
void World::set_mass(std::uint32_t id, double mass) {
    apply({.changed_balls = {{.id = id, .mass = mass}}});
}
void World::set_restitution(std::uint32_t id, double restitution) {
    apply({.changed_balls = {{.id = id, .restitution = restitution}}});
}
void World::apply_impulse(std::uint32_t id, const Vec2& impulse) {
    const Ball b = ball(id);
    set_velocity(id, b.velocity + impulse / b.mass);
}
std::uint32_t World::add_wall(const Wall& wall) {
    return apply({.added_walls = {wall}}).walls.front();
}
void World::remove_wall(std::uint32_t id) {
    apply({.removed_walls = {id}});
}
void World::set_attractors(const std::vector<Attractor>& attractors) {
    apply({.attractors = attractors});
}
void World::set_gravity(const Vec2& gravity) {
    apply({.gravity = gravity});
}

std::vector<std::uint32_t> World::balls_in(const Box& box) const {
    require_finite(box.min, "a box");
    require_finite(box.max, "a box");
    return state_->named(state_->places().within(box));
}

std::vector<std::uint32_t> World::balls_at(const Vec2& centre, double radius) const {
    require_finite(centre, "a place");
    require_finite(radius, "a radius");
    return state_->named(state_->places().within(centre, radius));
}

std::optional<NearestBall> World::nearest_ball(const Vec2& point, std::optional<std::uint32_t> except) const {
    require_finite(point, "a place");
    const std::uint32_t left_out = except ? state_->index_of_ball(*except) : PlaceIndex::kNobody;
    std::optional<NearestBall> found = state_->places().nearest(point, left_out);
    if (found) found->id = state_->bodies().ball_id(found->id);
    return found;
}

std::optional<RayHit> World::cast_ray(const Vec2& from, const Vec2& direction, double length) const {
    require_finite(from, "where a ray starts");
    require_finite(direction, "a ray's direction");
    if (!(length >= 0)) throw std::invalid_argument("a ray's length must be >= 0");
    const double norm = std::sqrt(length_squared(direction));
    if (!(norm > 0)) throw std::invalid_argument("a ray's direction must not be zero");
    std::optional<RayHit> hit = state_->places().first_along(from, direction / norm, length);
    if (!hit) return hit;
    const Bodies& bodies = state_->bodies();
    hit->id = hit->kind == CollisionKind::kBall ? bodies.ball_id(hit->id) : bodies.wall_id(hit->id);
    return hit;
}

}  // namespace carom
