// Scene files: what is read is what is written, defaults and all, and no text whatever does worse than be
// refused.
#include <carom/io/scene_file.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <gtest/gtest.h>

#include "random_values.hpp"
#include "temporary_folder.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;
using testing_values::Generator;
using testing_values::same_bits;

std::vector<fs::path> scene_files() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(CAROM_SOURCE_DIR) / "scenes"))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string scene_message_of(const std::string& text, const fs::path& folder = {}) {
    try {
        (void)parse_scene(text, folder);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(SceneFile, HasTheDefaultsOfTheFormat) {
    const Scene scene = parse_scene(R"({"balls": [{"position": [1, 2]}], "until": 10})");
    EXPECT_EQ(scene.name, "");
    EXPECT_FALSE(scene.domain);
    EXPECT_EQ(scene.gravity, Vec2(0, 0));
    EXPECT_EQ(scene.restitution_rule, RestitutionRule::kMin);
    EXPECT_FALSE(scene.contact_time);
    EXPECT_EQ(scene.speed_factor, 1);
    EXPECT_EQ(scene.precision, Precision::kDouble);
    EXPECT_EQ(scene.method, Method::kEvent);
    EXPECT_EQ(scene.step, std::nullopt);
    EXPECT_EQ(scene.tolerance, std::nullopt);
    EXPECT_EQ(scene.max_travel, std::nullopt);
    EXPECT_FALSE(scene.allows_overlap);
    EXPECT_EQ(scene.field_interval, 0.02);
    EXPECT_EQ(scene.until, 10);
    ASSERT_EQ(scene.balls.size(), 1U);
    EXPECT_EQ(scene.balls[0].position, Vec2(1, 2));
    EXPECT_EQ(scene.balls[0].velocity, Vec2(0, 0));
    EXPECT_EQ(scene.balls[0].acceleration, Vec2(0, 0));
    EXPECT_EQ(scene.balls[0].radius, 0.5);
    EXPECT_EQ(scene.balls[0].mass, 1);
    EXPECT_EQ(scene.balls[0].restitution, 1);
    EXPECT_FALSE(scene.balls[0].is_static);
}

TEST(SceneFile, ReadsEveryKey) {
    const Scene scene = parse_scene(R"({
        "$schema": "../schemas/scene.schema.json", "name": "Alles", "description": "one of everything",
        "domain": {"min": [-50, 0], "max": [100, 200], "boundary": ["periodic", "wall"], "restitution": 0.25},
        "gravity": [0.5, -9.81], "restitution_rule": "geometric", "contact_time": 1e-3, "speed_factor": 0.9,
        "precision": "float", "allow_overlap": true,
        "method": "empirical", "step": 0.01, "tolerance": 1e-5, "max_travel": 0.1,
        "balls": [{"position": [1, 2], "velocity": [3, 4], "acceleration": [5, 6], "radius": 0.75, "mass": 8,
                   "restitution": 0.5},
                  {"position": [9, 10], "static": true}],
        "fill": [{"count": 1e2, "packing_fraction": 0.25, "radius": {"min": 0.5, "max": 1.5}, "density": 2, "restitution": 0.75,
                  "temperature": 3, "seed": 18446744073709551615, "region": {"min": [0, 20], "max": [60, 80]}},
                 {"packing_fraction": 0.125, "radius": 2, "mass": 7}],
        "walls": [{"from": [1, 20], "to": [3, 25], "restitution": 0.5}],
        "attractors": [{"position": [7, 8], "strength": -9, "softening": 10}],
        "field_interval": 0.125, "until": 1.5})");
    EXPECT_EQ(scene.name, "Alles");
    ASSERT_TRUE(scene.domain);
    const Domain domain = scene.domain.value_or(Domain{});
    EXPECT_EQ(domain.box.min, Vec2(-50, 0));
    EXPECT_EQ(domain.box.max, Vec2(100, 200));
    EXPECT_EQ(domain.boundary[0], Boundary::kPeriodic);
    EXPECT_EQ(domain.boundary[1], Boundary::kWall);
    EXPECT_EQ(domain.restitution, 0.25);
    EXPECT_EQ(scene.gravity, Vec2(0.5, -9.81));
    EXPECT_EQ(scene.restitution_rule, RestitutionRule::kGeometric);
    EXPECT_EQ(scene.contact_time, 1e-3);
    EXPECT_EQ(scene.speed_factor, 0.9);
    EXPECT_EQ(scene.precision, Precision::kFloat);
    EXPECT_EQ(scene.method, Method::kEmpirical);
    EXPECT_EQ(scene.step, 0.01);
    EXPECT_EQ(scene.tolerance, 1e-5);
    EXPECT_EQ(scene.max_travel, 0.1);
    EXPECT_TRUE(scene.allows_overlap);
    EXPECT_EQ(scene.field_interval, 0.125);
    EXPECT_EQ(scene.until, 1.5);

    ASSERT_EQ(scene.balls.size(), 2U);
    EXPECT_EQ(scene.balls[0].position, Vec2(1, 2));
    EXPECT_EQ(scene.balls[0].velocity, Vec2(3, 4));
    EXPECT_EQ(scene.balls[0].acceleration, Vec2(5, 6));
    EXPECT_EQ(scene.balls[0].radius, 0.75);
    EXPECT_EQ(scene.balls[0].mass, 8);
    EXPECT_EQ(scene.balls[0].restitution, 0.5);
    EXPECT_TRUE(scene.balls[1].is_static);

    ASSERT_EQ(scene.fills.size(), 2U);
    const Fill& fill = scene.fills[0];
    EXPECT_EQ(fill.count, 100U);
    EXPECT_EQ(fill.packing_fraction, 0.25);
    EXPECT_EQ(fill.radius_min, 0.5);
    EXPECT_EQ(fill.radius_max, 1.5);
    EXPECT_FALSE(fill.mass);
    EXPECT_EQ(fill.density, 2);
    EXPECT_EQ(fill.restitution, 0.75);
    EXPECT_EQ(fill.temperature, 3);
    EXPECT_EQ(fill.seed, 18446744073709551615U);
    ASSERT_TRUE(fill.region);
    const Box region = fill.region.value_or(Box{});
    EXPECT_EQ(region.min, Vec2(0, 20));
    EXPECT_EQ(region.max, Vec2(60, 80));
    EXPECT_FALSE(scene.fills[1].count);
    EXPECT_EQ(scene.fills[1].radius_min, 2);
    EXPECT_EQ(scene.fills[1].radius_max, 2);
    EXPECT_EQ(scene.fills[1].mass, 7);

    ASSERT_EQ(scene.walls.size(), 1U);
    EXPECT_EQ(scene.walls[0].from, Vec2(1, 20));
    EXPECT_EQ(scene.walls[0].to, Vec2(3, 25));
    EXPECT_EQ(scene.walls[0].restitution, 0.5);
    ASSERT_EQ(scene.attractors.size(), 1U);
    EXPECT_EQ(scene.attractors[0].position, Vec2(7, 8));
    EXPECT_EQ(scene.attractors[0].strength, -9);
    EXPECT_EQ(scene.attractors[0].softening, 10);
}

TEST(SceneFile, TakesItsNameFromTheFile) {
    const TemporaryFolder folder;
    put_file(folder / "two.json", R"({"balls": [{"position": [0, 0]}], "until": 0})");
    EXPECT_EQ(read_scene(folder / "two.json").name, "two");
}

TEST(SceneFile, TakesAByteOrderMarkAndWindowsLines) {
    EXPECT_EQ(scene_message_of("\xEF\xBB\xBF{\"balls\": [{\"position\": [0, 0]}],\r\n\"until\": 1}\r\n"),
              "accepted");
}

TEST(SceneFile, SuggestsTheNearestKeyAtEveryLevel) {
    const auto suggestion = [](std::string_view member) {
        return scene_message_of(
            fmt::format(R"({{{}, "balls": [{{"position": [0, 0]}}], "until": 1}})", member));
    };
    EXPECT_EQ(suggestion(R"("gravty": [0, 0])"), "gravty: unknown key, did you mean \"gravity\"?");
    EXPECT_EQ(suggestion(R"("ball": [])"), "ball: unknown key, did you mean \"balls\"?");
    EXPECT_EQ(suggestion(R"("fills": [])"), "fills: unknown key, did you mean \"fill\"?");
    EXPECT_EQ(suggestion(R"("domain": {"mni": [0, 0]})"), "domain.mni: unknown key, did you mean \"min\"?");
    EXPECT_EQ(suggestion(R"("fill": [{"tempertaure": 1}])"),
              "fill[0].tempertaure: unknown key, did you mean \"temperature\"?");
    EXPECT_EQ(suggestion(R"("fill": [{"radius": {"mean": 1}}])"),
              "fill[0].radius.mean: unknown key, did you mean \"min\"?");
    EXPECT_EQ(suggestion(R"("walls": [{"form": [0, 0]}])"),
              "walls[0].form: unknown key, did you mean \"from\"?");
}

TEST(SceneFile, BallsOfAFileFollowThoseOfTheScene) {
    const TemporaryFolder folder;
    put_file(folder / "more.xyz", "2\nProperties=pos:R:2:velo:R:2:radius:R:1\n7 8 1 2 0.25\n9 8 0 0 0.125\n");
    const Scene scene = parse_scene(
        R"({"balls_file": "more.xyz", "balls": [{"position": [0, 0]}], "until": 1})", folder.path());
    ASSERT_EQ(scene.balls.size(), 3U);
    EXPECT_EQ(scene.balls[0].position, Vec2(0, 0));
    EXPECT_EQ(scene.balls[1].position, Vec2(7, 8));
    EXPECT_EQ(scene.balls[1].velocity, Vec2(1, 2));
    EXPECT_EQ(scene.balls[2].radius, 0.125);
}

TEST(SceneFile, NamesTheLineOfABadBallInABallsFile) {
    const TemporaryFolder folder;
    put_file(folder / "bad.xyz", "3\nProperties=id:I:1:pos:R:2:radius:R:1\n3 1 2 1\n2 4 4 -1\n1 8 8 1\n");
    EXPECT_EQ(scene_message_of(R"({"balls_file": "bad.xyz", "balls": [{"position": [90, 0]}], "until": 1})",
                               folder.path()),
              "bad.xyz:4: radius: must be > 0, is -1");
    EXPECT_EQ(scene_message_of(
                  R"({"balls_file": "bad.xyz", "balls": [{"position": [90, 0], "mass": 0}], "until": 1})",
                  folder.path()),
              "balls[0].mass: must be > 0, is 0");
    put_file(folder / "torn.xyz", "3\n\nA 1 2 3\n");
    EXPECT_EQ(scene_message_of(R"({"balls_file": "torn.xyz", "until": 1})", folder.path()),
              "torn.xyz:3: the file ends after 1 of the frame's 3 balls");
}

Scene random_scene(Generator& generator) {
    using namespace testing_values;
    const auto list_length = [&] { return static_cast<std::size_t>(below(generator, 5)); };
    const auto coin = [&] { return below(generator, 2) == 0; };
    Scene scene;
    scene.name = coin() ? "" : "a \"name\"\n\\ with \xC3\xA4";
    if (coin()) {
        const Vec2 low = any_vector(generator) * 1e-3;
        scene.domain =
            Domain{{low, low + Vec2(1e100, 1e100) / 2}, {Boundary::kOpen, Boundary::kOpen}, unit(generator)};
    }
    scene.gravity = any_vector(generator);
    scene.restitution_rule = static_cast<RestitutionRule>(below(generator, 5));
    if (coin()) scene.contact_time = std::abs(any_allowed(generator));
    scene.speed_factor = 1 - unit(generator);
    scene.allows_overlap = coin();
    scene.balls.resize(1 + list_length());
    for (Ball& ball : scene.balls) {
        ball = {any_vector(generator),
                any_vector(generator),
                any_vector(generator),
                any_positive(generator),
                any_positive(generator),
                unit(generator),
                coin()};
        if (ball.is_static) ball.velocity = ball.acceleration = Vec2::Zero();
    }
    scene.fills.resize(list_length());
    for (Fill& fill : scene.fills) {
        fill.count = 1 + below(generator, 100000000);
        fill.packing_fraction = (1 - unit(generator)) * 0.9;
        fill.radius_min = fill.radius_max = any_positive(generator);
        if (coin()) fill.radius_max = std::min(fill.radius_min * 1.5, 1e100);
        if (coin())
            fill.mass = any_positive(generator);
        else if (coin())
            fill.density = any_positive(generator);
        fill.restitution = unit(generator);
        fill.temperature = std::abs(any_allowed(generator));
        fill.seed = generator();
        const double low = unit(generator);
        fill.region = Box{{low, -low}, {low + 1 + unit(generator), 7}};
    }
    scene.walls.resize(list_length());
    for (Wall& wall : scene.walls) {
        wall.from = any_vector(generator);
        wall.to = Vec2(unit(generator) + 1, wall.from.y());
        if (std::abs(wall.to.x() - wall.from.x()) < 1e-90) wall.to.x() += 1;
        wall.restitution = unit(generator);
    }
    scene.attractors.resize(list_length());
    for (Attractor& attractor : scene.attractors)
        attractor = {any_vector(generator), any_allowed(generator), std::abs(any_allowed(generator))};
    scene.sensors.resize(list_length());
    for (Sensor& sensor : scene.sensors) {
        sensor.corners.push_back(any_vector(generator));
        if (coin())
            sensor.corners = {{0, unit(generator)}, {-1 - unit(generator), 0}, {0.5, -unit(generator)}};
        sensor.radius = std::abs(any_allowed(generator));
        sensor.filter = {static_cast<std::uint32_t>(generator()), static_cast<std::uint32_t>(generator())};
    }
    scene.field_interval = any_positive(generator);
    scene.until = std::abs(any_allowed(generator));
    return scene;
}

bool same_bits(const std::optional<double>& a, const std::optional<double>& b) {
    return a.has_value() == b.has_value() && same_bits(a.value_or(0), b.value_or(0));
}

bool same_bits(const Box& a, const Box& b) {
    return same_bits(a.min, b.min) && same_bits(a.max, b.max);
}

void expect_same_balls(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.balls.size(), b.balls.size());
    for (std::size_t i = 0; i < a.balls.size(); ++i) {
        EXPECT_TRUE(same_bits(a.balls[i].position, b.balls[i].position));
        EXPECT_TRUE(same_bits(a.balls[i].velocity, b.balls[i].velocity));
        EXPECT_TRUE(same_bits(a.balls[i].acceleration, b.balls[i].acceleration));
        EXPECT_TRUE(same_bits(a.balls[i].radius, b.balls[i].radius));
        EXPECT_TRUE(same_bits(a.balls[i].mass, b.balls[i].mass));
        EXPECT_TRUE(same_bits(a.balls[i].restitution, b.balls[i].restitution));
        EXPECT_EQ(a.balls[i].is_static, b.balls[i].is_static);
    }
}

void expect_same_fills(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.fills.size(), b.fills.size());
    for (std::size_t i = 0; i < a.fills.size(); ++i) {
        EXPECT_EQ(a.fills[i].count, b.fills[i].count);
        EXPECT_TRUE(same_bits(a.fills[i].packing_fraction, b.fills[i].packing_fraction));
        EXPECT_TRUE(same_bits(a.fills[i].radius_min, b.fills[i].radius_min));
        EXPECT_TRUE(same_bits(a.fills[i].radius_max, b.fills[i].radius_max));
        EXPECT_TRUE(same_bits(a.fills[i].mass, b.fills[i].mass));
        EXPECT_TRUE(same_bits(a.fills[i].density, b.fills[i].density));
        EXPECT_TRUE(same_bits(a.fills[i].restitution, b.fills[i].restitution));
        EXPECT_TRUE(same_bits(a.fills[i].temperature, b.fills[i].temperature));
        EXPECT_EQ(a.fills[i].seed, b.fills[i].seed);
        EXPECT_EQ(a.fills[i].region.has_value(), b.fills[i].region.has_value());
        EXPECT_TRUE(same_bits(a.fills[i].region.value_or(Box{}), b.fills[i].region.value_or(Box{})));
    }
}

void expect_same_surroundings(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.domain.has_value(), b.domain.has_value());
    const Domain domain_a = a.domain.value_or(Domain{});
    const Domain domain_b = b.domain.value_or(Domain{});
    EXPECT_TRUE(same_bits(domain_a.box, domain_b.box));
    EXPECT_EQ(domain_a.boundary, domain_b.boundary);
    EXPECT_TRUE(same_bits(domain_a.restitution, domain_b.restitution));
    EXPECT_TRUE(same_bits(a.gravity, b.gravity));
    EXPECT_EQ(a.restitution_rule, b.restitution_rule);
    EXPECT_TRUE(same_bits(a.contact_time, b.contact_time));
    EXPECT_TRUE(same_bits(a.speed_factor, b.speed_factor));
    EXPECT_EQ(a.precision, b.precision);
    EXPECT_EQ(a.method, b.method);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.tolerance, b.tolerance);
    EXPECT_EQ(a.max_travel, b.max_travel);
    EXPECT_EQ(a.allows_overlap, b.allows_overlap);
    EXPECT_TRUE(same_bits(a.field_interval, b.field_interval));
    EXPECT_TRUE(same_bits(a.until, b.until));
    ASSERT_EQ(a.walls.size(), b.walls.size());
    for (std::size_t i = 0; i < a.walls.size(); ++i) {
        EXPECT_TRUE(same_bits(a.walls[i].from, b.walls[i].from));
        EXPECT_TRUE(same_bits(a.walls[i].to, b.walls[i].to));
        EXPECT_TRUE(same_bits(a.walls[i].restitution, b.walls[i].restitution));
    }
    ASSERT_EQ(a.attractors.size(), b.attractors.size());
    for (std::size_t i = 0; i < a.attractors.size(); ++i) {
        EXPECT_TRUE(same_bits(a.attractors[i].position, b.attractors[i].position));
        EXPECT_TRUE(same_bits(a.attractors[i].strength, b.attractors[i].strength));
        EXPECT_TRUE(same_bits(a.attractors[i].softening, b.attractors[i].softening));
    }
    ASSERT_EQ(a.sensors.size(), b.sensors.size());
    for (std::size_t i = 0; i < a.sensors.size(); ++i) {
        ASSERT_EQ(a.sensors[i].corners.size(), b.sensors[i].corners.size());
        for (std::size_t k = 0; k < a.sensors[i].corners.size(); ++k)
            EXPECT_TRUE(same_bits(a.sensors[i].corners[k], b.sensors[i].corners[k]));
        EXPECT_TRUE(same_bits(a.sensors[i].radius, b.sensors[i].radius));
        EXPECT_EQ(a.sensors[i].filter, b.sensors[i].filter);
    }
}

void expect_same(const Scene& a, const Scene& b) {
    expect_same_surroundings(a, b);
    expect_same_balls(a, b);
    expect_same_fills(a, b);
}

TEST(SceneFile, WrittenScenesReadBackBitForBit) {
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Generator generator(seed);
        const Scene scene = random_scene(generator);
        ASSERT_NO_THROW(check(scene));
        const std::string text = write_scene(scene);
        expect_same(scene, parse_scene(text));
        if (HasFailure()) FAIL() << text;
    }
}

TEST(SceneFile, EveryShippedSceneIsReadAndWrittenBack) {
    const std::vector<fs::path> files = scene_files();
    EXPECT_GE(files.size(), 11U);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.string());
        const Scene scene = read_scene(file);
        EXPECT_FALSE(scene.name.empty());
        EXPECT_GT(scene.until, 0);
        expect_same(scene, parse_scene(write_scene(scene)));
    }
}

TEST(SceneFile, HundredThousandBallsKeepTheirOrder) {
    std::string text = R"({"until": 1, "balls": [)";
    for (int i = 0; i < 100000; ++i) text += fmt::format("{}{{\"position\":[{},0.5]}}", i > 0 ? "," : "", i);
    const Scene scene = parse_scene(text + "]}");
    ASSERT_EQ(scene.balls.size(), 100000U);
    for (std::size_t i = 0; i < scene.balls.size(); ++i)
        ASSERT_EQ(scene.balls[i].position.x(), static_cast<double>(i));
}

// Bytes replaced, put in, taken out or doubled: the reader may accept the result or refuse it in one line,
// nothing else.
TEST(SceneFile, MutatedTextIsReadOrRefused) {
    std::vector<std::string> texts;
    for (const fs::path& file : scene_files()) texts.push_back(content_of(file));
    const std::string pieces = R"({}[]":,0-1.eE9 truenlfas\u)";
    std::size_t refused = 0;
    for (std::uint64_t seed = 1; seed <= 5000; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Generator generator(seed);
        std::string text = texts[testing_values::below(generator, texts.size())];
        const std::uint64_t changes = 1 + testing_values::below(generator, 4);
        for (std::uint64_t i = 0; i < changes && !text.empty(); ++i) {
            const std::size_t at = testing_values::below(generator, text.size());
            const std::size_t length = 1 + testing_values::below(generator, 20);
            switch (testing_values::below(generator, 5)) {
                case 0:
                    text[at] = static_cast<char>(generator());
                    break;
                case 1:
                    text[at] = pieces[testing_values::below(generator, pieces.size())];
                    break;
                case 2:
                    text.erase(at, length);
                    break;
                case 3:
                    text.insert(at, text.substr(testing_values::below(generator, text.size()), length));
                    break;
                default:
                    text.resize(at);
                    break;
            }
        }
        try {
            (void)parse_scene(text, "/nonexistent");
        } catch (const SceneError& error) {
            ++refused;
            const std::string message = error.what();
            EXPECT_FALSE(message.empty());
            EXPECT_TRUE(std::none_of(message.begin(), message.end(), [](char c) {
                return static_cast<unsigned char>(c) < 0x20;
            })) << message;
        }
    }
    EXPECT_GT(refused, 2500U);  // most changes break the JSON
    EXPECT_LT(refused, 5000U);  // some only change a digit or a name
}

}  // namespace
}  // namespace carom
