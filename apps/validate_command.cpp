// carom validate: is a scene sound, and what is in it?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <carom/broadphase/placement.hpp>
#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

#include "commands.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "picture_layout.hpp"

namespace carom::app {
namespace {

constexpr const char* kFooter =
    R"(Reads the scene, checks every value, places its fills, looks for overlaps, and prints what it found. A scene that passes can
be run. The first fault is named with its place:
  carom: error: balls[17].radius: must be > 0, is -1

Examples:
  carom validate box.json
  carom validate box.json && carom run box.json)";

std::string row(const std::string& name, const std::string& value) {
    return fmt::format("{:<14}{}\n", name, value);
}

template <class Value>
std::string range_of(const std::vector<Ball>& balls, Value value) {
    if (balls.empty()) return "none";
    const auto less = [&](const Ball& a, const Ball& b) { return value(a) < value(b); };
    const auto [least, most] = std::minmax_element(balls.begin(), balls.end(), less);
    if (value(*least) == value(*most)) return fmt::format("{:.6g}", value(*least));
    return fmt::format("{:.6g} to {:.6g}", value(*least), value(*most));
}

std::string domain_text(const Scene& scene) {
    if (!scene.domain) return "none: open space";
    constexpr const char* kNames[] = {"wall", "periodic", "open"};
    const Domain& domain = *scene.domain;
    const auto name = [&](std::size_t axis) { return kNames[int(domain.boundary[axis])]; };
    return fmt::format("({:.6g}, {:.6g}) to ({:.6g}, {:.6g}), x {}, y {}", domain.box.min.x(),
                       domain.box.min.y(), domain.box.max.x(), domain.box.max.y(), name(0), name(1));
}

std::string packing_text(const Scene& scene, const std::vector<Ball>& balls) {
    if (!scene.domain) return "none: no domain";
    double area = 0;
    for (const Ball& ball : balls) area += std::numbers::pi * ball.radius * ball.radius;
    const Vec2 extent = scene.domain->box.max - scene.domain->box.min;
    return fmt::format("{:.6g}", area / (extent.x() * extent.y()));
}

/// What rests hops for a contact time: docs/accuracy.md has the figures.
std::string contact_text(double contact_time) {
    constexpr double kRestingCollisions = 5;
    if (contact_time == 0) return "0";
    return fmt::format("{:.6g} (at rest about {:.3g} collisions a ball and second)", contact_time,
                       kRestingCollisions / contact_time);
}

std::string method_text(const Scene& scene) {
    std::string text = name_of(scene.method);
    if (scene.method == Method::kEvent) return text;
    const double travel = scene.max_travel.value_or(scene.step ? 0 : Scene::kUsualTravel);
    if (scene.step) text += fmt::format(", step{} {:.6g}", travel > 0 ? " at most" : "", *scene.step);
    if (travel > 0) text += fmt::format(", travel at most {:.6g} of the smallest radius", travel);
    return text;
}

int validate(const std::string& path) {
    Scene scene = read_scene(path);
    scene.balls = place_balls(scene);
    scene.fills.clear();
    // Whether balls overlap, and whatever else the engine asks of a scene, it asks when it is built.
    const World world(scene);

    const auto static_count = std::count_if(scene.balls.begin(), scene.balls.end(),
                                            [](const Ball& ball) { return ball.is_static; });
    std::string balls = with_thousands(scene.balls.size());
    if (static_count > 0)
        balls += fmt::format(" ({} static)", with_thousands(static_cast<unsigned long long>(static_count)));
    print_out(
        row("scene", scene.name) + row("balls", balls) + row("walls", with_thousands(scene.walls.size())) +
        row("attractors", with_thousands(scene.attractors.size())) +
        row("radius", range_of(scene.balls, [](const Ball& ball) { return ball.radius; })) +
        row("mass", range_of(scene.balls, [](const Ball& ball) { return ball.mass; })) +
        row("speed",
            range_of(scene.balls,
                     [](const Ball& ball) { return std::hypot(ball.velocity.x(), ball.velocity.y()); })) +
        row("domain", domain_text(scene)) + row("packing", packing_text(scene, scene.balls)) +
        row("gravity", fmt::format("({:.6g}, {:.6g})", scene.gravity.x(), scene.gravity.y())) +
        row("precision", name_of(scene.precision)) + row("method", method_text(scene)) +
        row("contact time", contact_text(world.contact_time())) + row("kernel", describe(world.kernel())) +
        row("until", fmt::format("{:.6g}", scene.until)));
    return kGood;
}

}  // namespace

void add_validate_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("validate", "Check a scene and say what is in it");
    command->footer(kFooter);
    const auto scene = std::make_shared<std::string>();
    command->add_option("SCENE", *scene, "The scene file, JSON")->type_name("")->required();
    command->callback([scene, &status] { status = validate(*scene); });
}

}  // namespace carom::app
