// Bounces under gravity: with losses up to the Zeno point, and in a wedge of 90 degrees, whose two sides do
// not know of each other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/bouncing_point.hpp"
#include "accuracy/dropped_ball.hpp"
#include "accuracy/systems.hpp"

namespace carom::accuracy {
namespace {

/// The ball is dropped from height 1 with g = 2, so that it arrives at time 1 at speed 2, and impact k leaves
/// it the speed 2 e^(k+1), with which it flies for as long. What ends the series is
/// - its place: at a floor where the contact lies at y = 0 the last bit of the height scales with the height;
/// - its time: the clock's epoch is at most 16 times the time of falling a diameter. At a radius of 2^-30 it
///   tells 2^-63 from 0;
/// - the contact time, which is set just above that.
/// So it goes on until the reader's seconds, in a double, no longer move.
constexpr double kRadius = 0x1p-30;
constexpr double kTick = 0x1p-63;

Scene dropped(double restitution) {
    Scene s;
    s.gravity = {0, -2};
    s.contact_time = 4 * kTick;
    s.domain = Domain{{{-1, -kRadius}, {1, 2}}, {Boundary::kOpen, Boundary::kWall}, 1};
    s.balls = {ball_at(0, 1, 0, 0)};
    s.balls[0].radius = kRadius;
    s.balls[0].restitution = restitution;
    return s;
}

double ulp_of(double x) {
    return std::nextafter(x, std::numeric_limits<double>::infinity()) - x;
}

/// The speed after each impact is rounded six times (twice in the fall, twice in the time, in the product
/// with e, in the sum), and moved by the time's tick, which the next bounces shrink.
Deviation zeno(double restitution, bool of_times) {
    const long double e = restitution;
    const std::vector<Impact> impacts = impacts_of_dropped_ball(restitution);
    const double ulp = ulp_of(static_cast<double>((1 + e) / (1 - e)));
    const double most_ticks = kTick * 2 / (1 - restitution);
    Deviation d;
    long double time = 1;
    long double speed = 2 * e;
    double time_bound = 0;
    for (std::size_t k = 0; speed >= ulp; ++k) {
        ++d.expected;
        if (k >= impacts.size()) continue;
        const double relative = 6 * kRounding * static_cast<double>(k + 1);
        time_bound += static_cast<double>(speed) * relative + most_ticks;
        if (of_times)
            d.include(static_cast<double>(std::abs(impacts[k].time - time)), time_bound + ulp / 2);
        else
            d.include(static_cast<double>(std::abs(impacts[k].speed / speed - 1)),
                      relative + most_ticks / static_cast<double>(speed));
        time += speed;
        speed *= e;
    }
    d.collisions = impacts.size();
    return d;
}

/// Lehtihet and Miller 1986: the wedge of half angle 45 degrees is the integrable one. Seen along its sides,
/// the ball bounces on each as on a floor. Upright on two walls at 45 degrees, or on the sides of the box
/// with gravity along the diagonal.
Deviation wedge(bool upright, int end) {
    constexpr double kReach = 64;
    const long double root = std::numbers::sqrt2_v<long double>;
    Scene s;
    Deviation d;
    std::vector<BouncingPoint> points;
    if (upright) {
        s.gravity = {0, -1};
        s.walls = {{{0, 0}, {kReach, kReach}, 1}, {{0, 0}, {-kReach, kReach}, 1}};
        s.balls = {ball_at(0.75, 4.5, 0.375, 0.25)};
    } else {
        s.gravity = {-0.75, -0.75};
        s.domain = Domain{{{0, 0}, {kReach, kReach}}, {Boundary::kWall, Boundary::kWall}, 1};
        s.balls = {ball_at(3.25, 5.5, 0.5, -0.25)};
    }
    const Vec2& x = s.balls[0].position;
    const Vec2& v = s.balls[0].velocity;
    if (upright) {
        points.emplace_back((x.x() + x.y()) / root - 0.5L, (v.x() + v.y()) / root, 1 / root);
        points.emplace_back((x.y() - x.x()) / root - 0.5L, (v.y() - v.x()) / root, 1 / root);
    } else {
        for (int axis = 0; axis < 2; ++axis) points.emplace_back(x[axis] - 0.5L, v[axis], 0.75L);
    }
    World world(s, {.threads = 1});
    for (int time = 1; time <= end; ++time) {
        world.advance_to(time);
        const Vec2 now = world.positions()[0];
        for (int axis = 0; axis < 2; ++axis) {
            const long double height = upright ? (axis == 0 ? now.x() + static_cast<long double>(now.y())
                                                            : now.y() - static_cast<long double>(now.x())) /
                                                         root -
                                                     0.5L
                                               : now[axis] - 0.5L;
            const std::uint64_t events = points[0].bounces(time) + points[1].bounces(time) + 1;
            // Twelve roundings of a place and eight of a speed, as in a line of balls; a slanted wall's
            // largest coordinate counts as one of the place. Speeds stay below 4.
            d.include(static_cast<double>(std::abs(height - points[axis].height(time))),
                      points[axis].bound(events, time, 12 * kRounding * (upright ? kReach : 16),
                                         8 * kRounding * 4));
        }
    }
    d.collisions = world.counts().wall_collisions;
    d.expected = points[0].bounces(end) + points[1].bounces(end);
    return d;
}

}  // namespace

std::vector<Impact> impacts_of_dropped_ball(double restitution) {
    const double end = (1 + restitution) / (1 - restitution);
    // The flight lasts as long as the speed is high. Less a thousandth, for at the end the speed is rounded
    // to some ticks.
    const double least = ulp_of(end) * (1 - 1e-3);
    World world(dropped(restitution), {.threads = 1});
    std::vector<Impact> impacts;
    world.on_collision([&](const Collision& c) {
        const double speed = c.impulse / (1 + 1 / restitution);
        if (speed >= least) impacts.push_back({c.time, speed});
    });
    world.advance_to(end + 4 * ulp_of(end));
    return impacts;
}

std::vector<System> bounce_systems() {
    std::vector<System> all;
    for (const double e : {0.5, 0.9, 0.99}) {
        all.push_back({fmt::format("ball dropped, restitution {}, to the last bounce that seconds tell", e),
                       "time", [=] { return zeno(e, true); }});
        all.push_back(
            {fmt::format("the same, restitution {}", e), "speed, relative", [=] { return zeno(e, false); }});
    }
    all.push_back({"wedge of two walls at 45 degrees", "place", [] { return wedge(true, 1000); }});
    all.push_back(
        {"wedge of two sides, gravity along the diagonal", "place", [] { return wedge(false, 1000); }});
    return all;
}

}  // namespace carom::accuracy
