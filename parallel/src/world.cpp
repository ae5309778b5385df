// World: the face of the state, and the measures of it.
#include <carom/parallel/world.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <carom/broadphase/overlap.hpp>

#include "hash.hpp"
#include "world_state.hpp"

namespace carom {

World::World(const Scene& scene, const WorldOptions& options)
    : state_(std::make_unique<State>(scene, options, nullptr)) {}
World::World(const Scene& scene, const WorldOptions& options, const Snapshot& snapshot)
    : state_(std::make_unique<State>(scene, options, &snapshot)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::advance_to(double time) {
    if (!(time >= state_->seconds) || !std::isfinite(time))
        throw std::invalid_argument("cannot advance from time " + shown(state_->seconds) + " to " +
                                    shown(time));
    state_->advance_to(time);
}

void World::step(double dt) {
    if (!(dt >= 0)) throw std::invalid_argument("a step must be >= 0, is " + shown(dt));
    advance_to(time() + dt);
}

double World::time() const {
    return state_->seconds;
}
std::size_t World::ball_count() const {
    return state_->size();
}
std::size_t World::wall_count() const {
    return state_->bodies().walls.size();
}
int World::threads() const {
    return state_->executor.threads();
}
double World::cell_size() const {
    return state_->bodies().grid.x.width();
}
double World::contact_time() const {
    return state_->bodies().physics.contact_time;
}
const Domain& World::domain() const {
    return state_->bodies().physics.domain;
}
Kernel World::kernel() const {
    return state_->bodies().kernel();
}
Counts World::counts() const {
    return state_->engine->counts();
}
double World::working_seconds() const {
    return state_->engine->working_seconds();
}
double World::virial() const {
    return state_->engine->virial();
}

PlaneVectors World::positions() const {
    return state_->vectors(&BallState::position);
}

PlaneVectors World::velocities() const {
    return state_->vectors(&BallState::velocity);
}

PlaneVectors World::unwrapped_positions() const {
    return state_->vectors(&BallState::unwrapped);
}

std::vector<Ball> World::balls() const {
    return state_->balls();
}

std::vector<std::uint32_t> World::domains_of_balls() const {
    std::vector<std::uint32_t> domains(ball_count(), 0);
    state_->engine->read_domains(domains);
    return domains;
}

double World::kinetic_energy() const {
    const Property& mass = state_->bodies().mass;
    return state_->sum([&mass](std::uint32_t id, const BallState& s) {
        return mass.of(id) / 2 * length_squared(s.velocity);
    });
}

double World::energy() const {
    const Bodies& bodies = state_->bodies();
    return kinetic_energy() + state_->sum([&bodies](std::uint32_t id, const BallState& s) {
        return -bodies.mass.of(id) *
               dot<double>(bodies.physics.gravity + bodies.own_acceleration_of(id), s.unwrapped);
    });
}

Vec2 World::momentum() const {
    const Property& mass = state_->bodies().mass;
    return {
        state_->sum([&mass](std::uint32_t id, const BallState& s) { return mass.of(id) * s.velocity.x(); }),
        state_->sum([&mass](std::uint32_t id, const BallState& s) { return mass.of(id) * s.velocity.y(); })};
}

std::optional<double> World::compressibility_factor() const {
    const Domain& d = domain();
    if (d.boundary[0] != Boundary::kPeriodic || d.boundary[1] != Boundary::kPeriodic || !(time() > 0))
        return std::nullopt;
    if (state_->is_edited || !state_->cast->in_equilibrium) return std::nullopt;
    const double moving = state_->bodies().moving;
    const double kinetic = kinetic_energy();
    if (moving < 2 || !(kinetic > 0)) return std::nullopt;
    // NkT with the centre of mass at rest: 2 (N - 1) degrees of freedom share the kinetic energy.
    return 1 + virial() * (moving - 1) / (2 * moving * kinetic * time());
}

std::vector<Vector2<float>> World::positions_in_float() const {
    return state_->in_float(&BallState::position);
}

std::vector<Vector2<float>> World::velocities_in_float() const {
    return state_->in_float(&BallState::velocity);
}

double World::max_overlap() const {
    return state_->max_overlap();
}

std::uint64_t World::state_hash() const {
    const std::vector<BallState>& states = state_->states();
    const Bodies& bodies = state_->bodies();
    return state_->executor.sum(
        ball_count(), std::uint64_t{0}, [&states, &bodies](std::size_t first, std::size_t last) {
            std::uint64_t sum = 0;
            for (std::size_t i = first; i < last; ++i) {
                const BallState& b = states[i];
                sum += (Hash{mix(bodies.ball_id(static_cast<std::uint32_t>(i)) + 1ULL)} << b.position
                                                                                        << b.velocity)
                           .value;
            }
            return sum;
        });
}

std::vector<Violation> World::validate() const {
    std::vector<Violation> found;
    state_->engine->audit(found);
    if (state_->bodies().physics.empirical) return found;  // finds contacts by the overlaps that steps leave
    // An overlap that was there at the start is never deepened: a pair in it is hit where it approaches.
    const double allowed =
        state_->rounding_of_overlaps() + state_->cast->deepest_overlap + state_->inherited_overlap;
    if (const double deepest = max_overlap(); !(deepest <= allowed))
        found.push_back({"two bodies overlap by " + shown(deepest) + " of their radii's sum"});
    return found;
}

std::uint64_t World::scene_hash() const {
    return state_->hash;
}

Snapshot World::snapshot() const {
    return state_->snapshot();
}

void World::restore(const Snapshot& snapshot) {
    state_->restore(snapshot);
}

void World::on_collision(std::function<void(const Collision&)> listener) {
    const State::Telling telling(*state_);
    state_->listener = std::move(listener);
    state_->engine->listen(state_->listener);
}

}  // namespace carom
