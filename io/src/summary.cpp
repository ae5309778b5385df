// Summary as JSON.
#include <carom/io/summary.hpp>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace carom {

std::string to_json(const Summary& summary) {
    using OrderedJson = nlohmann::ordered_json;
    const auto pair = [](const Vec2& v) { return OrderedJson::array({v.x(), v.y()}); };
    OrderedJson json;
    json["scene"] = summary.scene;
    json["method"] = summary.method;
    json["precision"] = summary.precision;
    json["threads"] = summary.threads;
    json["balls"] = summary.balls;
    json["walls"] = summary.walls;
    json["time"] = summary.time;
    json["ball_collisions"] = summary.ball_collisions;
    json["wall_collisions"] = summary.wall_collisions;
    json["events"] = summary.events;
    json["wall_seconds"] = summary.wall_seconds;
    json["collisions_per_second"] = summary.collisions_per_second;
    json["energy_initial"] = summary.energy_initial;
    json["energy_final"] = summary.energy_final;
    json["energy_relative_change"] = summary.energy_relative_change;
    json["momentum_initial"] = pair(summary.momentum_initial);
    json["momentum_final"] = pair(summary.momentum_final);
    json["max_overlap"] = summary.max_overlap;
    json["compressibility_factor"] =
        summary.compressibility_factor ? OrderedJson(*summary.compressibility_factor) : OrderedJson();
    json["windows"] = summary.windows;
    json["window_retries"] = summary.window_retries;
    const auto count = [](const std::optional<std::uint64_t>& n) {
        return n ? OrderedJson(*n) : OrderedJson();
    };
    json["steps"] = count(summary.steps);
    json["missed_collisions"] = count(summary.missed_collisions);
    json["peak_memory_bytes"] = summary.peak_memory_bytes;
    json["state_hash"] = fmt::format("{:016x}", summary.state_hash);
    // A scene's name may hold bytes that are no UTF-8; they must not cost the user the summary.
    return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace carom
