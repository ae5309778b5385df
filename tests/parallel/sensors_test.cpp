// Sensors: who comes and goes, at the true times, and that looking on changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <carom/parallel/world.hpp>

#include "core/sensor_distance.hpp"
#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

using Told =
    std::vector<std::tuple<double, std::uint32_t, std::uint32_t, bool, double, double, double, double>>;

void listen(World& world, Told& told) {
    world.on_sensing([&told](const Sensing& s) {
        told.emplace_back(s.time, s.sensor, s.ball, s.enters, s.position.x(), s.position.y(), s.velocity.x(),
                          s.velocity.y());
    });
}

/// A point, a gate, a triangle and a box across the corner of the periodic sides.
std::vector<Sensor> sensors_for(const Scene& s) {
    const Box box = s.domain->box;
    const auto at = [&](double x, double y) {
        return Vec2(box.min + (box.max - box.min).cwiseProduct(Vec2(x, y)));
    };
    return {{{at(0.3, 0.3)}, 2},
            {{at(0.1, 0.8), at(0.9, 0.6)}},
            {{at(0.5, 0.2), at(0.9, 0.25), at(0.7, 0.55)}, 0.3},
            {{at(0.95, 0.95), at(1.05, 0.95), at(1.05, 1.05), at(0.95, 1.05)}}};
}

class SensedScenes : public testing::TestWithParam<NamedScene> {};

Told sensed(const Scene& scene, const WorldOptions& options, double until, int frames, std::uint64_t* hash) {
    World world(scene, options);
    Told told;
    listen(world, told);
    for (int k = 1; k <= frames; ++k) world.advance_to(until * k / frames);
    *hash = world.state_hash();
    return told;
}

TEST_P(SensedScenes, SameBitsForThreadsDomainsAndFramesAndNoneChangesTheCourse) {
    Scene scene = GetParam().scene;
    constexpr double kUntil = 5;
    World without(scene, {.threads = 1});
    without.advance_to(kUntil);
    scene.sensors = sensors_for(scene);
    std::uint64_t hash = 0;
    const Told expected = sensed(scene, {.threads = 1, .domains = 1}, kUntil, 1, &hash);
    EXPECT_GT(expected.size(), 10U);
    EXPECT_EQ(hash, without.state_hash());
    const std::vector<std::pair<WorldOptions, int>> others = {{{.threads = 1, .domains = 1}, 37},
                                                              {{.threads = 2, .domains = 3}, 1},
                                                              {{.threads = 2, .domains = 8}, 53}};
    for (const auto& [options, frames] : others) {
        const Told told = sensed(scene, options, kUntil, frames, &hash);
        EXPECT_TRUE(told == expected) << options.domains << " domains, " << frames << " frames";
        EXPECT_EQ(hash, without.state_hash());
    }
    // From a snapshot on, in another world.
    World half_way(scene, {.domains = 2});
    half_way.advance_to(2);
    World resumed(scene, {.domains = 3}, half_way.snapshot());
    Told rest;
    listen(resumed, rest);
    resumed.advance_to(kUntil);
    const auto later = std::ranges::find_if(expected, [](const auto& t) { return std::get<0>(t) > 2; });
    EXPECT_TRUE(std::ranges::equal(later, expected.end(), rest.begin(), rest.end()));
    rest.clear();
    resumed.restore(half_way.snapshot());
    resumed.advance_to(kUntil);
    EXPECT_TRUE(std::ranges::equal(later, expected.end(), rest.begin(), rest.end()));
}

// Everything at multiples of 2^-k: balls on a lattice at speed one, sensors between them. Collisions, balls
// at sensors, frames and whatever the engine divides time by fall on the same instants, and order must not
// show it.
TEST(Sensors, HaveOneOrderWhereAllHappensAtOnce) {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {16, 16}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.until = 8;
    for (int i = 0; i < 256; ++i) {
        Ball b;
        b.radius = 0.25;
        b.position = {i % 16 + 0.5, i / 16 + 0.5};
        b.velocity = i % 3 == 0 ? Vec2(1, 0) : i % 3 == 1 ? Vec2(-1, 0) : Vec2(0, 1);
        scene.balls.push_back(b);
    }
    scene.sensors = {
        {{{3.25, 0}, {3.25, 16}}}, {{{8, 8}}, 2}, {{{10, 2}, {14, 2}, {14, 6}, {10, 6}}}, {{{16, 16}}, 1}};
    std::uint64_t hash = 0;
    const Told expected = sensed(scene, {.threads = 1, .domains = 1}, 8, 1, &hash);
    EXPECT_GT(expected.size(), 300U);
    for (const int domains : {1, 2, 5, 9})
        for (const int frames : {1, 7, 32, 256})
            EXPECT_TRUE(sensed(scene, {.threads = 2, .domains = domains}, 8, frames, &hash) == expected)
                << domains << " domains, " << frames << " frames";
}

// At many times each ball is said to be where its distance says, but for balls at the border, and
// balls_in_sensor() says the same.
TEST_P(SensedScenes, TellsWhatTheDistancesSay) {
    Scene scene = GetParam().scene;
    scene.sensors = sensors_for(scene);
    World world(scene, {.threads = 1});
    std::set<std::pair<std::uint32_t, std::uint32_t>> inside;
    for (std::uint32_t k = 0; k < scene.sensors.size(); ++k)
        for (const std::uint32_t i : world.balls_in_sensor(k)) inside.emplace(k, i);
    double last = 0;
    world.on_sensing([&](const Sensing& s) {
        EXPECT_GE(s.time, last);
        last = s.time;
        if (s.enters)
            EXPECT_TRUE(inside.emplace(s.sensor, s.ball).second);
        else
            EXPECT_EQ(inside.erase({s.sensor, s.ball}), 1U);
    });
    const Vec2 size = scene.domain->box.max - scene.domain->box.min;
    for (int frame = 0; frame <= 60; ++frame) {
        if (frame > 0) world.advance_to(frame * 0.05);
        EXPECT_LE(last, world.time());
        const std::vector<Ball> balls = world.balls();
        for (std::uint32_t k = 0; k < scene.sensors.size(); ++k) {
            const Sensor& sensor = scene.sensors[k];
            std::vector<std::uint32_t> told;
            for (std::uint32_t i = 0; i < balls.size(); ++i) {
                if (balls[i].is_static || !may_collide(balls[i].filter, sensor.filter)) continue;
                double depth = 1e300;
                for (int image = 0; image < 9; ++image) {
                    const Vec2 shift(image % 3 - 1, image / 3 - 1);
                    bool is_there = true;
                    for (int axis = 0; axis < 2; ++axis)
                        is_there = is_there &&
                                   (shift[axis] == 0 || scene.domain->boundary[axis] == Boundary::kPeriodic);
                    if (is_there)
                        depth = std::min(
                            depth, distance_to_shape(balls[i].position + shift.cwiseProduct(size), sensor));
                }
                depth -= balls[i].radius + sensor.radius;
                const bool is_told = inside.contains({k, i});
                if (is_told) told.push_back(i);
                const double rounding = scene.precision == Precision::kFloat ? 1e-4 : 1e-10;
                if (std::abs(depth) < rounding) continue;
                EXPECT_EQ(is_told, depth < 0)
                    << "sensor " << k << ", ball " << i << ", time " << world.time();
            }
            EXPECT_EQ(world.balls_in_sensor(k), told);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, SensedScenes, testing::ValuesIn(all_scenes()), kNameOfScene);

// The places of hard discs in equilibrium are uniform and their velocities normal, whatever the density: the
// centres that come over a line of length L a time are n L <|v|> / pi, with <|v|> = sqrt(pi kT / 2 m). The
// line goes around the sensor at the discs' radius. Entries follow each other like throws of a die at best:
// five standard deviations of a Poisson number.
TEST(Sensors, AGasComesInAtTheRateOfKineticTheory) {
    if (kIsSanitized) GTEST_SKIP() << "a figure that takes long";
    Scene scene = gas(5, {.count = 400, .packing = 0.3});
    std::mt19937_64 random(9);
    double square = 0;
    for (Ball& b : scene.balls) {  // normal, nearly: the collisions do the rest
        b.velocity = Vec2::Zero();
        for (int k = 0; k < 12; ++k) b.velocity += random_velocity(random, 0.5);
        square += b.velocity.squaredNorm();
    }
    const double temperature = square / 800;
    scene.sensors = {{{{5, 5}, {9, 5}, {9, 8}, {5, 8}}, 1}, {{{15, 20}}, 2}};
    World world(scene);
    world.advance_to(20);
    std::array<double, 2> entries = {0, 0};
    world.on_sensing([&](const Sensing& s) { entries[s.sensor] += s.enters; });
    constexpr double kTime = 1000;
    world.advance_to(20 + kTime);
    const double side = scene.domain->box.max.x();
    const double density = 400 / (side * side);
    const double flux = density * std::sqrt(temperature / (2 * std::numbers::pi));
    const std::array<double, 2> around = {14 + 2 * std::numbers::pi * 1.5, 2 * std::numbers::pi * 2.5};
    for (int k = 0; k < 2; ++k) {
        const double expected = flux * around[std::size_t(k)] * kTime;
        EXPECT_GT(expected, 2000);
        EXPECT_NEAR(entries[std::size_t(k)], expected, 5 * std::sqrt(expected));
    }
}

Ball ball_with(const Vec2& position, const Vec2& velocity) {
    Ball b;
    b.position = position;
    b.velocity = velocity;
    return b;
}

// A ball that is put somewhere, comes, is taken away or grows does so at the time of the edit.
TEST(Sensors, KnowEdits) {
    Scene scene;
    scene.until = 10;
    scene.balls = {ball_with({0, 0}, {1, 0}), ball_with({0, 5}, {0, 0}), ball_with({20, 0}, {0, 0}),
                   ball_with({10, -2}, {0, 0})};
    scene.sensors = {{{{10, 0}}, 1}};
    World world(scene);
    EXPECT_TRUE(world.balls_in_sensor(0).empty());
    std::vector<std::tuple<double, std::uint32_t, bool>> told;
    world.on_sensing([&](const Sensing& s) { told.emplace_back(s.time, s.ball, s.enters); });
    world.advance_to(1);
    EXPECT_TRUE(told.empty());
    world.set_position(1, {10, 1.25});
    EXPECT_EQ(told, (decltype(told){{1.0, 1, true}}));
    told.clear();
    world.set_radius(3, 1.5);
    EXPECT_EQ(told, (decltype(told){{1.0, 3, true}}));
    told.clear();
    world.advance_to(2);
    world.remove_ball(1);
    EXPECT_EQ(told, (decltype(told){{2.0, 1, false}}));
    told.clear();
    const std::uint32_t id = world.add_ball(ball_with({10, 1.25}, {0, 0}));
    EXPECT_EQ(id, 1U);
    EXPECT_EQ(told, (decltype(told){{2.0, id, true}}));
    EXPECT_EQ(world.balls_in_sensor(0), (std::vector<std::uint32_t>{id, 3}));
    told.clear();
    world.remove_ball(id);
    world.remove_ball(3);
    told.clear();
    world.advance_to(10);  // ball 0 comes on, and is known by its id
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NEAR(std::get<0>(told[0]), 8.5, 1e-14);
    EXPECT_EQ(std::get<1>(told[0]), 0U);
}

TEST(Sensors, SenseWhomTheirFilterLetsPass) {
    Scene scene;
    scene.until = 10;
    scene.balls = {ball_with({0, 0}, {1, 0}), ball_with({0, 5}, {1, 0})};
    scene.balls[1].filter = {2, 0xff};
    scene.sensors = {{{{5, -10}, {5, 10}}, 0, {1, 2}}};
    World world(scene);
    std::vector<std::uint32_t> balls;
    world.on_sensing([&](const Sensing& s) { balls.push_back(s.ball); });
    world.advance_to(10);
    EXPECT_EQ(balls, (std::vector<std::uint32_t>{1, 1}));
}

TEST(Sensors, CanBeOthersFromNowOn) {
    Scene scene;
    scene.until = 10;
    scene.balls = {ball_with({0, 0}, {1, 0})};
    World world(scene);
    std::vector<double> times;
    world.on_sensing([&](const Sensing& s) { times.push_back(s.time); });
    world.advance_to(1);
    world.set_sensors({{{{4, 0}}, 0.5}});
    world.advance_to(4);
    world.set_sensors({});
    world.advance_to(10);
    ASSERT_EQ(times.size(), 1U);
    EXPECT_NEAR(times[0], 3, 1e-15);
    try {
        world.set_sensors({{{{4, 0}}, 0.5}, {{{0, 0}, {1, 0}, {2, 0}}}});
        FAIL() << "accepted";
    } catch (const SceneError& error) {
        EXPECT_STREQ(
            error.what(),
            "sensors[1].corners: must go once around a convex polygon, no three of them on one line");
    }
    EXPECT_TRUE(world.sensors().empty());
    EXPECT_THROW((void)world.balls_in_sensor(0), std::out_of_range);
}

TEST(Sensors, AreNotForTheEmpiricalMethod) {
    Scene scene;
    scene.until = 1;
    scene.balls = {ball_with({0, 0}, {1, 0})};
    scene.method = Method::kEmpirical;
    World world(scene);
    EXPECT_THROW(world.set_sensors({{{{4, 0}}, 0.5}}), std::logic_error);
    EXPECT_THROW(world.on_sensing([](const Sensing&) {}), std::logic_error);
    scene.sensors = {{{{4, 0}}, 0.5}};
    EXPECT_THROW(World{scene}, SceneError);
}

}  // namespace
}  // namespace carom::test
