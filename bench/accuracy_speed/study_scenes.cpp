#include "study_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include <carom/broadphase/placement.hpp>
#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>
#include <carom/trade/settings.hpp>

#include "../gas_scene.hpp"

namespace carom::bench {
namespace {

constexpr double kMelting = 4;  // collisions a ball, after which a gas has lost its start

/// Collisions a ball, those with walls counted for one ball.
double collisions_a_ball(const World& world, double balls) {
    const Counts counts = world.counts();
    return static_cast<double>(2 * counts.ball_collisions + counts.wall_collisions) / balls;
}

/// Advances by small frames until the balls have had so many collisions; the time then.
double run_for(World& world, double collisions, double balls, double frame) {
    while (collisions_a_ball(world, balls) < collisions) world.step(frame);
    return world.time();
}

void place(Scene& scene) {
    scene.balls = place_balls(scene);
    scene.fills.clear();
}

void melt(Scene& scene) {
    World world(scene, {.threads = 1});
    run_for(world, kMelting, trade::moving_balls(scene), trade::step_unit(scene) / 4);
    scene.balls = world.balls();
}

using Change = std::function<void(Scene&)>;

/// A gas of equal discs: `lay_out` changes it before it is placed, `alter` once it has melted.
Scene gas(bool small, double packing, const Change& lay_out, const Change& alter) {
    Scene scene = gas_scene(small ? 300 : 1500, packing);
    if (lay_out) lay_out(scene);
    place(scene);
    melt(scene);
    if (alter) alter(scene);
    return scene;
}

void enclose(Scene& scene) {
    scene.domain->boundary = {Boundary::kWall, Boundary::kWall};
}

double side_of(const Scene& scene) {
    return scene.domain->box.max.x();
}

// A ball at temperature 1 rises about half the box.
void pull_down(Scene& scene) {
    scene.gravity = {0, -2 / side_of(scene)};
}

// Every 33rd ball, 3 %.
void speed_up(Scene& scene) {
    for (std::size_t i = 0; i < scene.balls.size(); i += 33) scene.balls[i].velocity *= 30;
}

void mix_sizes(Scene& scene) {
    Fill& fill = scene.fills[0];
    fill.radius_min = 0.2;
    fill.radius_max = 1;
    fill.density = 1;
}

// Of a depth of four temperatures each; the field is renewed several times while a thermal ball crosses the
// softening length.
void add_holes(Scene& scene) {
    const double side = side_of(scene);
    for (const double x : {0.3, 0.7}) scene.attractors.push_back({{x * side, 0.5 * side}, 20, 5});
    scene.field_interval = 0.2;
}

void lose_energy(Scene& scene) {
    for (Ball& b : scene.balls) b.restitution = 0.9;
    scene.contact_time = 1e-2 * trade::step_unit(scene);
}

struct Recipe {
    std::string name;
    int stretches;
    std::function<Scene(bool small, const std::string& scenes)> make;
};

Scene screensaver(const std::string& folder) {
    Scene scene = read_scene(folder + "/screensaver.json");
    place(scene);
    return scene;
}

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> kAll = {
        {"dilute", 10, [](bool small, auto&) { return gas(small, 0.05, {}, {}); }},
        {"dense", 20, [](bool small, auto&) { return gas(small, 0.65, {}, {}); }},
        {"fast", 15, [](bool small, auto&) { return gas(small, 0.3, {}, speed_up); }},
        {"mixed", 15, [](bool small, auto&) { return gas(small, 0.5, mix_sizes, {}); }},
        {"gravity", 10, [](bool small, auto&) { return gas(small, 0.2, enclose, pull_down); }},
        {"holes", 6, [](bool small, auto&) { return gas(small, 0.1, enclose, add_holes); }},
        {"granular", 15, [](bool small, auto&) { return gas(small, 0.5, {}, lose_energy); }},
        {"screensaver", 6, [](bool, const std::string& scenes) { return screensaver(scenes); }},
    };
    return kAll;
}

bool is_elastic(const Scene& scene) {
    return scene.speed_factor == 1 && (!scene.domain || scene.domain->restitution == 1) &&
           std::ranges::all_of(scene.balls, [](const Ball& b) { return b.restitution == 1; });
}

}  // namespace

bool StudyScene::is_reversible() const {
    return is_elastic(scene) && scene.attractors.empty();
}

bool StudyScene::keeps_momentum() const {
    const auto& sides = scene.domain->boundary;
    return sides[0] == Boundary::kPeriodic && sides[1] == Boundary::kPeriodic;
}

std::vector<std::string> study_names() {
    std::vector<std::string> names;
    for (const Recipe& r : recipes()) names.push_back(r.name);
    return names;
}

StudyScene study_scene(const std::string& name, bool small, const std::string& scenes) {
    const auto recipe = std::ranges::find(recipes(), name, &Recipe::name);
    if (recipe == recipes().end()) throw std::invalid_argument("no scene " + name);
    StudyScene s{name, recipe->make(small, scenes), {}, {}, 0};
    s.unit = trade::step_unit(s.scene);
    s.course.stretches = small ? 4 : recipe->stretches;
    World world(s.scene, {.threads = 1});
    const double collisions = 2.0 * s.course.stretches;
    s.course.stretch =
        run_for(world, collisions, trade::moving_balls(s.scene), s.unit / 4) / s.course.stretches;
    s.scene.until = s.course.duration();
    s.reference = s.scene;
    s.reference.field_interval /= StudyScene::kFinerField;
    return s;
}

}  // namespace carom::bench
