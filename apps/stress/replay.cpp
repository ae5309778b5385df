#include "replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <carom/core/response.hpp>

namespace carom::stress {
namespace {

constexpr double kRoundingOfDouble = 0x1p-53;
constexpr double kRoundingOfFloat = 0x1p-24;
// A collision rounds some ten numbers on its way, each by half an ulp of the largest among them.
constexpr double kRoundings = 16;

double length(const Vec2& v) {
    return std::sqrt(length_squared<double>(v));
}

double farthest(const Box& box) {
    return length(box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()));
}

}  // namespace

Replay::Replay(const Scene& scene, const World& world) {
    start_anew(scene, world);
}

void Replay::start_anew(const Scene& scene, const World& world) {
    scene_ = scene;
    ids_ = world.ball_ids();
    wall_ids_ = world.wall_ids();
    follows_velocities_ = scene.attractors.empty() && scene.speed_factor == 1;
    rounding_ = scene.precision == Precision::kFloat ? kRoundingOfFloat : kRoundingOfDouble;
    const Physics physics = derive_physics(scene, scene.balls);
    rest_time_ = std::max(rest_time_, physics.rest_time);
    empirical_ = physics.empirical;
    corner_ = farthest(world.domain().box);
    energy_ = world.energy();
    energy_gained_ = 0;
    energy_doubt_ = 0;
    courses_.clear();
    const PlaneVectors places = world.unwrapped_positions();
    for (std::size_t i = 0; i < ids_.size(); ++i) {
        const Ball& b = scene.balls[i];
        Course& c = courses_.emplace_back();
        c.velocity = b.velocity;
        c.acceleration = b.is_static ? Vec2(Vec2::Zero()) : Vec2(scene.gravity + b.acceleration);
        c.time = world.time();
        c.reach = length(places[i]) + corner_;
        c.fastest = length(b.velocity);
        // What is shown of a ball that is on its way is rounded, its way itself is not.
        if (c.time > 0)
            c.doubt = 4 * (rounding_ * c.fastest + kRoundingOfDouble * length(c.acceleration) * c.time);
    }
}

std::size_t Replay::index_of(std::uint32_t id) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(ids_, id) - ids_.begin());
}

/// Sides are numbered after the last wall.
bool Replay::has_partner(const Collision& c) const {
    if (c.kind == CollisionKind::kBall) return c.i != c.j && std::ranges::binary_search(ids_, c.j);
    const std::uint32_t first_side = wall_ids_.empty() ? 0 : wall_ids_.back() + 1;
    return (c.j >= first_side && c.j < first_side + 4) || std::ranges::binary_search(wall_ids_, c.j);
}

void Replay::blame(const Collision& c, const std::string& what, double found, double bound) {
    if (!fault_.empty()) return;
    fault_ =
        fmt::format("collision {} at time {}, ball {} with {} {}: {}: {:.6g}, may be {:.6g}", collisions_,
                    c.time, c.i, c.kind == CollisionKind::kBall ? "ball" : "wall", c.j, what, found, bound);
}

bool Replay::is_well_formed(const Collision& c) {
    if (!std::ranges::binary_search(ids_, c.i) || !has_partner(c)) {
        blame(c, "number of a body that is not there, of balls", double(c.j), double(ids_.size()));
        return false;
    }
    if (!(c.time >= last_time_)) blame(c, "goes back in time", c.time, last_time_);
    last_time_ = c.time;
    if (scene_.balls[index_of(c.i)].is_static) blame(c, "moves a static ball", c.i, 0);
    const double norm_error = std::abs(length(c.normal) - 1);
    if (!(norm_error <= 4 * kRoundingOfDouble)) blame(c, "normal is no unit vector", norm_error, 0);
    return fault_.empty();
}

double Replay::restitution_of(const Collision& c) const {
    double of_partner = scene_.domain ? scene_.domain->restitution : 1;
    const auto wall = std::ranges::lower_bound(wall_ids_, c.j);
    if (c.kind == CollisionKind::kBall)
        of_partner = scene_.balls[index_of(c.j)].restitution;
    else if (wall != wall_ids_.end())
        of_partner = scene_.walls[static_cast<std::size_t>(wall - wall_ids_.begin())].restitution;
    return pair_restitution(scene_.restitution_rule, scene_.balls[index_of(c.i)].restitution, of_partner);
}

/// Free flight. The time of an event, told in seconds, is rounded once.
void Replay::move_to(Course& c, double time) const {
    const double since = time - c.time;
    const double pull = length(c.acceleration);
    c.velocity += since * c.acceleration;
    c.time = time;
    const double speed = length(c.velocity);
    c.reach += std::max(speed, c.fastest) * since;
    c.fastest = std::max(c.fastest, speed);
    c.doubt += 2 * kRoundingOfDouble * (speed + pull * (time + since));
    // Where balls are anchored at the end of each step, that rounds.
    if (pull > 0) c.doubt += 2 * rounding_ * double(steps_ - c.steps + 1) * c.fastest;
    c.steps = steps_;
}

void Replay::push(Course& c, const Vec2& change) {
    c.velocity += change;
    c.fastest = std::max(c.fastest, length(c.velocity));
    c.doubt += rounding_ * 4 * (length(c.velocity) + length(change));
}

/// The speed at which a contact under pressure may part, to stay open. The empirical method keeps it open for
/// a step, in which no ball goes farther than it may.
double Replay::hop_of(const Bodies& b) const {
    const double pull_first = length(b.first->acceleration);
    const double pull_second = b.second != nullptr ? length(b.second->acceleration) : 0.0;
    if (!(pull_first + pull_second > 0)) return 0;
    double open = rest_time_;
    if (empirical_) {
        const double travelled = std::sqrt(2 * empirical_->travel / std::max(pull_first, pull_second));
        open = std::max(open, std::min(empirical_->longest, travelled));
    }
    return (pull_first + pull_second) * open / 2;
}

void Replay::check_response(const Collision& c, const Bodies& b) {
    const Vec2 relative =
        b.second != nullptr ? Vec2(b.first->velocity - b.second->velocity) : b.first->velocity;
    const double inverse_mass = b.inverse_mass_first + b.inverse_mass_second;
    const double before = dot<double>(relative, c.normal);
    const double after = before + c.impulse * inverse_mass;
    // Along the normal, whose own rounding turns the whole relative velocity.
    const double speeds = b.first->fastest + (b.second != nullptr ? b.second->fastest : 0.0);
    const double doubt = b.first->doubt + (b.second != nullptr ? b.second->doubt : 0.0) +
                         kRoundings * rounding_ * (speeds + std::abs(c.impulse) * inverse_mass);
    const double hop = hop_of(b);
    const double approach = std::max(-before, 0.0);
    if (before > hop + doubt) blame(c, "the bodies part already, at", before, hop + doubt);
    if (after < -doubt) blame(c, "the bodies still approach, at", -after, doubt);
    const double fastest = std::max(approach, hop);
    if (after > fastest + doubt)
        blame(c, "the bodies part faster than they came, at", after, fastest + doubt);
    const double slowest = restitution_of(c) * approach;
    if (after < slowest - doubt) blame(c, "the bodies part slower than they should, at", after, slowest);
    if (inverse_mass > 0) {
        energy_gained_ += (after * after - before * before) / (2 * inverse_mass);
        energy_doubt_ += doubt * (std::abs(after) + std::abs(before) + doubt) / inverse_mass;
    }
}

void Replay::take(const Collision& c, std::uint64_t steps) {
    ++collisions_;
    steps_ = steps;
    if (!fault_.empty() || !is_well_formed(c) || !follows_velocities_) return;
    const std::size_t i = index_of(c.i);
    const double mass = scene_.balls[i].mass;
    Bodies bodies;
    bodies.first = &courses_[i];
    bodies.inverse_mass_first = 1 / mass;
    double second_mass = 0;
    if (c.kind == CollisionKind::kBall && !scene_.balls[index_of(c.j)].is_static) {
        const std::size_t j = index_of(c.j);
        second_mass = scene_.balls[j].mass;
        bodies.second = &courses_[j];
        bodies.inverse_mass_second = 1 / second_mass;
    }
    move_to(*bodies.first, c.time);
    if (bodies.second != nullptr) move_to(*bodies.second, c.time);
    check_response(c, bodies);
    // The anchor's place and velocity are rounded once each: so is the energy that they carry.
    const auto rounded = [&](const Course& course, double of_mass) {
        energy_doubt_ +=
            kRoundings * rounding_ * of_mass *
            (course.fastest * course.fastest + length(course.acceleration) * (corner_ + length(c.point)));
    };
    rounded(*bodies.first, mass);
    push(*bodies.first, Vec2(c.impulse * bodies.inverse_mass_first * c.normal));
    if (bodies.second == nullptr) return;
    rounded(*bodies.second, second_mass);
    push(*bodies.second, Vec2(-c.impulse * bodies.inverse_mass_second * c.normal));
}

void Replay::compare(const World& world) {
    if (!fault_.empty() || !follows_velocities_) return;
    const double time = world.time();
    steps_ = world.counts().steps.value_or(0);
    if (last_time_ > time * (1 + 4 * kRoundingOfDouble))
        fault_ = fmt::format("a collision at time {} is told before time {}", last_time_, time);
    const PlaneVectors shown = world.velocities();
    for (std::size_t i = 0; i < shown.size() && fault_.empty(); ++i) {
        move_to(courses_[i], time);
        // What is shown is held as the anchor is.
        const double bound = courses_[i].doubt + 4 * rounding_ * courses_[i].fastest;
        const double error = length(shown[i] - courses_[i].velocity);
        if (!(error <= bound))
            fault_ = fmt::format(
                "at time {} the velocity of ball {} is off by {:.6g} from what its collisions tell, may be "
                "{:.6g}",
                time, ids_[i], error, bound);
    }
    if (fault_.empty()) compare_energy(world, time);
}

void Replay::compare_energy(const World& world, double time) {
    double doubt = energy_doubt_;
    for (std::size_t i = 0; i < courses_.size(); ++i) {
        const Course& c = courses_[i];
        if (scene_.balls[i].is_static) continue;
        doubt += kRoundings * rounding_ * scene_.balls[i].mass * double(1 + steps_) *
                 (c.fastest * c.fastest + length(c.acceleration) * c.reach);
    }
    const double error = std::abs(world.energy() - energy_ - energy_gained_);
    if (!(error <= doubt))
        fault_ = fmt::format(
            "at time {} the energy is off by {:.6g} from what the collisions leave ({:.6g}), may be {:.6g}",
            time, error, energy_ + energy_gained_, doubt);
}

}  // namespace carom::stress
