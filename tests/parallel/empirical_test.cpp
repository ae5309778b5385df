// The empirical method: contacts within the tolerance, closed forms, conservation, several bodies at once,
// and how it comes to the event-driven method's result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <carom/core/bisection.hpp>
#include <carom/parallel/world.hpp>

#include "conservation.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

Scene empirical(Scene scene, std::optional<double> step = {}, std::optional<double> tolerance = {}) {
    scene.method = Method::kEmpirical;
    scene.step = step;
    scene.tolerance = tolerance;
    return scene;
}

std::vector<Collision> collisions_until(World& world, double end) {
    std::vector<Collision> seen;
    world.on_collision([&seen](const Collision& c) { seen.push_back(c); });
    world.advance_to(end);
    world.on_collision({});
    return seen;
}

// Two balls 2 apart close in at 1: the contact is found where they are apart by the tolerance or less, so
// that much time early. The response is the event method's.
TEST(Empirical, ContactOfTwoBalls) {
    Scene s;
    s.until = 10;
    s.balls.resize(2);
    s.balls[0].velocity = {1, 0};
    s.balls[1].position = {3, 0};
    s.balls[1].mass = 3;
    for (const double tolerance : {1e-3, 1e-6, 1e-12}) {
        for (const double step : {0.01, 0.3, 2.5}) {
            World world(empirical(s, step, tolerance));
            const std::vector<Collision> seen = collisions_until(world, 10);
            ASSERT_EQ(seen.size(), 1u);
            EXPECT_LE(seen[0].time, 2 + 1e-14);
            EXPECT_GE(seen[0].time, 2 - tolerance - 1e-14);
            EXPECT_EQ(seen[0].i, 0u);
            EXPECT_EQ(seen[0].j, 1u);
            EXPECT_EQ(seen[0].normal, Vec2(-1, 0));
            EXPECT_EQ(seen[0].impulse, 1.5);
            EXPECT_EQ(world.velocities()[0].x(), -0.5);
            EXPECT_EQ(world.velocities()[1].x(), 0.5);
        }
    }
}

/// How far the surface point that a collision reports is from the obstacle.
double distance_to_obstacle(const Scene& scene, const Collision& c) {
    if (c.kind == CollisionKind::kBall)
        return (c.point - scene.balls[c.j].position).norm() - scene.balls[c.j].radius;
    if (c.j < scene.walls.size()) {
        const Wall& wall = scene.walls[c.j];
        return detail::distance_to_wall<double>(c.point, wall.from, wall.to).distance;
    }
    const std::size_t side = c.j - scene.walls.size();
    const Box& box = scene.domain->box;
    const std::size_t axis = side / 2;
    return std::abs(c.point[int(axis)] - (side % 2 == 1 ? box.max : box.min)[int(axis)]);
}

// The point lies on the ball, on the line to the nearest point of the obstacle, so it is as far from that as
// the surfaces are. Without forces a contact is always traced back to where they are apart; but for a ball
// that has responded 32 times in a step there is no other case.
TEST(Empirical, ToleranceIsHonoured) {
    constexpr std::uint64_t kSeed = 71;
    Scene s = gas(kSeed, {.packing = 0.25,
                          .boundary_x = Boundary::kWall,
                          .boundary_y = Boundary::kWall,
                          .radius_spread = 0.4});
    for (std::size_t i = 0; i < s.balls.size(); ++i) {
        Ball& b = s.balls[i];
        if (i % 3 != 0) continue;
        b.is_static = true;
        b.velocity = Vec2::Zero();
    }
    for (std::size_t i = 1; i < s.balls.size(); i += 9) {
        s.walls.push_back({s.balls[i].position, s.balls[i].position + Vec2(0.4, 0.2), 1});
        s.balls[i].position += Vec2(1e4, 0);
    }
    std::erase_if(s.balls, [](const Ball& b) { return b.position.x() > 1e3; });
    for (const double tolerance : {1e-2, 1e-4, 1e-10}) {
        World world(empirical(s, 0.05, tolerance));
        std::size_t seen = 0;
        for (const Collision& c : collisions_until(world, 20)) {
            if (c.kind == CollisionKind::kBall && !s.balls[c.j].is_static) continue;
            ++seen;
            EXPECT_LE(distance_to_obstacle(s, c), tolerance + 1e-13);
        }
        EXPECT_GT(seen, 500u);
    }
}

// A ball dropped from H bounces at (2 k - 1) sqrt(2 H / g). The contact is found up to the tolerance above
// the floor, where the speed is sqrt(2 g H): each bounce so much height early, and twice the time of that
// early from there on (down to the floor and up again). Elastic, so that its energy is kept to rounding.
TEST(Empirical, DroppedBall) {
    constexpr double kHeight = 2;
    constexpr double kTolerance = 1e-7;
    Scene s;
    s.gravity = {0, -10};
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls.resize(1);
    s.balls[0].position = {5, kHeight + 0.5};
    const double fall = std::sqrt(2 * kHeight / 10);
    for (const double step : {0.001, 0.013, 0.1}) {
        World world(empirical(s, step, kTolerance));
        const double energy = world.energy();
        const std::vector<Collision> seen = collisions_until(world, 20 * fall);
        ASSERT_EQ(seen.size(), 10u) << step;
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const double early = kTolerance / std::sqrt(2 * 10 * kHeight) * (2 * double(k) + 1);
            const double exact = (2 * double(k) + 1) * fall;
            // Each step rounds height and speed by half an ulp of 4 and 8; the error in speed adds up twice.
            const double rounding = 20 * fall / step * 20 * fall / step * 0x1p-52;
            EXPECT_LE(seen[k].time, exact + rounding);
            EXPECT_GE(seen[k].time, exact - early * 1.001 - rounding);
        }
        EXPECT_NEAR(world.energy(), energy, 20 * fall / step * 0x1p-47);
    }
}

// Newton's cradle, touching: in one, out one, four collisions; in two, out two, six. Along an axis velocities
// are exact.
TEST(Empirical, TouchingCradle) {
    for (const std::size_t moving : {1u, 2u}) {
        Scene s;
        s.until = 10;
        s.balls.resize(5);
        for (std::size_t i = 0; i < 5; ++i) {
            s.balls[i].position = {double(i) - (i < moving ? 1 : 0), 0};
            s.balls[i].velocity = {i < moving ? 1.0 : 0.0, 0};
        }
        for (const double step : {0.03, 0.7, 1.5}) {
            World world(empirical(s, step));
            world.advance_to(6);
            EXPECT_EQ(world.counts().ball_collisions, moving == 1 ? 4u : 6u) << step;
            for (std::size_t i = 0; i < 5; ++i)
                EXPECT_EQ(world.velocities()[i], Vec2(i + moving >= 5 ? 1 : 0, 0)) << step << ' ' << i;
        }
    }
}

// The article's flaw: several balls overlap at once at the end of a step. A heavy ball is driven into a
// touching cluster by steps of its own radius; all part, none is locked, and not an ulp of energy is made.
TEST(Empirical, SeveralAtOnce) {
    Scene s;
    s.until = 30;
    for (int row = 0; row < 6; ++row)
        for (int k = 0; k <= row; ++k) {
            Ball& b = s.balls.emplace_back();
            b.position = {5 + row * 0.8661, k - 0.5 * row};
        }
    Ball& heavy = s.balls.emplace_back();
    heavy.radius = 2;
    heavy.mass = 50;
    heavy.velocity = {3, 0.1};
    World world(empirical(s, 0.3));
    const double energy = world.energy();
    const Vec2 momentum = world.momentum();
    for (int t = 1; t <= 30; ++t) {
        world.advance_to(t);
        const auto collisions = double(world.counts().ball_collisions);
        // Each collision rounds energies and momenta of this size by a few ulp.
        EXPECT_NEAR(world.energy() / energy, 1, 8 * 1.1e-16 * (collisions + 1));
        EXPECT_NEAR(world.momentum().x(), momentum.x(), 8 * 150 * 1.1e-16 * (collisions + 1));
    }
    EXPECT_GT(world.counts().ball_collisions, 20u);
    EXPECT_EQ(world.max_overlap(), 0.0) << "all have parted";
}

TEST(Empirical, ConservesMomentumAndEnergyOfAGas) {
    for (const double spread : {0.0, 0.9})
        expect_conserved(empirical(gas(41, {.count = 400, .packing = 0.5, .radius_spread = spread}), 0.05));
}

// No response adds energy in an elastic scene, wherever it is found. In one with losses a contact at rest
// parts at up to half of what a ball falls in a step, g h / 2; that such balls rise is less than what the gas
// has lost. A ball has at most 64 responses in a step.
TEST(Empirical, PileNeitherGainsNorHangs) {
    for (const double restitution : {1.0, 0.5, 0.0}) {
        Scene s = gas(72, {.count = 60,
                           .packing = 0.4,
                           .boundary_x = Boundary::kWall,
                           .boundary_y = Boundary::kWall,
                           .restitution = restitution});
        s.gravity = {0, -9.81};
        World world(empirical(s));
        const double energy = world.energy();
        for (int k = 1; k <= 20; ++k) {
            world.advance_to(0.5 * k);
            EXPECT_LE(world.energy(), energy * (1 + 1e-12)) << restitution;
            for (const Vec2& x : world.positions()) EXPECT_TRUE(std::isfinite(x.x() + x.y()));
            EXPECT_THAT(world.validate(), testing::IsEmpty());
        }
        const Counts counts = world.counts();
        EXPECT_LE(counts.ball_collisions + counts.wall_collisions, 64 * 60 * counts.steps.value());
        if (restitution < 1) {
            EXPECT_LT(world.kinetic_energy(), 0.05 * std::abs(energy));
        }
    }
}

// A pile that drifts through a period: what overlaps from step to step is known in the right image, which
// validate() looks after.
TEST(Empirical, DriftingPileIsKeptTrackOf) {
    Scene s = gas(75, {.count = 60, .packing = 0.4, .boundary_y = Boundary::kWall, .restitution = 0.5});
    s.gravity = {0, -9.81};
    for (Ball& b : s.balls) b.velocity.x() += 3;
    World world(empirical(s));
    double deepest = 0;
    for (int k = 1; k <= 100; ++k) {
        world.advance_to(0.1 * k);
        ASSERT_THAT(world.validate(), testing::IsEmpty()) << k;
        deepest = std::max(deepest, world.max_overlap());
    }
    EXPECT_GT(deepest, 0) << "nothing to keep track of";
}

// Where nothing is missed a contact is off by at most the tolerance over the speed of approach, and the rest
// follows: the same pairs meet in the same order, the times of the first collisions of all are off in
// proportion to the tolerance. The factor: a collision multiplies an error by about twice the free path over
// the radius (Krylov), 30 at this packing, and at a speed of approach of a tenth there is another factor 10;
// after one collision of such a ball and another 10^4 is a bound, and a hundredth of the tolerance must bring
// a tenth of the error or less.
TEST(Empirical, ComesToTheEventMethod) {
    Scene s = gas(73, {.count = 100, .packing = 0.1, .boundary_y = Boundary::kWall, .radius_spread = 0.3});
    s.gravity = {0, -0.2};
    constexpr double kEnd = 4;
    World event(s);
    const std::vector<Collision> exact = collisions_until(event, kEnd);
    ASSERT_GT(exact.size(), 20u);
    const PlaneVectors places = event.positions();
    double coarser = 0;
    for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
        World world(empirical(s, 1.0 / 1024, tolerance));
        const std::vector<Collision> found = collisions_until(world, kEnd);
        ASSERT_EQ(world.counts().missed_collisions, 0u);
        ASSERT_EQ(found.size(), exact.size());
        double worst = 0;
        for (std::size_t k = 0; k < exact.size(); ++k) {
            ASSERT_EQ(found[k].i, exact[k].i);
            ASSERT_EQ(found[k].j, exact[k].j);
            worst = std::max(worst, std::abs(found[k].time - exact[k].time));
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Vec2 d = world.positions()[i] - places[i];
            worst = std::max(worst, d.norm());
        }
        EXPECT_LT(worst, 1e4 * tolerance);
        EXPECT_GT(worst, 0);
        if (coarser > 0) {
            EXPECT_LT(worst, coarser / 10);
        }
        coarser = worst;
    }
}

TEST(Empirical, CollisionsComeInTimeOrder) {
    for (const NamedScene& named : all_scenes()) {
        World world(empirical(named.scene, 0.11));
        double last = 0;
        std::uint64_t told = 0;
        world.on_collision([&](const Collision& c) {
            EXPECT_GE(c.time, last) << named.name;
            EXPECT_NEAR(c.normal.norm(), 1, 1e-15) << named.name;
            last = c.time;
            ++told;
        });
        for (int k = 1; k <= 10; ++k) {
            world.advance_to(0.5 * k);
            EXPECT_THAT(world.validate(), testing::IsEmpty()) << named.name;
        }
        const Counts counts = world.counts();
        EXPECT_EQ(counts.ball_collisions + counts.wall_collisions, told) << named.name;
        EXPECT_EQ(counts.steps, named.scene.attractors.empty() ? 45u : counts.steps) << named.name;
    }
}

// Without forces nothing overlaps at the end of a step: whoever would is traced back and resolved. That is so
// whatever the boundaries, sizes, walls and cells, if no pair is overlooked. A hair for the rounding of
// positions of up to 64.
TEST(Empirical, NothingOverlapsAtTheEndOfAStep) {
    constexpr double kStep = 1.0 / 16;
    for (const NamedScene& named : feature_scenes()) {
        Scene s = named.scene;
        s.gravity = Vec2::Zero();
        for (Ball& b : s.balls) b.acceleration = Vec2::Zero();
        s.precision = Precision::kDouble;
        World world(empirical(s, kStep));
        for (int k = 1; k <= 64; ++k) {
            world.advance_to(k * kStep);
            ASSERT_LT(world.max_overlap(), 1e-12) << named.name << " at step " << k;
        }
        EXPECT_GT(world.counts().events, 5u) << named.name;
    }
}

// A touching elastic column laid down at rest, in steps that it can fall a fifth of a radius in. The only
// speed that is given is that at which a pressed contact parts, g t / 2 with t = 1e-4 sqrt(d / g) as in the
// event method: m g d 1e-8 / 8 a collision at most.
TEST(Empirical, ElasticColumnGainsNothing) {
    Scene s;
    s.gravity = {0, -10};
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    for (int k = 0; k < 5; ++k) s.balls.emplace_back().position = {5 + 0.01 * (k % 2), 0.5 + k};
    World world(empirical(s));
    const double energy = world.energy();
    for (int k = 1; k <= 100; ++k) {
        world.advance_to(0.5 * k);
        const Counts counts = world.counts();
        const double given = 10 * 1e-8 / 8 * double(counts.ball_collisions + counts.wall_collisions);
        ASSERT_LE(world.energy(), energy * (1 + 1e-12) + given) << k;
    }
}

// What starts inside another responds at once where it approaches, and is let go where it parts.
TEST(Empirical, OverlapAtTheStart) {
    Scene s;
    s.allows_overlap = true;
    s.until = 1;
    s.balls.resize(2);
    s.balls[1].position = {0.5, 0};
    s.balls[0].velocity = {1, 0};
    World approaching(empirical(s, 0.25));
    const std::vector<Collision> seen = collisions_until(approaching, 1);
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(seen[0].time, 0.0);
    EXPECT_EQ(approaching.positions()[1], Vec2(1.5, 0));

    s.balls[0].velocity = {-1, 0};
    World parting(empirical(s, 0.25));
    EXPECT_THAT(collisions_until(parting, 1), testing::IsEmpty());
    EXPECT_EQ(parting.counts().missed_collisions, 0u);

    s.balls[0].velocity = {64, 0};  // through and out in a step, but it approaches first
    World fast(empirical(s, 0.25));
    EXPECT_EQ(collisions_until(fast, 1).size(), 1u);
}

// One ball of radius 1/2 at speed 2: a step of 0.25 of the radius takes 1/16, exactly; 32 of them by time 2.
// With a longest step of 1/32 there are 64.
TEST(Empirical, StepsFollowTheTravel) {
    Scene s;
    s.until = 2;
    s.balls.resize(1);
    s.balls[0].velocity = {2, 0};
    s.max_travel = 0.25;
    World adaptive(empirical(s));
    adaptive.advance_to(2);
    EXPECT_EQ(adaptive.counts().steps, 32u);
    World both(empirical(s, 1.0 / 32));
    both.advance_to(2);
    EXPECT_EQ(both.counts().steps, 64u);
    // From rest under a constant pull g the step is sqrt(2 d / g) = 1/2 here; the next one begins at speed
    // 1/4.
    s.balls[0].velocity = Vec2::Zero();
    s.gravity = {0, 0.5};
    s.max_travel = 0.125;
    World falling(empirical(s));
    falling.advance_to(std::nextafter(0.5, 0.0));
    EXPECT_EQ(falling.counts().steps, 0u);
    falling.advance_to(0.5);
    EXPECT_EQ(falling.counts().steps, 1u);
}

// Between two steps balls are read in free flight, and a step longer than the run resolves nothing.
TEST(Empirical, ReadsInFreeFlight) {
    Scene s;
    s.until = 1;
    s.domain = Domain{{{0, 0}, {4, 4}}, {Boundary::kWall, Boundary::kPeriodic}, 1};
    s.balls.resize(1);
    s.balls[0].position = {3, 3};
    s.balls[0].velocity = {2, 2};
    World world(empirical(s, 1));
    world.advance_to(0.5);
    EXPECT_EQ(world.positions()[0], Vec2(4, 0));
    EXPECT_EQ(world.counts().steps, 0u);
    world.advance_to(1);
    EXPECT_EQ(world.counts().wall_collisions, 1u);
    EXPECT_NEAR(world.positions()[0].x(), 2, 1e-6);
    EXPECT_EQ(world.velocities()[0], Vec2(-2, 2));
}

TEST(Empirical, WorldsWithoutMotion) {
    Scene s = empirical({});
    s.until = 1;
    World empty(s);
    empty.advance_to(1e6);
    EXPECT_EQ(empty.counts().steps, 0u);
    s.balls.resize(2);
    s.balls[1].position = {2, 0};
    World at_rest(s);  // no step is too long
    at_rest.advance_to(1e6);
    EXPECT_EQ(at_rest.counts().steps, 0u);
    s.balls[0].is_static = s.balls[1].is_static = true;
    s.gravity = {0, -1};
    World fixed(s);
    fixed.advance_to(1e6);
    EXPECT_EQ(fixed.positions()[1], Vec2(2, 0));
}

TEST(Empirical, RefusesToLoseCountOfPeriods) {
    Scene s;
    s.until = 1;
    s.domain = Domain{{{0, 0}, {2, 2}}, {Boundary::kPeriodic, Boundary::kOpen}, 1};
    s.balls.resize(1);
    s.balls[0].velocity = {1e8, 1e9};
    World world(empirical(s, 1));
    world.advance_to(1);
    EXPECT_EQ(world.positions()[0], Vec2(0, 1e9));
    s.balls[0].velocity = {1e10, 0};
    World too_fast(empirical(s, 1));
    EXPECT_THROW(too_fast.advance_to(1), std::runtime_error);
}

std::string reason(const Scene& scene) {
    try {
        const World world(scene);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Empirical, RefusesWhatItCannotDo) {
    Scene s = empirical(gas(74, {}));
    EXPECT_EQ(reason(s), "accepted");
    s.tolerance = 0.5;
    EXPECT_EQ(reason(s), "tolerance: must be less than the smallest moving ball's radius, 0.5, is 0.5");
    s.tolerance = 0;
    EXPECT_EQ(reason(s), "tolerance: must be > 0, is 0");
    s.tolerance = 1e-3;
    s.step = 0;
    EXPECT_EQ(reason(s), "step: must be > 0, is 0");
    s.step = 1e-15;
    EXPECT_EQ(reason(s), "step: must be at least 1e-15 of until");
    s.step = {};
    s.max_travel = 0;
    EXPECT_EQ(reason(s), "max_travel: must be > 0 where no step is given, is 0");
    s.max_travel = -1;
    EXPECT_EQ(reason(s), "max_travel: must be >= 0, is -1");
    s.max_travel = 1e-10;
    EXPECT_EQ(reason(s), "max_travel: must be 0 or at least 1e-9, is 1e-10");
}

}  // namespace
}  // namespace carom::test
