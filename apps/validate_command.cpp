// carom validate: is a scene sound, and what is in it?
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
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

constexpr const char* kValidateFooter =
    R"(Reads the scene, checks every value, places its fills, looks for overlaps, and prints what it found. A scene that passes can
be run. The first fault is named with its place:
  carom: error: balls[17].radius: must be > 0, is -1

Examples:
  carom validate box.json
  carom validate box.json && carom run box.json
  carom validate box.json --json | jq .packing)";

std::string row(const std::string& name, const std::string& value) {
    return fmt::format("{:<14}{}\n", name, value);
}

constexpr const char* kBoundaryNames[] = {"wall", "periodic", "open"};

/// The least and the most that a ball has; none where there is no ball.
template <class Value>
std::optional<std::pair<double, double>> range_of(const std::vector<Ball>& balls, Value value) {
    if (balls.empty()) return std::nullopt;
    const auto less = [&](const Ball& a, const Ball& b) { return value(a) < value(b); };
    const auto [least, most] = std::minmax_element(balls.begin(), balls.end(), less);
    return std::pair(value(*least), value(*most));
}

double radius_of(const Ball& ball) {
    return ball.radius;
}
double mass_of(const Ball& ball) {
    return ball.mass;
}
double speed_of(const Ball& ball) {
    return std::hypot(ball.velocity.x(), ball.velocity.y());
}

/// The balls' area over the domain's.
std::optional<double> packing_of(const Scene& scene) {
    if (!scene.domain) return std::nullopt;
    double area = 0;
    for (const Ball& ball : scene.balls) area += std::numbers::pi * ball.radius * ball.radius;
    const Vec2 extent = scene.domain->box.max - scene.domain->box.min;
    return area / (extent.x() * extent.y());
}

std::size_t static_count(const Scene& scene) {
    return static_cast<std::size_t>(std::ranges::count_if(scene.balls, &Ball::is_static));
}

std::string range_text(const std::optional<std::pair<double, double>>& range) {
    if (!range) return "none";
    const auto& [least, most] = *range;
    return least == most ? fmt::format("{:.6g}", least) : fmt::format("{:.6g} to {:.6g}", least, most);
}

std::string domain_text(const Scene& scene) {
    if (!scene.domain) return "none: open space";
    const Domain& domain = *scene.domain;
    const auto name = [&](std::size_t axis) { return kBoundaryNames[int(domain.boundary[axis])]; };
    return fmt::format("({:.6g}, {:.6g}) to ({:.6g}, {:.6g}), x {}, y {}", domain.box.min.x(),
                       domain.box.min.y(), domain.box.max.x(), domain.box.max.y(), name(0), name(1));
}

std::string balls_text(const Scene& scene) {
    const std::string all = with_thousands(scene.balls.size());
    const std::size_t fixed = static_count(scene);
    return fixed > 0 ? fmt::format("{} ({} static)", all, with_thousands(fixed)) : all;
}

/// What rests hops for a contact time: docs/accuracy.md has the figures.
std::string contact_text(double contact_time) {
    constexpr double kRestingCollisions = 5;
    if (contact_time == 0) return "0";
    return fmt::format("{:.6g} (at rest about {:.3g} collisions a ball and unit of time)", contact_time,
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

std::string text_of(const Scene& scene, const World& world) {
    const std::optional<double> packing = packing_of(scene);
    return row("scene", scene.name) + row("balls", balls_text(scene)) +
           row("walls", with_thousands(scene.walls.size())) +
           row("attractors", with_thousands(scene.attractors.size())) +
           row("sensors", with_thousands(scene.sensors.size())) +
           row("radius", range_text(range_of(scene.balls, radius_of))) +
           row("mass", range_text(range_of(scene.balls, mass_of))) +
           row("speed", range_text(range_of(scene.balls, speed_of))) + row("domain", domain_text(scene)) +
           row("packing", packing ? fmt::format("{:.6g}", *packing) : "none: no domain") +
           row("gravity", fmt::format("({:.6g}, {:.6g})", scene.gravity.x(), scene.gravity.y())) +
           row("precision", name_of(scene.precision)) + row("method", method_text(scene)) +
           row("contact time", contact_text(world.contact_time())) + row("kernel", describe(world.kernel())) +
           row("until", fmt::format("{:.6g}", scene.until));
}

/// The same as one object; null where the text says none.
std::string json_of(const Scene& scene, const World& world) {
    using Json = nlohmann::ordered_json;
    const auto pair = [](const Vec2& v) { return Json{v.x(), v.y()}; };
    const auto range = [](const std::optional<std::pair<double, double>>& r) {
        return r ? Json{r->first, r->second} : Json();
    };
    const auto number = [](const auto& value) { return value ? Json(*value) : Json(); };
    Json json;
    json["scene"] = scene.name;
    json["balls"] = scene.balls.size();
    json["static_balls"] = static_count(scene);
    json["walls"] = scene.walls.size();
    json["attractors"] = scene.attractors.size();
    json["sensors"] = scene.sensors.size();
    json["radius"] = range(range_of(scene.balls, radius_of));
    json["mass"] = range(range_of(scene.balls, mass_of));
    json["speed"] = range(range_of(scene.balls, speed_of));
    json["domain"] = nullptr;
    if (const std::optional<Domain>& domain = scene.domain) {
        json["domain"] = Json::object();
        json["domain"]["min"] = pair(domain->box.min);
        json["domain"]["max"] = pair(domain->box.max);
        json["domain"]["boundary"] = {kBoundaryNames[int(domain->boundary[0])],
                                      kBoundaryNames[int(domain->boundary[1])]};
    }
    json["packing"] = number(packing_of(scene));
    json["gravity"] = pair(scene.gravity);
    json["precision"] = name_of(scene.precision);
    json["method"] = name_of(scene.method);
    json["step"] = number(scene.step);
    json["max_travel"] = number(scene.max_travel);
    json["contact_time"] = world.contact_time();
    json["kernel"] = describe(world.kernel());
    json["until"] = scene.until;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int validate(const std::string& path, bool as_json) {
    Scene scene = read_scene(path);
    scene.balls = place_balls(scene);
    scene.fills.clear();
    // Whether balls overlap, and whatever else the engine asks of a scene, it asks when it is built.
    const World world(scene);
    print_out(as_json ? json_of(scene, world) : text_of(scene, world));
    return kGood;
}

}  // namespace

void add_validate_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("validate", "Check a scene and say what is in it");
    command->footer(kValidateFooter);
    const auto scene = std::make_shared<std::string>();
    command->add_option("SCENE", *scene, "The scene file, JSON")->type_name("")->required();
    const auto as_json = std::make_shared<bool>(false);
    command->add_flag("--json", *as_json, "One JSON object instead of the table");
    command->callback([scene, as_json, &status] { status = validate(*scene, *as_json); });
}

}  // namespace carom::app
