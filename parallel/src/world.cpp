// World: builds the event loop from a scene, keeps the time and the field's schedule, reads the state.
#include <carom/parallel/world.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

#include <carom/broadphase/overlap.hpp>
#include <carom/broadphase/placement.hpp>

#include "event_loop.hpp"
#include "executor.hpp"
#include "physics.hpp"

namespace carom {
namespace {

std::vector<Ball> place_checked(const Scene& scene) {
    check(scene);
    std::vector<Ball> balls = place_balls(scene);
    check_overlaps(balls, scene);
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

/// A mixing step of 64 bits (the finaliser of MurmurHash3).
std::uint64_t mix(std::uint64_t h) {
    h ^= h >> 33;
    h *= 0xff51afd7ed558ccdULL;
    h ^= h >> 33;
    h *= 0xc4ceb9fe1a85ec53ULL;
    return h ^ (h >> 33);
}

}  // namespace

class World::State {
 public:
    State(const Scene& scene, const WorldOptions& options)
        : executor(options.threads),
          walls(scene.walls),
          attractors(scene.attractors),
          field_interval(scene.field_interval) {
        const std::vector<Ball> balls = place_checked(scene);
        physics = derive_physics(scene, balls);
        in_equilibrium = !physics.loses_energy && scene.gravity.isZero(0) && scene.attractors.empty() &&
                         std::ranges::all_of(balls, [](const Ball& b) { return b.acceleration.isZero(0); });
        const Grid grid =
            choose_grid(physics.domain, balls.size(), listed_diameter(balls), options.cell_size);
        loop = make_event_loop(physics, balls, walls, attractors, grid, executor);
    }

    [[nodiscard]] std::size_t size() const { return loop->ball_count(); }
    [[nodiscard]] Ball ball(std::size_t id) const {
        return loop->ball_at(static_cast<std::uint32_t>(id), now);
    }

    /// Sum of quantity(id) over all moving balls, compensated.
    template <class Quantity>
    [[nodiscard]] double sum(Quantity&& quantity) const {
        return executor
            .sum(size(), CompensatedSum{},
                 [&](std::size_t first, std::size_t last) {
                     CompensatedSum s;
                     for (std::size_t i = first; i < last; ++i) {
                         const Ball b = ball(i);
                         if (!b.is_static) s += quantity(i, b);
                     }
                     return s;
                 })
            .value();
    }

    void advance_to(double time) {
        const Time end = physics.clock.from_seconds(time);
        if (end == kNever)
            throw std::invalid_argument("time " + shown(time) +
                                        " is beyond what this scene's clock can tell");
        if (!attractors.empty()) {
            for (;; ++field_updates) {
                const double next = double(field_updates + 1) * field_interval;
                if (!(next <= time)) break;
                const Time t = physics.clock.from_seconds(next);
                loop->advance_to(t);
                loop->update_field(t, attractors);
            }
        }
        loop->advance_to(end);
        now = end;
        seconds = time;
    }

    Executor executor;
    Physics physics;
    std::vector<Wall> walls;
    std::vector<Attractor> attractors;
    double field_interval;
    std::uint64_t field_updates = 0;
    bool in_equilibrium = false;  // neither losses nor forces, so that one temperature holds throughout
    std::unique_ptr<EventLoop> loop;
    Time now;
    double seconds = 0;
};

World::World(const Scene& scene, const WorldOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}
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
    return state_->walls.size();
}
int World::threads() const {
    return state_->executor.threads();
}
double World::cell_size() const {
    return state_->loop->grid().x.width();
}
double World::contact_time() const {
    return state_->physics.contact_time;
}
const Domain& World::domain() const {
    return state_->physics.domain;
}
Counts World::counts() const {
    return state_->loop->counts();
}
double World::virial() const {
    return state_->loop->virial();
}

PlaneVectors World::positions() const {
    PlaneVectors out(ball_count());
    state_->executor.for_ranges(ball_count(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out[i] = state_->ball(i).position;
    });
    return out;
}

PlaneVectors World::velocities() const {
    PlaneVectors out(ball_count());
    state_->executor.for_ranges(ball_count(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out[i] = state_->ball(i).velocity;
    });
    return out;
}

std::vector<Ball> World::balls() const {
    std::vector<Ball> out(ball_count());
    state_->executor.for_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out[i] = state_->ball(i);
    });
    return out;
}

double World::kinetic_energy() const {
    return state_->sum([](std::size_t, const Ball& b) { return b.mass / 2 * length_squared(b.velocity); });
}

double World::energy() const {
    return kinetic_energy() + state_->sum([this](std::size_t i, const Ball& b) {
        const Vec2 x = state_->loop->unwrapped_position_at(static_cast<std::uint32_t>(i), state_->now);
        return -b.mass * dot<double>(state_->physics.gravity + b.acceleration, x);
    });
}

Vec2 World::momentum() const {
    return {state_->sum([](std::size_t, const Ball& b) { return b.mass * b.velocity.x(); }),
            state_->sum([](std::size_t, const Ball& b) { return b.mass * b.velocity.y(); })};
}

std::optional<double> World::compressibility_factor() const {
    const Domain& d = domain();
    if (d.boundary[0] != Boundary::kPeriodic || d.boundary[1] != Boundary::kPeriodic || !(time() > 0))
        return std::nullopt;
    if (!state_->in_equilibrium) return std::nullopt;
    const double moving = state_->sum([](std::size_t, const Ball&) { return 1.0; });
    const double kinetic = kinetic_energy();
    if (moving < 2 || !(kinetic > 0)) return std::nullopt;
    // NkT with the centre of mass at rest: 2 (N - 1) degrees of freedom share the kinetic energy.
    return 1 + virial() * (moving - 1) / (2 * moving * kinetic * time());
}

double World::max_overlap() const {
    Scene surroundings;
    surroundings.domain = domain();
    surroundings.walls = state_->walls;
    return carom::max_overlap(balls(), surroundings);
}

std::uint64_t World::state_hash() const {
    return state_->executor.sum(ball_count(), std::uint64_t{0}, [this](std::size_t first, std::size_t last) {
        std::uint64_t sum = 0;
        for (std::size_t i = first; i < last; ++i) {
            const Ball b = state_->ball(i);
            std::uint64_t h = mix(i + 1);
            for (const double x : {b.position.x(), b.position.y(), b.velocity.x(), b.velocity.y()})
                h = mix(h ^ std::bit_cast<std::uint64_t>(x)) + h;
            sum += h;
        }
        return sum;
    });
}

std::vector<Violation> World::validate() const {
    std::vector<Violation> found;
    state_->loop->audit(found);
    constexpr double kRounding = 1e-9;
    if (const double deepest = max_overlap(); !(deepest <= kRounding))
        found.push_back({"two bodies overlap by " + std::to_string(deepest) + " of their radii's sum"});
    return found;
}

void World::on_collision(std::function<void(const Collision&)> listener) {
    state_->loop->listener = std::move(listener);
}

}  // namespace carom
