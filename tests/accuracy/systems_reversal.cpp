// There and back: all velocities turned after a few collisions a ball, the balls return to where they came
// from, as well as the growth of errors allows.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/reversal.hpp"
#include "parallel/scenes.hpp"

namespace carom::accuracy {
namespace {

/// Growth of an error per collision a ball, of 100 discs.
double growth(double packing) {
    return packing < 0.1 ? 4.3 : packing < 0.5 ? 1.2 : 0.5;
}

}  // namespace

double error_after(const ReversalCase& c, double side) {
    const double most = c.collisions + 3 * std::sqrt(c.collisions);
    return 8 * kRounding * side * std::exp(growth(c.packing) * most);
}

std::vector<ReversalCase> reversal_cases() {
    std::vector<ReversalCase> all;
    for (const double packing : {0.05, 0.3, 0.6})
        for (const double collisions : {1.0, 2.0, 4.0})
            for (const bool walled : {false, true})
                // Beyond this a double holds nothing of where they came from.
                if (error_after({packing, collisions, walled}, 40) < 1e-2)
                    all.push_back({packing, collisions, walled});
    return all;
}

Deviation reverse(const ReversalCase& c, double fault) {
    const Boundary boundary = c.walled ? Boundary::kWall : Boundary::kPeriodic;
    Scene s =
        test::gas(31, {.count = 100, .packing = c.packing, .boundary_x = boundary, .boundary_y = boundary});
    if (c.walled) s.gravity = {0, -0.25};
    const std::vector<Ball> start = s.balls;
    World forth(s, {.threads = 1});
    double time = 0;
    const auto wanted = static_cast<std::uint64_t>(c.collisions * double(start.size()) / 2);
    while (forth.counts().ball_collisions < wanted) forth.advance_to(time += 0x1p-7);
    s.balls = forth.balls();
    for (Ball& b : s.balls) b.velocity = -b.velocity;
    s.balls[0].velocity.x() += fault;
    World back(s, {.threads = 1});
    back.advance_to(time);
    Deviation d;
    d.expected = forth.counts().ball_collisions + forth.counts().wall_collisions;
    d.collisions = back.counts().ball_collisions + back.counts().wall_collisions;
    const PlaneVectors x = back.positions();
    const double side = back.domain().box.max.x();
    for (std::size_t i = 0; i < start.size(); ++i)
        for (int axis = 0; axis < 2; ++axis) {
            double error = x[i][axis] - start[i].position[axis];
            if (!c.walled) error = std::remainder(error, side);
            d.include(std::abs(error), error_after(c, side));
        }
    return d;
}

std::vector<System> reversal_systems() {
    std::vector<System> all;
    for (const ReversalCase& c : reversal_cases())
        all.push_back({fmt::format("100 balls reversed after {} collisions each, packing {}{}", c.collisions,
                                   c.packing, c.walled ? ", walls and gravity" : ""),
                       "place", [c] { return reverse(c); }});
    return all;
}

}  // namespace carom::accuracy
