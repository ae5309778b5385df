// carom advise from outside: its figures against runs of the program and against an integrator of the test's
// own, its command line run as it stands, its errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <carom/io/scene_file.hpp>

#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

// A ball of unit speed on its way round a softened attractor; nothing collides.
constexpr const char* kOrbit = R"({"balls": [{"position": [3, 0], "velocity": [0, 1]}],
    "attractors": [{"position": [0, 0], "strength": 4, "softening": 1}], "field_interval": 0.2, "until": 6})";

// Far more than trying all takes, so that a machine's pause leaves nothing out.
constexpr const char* kTimeForAll = "10";

Json advice_of(const Folder& folder, std::vector<std::string> options) {
    options.insert(options.begin(), {"advise", "s.json", "--threads", "1", "--json"});
    const Result result = folder.run(options);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");  // progress is for terminals
    return Json::parse(result.out);
}

/// Runs what was advised, with more options behind it.
Result run_advised(const Folder& folder, const std::string& command, const std::string& more) {
    EXPECT_THAT(command, StartsWith("carom run "));
    return folder.run_shell("\"$0\"" + command.substr(5) + " " + more);
}

std::vector<Ball> balls_after(const Folder& folder, const std::string& command, const std::string& until) {
    EXPECT_EQ(run_advised(folder, command,
                          "--until " + until + " --final end.xyz --output-precision double --quiet")
                  .status,
              0)
        << command;
    return parse_scene(R"({"balls_file": ")" + folder.path("end.xyz") +
                       R"(", "allow_overlap": true, "until": 1})")
        .balls;
}

const Json& setting_of(const Json& advice, const std::string& name) {
    const auto& all = advice["settings"];
    const auto found = std::ranges::find_if(all, [&](const Json& s) { return s["name"] == name; });
    EXPECT_NE(found, all.end()) << name << " in " << advice.dump();
    return *found;
}

TEST(Advise, FiguresHangTogether) {
    const Folder folder;
    folder.write("s.json", busy_scene("wall"));
    const Json advice = advice_of(folder, {"--seconds", kTimeForAll, "--error", "0.01"});
    EXPECT_GT(advice["collisions_compared"], 50);
    ASSERT_GT(advice["settings"].size(), 3u);
    bool has_choice = false;
    for (const Json& s : advice["settings"]) {
        if (s["error"].is_null()) continue;
        const double largest = std::max({s["energy_error"].get<double>(), s["collision_error"].get<double>(),
                                         s["overlap"].get<double>(), s["place_error"].get<double>()});
        EXPECT_EQ(s["error"], largest);
        EXPECT_EQ(s["keeps"], largest <= 0.01);
        has_choice =
            has_choice || (s["name"] == advice["choice"] && s["keeps"] && s["command"] == advice["command"]);
    }
    EXPECT_TRUE(has_choice);
    // None that keeps the error is faster; the scene's own method gives way only to what clearly is.
    const double least =
        advice["choice"] == "event" ? 0.95 : setting_of(advice, advice["choice"])["time_ratio"].get<double>();
    for (const Json& s : advice["settings"])
        if (s["keeps"] && !s["time_ratio"].is_null()) {
            EXPECT_GE(s["time_ratio"], least) << s["name"];
        }
}

// What it calls a setting's error of place is what two runs of the program show, read from their files.
TEST(Advise, ErrorsAreThoseOfTheRuns) {
    const Folder folder;
    folder.write("s.json", busy_scene("wall"));
    const Json advice = advice_of(folder, {"--seconds", kTimeForAll, "--error", "0.01"});
    const std::string until = advice["until"].dump();
    const std::vector<Ball> exact = balls_after(folder, "carom run s.json", until);
    int steps = 0;
    for (const Json& s : advice["settings"]) {
        if (s["error"].is_null()) continue;
        const std::vector<Ball> other = balls_after(folder, s["command"], until);
        double sum = 0;
        for (std::size_t i = 0; i < exact.size(); ++i)
            sum += std::min(1.0, (exact[i].position - other[i].position).norm() / exact[i].radius);
        // One ball of the 144 stands still. Places are read a billionth of a sample after the end.
        EXPECT_NEAR(s["place_error"], sum / 143, 1e-8) << s["name"];
        if (!s["step"].is_null()) ++steps;
    }
    EXPECT_GT(steps, 0);
}

Vec2 pull_at(const Vec2& p) {
    return -4 * p / std::pow(p.squaredNorm() + 1, 1.5);
}

/// Where the orbit's ball is, by the classical method of Runge and Kutta.
Vec2 orbit_at(double time) {
    constexpr int kSteps = 100000;
    const double h = time / kSteps;
    Vec2 x(3, 0);
    Vec2 v(0, 1);
    for (int k = 0; k < kSteps; ++k) {
        const Vec2 x1 = v, v1 = pull_at(x);
        const Vec2 x2 = v + h / 2 * v1, v2 = pull_at(x + h / 2 * x1);
        const Vec2 x3 = v + h / 2 * v2, v3 = pull_at(x + h / 2 * x2);
        const Vec2 x4 = v + h * v3, v4 = pull_at(x + h * x3);
        x += h / 6 * (x1 + 2 * x2 + 2 * x3 + x4);
        v += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    }
    return x;
}

// Against the true orbit a setting is wrong by no more than it says; and it does not say far too much: at
// first order the reference's own uncertainty, which is added, is small against a coarse setting's error.
TEST(Advise, FieldsErrorIsThatOfTheTrueOrbit) {
    const Folder folder;
    folder.write("s.json", kOrbit);
    const Json advice = advice_of(folder, {"--seconds", "20", "--error", "0.05"});
    EXPECT_LE(advice["reference_error"], 0.05 / 4);
    EXPECT_GT(advice["reference_error"], 0);
    const Vec2 place = orbit_at(advice["until"]);
    int coarse = 0;
    for (const Json& s : advice["settings"]) {
        if (s["method"] != "event" || s["precision"] != "double" || s["error"].is_null()) continue;
        const std::vector<Ball> balls = balls_after(folder, s["command"], advice["until"].dump());
        const double wrong = std::min(1.0, (balls[0].position - place).norm() / 0.5);
        EXPECT_LT(wrong, 1.1 * s["error"].get<double>()) << s["name"];  // second order, a tenth
        if (s["place_error"] < 0.1 || s["place_error"] > 0.9) continue;
        ++coarse;
        EXPECT_GT(wrong, 0.8 * s["error"].get<double>()) << s["name"];
    }
    EXPECT_GT(coarse, 0);
    EXPECT_FALSE(setting_of(advice, "event")["keeps"]);
}

// The command line is for a shell, and undoes what the scene says of steps.
TEST(Advise, CommandLineRunsAsItStands) {
    const Folder folder;
    const std::string text = busy_scene("wall");
    folder.write("s.json", text);
    folder.write("my scene's.json",
                 with_keys(text, "\"method\": \"empirical\", \"step\": 1, \"max_travel\": 0.01, "));
    const Result result =
        folder.run({"advise", "my scene's.json", "--seconds", kTimeForAll, "--json", "--error", "0.5"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json advice = Json::parse(result.out);
    const auto hash = [](const Result& run) { return summary_value(run.out, "state_hash"); };
    const Json event = setting_of(advice, "event");
    EXPECT_EQ(hash(run_advised(folder, event["command"], "--quiet")),
              hash(folder.run({"run", "s.json", "--quiet"})));
    for (const Json& s : advice["settings"]) {
        if (s["step"].is_null()) continue;
        const std::string step = s["step"].dump();
        const Result plain = folder.run({"run", "s.json", "--quiet", "--method", "empirical", "--step", step,
                                         "--tolerance", s["tolerance"].dump()});
        EXPECT_EQ(hash(run_advised(folder, s["command"], "--quiet")), hash(plain)) << s["command"];
        return;
    }
    FAIL() << "no step was tried";
}

TEST(Advise, TableSaysWhatToRun) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result result = folder.run({"advise", "s.json", "--seconds", "1"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("one ball: 1 ball, compared from t = 0 to"));
    EXPECT_THAT(result.out, HasSubstr("keeps 0.001?"));
    EXPECT_THAT(result.out, HasSubstr("\n  carom run s.json --method "));
}

// Sensors change no bit, and steps, which know none, are not advised.
TEST(Advise, OfASceneWithSensors) {
    const Folder folder;
    folder.write("s.json", with_keys(busy_scene("wall"), R"("sensors": [{"corners": [[5, 5], [9, 5]]}], )"));
    const Json advice = advice_of(folder, {"--seconds", kTimeForAll, "--error", "0.5"});
    for (const Json& s : advice["settings"]) EXPECT_EQ(s["method"], "event");
    EXPECT_EQ(run_advised(folder, advice["command"], "--quiet").status, 0);
}

// Late in the scene: the same ball, later.
TEST(Advise, FromALaterTime) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Json advice = advice_of(folder, {"--seconds", "1", "--from", "4"});
    EXPECT_EQ(advice["from"], 4);
    EXPECT_GT(advice["until"], 4);
    EXPECT_LE(advice["until"], 9);
    expect_one_error(folder.run({"advise", "s.json", "--from", "9"}), 2, "--from");
}

TEST(Advise, WrongUsageAndInputAreOneLine) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    folder.write("now.json", R"({"balls": [{"position": [0, 0]}], "until": 0})");
    folder.write("fixed.json", R"({"balls": [{"position": [0, 0], "static": true}], "until": 1})");
    expect_one_error(folder.run({"advise"}), 2, "SCENE");
    expect_one_error(folder.run({"advise", "s.json", "--error", "0"}), 2, "--error");
    expect_one_error(folder.run({"advise", "s.json", "--seconds", "-1"}), 2, "--seconds");
    expect_one_error(folder.run({"advise", "none.json"}), 1, "none.json");
    expect_one_error(folder.run({"advise", "now.json"}), 1, "until: must be > 0");
    expect_one_error(folder.run({"advise", "fixed.json"}), 1, "none can move");
}

// An error below what the field's interval can be halved to: the table and a line, and no advice.
TEST(Advise, SaysWhereNothingKeepsTheError) {
    const Folder folder;
    folder.write("s.json", kOrbit);
    const Result result = folder.run({"advise", "s.json", "--error", "1e-9", "--seconds", "1"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.out, HasSubstr("keeps 1e-09?"));
    EXPECT_THAT(result.err, HasSubstr("carom: error: the reference itself could be found to"));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1);
}

// A ball at rest in free space, alone: no collisions, no speed, no steps to choose.
TEST(Advise, OfASceneWhereNothingHappens) {
    const Folder folder;
    folder.write("s.json", R"({"balls": [{"position": [0, 0]}], "until": 1})");
    // Of two that take no time the clock's noise chooses.
    EXPECT_THAT(advice_of(folder, {"--seconds", "1"})["choice"], testing::AnyOf("event", "event, float"));
}

}  // namespace
}  // namespace carom::testing_program
