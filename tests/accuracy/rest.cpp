#include "accuracy/rest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/tally.hpp"

namespace carom::accuracy {
namespace {

constexpr double kGravity = 9.81;
constexpr double kRestitution = 0.5;

Scene box(double width, double height, double contact_time) {
    Scene s;
    s.gravity = {0, -kGravity};
    s.contact_time = contact_time;
    s.domain = Domain{{{0, 0}, {width, height}}, {Boundary::kWall, Boundary::kWall}, kRestitution};
    s.until = 1e6;
    return s;
}

/// A triangular lattice on the floor, its balls some thousandths apart.
Scene lattice(int columns, int layers, double contact_time) {
    constexpr double kPitch = 1.001;
    Scene s = box(columns * kPitch + 0.501, layers + 5, contact_time);
    for (int layer = 0; layer < layers; ++layer)
        for (int k = 0; k < columns; ++k) {
            Ball& b = s.balls.emplace_back();
            b.restitution = kRestitution;
            b.position = {0.5005 + kPitch * (k + 0.5 * (layer % 2)),
                          0.5005 + kPitch * layer * std::sqrt(0.75) + 1e-6};
        }
    return s;
}

/// One ball above the other.
Scene column(int balls, double contact_time) {
    Scene s = box(10, balls + 5, contact_time);
    for (int k = 0; k < balls; ++k) {
        Ball& b = s.balls.emplace_back();
        b.restitution = kRestitution;
        b.position = {5, 0.5005 + 1.001 * k};
    }
    return s;
}

/// Balls of several sizes, poured from above into a box of that width.
Scene pour(std::uint64_t count, double width, double contact_time) {
    Scene s = box(width, 2.5 * static_cast<double>(count) / width + 5, contact_time);
    Fill& fill = s.fills.emplace_back();
    fill.count = count;
    fill.radius_min = 0.4;
    fill.radius_max = 0.6;
    fill.density = 1;
    fill.restitution = kRestitution;
    fill.temperature = 0.01;
    fill.seed = 6;
    return s;
}

double centre_of_mass(const World& world, double mass) {
    double moment = 0;
    for (const Ball& b : world.balls()) moment += b.mass * b.position.y();
    return moment / mass;
}

std::uint64_t collisions_of(const World& world) {
    const Counts counts = world.counts();
    return counts.ball_collisions + counts.wall_collisions;
}

}  // namespace

RestCase resting_pile() {
    return {"8 layers of 8", lattice(8, 8, 0.01), 1000, 1000};
}

std::vector<RestCase> rest_cases(bool all) {
    std::vector<RestCase> cases = {
        {"a ball on the floor", column(1, 0.01), 500, 1000},
        {"a column of 8", column(8, 0.01), 2000, 1000},
        {"8 layers of 8", lattice(8, 8, 0.03), 1000, 1000},
        resting_pile(),
        {"8 layers of 8", lattice(8, 8, 0.003), 1500, 1000},
        {"32 layers of 8", lattice(8, 32, 0.01), 500, 1000, false},
    };
    if (!all) return cases;
    cases.push_back({"poured, about 25 layers", pour(1000, 40, 0.01), 1500, 1000, false});
    cases.push_back({"20 layers of 20", lattice(20, 20, 0.01), 5000, 1000});
    cases.push_back({"poured, about 80 layers", pour(10000, 120, 0.01), 2500, 1000, false});
    cases.push_back({"poured, about 80 layers", pour(10000, 120, 0.04), 2500, 1000, false});
    return cases;
}

Rest measure(const RestCase& rest) {
    constexpr int kParts = 10;
    World world(rest.scene, {.threads = 1});
    Rest r;
    r.balls = world.ball_count();
    r.contact_time = world.contact_time();
    const auto balls = static_cast<double>(r.balls);
    double mass = 0;
    for (const Ball& b : world.balls()) mass += b.mass;
    const double energy_unit = mass * std::pow(kGravity * r.contact_time, 2);
    const double length_unit = kGravity * r.contact_time * r.contact_time;

    world.advance_to(rest.settling * r.contact_time);
    r.kinetic_0 = world.kinetic_energy() / energy_unit;
    const double energy = world.energy();
    const double height = centre_of_mass(world, mass);
    const std::uint64_t collisions = collisions_of(world);
    std::uint64_t before = collisions;
    for (int part = 1; part <= kParts; ++part) {
        world.advance_to((rest.settling + rest.length * part / kParts) * r.contact_time);
        const std::uint64_t now = collisions_of(world);
        r.most = std::max(r.most, static_cast<double>(now - before) * kParts / (balls * rest.length));
        before = now;
    }
    r.collisions = static_cast<double>(before - collisions) / (balls * rest.length);
    r.kinetic_1 = world.kinetic_energy() / energy_unit;
    r.energy_change = (world.energy() - energy) / energy_unit;
    r.height_change = (centre_of_mass(world, mass) - height) / length_unit;
    r.overlap = world.max_overlap();
    return r;
}

std::string rest_header() {
    return "| pile | balls | contact time | collisions a ball and contact time | busiest tenth | kinetic "
           "energy, "
           "start | end | change of energy | change of height | deepest overlap |\n"
           "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
}

std::string rest_line(const RestCase& rest, const Rest& r) {
    return fmt::format("| {}{} | {} | {:g} | {:.2f} | {:.2f} | {:.3g} | {:.3g} | {:+.2g} | {:+.2g} | {} |\n",
                       rest.name, rest.settles ? "" : ", still cooling",
                       grouped(static_cast<std::int64_t>(r.balls)), r.contact_time, r.collisions, r.most,
                       r.kinetic_0, r.kinetic_1, r.energy_change, r.height_change, brief(r.overlap));
}

}  // namespace carom::accuracy
