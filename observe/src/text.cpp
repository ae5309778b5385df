#include <carom/observe/text.hpp>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// Calls visit(name, value) for each column in order: the only list of them.
template <class Visit>
void for_each_column(const Sample& s, Visit&& visit) {
    visit("time", s.time);
    visit("kinetic_energy", s.kinetic_energy);
    visit("temperature", s.temperature);
    visit("pressure", s.pressure);
    visit("pressure_left", s.wall_pressure[0]);
    visit("pressure_right", s.wall_pressure[1]);
    visit("pressure_bottom", s.wall_pressure[2]);
    visit("pressure_top", s.wall_pressure[3]);
    visit("ball_collision_rate", s.ball_collision_rate);
    visit("wall_collision_rate", s.wall_collision_rate);
    visit("mean_free_path", s.mean_free_path);
    visit("mean_square_displacement", s.mean_square_displacement);
    visit("hexatic_global", s.hexatic_global);
    visit("hexatic_local", s.hexatic_local);
}

Json to_json(const Curve& curve, const char* argument, const char* value) {
    if (curve.at.empty()) return {};
    return {{argument, curve.at}, {value, curve.value}};
}

}  // namespace

std::string sample_header() {
    std::string line;
    for_each_column(Sample{}, [&line](const char* name, const auto&) {
        line += line.empty() ? "" : ",";
        line += name;
    });
    return line + "\n";
}

std::string to_csv(const Sample& sample) {
    std::string line;
    for_each_column(sample, [&line](const char*, const std::optional<double>& value) {
        line += line.empty() ? "" : ",";
        if (value) line += fmt::format("{}", *value);
    });
    return line + "\n";
}

std::string to_json(const Structure& structure) {
    Json json;
    json["samples"] = structure.samples;
    json["first_time"] = structure.first_time;
    json["last_time"] = structure.last_time;
    json["mean_diameter"] = structure.mean_diameter;
    json["radial_distribution"] = to_json(structure.radial_distribution, "r", "g");
    json["density_x"] = to_json(structure.density_x, "x", "density");
    json["density_y"] = to_json(structure.density_y, "y", "density");
    json["mean_square_displacement"] = to_json(structure.mean_square_displacement, "lag", "value");
    json["velocity_autocorrelation"] = to_json(structure.velocity_autocorrelation, "lag", "value");
    return json.dump(1) + "\n";
}

}  // namespace carom
