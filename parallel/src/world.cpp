// World: builds the event loop from a scene, keeps the time and the field's schedule, reads the state.
#include <carom/parallel/world.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <sstream>
#include <stdexcept>

#include <carom/broadphase/overlap.hpp>
#include <carom/broadphase/placement.hpp>

#include "engine.hpp"
#include "executor.hpp"
#include "hash.hpp"
#include "physics.hpp"
#include "scene_hash.hpp"

namespace carom {
namespace {

std::vector<Ball> place_checked(const Scene& scene) {
    check(scene);
    std::vector<Ball> balls = place_balls(scene);
    if (!scene.allows_overlap) check_overlaps(balls, scene);
    if (scene.precision == Precision::kFloat) {
        for (Ball& b : balls) {
            b.position = rounded_to_float(b.position);
            b.velocity = rounded_to_float(b.velocity);
        }
    }
    return balls;
}

/// The diameter that the cells follow: the largest, but for a few balls that may be larger than a cell.
double listed_diameter(const std::vector<Ball>& balls) {
    constexpr std::size_t kMostLarge = 16;
    std::vector<double> diameters;
    diameters.reserve(balls.size());
    for (const Ball& b : balls)
        if (!b.is_static) diameters.push_back(2 * b.radius);
    if (diameters.empty()) return 0;
    const std::size_t larger = diameters.size() > 4 * kMostLarge ? kMostLarge : 0;
    std::ranges::nth_element(diameters, diameters.begin() + static_cast<std::ptrdiff_t>(larger),
                             std::greater<>());
    return diameters[larger];
}

/// A sum that carries what its terms lose (Neumaier 1974).
struct CompensatedSum {
    double sum = 0;
    double lost = 0;
    CompensatedSum& operator+=(double x) {
        const double next = sum + x;
        lost += std::abs(sum) >= std::abs(x) ? (sum - next) + x : (x - next) + sum;
        sum = next;
        return *this;
    }
    CompensatedSum& operator+=(const CompensatedSum& other) {
        *this += other.sum;
        lost += other.lost;
        return *this;
    }
    [[nodiscard]] double value() const { return sum + lost; }
};

std::string shown(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
}

}  // namespace

class World::State {
 public:
    /// From the scene's beginning where `snapshot` is null.
    State(const Scene& scene, const WorldOptions& options, const Snapshot* snapshot)
        : State(scene, options, snapshot, place_checked(scene)) {}
    State(const Scene& scene, const WorldOptions& options, const Snapshot* snapshot,
          const std::vector<Ball>& balls)
        : State(scene, options, snapshot, balls, derive_physics(scene, balls)) {}
    State(const Scene& scene, const WorldOptions& options, const Snapshot* snapshot,
          const std::vector<Ball>& balls, const Physics& physics)
        : wanted(options),
          executor(options.threads),
          field_interval(scene.field_interval),
          allows_overlap(scene.allows_overlap),
          in_equilibrium(!physics.loses_energy && is_free(scene, balls)),
          bodies(physics, balls, scene.walls, scene.attractors,
                 choose_grid(physics.domain, balls.size(), listed_diameter(balls), options.cell_size)),
          hash_of_scene(carom::scene_hash(scene, physics, balls, executor)) {
        if (snapshot != nullptr)
            restore(*snapshot);
        else
            engine = make_engine(bodies, start_at_zero(bodies, balls), executor, options);
        for (std::uint32_t i = 0; i < bodies.count; ++i)
            if (bodies.fixes(i))
                fixed_states.emplace_back(i, BallState{bodies.fixed[i], balls[i].velocity, bodies.fixed[i]});
        if (allows_overlap) overlap_at_start = carom::max_overlap(balls, surroundings());
    }

    [[nodiscard]] Snapshot snapshot() const {
        Snapshot s;
        s.scene_hash = hash_of_scene;
        s.time = seconds;
        s.field_updates = field_updates;
        s.counts = engine->counts();
        s.virial = engine->saved_virial();
        engine->save(now, s);
        return s;
    }

    void restore(const Snapshot& s) {
        check(s);
        std::unique_ptr<Engine> restored =
            make_engine(bodies, start_from(bodies, s, executor), executor, wanted);
        if (listener) restored->listen(listener);
        engine = std::move(restored);
        field_updates = s.field_updates;
        seconds = s.time;
        now = bodies.physics.clock.from_seconds(seconds);
        is_read = false;
    }

    void check(const Snapshot& s) const {
        if (bodies.physics.empirical) throw SnapshotError("cannot be gone on from by the empirical method");
        if (s.method != "event") throw SnapshotError("is of the method '" + s.method + "'");
        if (s.scene_hash != hash_of_scene) throw SnapshotError("is of another scene");
        if (!(s.time >= 0) || bodies.physics.clock.from_seconds(s.time) == kNever)
            throw SnapshotError("is at no time that the scene comes to");
        const bool fits = bodies.attractors.empty()
                              ? s.field_updates == 0
                              : double(s.field_updates) * field_interval <= s.time &&
                                    s.time < double(s.field_updates + 1) * field_interval;
        if (!fits) throw SnapshotError("has another number of field updates than its time");
    }

    [[nodiscard]] std::size_t size() const { return bodies.count; }

    /// Every ball's state now, by id; read once for each time.
    [[nodiscard]] const std::vector<BallState>& states() const {
        const std::lock_guard lock(reading);
        if (!is_read) {
            read_states.resize(size());
            for (const auto& [id, state] : fixed_states) read_states[id] = state;
            engine->read(now, read_states);
            is_read = true;
        }
        return read_states;
    }
    [[nodiscard]] Ball ball(std::uint32_t id, const BallState& s) const {
        return {s.position,           s.velocity,         bodies.own_acceleration_of(id),
                bodies.radius.of(id), bodies.mass.of(id), bodies.restitution.of(id),
                bodies.fixes(id)};
    }

    /// Sum of quantity(id, state) over all moving balls, compensated.
    template <class Quantity>
    [[nodiscard]] double sum(Quantity&& quantity) const {
        const std::vector<BallState>& all = states();
        return executor
            .sum(size(), CompensatedSum{},
                 [&](std::size_t first, std::size_t last) {
                     CompensatedSum s;
                     for (std::size_t i = first; i < last; ++i) {
                         const auto id = static_cast<std::uint32_t>(i);
                         if (!bodies.fixes(id)) s += quantity(id, all[i]);
                     }
                     return s;
                 })
            .value();
    }

    void advance_to(double time) {
        const Time end = bodies.physics.clock.from_seconds(time);
        if (end == kNever)
            throw std::invalid_argument("time " + shown(time) +
                                        " is beyond what this scene's clock can tell");
        if (!bodies.attractors.empty() && time > kMostFieldUpdates * field_interval)
            throw std::invalid_argument(
                "time " + shown(time) +
                " is more than a thousand million of the scene's field_interval away");
        is_read = false;
        Time horizon = kNever;
        if (!bodies.attractors.empty()) {
            for (;; ++field_updates) {
                const double next = double(field_updates + 1) * field_interval;
                horizon = bodies.physics.clock.from_seconds(next);
                if (!(next <= time)) break;
                engine->advance_to(horizon, horizon);
                engine->renew_field(horizon);
            }
        }
        engine->advance_to(end, horizon);
        now = end;
        seconds = time;
    }

    [[nodiscard]] std::vector<Ball> balls() const {
        const std::vector<BallState>& all = states();
        std::vector<Ball> out(size());
        executor.for_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) out[i] = ball(static_cast<std::uint32_t>(i), all[i]);
        });
        return out;
    }

    [[nodiscard]] std::vector<Vector2<float>> in_float(Vec2 BallState::* part) const {
        const std::vector<BallState>& all = states();
        std::vector<Vector2<float>> out(all.size());
        executor.for_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) out[i] = (all[i].*part).cast<float>();
        });
        return out;
    }

    [[nodiscard]] Scene surroundings() const {
        Scene scene;
        scene.domain = bodies.physics.domain;
        scene.walls = bodies.walls;
        return scene;
    }
    [[nodiscard]] double max_overlap() const { return carom::max_overlap(balls(), surroundings()); }

    /// How deep rounding alone may let two bodies overlap, in units of their radii's sum.
    [[nodiscard]] double rounding_of_overlaps() const {
        constexpr double kInDouble = 1e-9;
        if (!bodies.physics.in_float) return kInDouble;
        double smallest = std::numeric_limits<double>::infinity();
        double farthest = 0;
        for (std::uint32_t id = 0; id < bodies.count; ++id) {
            smallest = std::min(smallest, bodies.radius.of(id));
            farthest = std::max(farthest, states()[id].position.cwiseAbs().maxCoeff());
        }
        // Each of two centres is rounded by half an ulp along either axis.
        return kInDouble + 2 * double(std::numeric_limits<float>::epsilon()) * farthest / (2 * smallest);
    }

    static bool is_free(const Scene& scene, const std::vector<Ball>& balls) {
        return scene.gravity.isZero(0) && scene.attractors.empty() &&
               std::ranges::all_of(balls, [](const Ball& b) { return b.acceleration.isZero(0); });
    }
    WorldOptions wanted;
    Executor executor;
    double field_interval;
    bool allows_overlap;
    double overlap_at_start = 0;  // deepest, where overlaps are allowed
    std::uint64_t field_updates = 0;
    bool in_equilibrium;  // neither losses nor forces, so that one temperature holds throughout
    Bodies bodies;
    std::uint64_t hash_of_scene;
    std::function<void(const Collision&)> listener;
    std::unique_ptr<Engine> engine;
    std::vector<std::pair<std::uint32_t, BallState>> fixed_states;
    Time now;
    double seconds = 0;
    mutable std::mutex reading;
    mutable bool is_read = false;
    mutable std::vector<BallState> read_states;
};

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
    advance_to(time() + dt);
}

double World::time() const {
    return state_->seconds;
}
std::size_t World::ball_count() const {
    return state_->size();
}
std::size_t World::wall_count() const {
    return state_->bodies.walls.size();
}
int World::threads() const {
    return state_->executor.threads();
}
double World::cell_size() const {
    return state_->bodies.grid.x.width();
}
double World::contact_time() const {
    return state_->bodies.physics.contact_time;
}
const Domain& World::domain() const {
    return state_->bodies.physics.domain;
}
Kernel World::kernel() const {
    return state_->bodies.kernel();
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
    const std::vector<BallState>& states = state_->states();
    PlaneVectors out(states.size());
    std::ranges::transform(states, out.begin(), &BallState::position);
    return out;
}

PlaneVectors World::velocities() const {
    const std::vector<BallState>& states = state_->states();
    PlaneVectors out(states.size());
    std::ranges::transform(states, out.begin(), &BallState::velocity);
    return out;
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
    const Property& mass = state_->bodies.mass;
    return state_->sum([&mass](std::uint32_t id, const BallState& s) {
        return mass.of(id) / 2 * length_squared(s.velocity);
    });
}

double World::energy() const {
    const Bodies& bodies = state_->bodies;
    return kinetic_energy() + state_->sum([&bodies](std::uint32_t id, const BallState& s) {
        return -bodies.mass.of(id) *
               dot<double>(bodies.physics.gravity + bodies.own_acceleration_of(id), s.unwrapped);
    });
}

Vec2 World::momentum() const {
    const Property& mass = state_->bodies.mass;
    return {
        state_->sum([&mass](std::uint32_t id, const BallState& s) { return mass.of(id) * s.velocity.x(); }),
        state_->sum([&mass](std::uint32_t id, const BallState& s) { return mass.of(id) * s.velocity.y(); })};
}

std::optional<double> World::compressibility_factor() const {
    const Domain& d = domain();
    if (d.boundary[0] != Boundary::kPeriodic || d.boundary[1] != Boundary::kPeriodic || !(time() > 0))
        return std::nullopt;
    if (!state_->in_equilibrium) return std::nullopt;
    const double moving = state_->bodies.moving;
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
    return state_->executor.sum(ball_count(), std::uint64_t{0},
                                [&states](std::size_t first, std::size_t last) {
                                    std::uint64_t sum = 0;
                                    for (std::size_t i = first; i < last; ++i) {
                                        const BallState& b = states[i];
                                        sum += (Hash{mix(i + 1)} << b.position << b.velocity).value;
                                    }
                                    return sum;
                                });
}

std::vector<Violation> World::validate() const {
    std::vector<Violation> found;
    state_->engine->audit(found);
    if (state_->bodies.physics.empirical) return found;  // finds contacts by the overlaps that steps leave
    // An overlap that was there at the start is never deepened: a pair in it is hit where it approaches.
    const double allowed = state_->rounding_of_overlaps() + state_->overlap_at_start;
    if (const double deepest = max_overlap(); !(deepest <= allowed))
        found.push_back({"two bodies overlap by " + std::to_string(deepest) + " of their radii's sum"});
    return found;
}

std::uint64_t World::scene_hash() const {
    return state_->hash_of_scene;
}

Snapshot World::snapshot() const {
    return state_->snapshot();
}

void World::restore(const Snapshot& snapshot) {
    state_->restore(snapshot);
}

void World::on_collision(std::function<void(const Collision&)> listener) {
    state_->listener = std::move(listener);
    state_->engine->listen(state_->listener);
}

}  // namespace carom
