// check(Scene): every rule refused at its place, with what must hold there; and what lies just inside the
// rules accepted.
#include <carom/core/scene.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "core/limits.hpp"

namespace carom {
namespace {

using test::kInfinity;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A scene with one of everything, nothing wrong with it: a domain walled along x and periodic along y.
Scene sound_scene() {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {10, 20}}, {Boundary::kWall, Boundary::kPeriodic}, 0.5};
    scene.gravity = {0, -9.81};
    scene.balls.resize(3);
    scene.balls[0].position = {1, 1};
    scene.balls[1].position = {3, 0};
    scene.balls[2].position = {5, 5};
    scene.balls[2].is_static = true;
    Fill fill;
    fill.count = 10;
    scene.fills = {fill};
    scene.walls = {{{1, 12}, {2, 13}, 0.5}};
    scene.attractors = {{{5, 5}, 10, 0.5}};
    scene.until = 1;
    return scene;
}

struct Fault {
    std::string message;
    std::function<void(Scene&)> make;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) {
    return out << fault.message;
}

class SceneFault : public testing::TestWithParam<Fault> {};

TEST_P(SceneFault, IsRefusedWithPlaceAndRule) {
    Scene scene = sound_scene();
    ASSERT_NO_THROW(check(scene));
    GetParam().make(scene);
    try {
        check(scene);
        FAIL() << "accepted";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), GetParam().message);
        EXPECT_EQ(GetParam().message.substr(0, error.place().size() + 2), error.place() + ": ");
    }
}

INSTANTIATE_TEST_SUITE_P(
    Balls, SceneFault,
    testing::Values(
        Fault{"balls[1].radius: must be > 0, is -1", [](Scene& s) { s.balls[1].radius = -1; }},
        Fault{"balls[1].radius: must be > 0, is 0", [](Scene& s) { s.balls[1].radius = 0; }},
        Fault{"balls[1].radius: must be finite, is nan", [](Scene& s) { s.balls[1].radius = kNan; }},
        Fault{"balls[1].radius: must be at least 1e-100, is 1e-200",
              [](Scene& s) { s.balls[1].radius = 1e-200; }},
        Fault{"balls[0].mass: must be > 0, is -0.1", [](Scene& s) { s.balls[0].mass = -0.1; }},
        Fault{"balls[0].mass: must be finite, is inf", [](Scene& s) { s.balls[0].mass = kInfinity; }},
        Fault{"balls[0].restitution: must lie in [0, 1], is 1.5",
              [](Scene& s) { s.balls[0].restitution = 1.5; }},
        Fault{"balls[0].restitution: must lie in [0, 1], is -0.5",
              [](Scene& s) { s.balls[0].restitution = -0.5; }},
        Fault{"balls[0].restitution: must lie in [0, 1], is nan",
              [](Scene& s) { s.balls[0].restitution = kNan; }},
        Fault{"balls[0].position: must be finite, is [1, nan]",
              [](Scene& s) { s.balls[0].position.y() = kNan; }},
        Fault{"balls[0].velocity: must be finite, is [inf, 0]",
              [](Scene& s) { s.balls[0].velocity = {kInfinity, 0}; }},
        Fault{"balls[0].velocity: must lie within -1e100 and 1e100, is [0, 1e+101]",
              [](Scene& s) { s.balls[0].velocity = {0, 1e101}; }},
        Fault{"balls[0].acceleration: must be finite, is [0, -inf]",
              [](Scene& s) { s.balls[0].acceleration = {0, -kInfinity}; }},
        Fault{"balls[2].velocity: must be [0, 0] for a static ball, is [0, 2]",
              [](Scene& s) { s.balls[2].velocity = {0, 2}; }},
        Fault{"balls[2].acceleration: must be [0, 0] for a static ball, is [1, 0]",
              [](Scene& s) { s.balls[2].acceleration = {1, 0}; }},
        Fault{"balls[0].position: must lie a radius (0.5) or more inside the walled sides, x from 0 to 10, "
              "is [9.75, 1]",
              [](Scene& s) { s.balls[0].position.x() = 9.75; }},
        Fault{"balls[0].position: must lie a radius (0.5) or more inside the walled sides, x from 0 to 10, "
              "is [0.25, 1]",
              [](Scene& s) { s.balls[0].position.x() = 0.25; }},
        Fault{"balls[0].position: must lie inside the periodic sides, y from 0 to 20 (excluded), is [1, 20]",
              [](Scene& s) { s.balls[0].position.y() = 20; }},
        Fault{
            "balls[0].position: must lie inside the periodic sides, y from 0 to 20 (excluded), is [1, -0.5]",
            [](Scene& s) { s.balls[0].position.y() = -0.5; }}));

INSTANTIATE_TEST_SUITE_P(
    Fills, SceneFault,
    testing::Values(
        Fault{"fill[0]: must have a count or a packing_fraction", [](Scene& s) { s.fills[0].count.reset(); }},
        Fault{"fill[0].count: must be at least 1, is 0", [](Scene& s) { s.fills[0].count = 0; }},
        Fault{"fill[0].count: must be at most 100000000 (a ball takes some hundred bytes), is 1000000000000",
              [](Scene& s) { s.fills[0].count = 1000000000000; }},
        Fault{"fill[0].packing_fraction: must be > 0 and at most 0.9069 (pi / (2 sqrt 3), the limit for "
              "equal discs), is 0",
              [](Scene& s) { s.fills[0].packing_fraction = 0; }},
        Fault{"fill[0].packing_fraction: must be > 0 and at most 0.9069 (pi / (2 sqrt 3), the limit for "
              "equal discs), is 0.92",
              [](Scene& s) { s.fills[0].packing_fraction = 0.92; }},
        Fault{"fill[0].packing_fraction: must be > 0 and at most 0.9069 (pi / (2 sqrt 3), the limit for "
              "equal discs), is nan",
              [](Scene& s) { s.fills[0].packing_fraction = kNan; }},
        Fault{"fill[0].radius: must be > 0, is -2",
              [](Scene& s) { s.fills[0].radius_min = s.fills[0].radius_max = -2; }},
        Fault{"fill[0].radius.min: must be > 0, is 0", [](Scene& s) { s.fills[0].radius_min = 0; }},
        Fault{"fill[0].radius.min: must be at most max (0.25), is 0.5",
              [](Scene& s) { s.fills[0].radius_max = 0.25; }},
        Fault{"fill[0].radius.max: must be finite, is inf",
              [](Scene& s) { s.fills[0].radius_max = kInfinity; }},
        Fault{"fill[0].density: must not stand beside mass: give one of the two",
              [](Scene& s) { s.fills[0].mass = s.fills[0].density = 1; }},
        Fault{"fill[0].mass: must be > 0, is 0", [](Scene& s) { s.fills[0].mass = 0; }},
        Fault{"fill[0].density: must be > 0, is -1", [](Scene& s) { s.fills[0].density = -1; }},
        Fault{"fill[0].restitution: must lie in [0, 1], is 2", [](Scene& s) { s.fills[0].restitution = 2; }},
        Fault{"fill[0].temperature: must be >= 0, is -3", [](Scene& s) { s.fills[0].temperature = -3; }},
        Fault{"fill[0].temperature: must be finite, is nan", [](Scene& s) { s.fills[0].temperature = kNan; }},
        Fault{"fill[0].region.max: must be greater than min on both axes, is [1, 3] with min [1, 1]",
              [](Scene& s) { s.fills[0].region = Box{{1, 1}, {1, 3}}; }},
        Fault{"fill[0].region: must lie inside the domain, x from 0 to 10, is [1, 1] to [11, 3]",
              [](Scene& s) { s.fills[0].region = Box{{1, 1}, {11, 3}}; }},
        Fault{"fill[0].region: must lie inside the domain, y from 0 to 20, is [1, -1] to [9, 3]",
              [](Scene& s) { s.fills[0].region = Box{{1, -1}, {9, 3}}; }},
        Fault{"fill[0].region: is required where the scene has no domain",
              [](Scene& s) { s.domain.reset(); }},
        // pi / 4 of the 200 is 0.003927 a ball: 300 balls would cover 1.178 of the area.
        Fault{"fill[0].count: is too many: the balls would cover 1.1780972450961724 of the region's area, "
              "the limit for equal discs "
              "is 0.9069",
              [](Scene& s) { s.fills[0].count = 300; }},
        Fault{"fill[0].packing_fraction: asks for 509295818 balls, must be at most 100000000", [](Scene& s) {
                  s.fills[0].count.reset();
                  s.fills[0].packing_fraction = 0.8;
                  s.fills[0].radius_min = s.fills[0].radius_max = 0.0003162277660168379;  // radius^2 = 1e-7
              }}));

INSTANTIATE_TEST_SUITE_P(
    Surroundings, SceneFault,
    testing::Values(
        Fault{"walls[0]: must have a length, from and to are both [2, 3]",
              [](Scene& s) { s.walls[0].from = s.walls[0].to = {2, 3}; }},
        Fault{"walls[0]: must be at least 1e-100 long",
              [](Scene& s) { s.walls[0] = {{0, 0}, {1e-120, 0}, 1}; }},
        Fault{"walls[0].from: must be finite, is [nan, 12]", [](Scene& s) { s.walls[0].from.x() = kNan; }},
        Fault{"walls[0].to: must be finite, is [2, inf]", [](Scene& s) { s.walls[0].to.y() = kInfinity; }},
        Fault{"walls[0].to: must lie inside the periodic sides, y from 0 to 20, is [2, 21]",
              [](Scene& s) { s.walls[0].to.y() = 21; }},
        Fault{"walls[0].restitution: must lie in [0, 1], is 1.0625",
              [](Scene& s) { s.walls[0].restitution = 1.0625; }},
        Fault{"attractors[0].position: must be finite, is [nan, 5]",
              [](Scene& s) { s.attractors[0].position.x() = kNan; }},
        Fault{"attractors[0].strength: must be finite, is inf",
              [](Scene& s) { s.attractors[0].strength = kInfinity; }},
        Fault{"attractors[0].softening: must be >= 0, is -1",
              [](Scene& s) { s.attractors[0].softening = -1; }},
        Fault{"sensors[0].corners: must be 1 to 64, are 0", [](Scene& s) { s.sensors = {{}}; }},
        Fault{"sensors[0].corners: must be 1 to 64, are 65",
              [](Scene& s) { s.sensors = {{std::vector<Vec2>(65)}}; }},
        Fault{"sensors[1].corners: must be finite, is [nan, 0]",
              [](Scene& s) { s.sensors = {{{{0, 0}}}, {{{kNan, 0}}}}; }},
        Fault{"sensors[0].radius: must be >= 0, is -1", [](Scene& s) { s.sensors = {{{{0, 0}}, -1}}; }},
        Fault{"sensors[0].corners: must be at least 1e-100 apart",
              [](Scene& s) { s.sensors = {{{{1, 1}, {1, 1}}}}; }},
        // On one line, dented, and a star with five points that goes around twice.
        Fault{"sensors[0].corners: must go once around a convex polygon, no three of them on one line",
              [](Scene& s) { s.sensors = {{{{0, 0}, {1, 1}, {2, 2}}}}; }},
        Fault{"sensors[0].corners: must go once around a convex polygon, no three of them on one line",
              [](Scene& s) { s.sensors = {{{{0, 0}, {4, 0}, {1, 1}, {0, 4}}}}; }},
        Fault{"sensors[0].corners: must go once around a convex polygon, no three of them on one line",
              [](Scene& s) { s.sensors = {{{{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}}}}; }},
        Fault{"sensors[0].corners: must go once around a convex polygon, no three of them on one line",
              [](Scene& s) { s.sensors = {{{{5, 5}, {6, 5}, {7, 5}, {7, 7}, {5, 7}}}}; }},
        Fault{"sensors[0].corners: must be at least 1e-100 apart",
              [](Scene& s) { s.sensors = {{{{0, 0}, {0.9e-100, 0}}}}; }},
        Fault{"sensors: must be none where method is empirical, which does not know them",
              [](Scene& s) {
                  s.sensors = {{{{0, 0}}}};
                  s.method = Method::kEmpirical;
              }},
        Fault{"domain.max: must be greater than min on both axes, is [0, 20] with min [0, 0]",
              [](Scene& s) { s.domain->box.max.x() = 0; }},
        Fault{"domain.min: must be finite, is [0, -inf]",
              [](Scene& s) { s.domain->box.min.y() = -kInfinity; }},
        Fault{"domain.restitution: must lie in [0, 1], is -1", [](Scene& s) { s.domain->restitution = -1; }},
        Fault{"domain: must be at least as wide as its largest ball (1) on the periodic axis y, is 0.75",
              [](Scene& s) {
                  s.domain->box.max.y() = 0.75;
                  s.balls.resize(1);
                  s.balls[0].position = {1, 0.5};
                  s.fills.clear();
                  s.walls.clear();
              }},
        Fault{"domain: must be at least as wide as its largest ball (30) on the periodic axis y, is 20",
              [](Scene& s) {
                  s.domain->box.max.x() = 1000;
                  s.fills[0].radius_max = 15;
              }},
        Fault{"gravity: must be finite, is [0, nan]", [](Scene& s) { s.gravity = {0, kNan}; }},
        Fault{"contact_time: must be >= 0, is -1", [](Scene& s) { s.contact_time = -1; }},
        Fault{"contact_time: must be finite, is nan", [](Scene& s) { s.contact_time = kNan; }},
        Fault{"speed_factor: must be > 0 and at most 1, is 0", [](Scene& s) { s.speed_factor = 0; }},
        Fault{"speed_factor: must be > 0 and at most 1, is 1.25", [](Scene& s) { s.speed_factor = 1.25; }},
        Fault{"speed_factor: must be > 0 and at most 1, is nan", [](Scene& s) { s.speed_factor = kNan; }},
        Fault{"field_interval: must be > 0, is 0", [](Scene& s) { s.field_interval = 0; }},
        Fault{"field_interval: must be finite, is inf", [](Scene& s) { s.field_interval = kInfinity; }},
        Fault{"until: must be >= 0, is -1", [](Scene& s) { s.until = -1; }},
        Fault{"until: must be finite, is nan", [](Scene& s) { s.until = kNan; }}));

// docs/scene-format.md says what is taken where nothing is given.
TEST(Scene, HasTheDocumentedDefaults) {
    const Ball ball;
    EXPECT_EQ(ball.radius, 0.5);
    EXPECT_EQ(ball.mass, 1);
    EXPECT_EQ(ball.restitution, 1);
    EXPECT_FALSE(ball.is_static);
    EXPECT_EQ(Wall().restitution, 1);
    EXPECT_EQ(Domain().restitution, 1);
    EXPECT_EQ(Attractor().strength, 0);
    EXPECT_EQ(Attractor().softening, 0);
    const Fill fill;
    EXPECT_EQ(fill.radius_min, 0.5);
    EXPECT_EQ(fill.radius_max, 0.5);
    EXPECT_EQ(fill.restitution, 1);
    EXPECT_EQ(fill.temperature, 0);
    EXPECT_EQ(fill.seed, 1U);
    const Scene scene;
    EXPECT_EQ(scene.speed_factor, 1);
    EXPECT_EQ(scene.field_interval, 0.02);
    EXPECT_EQ(scene.until, 0);
    EXPECT_FALSE(scene.allows_overlap);
    EXPECT_EQ(double(Scene::kUsualTravel), 0.2);
    EXPECT_EQ(double(Scene::kUsualTolerance), 1e-6);
}

TEST(Scene, BodiesCollideWhereEachOnesCategoryIsInTheOthersMask) {
    const CollisionFilter usual;
    EXPECT_EQ(usual.category, 1U);
    EXPECT_EQ(usual.mask, 0xffffffffU);
    EXPECT_TRUE(may_collide(usual, usual));
    const CollisionFilter blind{2, 4};
    EXPECT_FALSE(may_collide(usual, blind)) << "one would, the other would not";
    EXPECT_FALSE(may_collide(blind, usual));
    EXPECT_FALSE(may_collide(blind, blind));
    EXPECT_TRUE(may_collide(blind, {4, 2}));
    EXPECT_TRUE(may_collide({1, 1}, {1, 1}));
}

TEST(CheckScene, AcceptsAnEmptyScene) {
    EXPECT_NO_THROW(check(Scene{}));
}

// A position computed as side - radius may be off by an ulp of the side; the rule allows 1e-12 of it and no
// more.
TEST(CheckScene, AcceptsABallThatTouchesAWalledSideUpToRounding) {
    Scene scene = sound_scene();
    scene.balls[0].radius = 0.1;
    for (const double x : {0.1, 10 - 0.1, std::nextafter(10 - 0.1, 11.0), 9.9 + 0.9e-11}) {
        scene.balls[0].position.x() = x;
        EXPECT_NO_THROW(check(scene)) << x;
    }
    scene.balls[0].position.x() = 9.9 + 1.1e-11;
    EXPECT_THROW(check(scene), SceneError);
}

TEST(CheckScene, AcceptsBallsAnywhereOnAnOpenAxis) {
    Scene scene = sound_scene();
    scene.domain->boundary = {Boundary::kOpen, Boundary::kOpen};
    scene.balls[0].position = {-100, 1e6};
    scene.fills[0].region = Box{{-5, -5}, {100, 100}};
    EXPECT_NO_THROW(check(scene));
}

TEST(CheckScene, AcceptsTheDensestPackingAndScaledRadii) {
    Scene scene = sound_scene();
    scene.fills[0].count.reset();
    scene.fills[0].packing_fraction = std::numbers::pi / (2 * std::numbers::sqrt3);
    EXPECT_NO_THROW(check(scene));
    // With both, the radius follows: the one that is written does not have to fit.
    scene.fills[0].count = 1000;
    scene.fills[0].radius_min = scene.fills[0].radius_max = 50;
    EXPECT_NO_THROW(check(scene));
}

TEST(CheckScene, AcceptsAPeriodicBoxAsWideAsItsBall) {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {1, 4}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.balls.resize(1);
    EXPECT_NO_THROW(check(scene));
    scene.balls[0].radius = std::nextafter(0.5, 1.0);
    EXPECT_THROW(check(scene), SceneError);
}

TEST(CheckScene, AcceptsAWallFromPeriodicSideToSide) {
    Scene scene;
    scene.balls.resize(1);
    scene.balls[0].position = {5, 5};
    scene.domain = Domain{{{1, 1}, {11, 11}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.walls = {{{1, 2}, {11, 3}, 1}, {{2, 1}, {3, 11}, 1}};
    EXPECT_NO_THROW(check(scene));
    scene.walls[0].from.x() = 0.999;
    EXPECT_THROW(check(scene), SceneError);
}

// Convex corners either way around, as many as there may be, and what is least: a point, a short segment.
TEST(CheckScene, AcceptsSensorsOfAnyConvexShape) {
    std::vector<Vec2> many;
    for (int k = 0; k < 64; ++k)
        many.emplace_back(5 + std::cos(2 * std::numbers::pi * k / 64),
                          5 + std::sin(2 * std::numbers::pi * k / 64));
    Scene scene = sound_scene();
    for (const std::vector<Vec2>& corners :
         {std::vector<Vec2>{{3, 4}}, std::vector<Vec2>{{3, 4}, {3, 4.5}},
          std::vector<Vec2>{{0, 0}, {1e-100, 0}}, std::vector<Vec2>{{3, 4}, {5, 4}, {4, 7}},
          std::vector<Vec2>{{3, 4}, {4, 7}, {5, 4}}, std::vector<Vec2>{{3, 4}, {5, 4}, {5, 4.5}, {3, 4.5}},
          many}) {
        scene.sensors = {{corners, 0.5}};
        EXPECT_NO_THROW(check(scene)) << corners.size() << " corners";
    }
}

TEST(CheckScene, AcceptsTheEmpiricalMethodWithoutSensors) {
    Scene scene = sound_scene();
    scene.method = Method::kEmpirical;
    EXPECT_NO_THROW(check(scene));
}

// Float ends near 3.4e38: what is within 1e30 and what is not, in float and in double.
TEST(CheckScene, KnowsTheRangeOfFloat) {
    const auto is_refused = [](Precision precision, const Vec2& position, const Vec2& velocity) {
        Scene scene;
        scene.precision = precision;
        scene.balls.resize(1);
        scene.balls[0].position = position;
        scene.balls[0].velocity = velocity;
        try {
            check(scene);
        } catch (const SceneError&) {
            return true;
        }
        return false;
    };
    EXPECT_FALSE(is_refused(Precision::kFloat, {1e30, -1e30}, {0, 0}));
    EXPECT_FALSE(is_refused(Precision::kFloat, {0, 0}, {1, -1e30}));
    EXPECT_TRUE(is_refused(Precision::kFloat, {0, -1.1e30}, {0, 0}));
    EXPECT_TRUE(is_refused(Precision::kFloat, {0, 0}, {1.1e30, 0}));
    EXPECT_FALSE(is_refused(Precision::kDouble, {0, -1.1e30}, {1.1e30, 0}));
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
        Scene scene;
        scene.precision = precision;
        scene.domain = Domain{{{0, 0}, {1.1e30, 1}}, {Boundary::kOpen, Boundary::kOpen}, 1};
        EXPECT_EQ(precision == Precision::kFloat, [&] {
            try {
                check(scene);
            } catch (const SceneError&) {
                return true;
            }
            return false;
        }());
    }
}

/// The message of the fault that `change` makes in a sound scene; empty where it makes none.
template <class Change>
std::string fault_of(Change&& change) {
    Scene scene = sound_scene();
    change(scene);
    try {
        check(scene);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(CheckScene, KnowsTheEndsOfItsRanges) {
    EXPECT_EQ(fault_of([](Scene& s) { s.gravity = {1e100, -1e100}; }), "");
    EXPECT_NE(fault_of([](Scene& s) { s.gravity = {1.1e100, 0}; }), "");
    EXPECT_EQ(fault_of([](Scene& s) { s.until = 1e100; }), "");
    EXPECT_EQ(fault_of([](Scene& s) { s.until = 2e100; }),
              "until: must lie within -1e100 and 1e100, is 2e+100");
    EXPECT_EQ(fault_of([](Scene& s) { s.balls[0].mass = 1e-100; }), "");
    EXPECT_NE(fault_of([](Scene& s) { s.balls[0].mass = 0.9e-100; }), "");
    EXPECT_EQ(fault_of([](Scene& s) { s.balls[0].restitution = 0; }), "");
}

TEST(CheckScene, AcceptsShortWallsAndSmallDomains) {
    EXPECT_EQ(fault_of([](Scene& s) { s.walls[0] = {{-1, 5}, {1, 5}, 1}; }), "");
    EXPECT_EQ(fault_of([](Scene& s) {
                  s.walls[0] = {{-1, 0.5}, {1, -0.5}, 1};
                  s.domain.reset();
                  s.fills.clear();
              }),
              "");
    EXPECT_EQ(fault_of([](Scene& s) { s.walls[0] = {{2, 2}, {2.5, 2}, 1}; }), "");
    EXPECT_EQ(fault_of([](Scene& s) { s.walls[0] = {{0, 0}, {1e-100, 0}, 1}; }), "");
    Scene scene;
    scene.domain = Domain{{{0, 0}, {1e-100, 1}}, {Boundary::kOpen, Boundary::kOpen}, 1};
    EXPECT_NO_THROW(check(scene));
    // Wider than its small balls, though not than one of radius 0.5; and around the origin.
    scene.domain = Domain{{{-0.25, -0.25}, {0.25, 0.25}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.balls.resize(1);
    scene.balls[0].radius = 0.125;
    EXPECT_NO_THROW(check(scene));
}

TEST(CheckScene, ChecksTheStepsOfTheEmpiricalMethod) {
    const auto fault = [](std::optional<double> max_travel, std::optional<double> step) {
        return fault_of([&](Scene& s) {
            s.max_travel = max_travel;
            s.step = step;
        });
    };
    EXPECT_EQ(fault(1e-9, {}), "");
    EXPECT_EQ(fault(0.5, {}), "");
    EXPECT_EQ(fault(0.9e-9, {}), "max_travel: must be 0 or at least 1e-9, is 9e-10");
    EXPECT_EQ(fault(0, 0.1), "");
    EXPECT_EQ(fault(1, 0.1), "");
    EXPECT_EQ(fault(0, {}), "max_travel: must be > 0 where no step is given, is 0");
    EXPECT_EQ(fault(-1, 0.1), "max_travel: must be >= 0, is -1");
    EXPECT_EQ(fault({}, 0), "step: must be > 0, is 0");
}

// Regions may reach beyond the domain by rounding as balls may: 1e-12 of 20.
TEST(CheckScene, AcceptsARegionAsWideAsTheDomainUpToRounding) {
    const auto fault = [](double beyond) {
        return fault_of([&](Scene& s) { s.fills[0].region = Box{{0, -beyond}, {10, 20 + beyond}}; });
    };
    EXPECT_EQ(fault(1.8e-11), "");
    EXPECT_NE(fault(2.2e-11), "");
    EXPECT_NE(fault_of([](Scene& s) { s.fills[0].region = Box{{0, -2.2e-11}, {10, 20}}; }), "");
    EXPECT_NE(fault_of([](Scene& s) { s.fills[0].region = Box{{0, 0}, {10, 20 + 2.2e-11}}; }), "");
}

TEST(CheckScene, CountsTheBallsOfAFill) {
    EXPECT_EQ(fault_of([](Scene& s) { s.fills[0].region = Box{{0, 0}, {10, 20}}; }), "");
    const auto wide = [](Scene& s) {
        s.domain->box = {{0, 0}, {1e5, 1e5}};
        s.walls.clear();
    };
    EXPECT_EQ(fault_of([&](Scene& s) {
                  wide(s);
                  s.fills[0].count = 100'000'000;
              }),
              "");
    EXPECT_NE(fault_of([&](Scene& s) {
                  wide(s);
                  s.fills[0].count = 100'000'001;
              }),
              "");
    // 16 discs of radius 0.5 in the 4 x 4 of a region away from the origin cover pi / 4 of it, 19 more than
    // 0.9069.
    const auto in_square = [](std::uint64_t count) {
        return fault_of([&](Scene& s) {
            s.fills[0].count = count;
            s.fills[0].region = Box{{4, 4}, {8, 8}};
        });
    };
    EXPECT_EQ(in_square(16), "");
    EXPECT_NE(in_square(19), "");
    // A number of balls is told in full as long as it has a meaning, which ends somewhere below 2^63
    // = 9.2e18.
    const auto of_radius = [](double radius) {
        return fault_of([&](Scene& s) {
            s.fills[0].count.reset();
            s.fills[0].packing_fraction = 0.5;
            s.fills[0].radius_min = s.fills[0].radius_max = radius;
        });
    };
    EXPECT_EQ(of_radius(7e-9).find("e+"), std::string::npos) << "100 / (pi r^2) is 6.5e17";
    EXPECT_NE(of_radius(1e-9).find("e+19"), std::string::npos) << "3.2e19";
}

TEST(CheckScene, NamesTheFirstFaultAmongMany) {
    Scene scene = sound_scene();
    scene.domain.reset();
    scene.fills.clear();
    scene.balls.resize(1000);
    for (std::size_t i = 17; i < scene.balls.size(); ++i) scene.balls[i].radius = -1;
    try {
        check(scene);
        FAIL() << "accepted";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.place(), "balls[17].radius");
    }
}

}  // namespace
}  // namespace carom
