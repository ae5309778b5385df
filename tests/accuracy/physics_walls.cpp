// What the walls of a box take up, against energy and virial inside.
#include <cmath>

#include "accuracy/physics_run.hpp"

namespace carom::accuracy {
namespace {

/// Sum of m r . v, with the origin in the middle of the box.
double motion(const World& world) {
    double sum = 0;
    for (const Ball& b : world.balls()) sum += b.mass * dot<double>(b.position, b.velocity);
    return sum;
}

/// What the sum of m r . v differs by at two times that have nothing to do with each other: velocities are
/// independent of places, and these uniform in what the walls leave to a disc's centre.
double spread_of_motion(const World& world, double side, double temperature) {
    double sum = 0;
    for (const Ball& b : world.balls()) {
        const double free = side - 2 * b.radius;
        sum += b.mass * temperature * free * free / 6;
    }
    return std::sqrt(2 * sum);
}

}  // namespace

// With the walls at -L/2 and L/2 every hit on one of them, of impulse J, changes the sum of m r . v by -J
// (L/2 - r), every collision of two discs by what it adds to the virial W, and free flight by 2 K t. So the
// walls' sum of J (L/2 - r), which is P t L (L - 2 r) if all discs are equal, is 2 K t + W less the change
// from the first to the last moment.
std::vector<Figure> walled_gas(const GasRun& run, const Mixture& mixture) {
    World world(filled_box(run, mixture, Boundary::kWall), run.options);
    const double rate = collision_rate(run.packing);
    constexpr double kRelaxation = 50;  // collisions of a disc
    world.advance_to(kRelaxation / rate);
    const std::vector<Ball> balls = world.balls();
    const double side = side_of(run, mixture);
    double taken = 0;
    world.on_collision([&](const Collision& c) {
        if (c.kind == CollisionKind::kWall) taken += c.impulse * (side / 2 - balls[c.i].radius);
    });
    const double start = world.time(), virial = world.virial(), before = motion(world);
    world.advance_to(start + run.collisions / rate);
    const double time = world.time() - start;
    const double inside = 2 * world.kinetic_energy() * time + (world.virial() - virial);
    const double energy = world.kinetic_energy();  // N k T: no momentum is kept between walls
    const double unit = 2 * energy * time;
    const Counts counts = world.counts();
    // Each hit's impulse and each collision's part of the virial is right to a few ulp, and so is each sum
    // of them after each term.
    const double rounding = static_cast<double>(counts.ball_collisions + counts.wall_collisions) * 0x1p-52;
    const double spread = spread_of_motion(world, side, energy / static_cast<double>(run.discs));
    return {{"P L (L - 2r) / NkT from the walls' impulses, against energy and virial",
             system_name(run, mixture),
             {taken / unit, spread / unit},
             inside / unit,
             0},
            {"the same, with the motion at both ends",
             system_name(run, mixture),
             {taken / unit, rounding * taken / unit},
             (inside - (motion(world) - before)) / unit,
             0}};
}

}  // namespace carom::accuracy
