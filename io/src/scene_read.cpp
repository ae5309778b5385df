// Scene files into scenes: what JSON says goes into the struct, check() judges the values.
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <carom/io/atomic_file.hpp>
#include <carom/io/lammps.hpp>
#include <carom/io/read_file.hpp>
#include <carom/io/scene_file.hpp>

#include "json_stream.hpp"
#include "json_value.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;
using Keys = std::string_view[];

constexpr Keys kSceneKeys = {"name",         "domain",       "gravity",       "restitution_rule",
                             "contact_time", "speed_factor", "balls",         "fill",
                             "balls_file",   "walls",        "attractors",    "field_interval",
                             "sensors",      "precision",    "allow_overlap", "method",
                             "step",         "tolerance",    "max_travel",    "until",
                             "description",  "$schema"};
constexpr Keys kDomainKeys = {"min", "max", "boundary", "restitution"};
constexpr Keys kBallKeys = {"position",    "velocity", "acceleration", "radius", "mass",
                            "restitution", "static",   "category",     "mask"};
constexpr Keys kFillKeys = {"count",   "packing_fraction", "radius",      "mass",
                            "density", "restitution",      "temperature", "seed",
                            "region",  "category",         "mask"};
constexpr Keys kWallKeys = {"from", "to", "restitution", "category", "mask"};
constexpr Keys kAttractorKeys = {"position", "strength", "softening"};
constexpr Keys kSensorKeys = {"corners", "radius", "category", "mask"};
constexpr Keys kRangeKeys = {"min", "max"};

constexpr std::array<std::pair<std::string_view, Boundary>, 3> kBoundaries = {
    {{"wall", Boundary::kWall}, {"periodic", Boundary::kPeriodic}, {"open", Boundary::kOpen}}};
constexpr std::array<std::pair<std::string_view, RestitutionRule>, 5> kRules = {
    {{"min", RestitutionRule::kMin},
     {"max", RestitutionRule::kMax},
     {"product", RestitutionRule::kProduct},
     {"mean", RestitutionRule::kMean},
     {"geometric", RestitutionRule::kGeometric}}};
constexpr std::array<std::pair<std::string_view, Precision>, 2> kPrecisions = {
    {{"double", Precision::kDouble}, {"float", Precision::kFloat}}};
constexpr std::array<std::pair<std::string_view, Method>, 2> kMethods = {
    {{"event", Method::kEvent}, {"empirical", Method::kEmpirical}}};

/// The enumerator that the string names.
template <class Table>
auto read_word(const Table& table, const Json& value, const Place& place) {
    std::string words;
    for (const auto& [word, enumerator] : table) {
        if (value.is_string() && value.get_ref<const std::string&>() == word) return enumerator;
        words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", word);
    }
    throw SceneError(place.text(),
                     fmt::format("must be one of {}, is {}", words,
                                 value.is_string() ? '"' + quotable(value.get_ref<const std::string&>()) + '"'
                                                   : std::string(kind_of(value))));
}

Box read_box(const Members& members) {
    Box box;
    members.require({"min", "max"});
    members.pair("min", box.min);
    members.pair("max", box.max);
    return box;
}

Domain read_domain(const Json& value, const Place& place) {
    const Members members(value, place, kDomainKeys);
    Domain domain;
    domain.box = read_box(members);
    members.number("restitution", domain.restitution);
    members.with("boundary", [&](const Json& words, const Place& at) {
        if (!words.is_array() || words.size() != 2)
            throw SceneError(at.text(),
                             fmt::format("must be an array of two words, one for x and one for y, is {}",
                                         words.is_array() ? fmt::format("an array of {}", words.size())
                                                          : std::string(kind_of(words))));
        for (std::size_t axis = 0; axis < 2; ++axis)
            domain.boundary[axis] = read_word(kBoundaries, words[axis], {&at, {}, axis});
    });
    return domain;
}

/// Category and mask, each 32 bits.
CollisionFilter read_filter(const Members& members) {
    CollisionFilter filter;
    const auto bits = [&members](std::string_view key, std::uint32_t& target) {
        members.with(key, [&target](const Json& value, const Place& at) {
            const std::uint64_t number = read_count(value, at);
            if (number > 0xffffffff)
                throw SceneError(at.text(), fmt::format("must be below 2^32, is {}", number));
            target = static_cast<std::uint32_t>(number);
        });
    };
    bits("category", filter.category);
    bits("mask", filter.mask);
    return filter;
}

Ball read_ball(const Json& value, const Place& place) {
    const Members members(value, place, kBallKeys);
    Ball ball;
    members.require({"position"});
    members.pair("position", ball.position);
    members.pair("velocity", ball.velocity);
    members.pair("acceleration", ball.acceleration);
    members.number("radius", ball.radius);
    members.number("mass", ball.mass);
    members.number("restitution", ball.restitution);
    members.with("static", [&](const Json& flag, const Place& at) { ball.is_static = read_flag(flag, at); });
    ball.filter = read_filter(members);
    return ball;
}

void read_radius(Fill& fill, const Json& value, const Place& place) {
    if (!value.is_object()) {
        if (!value.is_number())
            throw SceneError(
                place.text(),
                fmt::format("must be a number or an object with min and max, is {}", kind_of(value)));
        fill.radius_min = fill.radius_max = read_number(value, place);
        return;
    }
    const Members range(value, place, kRangeKeys);
    range.require({"min", "max"});
    range.number("min", fill.radius_min);
    range.number("max", fill.radius_max);
}

Fill read_fill(const Json& value, const Place& place) {
    const Members members(value, place, kFillKeys);
    Fill fill;
    members.with("count", [&](const Json& count, const Place& at) { fill.count = read_count(count, at); });
    members.number("packing_fraction", fill.packing_fraction);
    members.with("radius", [&](const Json& radius, const Place& at) { read_radius(fill, radius, at); });
    members.number("mass", fill.mass);
    members.number("density", fill.density);
    members.number("restitution", fill.restitution);
    members.number("temperature", fill.temperature);
    members.with("seed", [&](const Json& seed, const Place& at) { fill.seed = read_count(seed, at); });
    members.with("region", [&](const Json& region, const Place& at) {
        fill.region = read_box(Members(region, at, kRangeKeys));
    });
    fill.filter = read_filter(members);
    return fill;
}

Wall read_wall(const Json& value, const Place& place) {
    const Members members(value, place, kWallKeys);
    Wall wall;
    members.require({"from", "to"});
    members.pair("from", wall.from);
    members.pair("to", wall.to);
    members.number("restitution", wall.restitution);
    wall.filter = read_filter(members);
    return wall;
}

Attractor read_attractor(const Json& value, const Place& place) {
    const Members members(value, place, kAttractorKeys);
    Attractor attractor;
    members.require({"position", "strength"});
    members.pair("position", attractor.position);
    members.number("strength", attractor.strength);
    members.number("softening", attractor.softening);
    return attractor;
}

Sensor read_sensor(const Json& value, const Place& place) {
    const Members members(value, place, kSensorKeys);
    Sensor sensor;
    members.require({"corners"});
    members.with("corners", [&](const Json& corners, const Place& at) {
        if (!corners.is_array())
            throw SceneError(at.text(), fmt::format("must be an array of points, is {}", kind_of(corners)));
        for (std::size_t k = 0; k < corners.size(); ++k)
            sensor.corners.push_back(read_pair(corners[k], {&at, {}, k}));
    });
    members.number("radius", sensor.radius);
    sensor.filter = read_filter(members);
    return sensor;
}

/// Collects a scene member by member.
class SceneReader {
 public:
    explicit SceneReader(const fs::path& folder) : folder_(folder) {}

    /// Notes a key of the scene; says whether it is a list whose elements come one by one.
    bool begin(std::string_view key) {
        const auto* const known = std::find(std::begin(kSceneKeys), std::end(kSceneKeys), key);
        if (known == std::end(kSceneKeys)) fail_unknown_key({nullptr, key, {}}, kSceneKeys);
        if (is_given(key)) throw SceneError(std::string(key), "is given twice");
        given_.push_back(*known);
        return key == "balls" || key == "fill" || key == "walls" || key == "attractors" || key == "sensors";
    }

    void take(const Json& value, const Place& place) {
        if (place.index) return take_element(value, place);
        const std::string_view key = place.key;
        if (key == "name")
            scene_.name = read_string(value, place);
        else if (key == "domain")
            scene_.domain = read_domain(value, place);
        else if (key == "gravity")
            scene_.gravity = read_pair(value, place);
        else if (key == "restitution_rule")
            scene_.restitution_rule = read_word(kRules, value, place);
        else if (key == "contact_time")
            scene_.contact_time = read_number(value, place);
        else if (key == "speed_factor")
            scene_.speed_factor = read_number(value, place);
        else if (key == "precision")
            scene_.precision = read_word(kPrecisions, value, place);
        else if (key == "method")
            scene_.method = read_word(kMethods, value, place);
        else if (key == "step")
            scene_.step = read_number(value, place);
        else if (key == "tolerance")
            scene_.tolerance = read_number(value, place);
        else if (key == "max_travel")
            scene_.max_travel = read_number(value, place);
        else if (key == "allow_overlap")
            scene_.allows_overlap = read_flag(value, place);
        else if (key == "field_interval")
            scene_.field_interval = read_number(value, place);
        else if (key == "until")
            scene_.until = read_number(value, place);
        else if (key == "balls_file")
            balls_file_ = read_string(value, place);
        else if (key == "description" || key == "$schema")
            (void)read_string(value, place);
        else
            throw SceneError(place.text(), fmt::format("must be an array of objects, is {}", kind_of(value)));
    }

    Scene finish() {
        if (!is_given("until"))
            throw SceneError("until", "is required: the time at which the simulation ends");
        if (scene_.balls.empty() && scene_.fills.empty() && !is_given("balls_file"))
            throw SceneError("balls", "some balls are required: give balls, fill or balls_file");
        const std::size_t own_balls = scene_.balls.size();
        std::optional<XyzFrame> frame;
        if (is_given("balls_file")) frame = take_balls_file();
        try {
            check(scene_);
        } catch (const SceneError& error) {
            if (frame) rethrow_with_line(error, own_balls, *frame);
            throw;
        }
        return std::move(scene_);
    }

 private:
    [[nodiscard]] bool is_given(std::string_view key) const {
        return std::find(given_.begin(), given_.end(), key) != given_.end();
    }

    void take_element(const Json& value, const Place& place) {
        if (place.key == "balls")
            scene_.balls.push_back(read_ball(value, place));
        else if (place.key == "fill")
            scene_.fills.push_back(read_fill(value, place));
        else if (place.key == "walls")
            scene_.walls.push_back(read_wall(value, place));
        else if (place.key == "sensors")
            scene_.sensors.push_back(read_sensor(value, place));
        else
            scene_.attractors.push_back(read_attractor(value, place));
    }

    XyzFrame take_balls_file() {
        if (balls_file_.empty()) throw SceneError("balls_file", "must name a file, is \"\"");
        XyzFrame frame;
        try {
            frame = read_balls(folder_ / balls_file_);
        } catch (const FileError& error) {
            throw SceneError("balls_file", error.what());
        }
        scene_.balls.insert(scene_.balls.end(), frame.balls.begin(), frame.balls.end());
        frame.balls.clear();
        return frame;
    }

    /// A fault at `balls[1017].radius` that came from the balls file is reported with its line there.
    void rethrow_with_line(const SceneError& error, std::size_t own_balls, const XyzFrame& frame) const {
        for (std::size_t i = 0; i < frame.lines.size(); ++i) {
            const std::string prefix = fmt::format("balls[{}].", own_balls + i);
            if (!error.place().starts_with(prefix)) continue;
            const std::string what = error.what();
            throw SceneError(
                fmt::format("{}:{}: {}", balls_file_, frame.lines[i], error.place().substr(prefix.size())),
                what.substr(error.place().size() + 2));
        }
    }

    fs::path folder_;
    Scene scene_;
    std::string balls_file_;
    std::vector<std::string_view> given_;
};

}  // namespace

Scene parse_scene(std::string_view text, const fs::path& folder) {
    SceneReader reader(folder);
    stream_object(text, {[&](std::string_view key) { return reader.begin(key); },
                         [&](const Json& value, const Place& place) { reader.take(value, place); }});
    return reader.finish();
}

Scene read_scene(const fs::path& path) {
    std::string text;
    try {
        text = read_file(path);
    } catch (const FileError& error) {
        throw SceneError({}, error.what());
    }
    Scene scene = parse_scene(text, path.parent_path());
    if (scene.name.empty()) scene.name = path.stem().string();
    return scene;
}

}  // namespace carom
