#include "accuracy/precision_cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/rest.hpp"
#include "accuracy/tally.hpp"

namespace carom::accuracy {
namespace {

constexpr std::size_t kDiscs = 1000;
constexpr double kSide = 39.6;  // packing 0.5 with radii of 0.5

Scene gas(Precision precision) {
    Scene s;
    s.precision = precision;
    s.domain = Domain{{{0, 0}, {kSide, kSide}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.until = 1e6;
    Fill& fill = s.fills.emplace_back();
    fill.count = kDiscs;
    fill.temperature = 1;
    fill.seed = 8;
    return s;
}

double collisions_a_ball(const World& world) {
    return 2 * static_cast<double>(world.counts().ball_collisions) / kDiscs;
}

/// Kinetic energy and momentum as whoever reads floats finds them.
struct Balance {
    double energy = 0;
    Vec2 momentum = Vec2::Zero();

    explicit Balance(const World& world, bool reads_float) {
        for (const Ball& b : world.balls()) {
            const Vec2 v = reads_float ? rounded_to_float(b.velocity) : b.velocity;
            energy += length_squared(v) / 2;
            momentum += v;
        }
    }
};

struct GasRun {
    double energy, momentum, overlap;
};

/// After 100 collisions a ball: relative change of the energy, the momentum, which was 0, over N times the
/// root-mean-square velocity, and the deepest overlap.
GasRun run_gas(Precision precision, bool reads_float) {
    World world(gas(precision), {.threads = 1});
    const Balance start(world, reads_float);
    while (collisions_a_ball(world) < 100) world.step(0.25);
    const Balance end(world, reads_float);
    const double speed = std::sqrt(2 * end.energy / kDiscs);
    return {std::abs(end.energy / start.energy - 1),
            std::sqrt(length_squared(end.momentum)) / (kDiscs * speed), world.max_overlap()};
}

double largest_difference(const World& a, const World& b) {
    const PlaneVectors x = a.positions();
    const PlaneVectors y = b.positions();
    double most = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (int axis = 0; axis < 2; ++axis)
            most = std::max(most, std::abs(std::remainder(x[i][axis] - y[i][axis], kSide)));
    return most;
}

/// Collisions a ball until some ball is `distance` away from where it is in double.
double collisions_until_apart(double distance) {
    World a(gas(Precision::kDouble), {.threads = 1});
    World b(gas(Precision::kFloat), {.threads = 1});
    while (largest_difference(a, b) < distance) {
        a.step(0.01);
        b.step(0.01);
    }
    return collisions_a_ball(b);
}

/// Galperin's billiard for three digits of pi: 3141 collisions.
std::uint64_t digits_of_pi(Precision precision) {
    Scene s;
    s.precision = precision;
    s.until = 1000;
    s.balls.resize(2);
    s.balls[0].position = {2, 0};
    s.balls[1].position = {4, 0};
    s.balls[1].velocity = {-1, 0};
    s.balls[1].mass = 1e6;
    s.walls = {{{0, -1}, {0, 1}, 1}};
    World world(s, {.threads = 1});
    world.advance_to(s.until);
    return world.counts().ball_collisions + world.counts().wall_collisions;
}

Rest pile(Precision precision) {
    RestCase rest = resting_pile();
    rest.scene.precision = precision;
    return measure(rest);
}

}  // namespace

std::vector<PrecisionRow> measure_precision() {
    const GasRun in_double = run_gas(Precision::kDouble, false);
    const GasRun read = run_gas(Precision::kDouble, true);
    const GasRun in_float = run_gas(Precision::kFloat, true);
    const Rest still = pile(Precision::kDouble);
    const Rest still_in_float = pile(Precision::kFloat);
    const auto count = [](Precision p) { return fmt::format("{}", digits_of_pi(p)); };
    const auto apart = [](double distance) {
        return fmt::format("{:.1f}", collisions_until_apart(distance));
    };
    return {
        {"1,000 discs, 100 collisions a disc: relative change of energy", brief(in_double.energy),
         brief(read.energy), brief(in_float.energy)},
        {"the same: momentum, over N m v", brief(in_double.momentum), brief(read.momentum),
         brief(in_float.momentum)},
        {"the same: deepest overlap", brief(in_double.overlap), brief(in_double.overlap),
         brief(in_float.overlap)},
        {"collisions a disc until one is 0.001 radii from its place in double", "", "", apart(0.0005)},
        {"until one is a radius from there", "", "", apart(0.5)},
        {"Galperin's billiard, 3141 collisions", count(Precision::kDouble), count(Precision::kDouble),
         count(Precision::kFloat)},
        {"8 layers of 8 at rest, 1,000 contact times: change of height, g t_c²",
         fmt::format("{:+.2g}", still.height_change), fmt::format("{:+.2g}", still.height_change),
         fmt::format("{:+.2g}", still_in_float.height_change)},
        {"the same: kinetic energy at the end, m (g t_c)²", fmt::format("{:.2g}", still.kinetic_1),
         fmt::format("{:.2g}", still.kinetic_1), fmt::format("{:.2g}", still_in_float.kinetic_1)},
    };
}

}  // namespace carom::accuracy
