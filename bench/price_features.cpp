#include "price_features.hpp"

#include <cmath>

#include <carom/broadphase/placement.hpp>
#include <carom/parallel/world.hpp>

namespace carom::bench {
namespace {

constexpr double kWarmUp = 6;  // collisions a ball, until the start has melted

// Forces are weak: in a mean free time they change a thermal velocity by a hundredth, so that the gas stays
// the plain one.
constexpr double kPull = 0.01;

double pull(const PlainGas& gas) {
    return kPull / gas.free_time();
}

void add_gravity(Scene& scene, const PlainGas& gas) {
    scene.gravity = {0, -pull(gas)};
}

void accelerate_each(Scene& scene, const PlainGas& gas) {
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
        const auto angle = static_cast<double>(i);
        scene.balls[i].acceleration = pull(gas) * Vec2(std::cos(angle), std::sin(angle));
    }
}

// Its pull is greatest, 0.385 of strength over softening squared, at 0.7 times the softening.
void attract(Scene& scene, const PlainGas& gas) {
    const Vec2 centre = scene.domain->box.max / 2;
    const double softening = centre.x() / 2;
    scene.attractors.push_back({centre, pull(gas) * softening * softening / 0.385, softening});
    scene.field_interval = gas.free_time();
}

void attract_often(Scene& scene, const PlainGas& gas) {
    attract(scene, gas);
    scene.field_interval /= 4;
}

void lose_energy(Scene& scene, const PlainGas&) {
    for (Ball& b : scene.balls) b.restitution = 0.9;
    scene.contact_time = 0;
}

void keep_contacts(Scene& scene, const PlainGas& gas) {
    scene.contact_time = gas.free_time() / 100;
}

void lose_energy_and_keep_contacts(Scene& scene, const PlainGas& gas) {
    lose_energy(scene, gas);
    keep_contacts(scene, gas);
}

void round_to_float(Scene& scene, const PlainGas&) {
    scene.precision = Precision::kFloat;
}

void mix_radii(Scene& scene) {
    scene.fills[0].radius_min = scene.fills[0].radius_max / 2;
}

// Every other ball four times as heavy, at the same temperature.
void mix_masses(Scene& scene) {
    for (std::size_t i = 0; i < scene.balls.size(); i += 2) {
        scene.balls[i].mass = 4;
        scene.balls[i].velocity /= 2;
    }
}

void match_masses(Scene& scene) {
    for (Ball& b : scene.balls) {
        b.mass = 4 * b.radius * b.radius;
        b.velocity /= std::sqrt(b.mass);
    }
}

void enclose(Scene& scene) {
    scene.domain->boundary = {Boundary::kWall, Boundary::kWall};
}

// A hundred segments of many slants, spread over the box; the fill keeps clear of them.
void add_walls(Scene& scene) {
    constexpr int kAcross = 10;
    const double pitch = scene.domain->box.max.x() / kAcross;
    for (int row = 0; row < kAcross; ++row) {
        for (int column = 0; column < kAcross; ++column) {
            const double angle = row * kAcross + column;
            const Vec2 middle((column + 0.5) * pitch, (row + 0.5) * pitch);
            const Vec2 half(0.2 * pitch * std::cos(angle), 0.2 * pitch * std::sin(angle));
            scene.walls.push_back({middle - half, middle + half, 1});
        }
    }
}

void fix_some(Scene& scene) {
    for (std::size_t i = 0; i < scene.balls.size(); i += 100) {
        scene.balls[i].is_static = true;
        scene.balls[i].velocity.setZero();
    }
}

// Four balls as wide as ten in place of others; the same area is covered.
void add_large(Scene& scene) {
    constexpr double kRadius = 5;
    constexpr double kReplaced = 400;
    Fill& fill = scene.fills[0];
    const auto count = static_cast<double>(*fill.count);
    if (count <= 2 * kReplaced) throw SceneError("--balls", "must be more than 800 for the large ones");
    const double side = scene.domain->box.max.x();
    for (const double x : {0.25, 0.75}) {
        for (const double y : {0.25, 0.75}) {
            Ball& large = scene.balls.emplace_back();
            large.position = {x * side, y * side};
            large.radius = kRadius;
            large.mass = 4 * kRadius * kRadius;
        }
    }
    fill.count = static_cast<std::uint64_t>(count - kReplaced);
    fill.packing_fraction = *fill.packing_fraction * (count - kReplaced) / count;
}

}  // namespace

const std::vector<Feature>& features() {
    static const std::vector<Feature> kAll = {
        {.name = "gravity", .force = add_gravity},
        {.name = "an acceleration of each ball's own", .force = accelerate_each},
        {.name = "an attractor, its field renewed once in a mean free time", .force = attract},
        {.name = "an attractor, its field renewed four times in one", .force = attract_often},
        {.name = "radii 1 to 2", .lay_out = mix_radii},
        {.name = "masses 1 and 4", .alter = mix_masses},
        {.name = "radii 1 to 2, masses to match", .lay_out = mix_radii, .alter = match_masses},
        {.name = "restitution 0.9, no contact time", .force = lose_energy},
        {.name = "contact time, elastic", .force = keep_contacts},
        {.name = "restitution 0.9 and contact time", .force = lose_energy_and_keep_contacts},
        {.name = "walled box", .lay_out = enclose},
        {.name = "walled box and gravity", .lay_out = enclose, .force = add_gravity},
        {.name = "100 wall segments", .lay_out = add_walls},
        {.name = "1 % of the balls static", .alter = fix_some},
        {.name = "4 balls ten times as wide", .lay_out = add_large},
        {.name = "precision float", .force = round_to_float},
        {.name = "listening to collisions", .running = {.listens = true}},
        {.name = "frames of 1/60", .running = {.frame = 1.0 / 60}},
        {.name = "frames of 1/60, all positions read", .running = {.frame = 1.0 / 60, .reads = true}},
    };
    return kAll;
}

Scene melted(const PlainGas& gas, const Feature& feature) {
    Scene scene = gas_scene(gas.count, gas.packing);
    if (feature.lay_out != nullptr) feature.lay_out(scene);
    scene.balls = place_balls(scene);
    scene.fills.clear();
    if (feature.alter != nullptr) feature.alter(scene);
    World world(scene, {.threads = 1});
    world.step(kWarmUp * gas.free_time());
    scene.balls = world.balls();
    return scene;
}

}  // namespace carom::bench
