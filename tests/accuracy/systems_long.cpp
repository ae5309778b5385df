// Some ten million collisions: time as epoch and offset loses nothing on a long run.
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/response_accuracy.hpp"
#include "accuracy/reversal.hpp"
#include "accuracy/systems.hpp"
#include "accuracy/tally.hpp"

namespace carom::accuracy {
namespace {

constexpr std::uint64_t kCollisions = 10'000'000;

/// Whatever differs from the start in any bit.
void include_return(Deviation& d, const World& world, const std::vector<Ball>& start) {
    const std::vector<Ball> balls = world.balls();
    for (std::size_t i = 0; i < start.size(); ++i)
        for (int axis = 0; axis < 2; ++axis) {
            d.include(std::abs(balls[i].position[axis] - start[i].position[axis]), 0);
            d.include(std::abs(balls[i].velocity[axis] - start[i].velocity[axis]), 0);
        }
}

/// Dropped from height 1 with g = 2, it is back at every even time; all numbers on the way are dyadic.
Deviation bounces() {
    Scene s;
    s.gravity = {0, -2};
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kOpen, Boundary::kWall}, 1};
    s.balls = {ball_at(5, 1.5, 0, 0)};
    World world(s, {.threads = 1});
    world.advance_to(2.0 * kCollisions);
    Deviation d;
    d.collisions = world.counts().wall_collisions;
    d.expected = kCollisions;
    include_return(d, world, s.balls);
    return d;
}

/// Four balls between walls, with room of 8 besides their diameters: points at speed 1 or at rest, so that
/// every meeting is at a dyadic time, and all are back after every 16.
Deviation line() {
    Scene s;
    s.domain = Domain{{{-5, 0}, {5, 12}}, {Boundary::kOpen, Boundary::kWall}, 1};
    s.balls = {ball_at(0, 1.5, 0, 1), ball_at(0, 4.25, 0, 0), ball_at(0, 5.5, 0, -1), ball_at(0, 8.75, 0, 1)};
    // In 16 every moving point meets the resting one twice and either other one twice, and each wall once.
    constexpr std::uint64_t kEach = 3 * 2 + 3 * 2 + 3 * 2;
    constexpr std::uint64_t kPeriods = kCollisions / kEach;
    World world(s, {.threads = 1});
    world.advance_to(16.0 * kPeriods);
    Deviation d;
    d.collisions = world.counts().ball_collisions + world.counts().wall_collisions;
    d.expected = kEach * kPeriods;
    include_return(d, world, s.balls);
    return d;
}

/// A ball between two walls at a speed that is no dyadic number: twelve roundings of a place a hit, at most.
Deviation between_walls() {
    Scene s;
    s.domain = Domain{{{0, 0}, {10, 4}}, {Boundary::kOpen, Boundary::kWall}, 1};
    s.balls = {ball_at(5, 1.25, 0, std::numbers::pi)};
    World world(s, {.threads = 1});
    const double end = std::floor(3.0 * kCollisions / std::numbers::pi);
    world.advance_to(end);
    Deviation d;
    d.collisions = world.counts().wall_collisions;
    // Of the products of the speed, an integer of 24 bits and a place a long double holds all but half an
    // ulp.
    const long double way = 0.75L + static_cast<long double>(std::numbers::pi) * end;
    d.expected = static_cast<std::uint64_t>(std::floor(way / 3));
    const long double place = 0.5L + std::abs(std::remainder(way, 6.0L));
    d.include(static_cast<double>(std::abs(world.positions()[0].y() - place)),
              static_cast<double>(kCollisions) * 12 * kRounding * 4);
    return d;
}

Scene two_discs() {
    const double side = std::sqrt(2 * std::numbers::pi / 4 / 0.3);
    Scene s;
    s.domain = Domain{{{0, 0}, {side, side}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.balls = {ball_at(0, 0, 0.6, 0.8), ball_at(side / 2, side / 3, -0.6, -0.8)};
    return s;
}

/// Two discs in a periodic box, then two runs on: one goes on, the other starts anew from what the first has
/// at that time. A clock that had lost digits would part them.
Deviation late_and_early(bool of_energy) {
    const Scene s = two_discs();
    World late(s, {.threads = 1});
    const double energy = late.energy();
    double time = 0;
    while (late.counts().ball_collisions < kCollisions) late.advance_to(time += 0x1p17);
    Deviation d;
    d.collisions = d.expected = late.counts().ball_collisions;
    if (of_energy) {
        // Four standard deviations of what rounding makes of the response alone.
        d.include(std::abs(late.energy() / energy - 1),
                  4 * random_walk(2, static_cast<std::int64_t>(d.collisions)));
        return d;
    }
    Scene again = s;
    again.balls = late.balls();
    World early(again, {.threads = 1});
    const double free_time = time / static_cast<double>(d.collisions);
    constexpr double kOn = 3;
    late.advance_to(time + std::ceil(kOn * free_time));
    early.advance_to(std::ceil(kOn * free_time));
    const double side = late.domain().box.max.x();
    for (int i = 0; i < 2; ++i)
        for (int axis = 0; axis < 2; ++axis)
            d.include(std::abs(std::remainder(late.positions()[i][axis] - early.positions()[i][axis], side)),
                      error_after({0.3, kOn + 1, false}, side));
    return d;
}

}  // namespace

std::vector<System> long_systems() {
    return {{"ball dropped, elastic, back at its height after every bounce", "place and speed", bounces},
            {"four equal balls between walls, back in place", "place and speed", line},
            {"ball between two walls at speed pi", "place", between_walls},
            {"two discs in a periodic box", "energy, relative", [] { return late_and_early(true); }},
            {"the same: goes on, or starts anew from there; after 3 mean free times", "place",
             [] { return late_and_early(false); }}};
}

}  // namespace carom::accuracy
