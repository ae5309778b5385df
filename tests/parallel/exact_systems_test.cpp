// Systems whose course is known in closed form, through the whole engine.
#include <gtest/gtest.h>

#include <carom/parallel/world.hpp>

#include "core/table.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

Ball ball(double x, double y, double vx, double vy = 0) {
    Ball b;
    b.position = {x, y};
    b.velocity = {vx, vy};
    return b;
}

// Galperin 2003: a heavy ball, mass ratio 100^n, drives a light one against a wall; the collisions spell pi.
TEST(ExactSystems, GalperinCountsTheDigitsOfPi) {
    for (const Row& row : read_table("galperin.csv")) {
        const double ratio = std::stod(row[0]);
        const std::uint64_t expected = std::stoull(row[1]);
        Scene s;
        s.until = 1000;
        s.balls = {ball(2, 0, 0), ball(4, 0, -1)};
        s.balls[1].mass = ratio;
        s.walls = {{{0, -1}, {0, 1}, 1}};
        World world(s);
        world.advance_to(1000);
        const Counts counts = world.counts();
        EXPECT_EQ(counts.ball_collisions + counts.wall_collisions, expected) << "mass ratio " << ratio;
        // Each collision rounds velocities that are at most sqrt(ratio); energies agree to a few ulp for
        // each.
        EXPECT_NEAR(world.energy() / (ratio / 2), 1, 1e-16 * 10 * double(expected) + 1e-15);
    }
}

// Five equal touching balls: as many leave as come, with all of the velocity, exactly.
TEST(ExactSystems, CradlePassesOnWhatComes) {
    for (const int incoming : {1, 2}) {
        Scene s;
        s.until = 10;
        for (int i = 0; i < 5; ++i)
            s.balls.push_back(ball(i < incoming ? i - 2.0 : double(i), 0, i < incoming ? 1 : 0));
        World world(s);
        world.advance_to(10);
        EXPECT_EQ(world.counts().ball_collisions, incoming == 1 ? 4u : 6u);
        const PlaneVectors v = world.velocities();
        for (std::size_t i = 0; i < 5; ++i) {
            EXPECT_EQ(v[i].x(), i + static_cast<std::size_t>(incoming) >= 5 ? 1.0 : 0.0)
                << "ball " << i << " of " << incoming << " in";
            EXPECT_EQ(v[i].y(), 0.0);
        }
    }
}

// A ball dropped from height 1 with g = 2: impact k at times in closed form, until the Zeno point.
TEST(ExactSystems, BouncingBallFollowsItsSeries) {
    for (const Row& row : read_table("bouncing_ball.csv")) {
        const double e = std::stod(row[0]);
        const std::size_t k = std::stoul(row[1]);
        const double time = std::stod(row[2]);
        const double speed = std::stod(row[3]);
        // The flight lasts as long as its speed is high, g being 2. Below rest_time, 1e-4 sqrt(d / g), the
        // hop holds the ball up.
        if (speed < 1e-3) continue;
        Scene s;
        s.gravity = {0, -2};
        s.contact_time = 0;
        s.until = 100;
        s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kOpen, Boundary::kWall}, 1};
        s.balls = {ball(5, 1.5, 0)};
        s.balls[0].restitution = e;
        World world(s);
        std::vector<Collision> hits;
        world.on_collision([&hits](const Collision& c) { hits.push_back(c); });
        world.advance_to(time + 1e-9);
        ASSERT_GT(hits.size(), k) << "restitution " << e;
        // The floor is met at y = 0.5, which is exact; each flight adds a rounding of the time, ulp(20)
        // = 3.6e-15.
        EXPECT_NEAR(hits[k].time, time, 4e-15 * double(k + 1)) << "restitution " << e << ", impact " << k;
        EXPECT_NEAR(hits[k].impulse, speed * (1 + 1 / e), 1e-14 * double(k + 1))
            << "restitution " << e << ", impact " << k;
    }
}

// Equal elastic balls in a line are points that pass through each other: sorted free flights.
TEST(ExactSystems, LineOfEqualBallsIsSortedFreeFlight) {
    constexpr int kBalls = 100;
    constexpr std::uint64_t kSeed = 3;
    std::mt19937_64 random(kSeed);
    Scene s;
    s.until = 50;
    std::vector<double> free;  // the free points at the end, each ball's diameter taken out
    for (int i = 0; i < kBalls; ++i) {
        const double gap = uniform(random, 0, 3);
        const double x = i == 0 ? 0 : s.balls.back().position.x() + 1 + gap;
        const double v = uniform(random, -1, 1);
        s.balls.push_back(ball(x, 0, v));
        free.push_back(x - i + 50 * v);
    }
    std::sort(free.begin(), free.end());
    World world(s);
    world.advance_to(50);
    const PlaneVectors x = world.positions();
    // Positions reach 250; some thousand collisions each round by an ulp of that, 2.8e-14, and nothing
    // amplifies.
    for (int i = 0; i < kBalls; ++i) EXPECT_NEAR(x[i].x(), free[i] + i, 1e-11) << "ball " << i;
}

// All velocities reversed after a few collisions a ball, the gas goes back to where it came from.
TEST(ExactSystems, ReversalReturnsToTheStart) {
    Scene s = gas(31, {.count = 100, .packing = 0.6});
    const Scene start = s;
    World forth(s);
    double time = 0;
    while (2 * forth.counts().ball_collisions < 2 * s.balls.size()) forth.advance_to(time += 0.01);
    std::vector<Ball> turned = forth.balls();
    for (Ball& b : turned) b.velocity = -b.velocity;
    s.balls = turned;
    World back(s);
    back.advance_to(time);
    const PlaneVectors x = back.positions();
    // 2 collisions a ball forth and 2 back at packing 0.6: errors grow as exp(0.5 k) at the mean, here k = 4
    // in all, from 1e-15 times the box; a factor of 1e3 stands for the fastest of the directions.
    const double side = start.domain->box.max.x();
    for (int i = 0; i < 100; ++i)
        for (int axis = 0; axis < 2; ++axis) {
            const double error = std::remainder(x[i][axis] - start.balls[i].position[axis], side);
            EXPECT_LT(std::abs(error), 1e-15 * side * std::exp(0.5 * 4) * 1e3) << "ball " << i;
        }
}

// A ball that falls past the end of a wall: one ulp decides between a miss and a hit.
TEST(ExactSystems, OneUlpDecidesAtTheEndOfAWall) {
    const auto hits = [](double x) {
        Scene s;
        s.until = 10;
        s.balls = {ball(x, 2, 0, -1)};
        s.walls = {{{-5, 0}, {0, 0}, 1}};
        World world(s);
        world.advance_to(10);
        return world.counts().wall_collisions;
    };
    EXPECT_EQ(hits(0.5), 0u) << "a touch is no hit";
    EXPECT_EQ(hits(std::nextafter(0.5, 1.0)), 0u);
    EXPECT_EQ(hits(std::nextafter(0.5, 0.0)), 1u);
}

// A gap as wide as the ball lets it through, one narrower by a millionth turns it back. Between the two
// rounded ends it bounces as in a wedge of angle 2 d, where d is the height at which it touches over its
// radius, sqrt(1 - (1 - 1e-6)^2): pi / (2 d) times.
TEST(ExactSystems, GapTurnsBackWhatIsWider) {
    const auto fall = [](double half_gap) {
        Scene s;
        s.until = 10;
        s.balls = {ball(0, 2, 0, -1)};
        s.walls = {{{-5, 0}, {-half_gap, 0}, 1}, {{half_gap, 0}, {5, 0}, 1}};
        World world(s);
        world.advance_to(10);
        return std::pair(world.positions()[0].y(), world.counts().wall_collisions);
    };
    EXPECT_EQ(fall(0.5), std::pair(-8.0, std::uint64_t{0}));
    EXPECT_EQ(fall(std::nextafter(0.5, 1.0)).second, 0u);
    const auto [height, collisions] = fall(0.5 * (1 - 1e-6));
    EXPECT_GT(height, 0);
    EXPECT_NEAR(double(collisions), std::numbers::pi / 2 / std::sqrt(2e-6), 2);
}

}  // namespace
}  // namespace carom::test
