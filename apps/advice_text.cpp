// Advice as text.
#include "advice_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "options.hpp"

namespace carom::app {
namespace {

using Row = std::vector<std::string>;

// Quoted for a shell where it holds more than letters that no shell minds.
std::string shell_word(const std::string& word) {
    const auto is_plain = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               std::string_view("_-./+:,@%").find(c) != std::string_view::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string figure(double value) {
    return value == 0 ? "0" : fmt::format("{:.1e}", value);
}

std::string ratio(double value) {
    return fmt::format("{:.{}f}", value, value < 0.995 ? 3 : value < 9.95 ? 2 : 1);
}

Row row_of(const trade::Trial& t, bool is_choice) {
    if (!t.errors) return {t.name, "-", "-", "-", "-", "-", "-", "too slow to be worth its end"};
    const trade::Errors& e = *t.errors;
    return {t.name,
            t.time ? ratio(t.time->median) : "-",
            figure(e.energy),
            figure(e.collisions),
            figure(e.overlap),
            figure(e.places),
            figure(t.error),
            !t.keeps    ? "no"
            : is_choice ? "yes, the fastest"
                        : "yes"};
}

// The first and the last column of words, the others of figures.
std::string aligned(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const Row& row : rows) {
        text += fmt::format("{:<{}}", row[0], widths[0]);
        for (std::size_t c = 1; c + 1 < row.size(); ++c) text += fmt::format("  {:>{}}", row[c], widths[c]);
        text += "  " + row.back() + "\n";
    }
    return text;
}

std::string conclusion(const AdviceRequest& request, const trade::Advice& advice) {
    if (!advice.choice) return "";
    const trade::Trial& best = advice.trials[*advice.choice];
    const double ratio = best.time.value_or(trade::TimeRatio{}).median;
    const std::string faster =
        ratio < 0.95 ? fmt::format(", {:.3g} times as fast as the scene's event method", 1 / ratio) : "";
    return fmt::format("\nThe fastest that keeps an error of {:g}: {}{}\n  {}\n", request.error, best.name,
                       faster, command_of(request, best.scene));
}

nlohmann::ordered_json json_of(const AdviceRequest& request, const trade::Trial& t) {
    using Json = nlohmann::ordered_json;
    const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
    const auto error = [&t](double trade::Errors::* part) {
        return t.errors ? Json((*t.errors).*part) : Json();
    };
    Json json;
    json["name"] = t.name;
    json["method"] = name_of(t.scene.method);
    json["precision"] = name_of(t.scene.precision);
    json["step"] = number(t.scene.step);
    json["tolerance"] = number(t.scene.tolerance);
    json["field_interval"] = t.scene.attractors.empty() ? Json() : Json(t.scene.field_interval);
    json["time_ratio"] = t.time ? Json(t.time->median) : Json();
    json["time_ratio_least"] = t.time ? Json(t.time->least) : Json();
    json["time_ratio_most"] = t.time ? Json(t.time->most) : Json();
    json["energy_error"] = error(&trade::Errors::energy);
    json["collision_error"] = error(&trade::Errors::collisions);
    json["overlap"] = error(&trade::Errors::overlap);
    json["place_error"] = error(&trade::Errors::places);
    json["error"] = t.errors ? Json(t.error) : Json();
    json["keeps"] = t.keeps;
    json["command"] = command_of(request, t.scene);
    return json;
}

}  // namespace

std::string command_of(const AdviceRequest& request, const Scene& setting) {
    std::string line =
        fmt::format("carom run {} --method {}", shell_word(request.path), name_of(setting.method));
    const auto add = [&line](const std::string& option, const auto& value) {
        line += fmt::format(" {} {}", option, value);
    };
    if (setting.method == Method::kEmpirical) {
        add("--step", setting.step.value_or(0));
        add("--tolerance", setting.tolerance.value_or(0));
        if (request.scene.max_travel) add("--max-travel", 0);  // or the scene's would shorten steps
        line += " --no-missed";
    }
    if (setting.precision != request.scene.precision) add("--precision", name_of(setting.precision));
    if (setting.field_interval != request.scene.field_interval)
        add("--field-interval", setting.field_interval);
    if (request.threads > 0) add("--threads", request.threads);
    return line;
}

std::string table_of(const AdviceRequest& request, const trade::Advice& advice) {
    std::string text = fmt::format(
        "{}: {} ball{}, compared from t = {:.4g} to {:.4g}, {:.2g} collisions a ball, {} of them one by "
        "one\n",
        request.scene.name, request.scene.balls.size(), request.scene.balls.size() == 1 ? "" : "s",
        request.from, request.from + advice.until, advice.collisions_a_ball, advice.compared);
    if (advice.reference_error > 0)
        text += fmt::format("The reference itself is uncertain by {:.1e}, which every error has in it.\n",
                            advice.reference_error);
    std::vector<Row> rows = {{"setting", "time", "energy", "collisions", "overlap", "places", "error",
                              fmt::format("keeps {:g}?", request.error)}};
    for (std::size_t k = 0; k < advice.trials.size(); ++k)
        rows.push_back(row_of(advice.trials[k], advice.choice == k));
    text += "\n" + aligned(rows);
    if (advice.is_cut_short)
        text += fmt::format("Time was up after {:g} s: not all was tried (--seconds).\n", request.seconds);
    return text + conclusion(request, advice);
}

std::string json_of(const AdviceRequest& request, const trade::Advice& advice) {
    using Json = nlohmann::ordered_json;
    Json json;
    json["scene"] = request.scene.name;
    json["balls"] = request.scene.balls.size();
    json["asked_error"] = request.error;
    json["seconds"] = request.seconds;
    json["from"] = request.from;
    json["until"] = request.from + advice.until;
    json["collisions_a_ball"] = advice.collisions_a_ball;
    json["collisions_compared"] = advice.compared;
    json["reference_error"] = advice.reference_error;
    json["cut_short"] = advice.is_cut_short;
    json["choice"] = advice.choice ? Json(advice.trials[*advice.choice].name) : Json();
    json["command"] = advice.choice ? Json(command_of(request, advice.trials[*advice.choice].scene)) : Json();
    json["settings"] = Json::array();
    for (const trade::Trial& t : advice.trials) json["settings"].push_back(json_of(request, t));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace carom::app
