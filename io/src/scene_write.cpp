// Scenes into JSON text, one ball or wall a line.
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <carom/io/scene_file.hpp>

namespace carom {
namespace {

std::string json(double value) {
    // "-0" would read back as the whole number 0.
    if (value == 0) return std::signbit(value) ? "-0.0" : "0";
    return fmt::format("{}", value);
}

std::string json(const Vec2& v) {
    return fmt::format("[{}, {}]", json(v.x()), json(v.y()));
}

std::string json(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json(const Box& box) {
    return fmt::format("{{\"min\": {}, \"max\": {}}}", json(box.min), json(box.max));
}

/// Same bits: -0 is not the default 0.
bool same(double a, double b) {
    return a == b && std::signbit(a) == std::signbit(b);
}
bool same(const Vec2& a, const Vec2& b) {
    return same(a.x(), b.x()) && same(a.y(), b.y());
}

/// The members of one object, on one line or each on its own.
class ObjectWriter {
 public:
    ObjectWriter(std::string& text, std::string_view separator) : text_(text), separator_(separator) {}

    void raw(std::string_view key, std::string_view value) {
        if (!first_) text_ += separator_;
        first_ = false;
        fmt::format_to(std::back_inserter(text_), "\"{}\": {}", key, value);
    }
    template <class T>
    void put(std::string_view key, const T& value) {
        raw(key, json(value));
    }
    template <class T>
    void put_unless(const T& usual, std::string_view key, const T& value) {
        if (!same(value, usual)) put(key, value);
    }

 private:
    std::string& text_;
    std::string_view separator_;
    bool first_ = true;
};

std::string_view word(Boundary boundary) {
    switch (boundary) {
        case Boundary::kWall:
            return "wall";
        case Boundary::kPeriodic:
            return "periodic";
        case Boundary::kOpen:
            break;
    }
    return "open";
}

std::string_view word(RestitutionRule rule) {
    switch (rule) {
        case RestitutionRule::kMax:
            return "max";
        case RestitutionRule::kProduct:
            return "product";
        case RestitutionRule::kMean:
            return "mean";
        case RestitutionRule::kGeometric:
            return "geometric";
        case RestitutionRule::kMin:
            break;
    }
    return "min";
}

void put_members(ObjectWriter& object, const Domain& domain) {
    object.put("min", domain.box.min);
    object.put("max", domain.box.max);
    object.raw("boundary",
               fmt::format("[\"{}\", \"{}\"]", word(domain.boundary[0]), word(domain.boundary[1])));
    object.put_unless(Domain{}.restitution, "restitution", domain.restitution);
}

void put_filter(ObjectWriter& object, const CollisionFilter& filter) {
    const CollisionFilter usual;
    if (filter.category != usual.category) object.raw("category", std::to_string(filter.category));
    if (filter.mask != usual.mask) object.raw("mask", std::to_string(filter.mask));
}

void put_members(ObjectWriter& object, const Ball& ball) {
    const Ball usual;
    object.put("position", ball.position);
    object.put_unless(usual.velocity, "velocity", ball.velocity);
    object.put_unless(usual.acceleration, "acceleration", ball.acceleration);
    object.put_unless(usual.radius, "radius", ball.radius);
    object.put_unless(usual.mass, "mass", ball.mass);
    object.put_unless(usual.restitution, "restitution", ball.restitution);
    if (ball.is_static) object.raw("static", "true");
    put_filter(object, ball.filter);
}

void put_members(ObjectWriter& object, const Fill& fill) {
    const Fill usual;
    if (fill.count) object.raw("count", std::to_string(*fill.count));
    if (fill.packing_fraction) object.put("packing_fraction", *fill.packing_fraction);
    if (fill.radius_min == fill.radius_max)
        object.put_unless(usual.radius_min, "radius", fill.radius_min);
    else
        object.raw("radius",
                   fmt::format("{{\"min\": {}, \"max\": {}}}", json(fill.radius_min), json(fill.radius_max)));
    if (fill.mass) object.put("mass", *fill.mass);
    if (fill.density) object.put("density", *fill.density);
    object.put_unless(usual.restitution, "restitution", fill.restitution);
    object.put_unless(usual.temperature, "temperature", fill.temperature);
    if (fill.seed != usual.seed) object.raw("seed", std::to_string(fill.seed));
    if (fill.region) object.put("region", *fill.region);
    put_filter(object, fill.filter);
}

void put_members(ObjectWriter& object, const Wall& wall) {
    object.put("from", wall.from);
    object.put("to", wall.to);
    object.put_unless(Wall{}.restitution, "restitution", wall.restitution);
    put_filter(object, wall.filter);
}

void put_members(ObjectWriter& object, const Attractor& attractor) {
    object.put("position", attractor.position);
    object.put("strength", attractor.strength);
    object.put_unless(Attractor{}.softening, "softening", attractor.softening);
}

void put_members(ObjectWriter& object, const Sensor& sensor) {
    std::string corners;
    for (const Vec2& corner : sensor.corners) corners += (corners.empty() ? "" : ", ") + json(corner);
    object.raw("corners", "[" + corners + "]");
    object.put_unless(Sensor{}.radius, "radius", sensor.radius);
    put_filter(object, sensor.filter);
}

template <class T>
std::string json_object(const T& value) {
    std::string text = "{";
    ObjectWriter object(text, ", ");
    put_members(object, value);
    return text + "}";
}

template <class T>
void put_list(ObjectWriter& object, std::string_view key, const std::vector<T>& values) {
    if (values.empty()) return;
    std::string text = "[";
    for (const T& value : values) {
        text += text.size() > 1 ? ",\n    " : "\n    ";
        text += json_object(value);
    }
    object.raw(key, text + "\n  ]");
}

}  // namespace

std::string write_scene(const Scene& scene) {
    const Scene usual;
    std::string text = "{\n  ";
    ObjectWriter object(text, ",\n  ");
    if (!scene.name.empty()) object.put("name", scene.name);
    if (scene.domain) object.raw("domain", json_object(*scene.domain));
    object.put_unless(usual.gravity, "gravity", scene.gravity);
    if (scene.restitution_rule != usual.restitution_rule)
        object.raw("restitution_rule", fmt::format("\"{}\"", word(scene.restitution_rule)));
    if (scene.contact_time) object.put("contact_time", *scene.contact_time);
    object.put_unless(usual.speed_factor, "speed_factor", scene.speed_factor);
    if (scene.precision == Precision::kFloat) object.raw("precision", "\"float\"");
    if (scene.method == Method::kEmpirical) object.raw("method", "\"empirical\"");
    if (scene.step) object.put("step", *scene.step);
    if (scene.tolerance) object.put("tolerance", *scene.tolerance);
    if (scene.max_travel) object.put("max_travel", *scene.max_travel);
    if (scene.allows_overlap) object.raw("allow_overlap", "true");
    put_list(object, "balls", scene.balls);
    put_list(object, "fill", scene.fills);
    put_list(object, "walls", scene.walls);
    put_list(object, "attractors", scene.attractors);
    put_list(object, "sensors", scene.sensors);
    object.put_unless(usual.field_interval, "field_interval", scene.field_interval);
    object.put("until", scene.until);
    return text + "\n}\n";
}

}  // namespace carom
