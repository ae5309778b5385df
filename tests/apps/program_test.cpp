// The program from outside: statuses, messages, files.
#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(Program, HelpAndVersion) {
    const Folder folder;
    EXPECT_THAT(folder.run({"--version"}).out, StartsWith("carom 0."));
    EXPECT_EQ(folder.run({"--version"}).status, 0);
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--help"},
                                               {"run", "--help"},
                                               {"validate", "--help"},
                                               {"render", "--help"},
                                               {"advise", "--help"},
                                               {"view", "--help"},
                                               {"plot", "--help"}}) {
        const Result result = folder.run(arguments);
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
        EXPECT_THAT(result.out, HasSubstr("Examples:"));
    }
}

TEST(Program, WrongUsageIsOneLineAndStatusTwo) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    expect_one_error(folder.run({}), 2, "no command");
    expect_one_error(folder.run({"simulate"}), 2, "'simulate' is no command");
    expect_one_error(folder.run({"rum"}), 2, "'rum' is no command, did you mean run?");
    expect_one_error(folder.run({"s.json", "--quiet"}), 2, "did you mean carom run s.json?");
    expect_one_error(folder.run({"run"}), 2, "SCENE");
    expect_one_error(folder.run({"run", "s.json", "--picutre", "x.png"}), 2,
                     "--picutre: no option of carom run, did you mean --picture?");
    expect_one_error(folder.run({"run", "s.json", "t.json"}), 2, "not expected: t.json");
    expect_one_error(folder.run({"run", "s.json", "--frobnicate"}), 2, "--frobnicate");
    expect_one_error(folder.run({"run", "s.json", "--until", "soon"}), 2, "--until");
    expect_one_error(folder.run({"run", "s.json", "--until", "nan"}), 2, "--until");
    expect_one_error(folder.run({"run", "s.json", "--step", "0"}), 2, "--step");
    expect_one_error(folder.run({"run", "s.json", "--threads", "0"}), 2, "--threads");
    expect_one_error(folder.run({"run", "s.json", "--trajectory", "t.xyz"}), 2, "--every");
    expect_one_error(folder.run({"run", "s.json", "--every", "1"}), 2, "--trajectory");
    expect_one_error(folder.run({"run", "s.json", "--trajectory", "t.gro", "--every", "1"}), 2,
                     "unknown format '.gro'");
    expect_one_error(folder.run({"run", "s.json", "--picture", "p.mp4"}), 2,
                     "unknown picture format '.mp4' (known: .png, .svg)");
    expect_one_error(folder.run({"render", "s.json", "--out", "p.avi"}), 2,
                     "unknown format '.avi' (known: .png, .svg, .mp4, .gif)");
    expect_one_error(folder.run({"render", "s.json"}), 2, "--out");
    expect_one_error(folder.run({"render", "s.json", "--out", "p.png", "--size", "big"}), 2, "'big'");
    expect_one_error(folder.run({"run", "s.json", "--summary", "./s.json"}), 2, "overwrite the scene");
    expect_one_error(folder.run({"run", "s.json", "--summary", "x", "--events", "./x"}), 2, "same file");
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"s.json"}));
}

TEST(Program, ValidateSaysTheSameInJson) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result result = folder.run({"validate", "s.json", "--json"});
    EXPECT_EQ(result.status, 0);
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["scene"], "one ball");
    EXPECT_EQ(json["balls"], 1);
    EXPECT_EQ(json["static_balls"], 0);
    EXPECT_EQ(json["mass"], (nlohmann::json{2, 2}));
    EXPECT_EQ(json["speed"], (nlohmann::json{3, 3}));
    EXPECT_EQ(json["domain"]["boundary"], (nlohmann::json{"wall", "wall"}));
    EXPECT_NEAR(json["packing"].get<double>(), 0.0025 * std::numbers::pi, 1e-15);
    EXPECT_TRUE(json["step"].is_null());
    EXPECT_EQ(json["until"], 9);
    expect_one_error(folder.run({"validate", "none.json", "--json"}), 1, "none.json");
}

// The ball of 0.5 at speed 3 touches the gate at x = 8 at 2.5 / 3 and parts at 3.5 / 3, turns at 1.5 and
// comes again.
TEST(Program, WritesWhoComesIntoSensors) {
    const Folder folder;
    folder.write("s.json", with_keys(kOneBall, "\"sensors\": [{\"corners\": [[8, 0], [8, 10]]}], "));
    const Result result =
        folder.run({"run", "s.json", "--until", "2", "--sensings", "in.csv", "--picture", "p.svg"});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::vector<std::string> lines = lines_of(folder.read("in.csv"));
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[0], "time,sensor,ball,enters,x,y,vx,vy");
    EXPECT_THAT(lines[1], StartsWith("0.83333333333333"));
    EXPECT_THAT(lines[1], HasSubstr(",0,0,1,7.5"));
    EXPECT_THAT(lines[2], StartsWith("1.16666666666666"));
    EXPECT_THAT(lines[3], StartsWith("1.83333333333333"));
    EXPECT_THAT(lines[3], HasSubstr(",0,0,1,8.5"));
    EXPECT_THAT(lines[3], testing::EndsWith(",5,-3,0"));

    folder.write("none.json", kOneBall);
    expect_one_error(folder.run({"run", "none.json", "--sensings", "in.csv"}), 2, "this has none");
    expect_one_error(folder.run({"run", "s.json", "--sensings", "s.json"}), 2, "overwrite the scene");
    expect_one_error(folder.run({"run", "s.json", "--method", "empirical"}), 1, "sensors: must be none");
}

// Simulated in float, or in double and written in float: other trajectories, fewer digits.
TEST(Program, PrecisionOfTheSimulationAndOfItsOutput) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const auto run = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"run", "s.json", "--quiet", "--final", "end.xyz"});
        return folder.run(options).out;
    };
    const std::string in_double = run({});
    EXPECT_THAT(in_double, HasSubstr("\"precision\": \"double\""));
    const std::string digits = folder.read("end.xyz");
    const auto hash = [](const std::string& summary) { return summary.substr(summary.find("state_hash")); };

    const std::string read_in_float = run({"--output-precision", "float"});
    EXPECT_EQ(hash(read_in_float), hash(in_double)) << "the simulation is the same";
    EXPECT_LT(folder.read("end.xyz").size(), 0.7 * double(digits.size()));

    const std::string in_float = run({"--precision", "float"});
    EXPECT_THAT(in_float, HasSubstr("\"precision\": \"float\""));
    EXPECT_NE(hash(in_float), hash(in_double));
    EXPECT_LT(folder.read("end.xyz").size(), 0.7 * double(digits.size()));
    EXPECT_EQ(hash(run({"--precision", "float", "--threads", "1", "--step", "0.3"})), hash(in_float));
    expect_one_error(folder.run({"run", "s.json", "--precision", "half"}), 2, "--precision");
}

// The other method: its result depends on its own options, not on threads; the summary says what it was.
TEST(Program, EmpiricalMethod) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const auto run = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"run", "s.json", "--quiet"});
        return folder.run(options).out;
    };
    const auto hash = [](const std::string& summary) { return summary_value(summary, "state_hash"); };
    const std::string event = run({});
    EXPECT_EQ(summary_value(event, "steps"), "null");
    EXPECT_EQ(summary_value(event, "missed_collisions"), "null");
    EXPECT_EQ(hash(run({"--method", "event"})), hash(event));

    const std::string stepped = run({"--method", "empirical", "--step", "0.1"});
    EXPECT_EQ(summary_value(stepped, "method"), "\"empirical\"");
    EXPECT_NE(hash(stepped), hash(event));
    EXPECT_NE(summary_value(stepped, "missed_collisions"), "null");
    EXPECT_EQ(hash(run({"--method", "empirical", "--step", "0.1", "--threads", "1"})), hash(stepped));
    EXPECT_NE(hash(run({"--method", "empirical", "--step", "0.05"})), hash(stepped));
    EXPECT_NE(hash(run({"--method", "empirical", "--step", "0.1", "--tolerance", "1e-3"})), hash(stepped));
    EXPECT_NE(hash(run({"--method", "empirical", "--step", "0.1", "--max-travel", "0.02"})), hash(stepped));
    const std::string uncounted = run({"--method", "empirical", "--step", "0.1", "--no-missed"});
    EXPECT_EQ(summary_value(uncounted, "missed_collisions"), "null");
    EXPECT_EQ(hash(uncounted), hash(stepped));

    EXPECT_THAT(folder.run({"validate", "s.json"}).out, HasSubstr("method        event\n"));
    expect_one_error(folder.run({"run", "s.json", "--method", "exact"}), 2, "--method");
    expect_one_error(folder.run({"run", "s.json", "--method", "empirical", "--tolerance", "0"}), 2,
                     "--tolerance");
    expect_one_error(folder.run({"run", "s.json", "--tolerance", "1e-6"}), 2, "--method empirical");
    expect_one_error(folder.run({"run", "s.json", "--no-missed"}), 2, "--method empirical");
    expect_one_error(folder.run({"run", "s.json", "--method", "empirical", "--max-travel", "0"}), 1,
                     "max_travel: must be > 0");
}

TEST(Program, EmpiricalMethodFromTheScene) {
    const Folder folder;
    folder.write("s.json", with_keys(kOneBall, "\"method\": \"empirical\", \"step\": 0.25, "));
    EXPECT_THAT(folder.run({"validate", "s.json"}).out, HasSubstr("method        empirical, step 0.25\n"));
    const std::string out = folder.run({"run", "s.json", "--quiet"}).out;
    EXPECT_EQ(summary_value(out, "method"), "\"empirical\"");
    EXPECT_EQ(summary_value(out, "steps"), "36");  // until 9
    EXPECT_EQ(summary_value(out, "wall_collisions"), "3");
    EXPECT_EQ(summary_value(folder.run({"run", "s.json", "--method", "event"}).out, "method"), "\"event\"");
}

TEST(Program, OverlapIsAllowedWhereTheSceneSaysSo) {
    const Folder folder;
    folder.write("s.json", R"({"allow_overlap": true, "until": 1,
        "balls": [{"position": [0, 0], "velocity": [1, 0]}, {"position": [0.5, 0]}]})");
    EXPECT_EQ(folder.run({"validate", "s.json"}).status, 0);
    EXPECT_THAT(folder.run({"run", "s.json", "--quiet"}).out, HasSubstr("\"ball_collisions\": 1,"));
}

TEST(Program, WrongInputOrOutputIsOneLineAndStatusOne) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    folder.write("broken.json", "{ \"balls\": [ }");
    folder.write("overlap.json", R"({"balls": [{"position": [0, 0]}, {"position": [0.5, 0]}], "until": 1})");
    folder.write("radius.json", R"({"balls": [{"position": [0, 0], "radius": -1}], "until": 1})");
    for (const std::string command : {"run", "validate"}) {
        expect_one_error(folder.run({command, "none.json"}), 1, "none.json");
        expect_one_error(folder.run({command, "broken.json"}), 1, "line 1");
        expect_one_error(folder.run({command, "overlap.json"}), 1, "overlaps balls[1]");
        expect_one_error(folder.run({command, "radius.json"}), 1, "balls[0].radius");
    }
    for (const char* const option : {"--summary", "--events"}) {
        expect_one_error(folder.run({"run", "s.json", option, "no/such/file"}), 1, "no/such/file");
    }
    expect_one_error(folder.run({"run", "s.json", "--picture", "no/such.png"}), 1, "no/such.png");
    expect_one_error(folder.run({"run", "s.json", "--final", "no/such.xyz"}), 1, "no/such.xyz");
    expect_one_error(folder.run({"run", "s.json", "--trajectory", "no/such.xyz", "--every", "1"}), 1,
                     "no/such.xyz");
    expect_one_error(folder.run({"render", "s.json", "--out", "no/such.png"}), 1, "no/such.png");
    EXPECT_EQ(folder.names(),
              (std::vector<std::string>{"broken.json", "overlap.json", "radius.json", "s.json"}));
}

TEST(Program, AnUnwritableOutputCostsNoOldOneAndNoRun) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    folder.write("t.xyz", "precious");
    folder.write("events.csv", "precious, too");
    // A run to this time would not end while anybody waits.
    expect_one_error(folder.run({"run", "s.json", "--until", "1e15", "--trajectory", "t.xyz", "--every", "1",
                                 "--events", "events.csv", "--summary", "no/such"}),
                     1, "no/such");
    EXPECT_EQ(folder.read("t.xyz"), "precious");
    EXPECT_EQ(folder.read("events.csv"), "precious, too");
}

TEST(Program, SummaryHasItsKeysInOrder) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result result = folder.run({"run", "s.json"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    std::size_t last = 0;
    for (const char* const key : {"scene",
                                  "method",
                                  "precision",
                                  "threads",
                                  "balls",
                                  "walls",
                                  "time",
                                  "ball_collisions",
                                  "wall_collisions",
                                  "events",
                                  "wall_seconds",
                                  "collisions_per_second",
                                  "energy_initial",
                                  "energy_final",
                                  "energy_relative_change",
                                  "momentum_initial",
                                  "momentum_final",
                                  "max_overlap",
                                  "compressibility_factor",
                                  "windows",
                                  "window_retries",
                                  "steps",
                                  "missed_collisions",
                                  "peak_memory_bytes",
                                  "state_hash"}) {
        const std::size_t place = result.out.find(std::string("\"").append(key).append("\":"));
        ASSERT_NE(place, std::string::npos) << key;
        EXPECT_GT(place, last) << key;
        last = place;
    }
    EXPECT_EQ(summary_value(result.out, "scene"), "\"one ball\"");
    EXPECT_EQ(summary_value(result.out, "method"), "\"event\"");
    EXPECT_EQ(summary_value(result.out, "balls"), "1");
    EXPECT_EQ(summary_value(result.out, "time"), "9.0");
    EXPECT_EQ(summary_value(result.out, "wall_collisions"), "3");
    EXPECT_EQ(summary_value(result.out, "energy_initial"), "9.0");
    EXPECT_EQ(summary_value(result.out, "energy_relative_change"), "0.0");
    EXPECT_GT(std::stoull(summary_value(result.out, "peak_memory_bytes")), 1'000'000U);
}

TEST(Program, SummaryGoesWhereItIsTold) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result to_file = folder.run({"run", "s.json", "--summary", "sum.json", "--quiet"});
    EXPECT_EQ(to_file.status, 0);
    EXPECT_EQ(to_file.out, "");
    EXPECT_EQ(to_file.err, "");
    EXPECT_EQ(summary_value(folder.read("sum.json"), "time"), "9.0");
    const Result to_output = folder.run({"run", "s.json", "--summary", "-", "--until", "0"});
    EXPECT_EQ(summary_value(to_output.out, "time"), "0.0");
    EXPECT_EQ(summary_value(to_output.out, "events"), "0");
}

TEST(Program, EventsAreTheBouncesOfOneBall) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    ASSERT_EQ(folder.run({"run", "s.json", "--events", "e.csv"}).status, 0);
    // Walls are numbered left, right, bottom, top; the impulse is 2 m v.
    EXPECT_EQ(folder.read("e.csv"),
              "time,kind,i,j,x,y,nx,ny,impulse\n"
              "1.5,wall,0,1,10,5,-1,0,12\n"
              "4.5,wall,0,0,0,5,1,0,12\n"
              "7.5,wall,0,1,10,5,-1,0,12\n");
}

TEST(Program, TrajectoryHasAFrameEachStepAndOneAtTheEnd) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const auto times_of = [&](const std::string& name) {
        std::vector<double> times;
        for (const std::string& line : lines_of(folder.read(name))) {
            if (const std::size_t place = line.find("Time="); place != std::string::npos)
                times.push_back(std::stod(line.substr(place + 5)));
        }
        return times;
    };
    ASSERT_EQ(folder
                  .run({"run", "s.json", "--until", "1", "--trajectory", "t.xyz", "--every", "0.1", "--final",
                        "f.xyz"})
                  .status,
              0);
    std::vector<double> wanted;
    wanted.reserve(11);
    for (int k = 0; k < 10; ++k) wanted.push_back(k * 0.1);
    wanted.push_back(1);
    EXPECT_EQ(times_of("t.xyz"), wanted);
    ASSERT_EQ(folder.run({"run", "s.json", "--until", "1", "--trajectory", "u.xyz", "--every", "0.4"}).status,
              0);
    EXPECT_EQ(times_of("u.xyz"), (std::vector<double>{0, 0.4, 0.8, 1}));
    ASSERT_EQ(folder.run({"run", "s.json", "--until", "0", "--trajectory", "v.xyz", "--every", "0.4"}).status,
              0);
    EXPECT_EQ(times_of("v.xyz"), (std::vector<double>{0}));
    // The last frame is the final state.
    const std::string all = folder.read("t.xyz");
    const std::string last = folder.read("f.xyz");
    ASSERT_GT(all.size(), last.size());
    EXPECT_EQ(all.substr(all.size() - last.size()), last);
}

TEST(Program, HashIsTheSameForThreadsStepsCellsAndFrames) {
    const Folder folder;
    for (const std::string boundary : {"wall", "periodic", "open"}) {
        SCOPED_TRACE(boundary);
        folder.write("s.json", busy_scene(boundary));
        const Result plain = folder.run({"run", "s.json", "--threads", "1"});
        ASSERT_EQ(plain.status, 0) << plain.err;
        EXPECT_NE(summary_value(plain.out, "ball_collisions"), "0");
        for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
                 {"--threads", "2"},
                 {"--threads", "3", "--step", "0.0171"},
                 {"--step", "1"},
                 {"--cell-size", "1.9"},
                 {"--cell-size", "4.1", "--step", "0.3"},
                 {"--trajectory", "t.xyz", "--every", "0.07", "--events", "e.csv", "--picture", "p.png"}}) {
            std::vector<std::string> arguments = {"run", "s.json"};
            arguments.insert(arguments.end(), options.begin(), options.end());
            const Result other = folder.run(arguments);
            EXPECT_EQ(other.status, 0) << other.err;
            for (const char* const key : {"state_hash", "ball_collisions", "wall_collisions"}) {
                EXPECT_EQ(summary_value(other.out, key), summary_value(plain.out, key)) << options.front();
            }
        }
        const Result earlier = folder.run({"run", "s.json", "--until", "14.9"});
        EXPECT_NE(summary_value(earlier.out, "state_hash"), summary_value(plain.out, "state_hash"));
    }
}

TEST(Program, ValidateSaysWhatIsThere) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const Result result = folder.run({"validate", "s.json"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* const part : {"busy", "144 (1 static)", "x periodic, y wall", "0.282743", "(0, -0.5)",
                                   "kernel        uniform acceleration (gravity), ", "x periodic, y walled",
                                   "bounds on vectors: yes"}) {
        EXPECT_THAT(result.out, HasSubstr(part));  // 144 pi 0.36 / 576 = 0.2827433
    }
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"s.json"}));
}

TEST(Program, RenderDrawsTheTimeAskedFor) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    ASSERT_EQ(folder.run({"render", "s.json", "--out", "start.png", "--size", "640x480"}).status, 0);
    ASSERT_EQ(
        folder.run({"render", "s.json", "--out", "later.png", "--size", "640x480", "--time", "6"}).status, 0);
    ASSERT_EQ(folder.run({"render", "s.json", "--out", "later.svg", "--time", "6"}).status, 0);
    cairo_surface_t* const image = cairo_image_surface_create_from_png(folder.path("start.png").c_str());
    EXPECT_EQ(cairo_surface_status(image), CAIRO_STATUS_SUCCESS);
    EXPECT_EQ(cairo_image_surface_get_width(image), 640);
    EXPECT_EQ(cairo_image_surface_get_height(image), 480);
    cairo_surface_destroy(image);
    EXPECT_NE(folder.read("start.png"), folder.read("later.png"));
    EXPECT_THAT(folder.read("later.svg"), StartsWith("<?xml"));
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"later.png", "later.svg", "s.json", "start.png"}));
}

}  // namespace
}  // namespace carom::testing_program
