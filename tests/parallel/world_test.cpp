// World's face: what it counts, conserves, reports and refuses.
#include <carom/parallel/world.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conservation.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

TEST(World, ConservesMomentumAndEnergyInAnElasticGas) {
    for (const double spread : {0.0, 0.9})
        expect_conserved(gas(41, {.count = 400, .packing = 0.5, .radius_spread = spread}));
}

TEST(World, EnergyCountsTheSceneGravity) {
    Scene s = gas(42, {.packing = 0.2, .boundary_y = Boundary::kWall});
    s.gravity = {0.3, -0.5};  // x is periodic: the energy follows the unwrapped path
    World world(s);
    const double energy = world.energy();
    world.advance_to(20);
    EXPECT_NEAR(world.energy(), energy, 1e-11 * std::abs(energy));
}

TEST(World, StepAddsToTheTime) {
    World world(gas(43, {}));
    world.step(0.25);
    world.step(0.5);
    EXPECT_EQ(world.time(), 0.75);
}

TEST(World, TellsItsCellsAndTheTimeItsThreadsWorked) {
    const Scene scene = gas(45, {.count = 400, .packing = 0.5});
    World one(scene, {.domains = 1});
    World four(scene, {.threads = 2, .cell_size = 2, .domains = 4});
    EXPECT_GE(one.cell_size(), 1);
    EXPECT_LT(one.cell_size(), 2);
    EXPECT_GE(four.cell_size(), 2);
    one.step(0.1);
    four.step(0.1);
    EXPECT_EQ(one.working_seconds(), 0);
    EXPECT_GT(four.working_seconds(), 0);
}

TEST(World, RefusesThePast) {
    World world(gas(44, {}));
    world.advance_to(1);
    EXPECT_THROW(world.advance_to(0.5), std::invalid_argument);
    EXPECT_THROW(world.advance_to(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
    EXPECT_THROW(world.advance_to(std::numeric_limits<double>::infinity()), std::invalid_argument);
    EXPECT_EQ(world.time(), 1);
}

TEST(World, ReportsACollision) {
    Scene s;
    s.until = 10;
    s.balls.resize(2);
    s.balls[0].position = {0, 0};
    s.balls[0].velocity = {1, 0};
    s.balls[1].position = {3, 0};
    s.balls[1].mass = 3;
    World world(s);
    std::vector<Collision> seen;
    world.on_collision([&seen](const Collision& c) { seen.push_back(c); });
    world.advance_to(10);
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(seen[0].time, 2);
    EXPECT_EQ(seen[0].kind, CollisionKind::kBall);
    EXPECT_EQ(seen[0].i, 0u);
    EXPECT_EQ(seen[0].j, 1u);
    EXPECT_EQ(seen[0].point, Vec2(2.5, 0));
    EXPECT_EQ(seen[0].normal, Vec2(-1, 0));
    EXPECT_EQ(seen[0].impulse, 1.5);  // 2 m1 m2 / (m1 + m2) times the speed
    EXPECT_EQ(world.velocities()[0].x(), -0.5);
    EXPECT_EQ(world.velocities()[1].x(), 0.5);
}

TEST(World, NumbersTheDomainsSidesAfterTheWalls) {
    Scene s;
    s.until = 10;
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.walls = {{{4, 9}, {6, 9}, 1}};
    s.balls.resize(1);
    s.balls[0].position = {5, 5};
    for (const auto& [velocity, wall] : std::vector<std::pair<Vec2, std::uint32_t>>{
             {{0, 1}, 0}, {{-1, 0}, 1}, {{1, 0}, 2}, {{0, -1}, 3}, {{0.9, 1}, 4}}) {
        s.balls[0].velocity = velocity;
        World world(s);
        std::vector<std::uint32_t> seen;
        world.on_collision([&seen](const Collision& c) { seen.push_back(c.j); });
        world.advance_to(4.9);
        ASSERT_THAT(seen, testing::Not(testing::IsEmpty()));
        EXPECT_EQ(seen[0], wall);
    }
}

TEST(World, SpeedFactorTakesWholeVelocityAtWallsOnly) {
    Scene s;
    s.until = 10;
    s.contact_time = 0;
    s.speed_factor = 0.5;
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls.resize(2);
    s.balls[0].position = {5, 5};
    s.balls[0].velocity = {3, 4};
    s.balls[1].position = {8, 1};
    World world(s);
    world.advance_to(1.25);  // the ceiling is met at 1.125
    EXPECT_EQ(world.velocities()[0].x(), 1.5);
    EXPECT_EQ(world.velocities()[0].y(), -2);
}

// A bullet of a million radii a second meets a thin row of balls and a wall, whatever the step.
TEST(World, NothingTunnels) {
    for (const double speed : {1e3, 1e6, 1e9}) {
        Scene s;
        s.until = 1;
        s.balls.resize(2);
        s.balls[0].radius = 1e-3;
        s.balls[0].position = {0, 0.25};
        s.balls[0].velocity = {speed, 0};
        s.balls[1].radius = 1e-3;
        s.balls[1].position = {50, 0.2505};
        s.walls = {{{100, -50}, {100, 50}, 1}};
        World world(s);
        world.advance_to(1);
        EXPECT_EQ(world.counts().ball_collisions, 1u) << speed;
        EXPECT_EQ(world.counts().wall_collisions, 1u)
            << speed;  // by the struck ball, which leaves at 14.5 degrees
    }
}

TEST(World, ValidatesAsSoundThroughARun) {
    for (const NamedScene& named : feature_scenes()) {
        World world(named.scene);
        for (int k = 1; k <= 5; ++k) {
            world.advance_to(k);
            EXPECT_THAT(world.validate(), testing::IsEmpty()) << named.name;
            // Float rounds either centre at coordinates of up to 64, and the smallest radii's sum is 0.1.
            const double rounding = named.scene.precision == Precision::kFloat ? 0x1p-23 * 64 / 0.1 : 1e-12;
            EXPECT_LT(world.max_overlap(), rounding) << named.name;
        }
    }
}

// A ball of any size among small ones in the open: what it meets does not depend on how many cells it covers.
TEST(World, LargeBallOfAnySizeMeetsTheSmallOnes) {
    for (const double radius : {1.0, 1e2, 1e4, 1e9}) {
        Scene s;
        s.until = 2;
        s.domain = Domain{{{0, 0}, {1, 1}}, {Boundary::kOpen, Boundary::kOpen}, 1};
        for (int k = 0; k < 100; ++k) {
            s.balls.emplace_back();
            s.balls.back().radius = 0.01;
            s.balls.back().position = {0.1 * (k % 10) + 0.05, 0.1 * (k / 10) + 0.05};
        }
        s.balls.emplace_back();
        s.balls.back().radius = radius;
        s.balls.back().mass = 1e6;
        s.balls.back().position = {radius + 2, 0.5};
        s.balls.back().velocity = {-1, 0};
        World world(s);
        world.advance_to(2);
        EXPECT_GE(world.counts().ball_collisions, 50u) << radius;
        EXPECT_LT(world.max_overlap(), 1e-7) << radius;
    }
}

// A period so short that even the smallest balls are wider than a cell with its margin: with equal radii none
// is in a cell's list. At offset 0.4 the surfaces meet where the centres are sqrt(1 - 0.4^2) apart in height.
TEST(World, EqualBallsFillANarrowPeriod) {
    Scene s;
    s.domain = Domain{{{0, 0}, {1.01, 10}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.balls.resize(2);
    s.balls[0].position = {0.5, 2};
    s.balls[0].velocity = {0, 1};
    s.balls[1].position = {0.9, 4};
    World world(s);
    std::vector<double> times;
    world.on_collision([&times](const Collision& c) { times.push_back(c.time); });
    world.advance_to(1.5);
    ASSERT_FALSE(times.empty());
    EXPECT_NEAR(times.front(), 2 - std::sqrt(0.84), 1e-15);
    world.advance_to(30);
    EXPECT_TRUE(world.validate().empty());
}

// A domain is a part of the plane and not a lottery: the ball nearest to a ball is mostly of its own
// domain. Four domains of 500 balls each have some 22 x 22 balls, 84 of them along the border.
TEST(World, TellsWhichDomainOwnsEachBall) {
    const Scene s = gas(45, {.count = 2000, .packing = 0.4});
    World world(s, {.threads = 1, .domains = 4});
    world.advance_to(1);
    const std::vector<std::uint32_t> domains = world.domains_of_balls();
    const PlaneVectors places = world.positions();
    ASSERT_EQ(domains.size(), 2000u);
    std::vector<int> sizes(4, 0);
    for (const std::uint32_t d : domains) ++sizes.at(d);
    for (const int size : sizes) EXPECT_NEAR(size, 500, 250);
    int strangers = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::size_t nearest = i == 0 ? 1 : 0;
        for (std::size_t j = 0; j < places.size(); ++j)
            if (j != i && (places[j] - places[i]).squaredNorm() < (places[nearest] - places[i]).squaredNorm())
                nearest = j;
        strangers += domains[nearest] != domains[i];
    }
    EXPECT_LT(strangers, 4 * 84);  // chance would make it 1,500
    World whole(s, {.threads = 1, .domains = 1});
    EXPECT_EQ(whole.domains_of_balls(), std::vector<std::uint32_t>(2000, 0));
}

TEST(World, EmptyAndStaticWorldsStandStill) {
    Scene s;
    s.until = 1;
    World empty(s);
    empty.advance_to(1e6);
    EXPECT_EQ(empty.counts().events, 0u);
    s.gravity = {0, -1};
    s.balls.resize(3);
    for (int i = 0; i < 3; ++i) {
        s.balls[i].position = {0.5 * i, 0};
        s.balls[i].is_static = true;
    }
    World still(s);
    still.advance_to(1e6);
    EXPECT_EQ(still.counts().events, 0u);
    EXPECT_EQ(still.positions()[2].x(), 1.0);
}

TEST(World, RefusesOverlappingBalls) {
    Scene s = gas(45, {});
    s.balls[7].position = s.balls[3].position + Vec2(0.75, 0);
    EXPECT_THROW(World{s}, SceneError);
}

}  // namespace
}  // namespace carom::test
