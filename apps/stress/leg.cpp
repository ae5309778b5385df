#include "leg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "edits.hpp"
#include "reference_engine.hpp"
#include "world_state.hpp"

namespace carom::stress {
namespace {

// All pairs at each event.
constexpr std::size_t kMostBallsOfReference = 64;
constexpr double kMostPeriodsOfReference = 6;

/// Periods that two balls may pass between two events of theirs, seen from each other, in all of the time.
double periods_passed(const Scene& scene) {
    double speed = 0;
    double pull = 0;
    for (const Ball& b : scene.balls) {
        speed = std::max(speed, std::sqrt(length_squared<double>(b.velocity)));
        pull = std::max(pull, std::sqrt(length_squared<double>(b.acceleration + scene.gravity)));
    }
    double width = std::numeric_limits<double>::infinity();
    for (int axis = 0; scene.domain && axis < 2; ++axis)
        if (scene.domain->boundary[std::size_t(axis)] == Boundary::kPeriodic)
            width = std::min(width, scene.domain->box.max[axis] - scene.domain->box.min[axis]);
    // A light ball may leave a heavy one with twice its speed.
    return 2 * (2 * speed + pull * scene.until) * scene.until / width;
}

/// Edits leave the scales of the scene as they were at its beginning.
BruteForce reference_of(const Leg& leg, double periods) {
    const bool is_edited = leg.start && leg.start->edited;
    BruteForceRules rules = is_edited ? rules_of(leg.start->edited->bodies.physics) : rules_of(leg.scene);
    rules.images = 1 + static_cast<int>(periods);
    return leg.start ? BruteForce(rules, leg.scene.balls, leg.scene.walls, *leg.start)
                     : BruteForce(rules, leg.scene.balls, leg.scene.walls);
}

/// The reference numbers balls, then walls, then sides.
std::pair<std::uint32_t, std::uint32_t> ids_in(const Leg& leg, const BruteForceEvent& event) {
    const std::size_t balls = leg.ids.size();
    const std::size_t walls = leg.wall_ids.size();
    const std::uint32_t i = leg.ids[event.i];
    if (event.j < balls) return {i, leg.ids[event.j]};
    if (event.j < balls + walls) return {i, leg.wall_ids[event.j - balls]};
    const std::uint32_t first_side = walls == 0 ? 0 : leg.wall_ids.back() + 1;
    return {i, first_side + static_cast<std::uint32_t>(event.j - balls - walls)};
}

}  // namespace

Leg leg_from(const Scene& scene, const World& world, bool is_edited) {
    Leg leg{scene, {}, world.ball_ids(), world.wall_ids(), {}, world.time()};
    if (is_edited) leg.start = world.snapshot();
    return leg;
}

std::string find_difference(const Leg& leg) {
    if (!leg.scene.attractors.empty() || leg.scene.method != Method::kEvent) return {};
    if (leg.scene.balls.size() > kMostBallsOfReference || leg.scene.allows_overlap) return {};
    const double periods = periods_passed(leg.scene);
    if (periods > kMostPeriodsOfReference) return {};
    BruteForce reference = reference_of(leg, periods);
    for (std::size_t k = 0; k < kEventsOfReference && !reference.finished(); ++k) {
        const BruteForceEvent expected = reference.next();
        if (expected.time > leg.end) return {};
        const auto [i, j] = ids_in(leg, expected);
        if (k >= leg.events.size())
            return fmt::format("event {} at time {} between {} and {} is missed", k, expected.time, i, j);
        const Collision& got = leg.events[k];
        const bool with_ball = got.kind == CollisionKind::kBall;
        const std::uint32_t lower = with_ball ? std::min(got.i, got.j) : got.i;
        const std::uint32_t higher = with_ball ? std::max(got.i, got.j) : got.j;
        const bool is_ball = expected.j < leg.ids.size();
        if (got.time == expected.time && lower == i && higher == j && with_ball == is_ball) continue;
        return fmt::format("event {} is at time {} between {} and {}, must be at {} between {} and {}", k,
                           got.time, lower, higher, expected.time, i, j);
    }
    return {};
}

}  // namespace carom::stress
