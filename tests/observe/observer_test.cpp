// What an observer tells, against what is known of the scene and against plain loops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <carom/observe/observer.hpp>
#include <carom/observe/text.hpp>

#include "parallel/scenes.hpp"

namespace carom {
namespace {

constexpr double kUlp = 0x1p-52;

/// Balls at rest on a lattice of the given rows; `shift` moves every other row by half a spacing.
Scene lattice(int columns, int rows, double row_height, bool shift) {
    Scene s;
    s.domain =
        Domain{{{0, 0}, {double(columns), rows * row_height}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.until = 1;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            Ball b;
            b.radius = 0.4;
            b.position = {column + (shift && row % 2 == 1 ? 0.75 : 0.25), (row + 0.5) * row_height};
            s.balls.push_back(b);
        }
    }
    return s;
}

// A run that is looked at is the run that is not.
TEST(Observer, ChangesNoBit) {
    for (const test::NamedScene& named : test::all_scenes()) {
        SCOPED_TRACE(named.name);
        World alone(named.scene, {.threads = 1});
        alone.advance_to(3);
        World watched(named.scene, {.threads = 2, .domains = 3});
        Observer observer(watched, {.records_collisions = true});
        watched.on_collision([&observer](const Collision& c) { observer.record(c); });
        for (int k = 0; k <= 30; ++k) {
            watched.advance_to(k / 10.0);
            (void)observer.sample(watched);
        }
        EXPECT_EQ(watched.state_hash(), alone.state_hash());
        EXPECT_EQ(watched.counts().ball_collisions, alone.counts().ball_collisions);
    }
}

// Nor do threads and domains change a bit of what it tells.
TEST(Observer, TellsTheSameOfAnyThreads) {
    const auto told = [](const WorldOptions& options) {
        World world(test::gas(5, {.boundary_x = Boundary::kWall}), options);
        Observer observer(world, {.records_collisions = true});
        world.on_collision([&observer](const Collision& c) { observer.record(c); });
        std::string text;
        for (int k = 0; k <= 10; ++k) {
            world.advance_to(k / 4.0);
            text += to_csv(observer.sample(world));
        }
        return text + to_json(observer.structure());
    };
    EXPECT_EQ(told({.threads = 1, .domains = 1}), told({.threads = 2, .domains = 4}));
}

// Balls that fly in lanes meet nobody: displacements are <v^2> t^2 through any number of periods, velocities
// stay.
TEST(Observer, FreeFlightIsBallistic) {
    Scene s;
    s.domain = Domain{{{0, 0}, {10, 40}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    s.until = 1;
    double squares = 0;
    for (int k = 0; k < 20; ++k) {
        Ball b;
        b.position = {1.0 + k % 5, 1.0 + 2 * k};
        b.velocity = {0.37 * (k - 7), 0};
        squares += length_squared(b.velocity) / 20;
        s.balls.push_back(b);
    }
    World world(s, {.threads = 1});
    Observer observer(world, {.lags = 8});
    for (int k = 0; k <= 40; ++k) {
        world.advance_to(0.5 * k);
        const Sample sample = observer.sample(world);
        // Positions of up to 100 are rounded to half an ulp of 128 twice; displacements double that.
        EXPECT_NEAR(sample.mean_square_displacement, squares * 0.25 * k * k, 4 * 128 * kUlp * 100);
        EXPECT_EQ(sample.ball_collision_rate.value_or(0), 0);
        EXPECT_FALSE(sample.mean_free_path);
    }
    const Structure structure = observer.structure();
    ASSERT_EQ(structure.mean_square_displacement.at.size(), 9U);
    for (std::size_t lag = 0; lag <= 8; ++lag) {
        const double t = 0.5 * double(lag);
        EXPECT_NEAR(structure.mean_square_displacement.at[lag], t, 40 * kUlp * 20);
        EXPECT_NEAR(structure.mean_square_displacement.value[lag], squares * t * t, 4 * 128 * kUlp * 100);
        EXPECT_NEAR(structure.velocity_autocorrelation.value[lag], squares, 40 * kUlp * squares);
    }
}

TEST(Observer, OddIntervalsAreNoLags) {
    World world(test::gas(1, {.count = 16}), {.threads = 1});
    Observer observer(world, {.lags = 4});
    for (const double t : {0.0, 1.0, 2.0, 2.3}) {
        world.advance_to(t);
        (void)observer.sample(world);
    }
    const Curve lags = observer.structure().mean_square_displacement;
    ASSERT_EQ(lags.at.size(), 3U);
    EXPECT_EQ(lags.at, (std::vector<double>{0, 1, 2}));
}

TEST(Observer, TriangularLatticeHasFullHexaticOrder) {
    World world(lattice(12, 14, std::sqrt(3.0) / 2, true), {.threads = 1});
    const Sample sample = Observer(world).sample(world);
    EXPECT_NEAR(*sample.hexatic_global, 1, 100 * kUlp);  // some roundings a direction, positions of 12
    EXPECT_NEAR(*sample.hexatic_local, 1, 100 * kUlp);
}

TEST(Observer, SquareLatticeHasNone) {
    World world(lattice(12, 12, 1, false), {.threads = 1});
    const Sample sample = Observer(world).sample(world);
    EXPECT_NEAR(*sample.hexatic_local, 0, 100 * kUlp);
}

// Two grains turned by thirty degrees: each has order, the whole has none.
TEST(Observer, GlobalOrderNeedsOneDirection) {
    Scene s;
    s.domain = Domain{{{-40, -20}, {40, 20}}, {Boundary::kOpen, Boundary::kOpen}, 1};
    s.until = 1;
    for (const bool turned : {false, true}) {
        for (int row = -5; row <= 5; ++row) {
            for (int column = -5; column <= 5; ++column) {
                const Vec2 p(column + 0.5 * row, std::sqrt(3.0) / 2 * row);
                Ball b;
                b.radius = 0.45;
                b.position = turned ? Vec2(20 + p.y(), p.x()) : Vec2(-20 + p.x(), p.y());
                s.balls.push_back(b);
            }
        }
    }
    World world(s, {.threads = 1});
    const Sample sample = Observer(world, {.neighbour_cutoff = 1.3}).sample(world);
    EXPECT_NEAR(*sample.hexatic_local, 1, 1e-12);  // at edges too: all that is there lies in six directions
    EXPECT_NEAR(*sample.hexatic_global, 0, 1e-12);
}

TEST(Observer, LatticeHasItsShells) {
    const Scene scene = lattice(12, 14, std::sqrt(3.0) / 2, true);
    World world(scene, {.threads = 1});
    Observer observer(world, {.reach = 3, .bin = 0.0625});  // in diameters of 0.8: bins of 0.05
    (void)observer.sample(world);
    const Curve g = observer.structure().radial_distribution;
    ASSERT_EQ(g.at.size(), 48U);
    const double density = double(scene.balls.size() - 1) / (12 * 14 * std::sqrt(3.0) / 2);
    const auto neighbours = [&](double distance) {  // around it, however rounding puts it
        double sum = 0;
        for (std::size_t k = 0; k < g.at.size(); ++k)
            if (std::abs(g.at[k] - distance) < 0.05)
                sum += g.value[k] * density * 2 * std::numbers::pi * g.at[k] * 0.05;
        return sum;
    };
    EXPECT_NEAR(neighbours(1), 6, 1e-9);
    EXPECT_NEAR(neighbours(std::sqrt(3.0)), 6, 1e-9);
    EXPECT_NEAR(neighbours(2), 6, 1e-9);
    EXPECT_NEAR(neighbours(1.35), 0, 1e-9);
}

// Every pair by two loops, and only centres whose circle lies in the box.
TEST(Observer, RadialDistributionIsThatOfAllPairs) {
    for (const Boundary x : {Boundary::kPeriodic, Boundary::kWall}) {
        const Scene scene = test::gas(3, {.packing = 0.2, .boundary_x = x});
        World world(scene, {.threads = 1});
        world.advance_to(1);
        Observer observer(world, {.reach = 4, .bin = 0.125});
        (void)observer.sample(world);
        const Curve g = observer.structure().radial_distribution;
        ASSERT_EQ(g.at.size(), 32U);
        const double side = scene.domain->box.max.x();
        const PlaneVectors p = world.positions();
        std::vector<double> expected(g.at.size(), 0);
        double centres = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            if (x == Boundary::kWall && (p[i].x() < 4 || side - p[i].x() < 4)) continue;
            ++centres;
            for (std::size_t j = 0; j < p.size(); ++j) {
                if (j == i) continue;
                Vec2 d = p[j] - p[i];
                d.y() -= side * std::round(d.y() / side);
                if (x == Boundary::kPeriodic) d.x() -= side * std::round(d.x() / side);
                const auto k = static_cast<std::size_t>(d.norm() / 0.125);
                if (k < expected.size()) expected[k] += 1;
            }
        }
        for (std::size_t k = 0; k < expected.size(); ++k) {
            const double outer = 0.125 * double(k + 1);
            const double ring = std::numbers::pi * (outer * outer - (outer - 0.125) * (outer - 0.125));
            expected[k] *= side * side / (centres * double(p.size() - 1) * ring);
            EXPECT_NEAR(g.value[k], expected[k], 1e-12 * (1 + expected[k])) << k;
        }
    }
}

TEST(Observer, ProfilesCountEveryBall) {
    const Scene scene = test::gas(4, {.packing = 0.2});
    World world(scene, {.threads = 1});
    Observer observer(world, {.profile_bins = 7});
    (void)observer.sample(world);
    const Structure s = observer.structure();
    const double side = scene.domain->box.max.x();
    for (const Curve& c : {s.density_x, s.density_y}) {
        double balls = 0;
        for (const double density : c.value) balls += density * side * side / 7;
        EXPECT_NEAR(balls, double(scene.balls.size()), 1e-9);
    }
    const auto left =
        std::ranges::count_if(scene.balls, [&](const Ball& b) { return b.position.x() < side / 7; });
    EXPECT_NEAR(s.density_x.value[0] * side * side / 7, double(left), 1e-9);
}

// A ball that goes to and fro between two walls: 2 m v a hit, one hit a wall every 2 (L - 2 r) / v.
TEST(Observer, WallsTakeUpTheirMomentum) {
    Scene s;
    s.domain = Domain{{{0, 0}, {9, 4}}, {Boundary::kWall, Boundary::kPeriodic}, 1};
    s.until = 1;
    s.balls.resize(1);
    s.balls[0].position = {4, 2};
    s.balls[0].velocity = {2, 0};
    s.balls[0].mass = 3;
    World world(s, {.threads = 1});
    Observer observer(world, {.records_collisions = true});
    world.on_collision([&observer](const Collision& c) { observer.record(c); });
    (void)observer.sample(world);
    world.advance_to(80);  // 10 rounds of 16
    const Sample sample = observer.sample(world);
    EXPECT_NEAR(*sample.wall_pressure[0], 10 * 2 * 3 * 2 / (80.0 * 4), 1e-12);
    EXPECT_NEAR(*sample.wall_pressure[1], 10 * 2 * 3 * 2 / (80.0 * 4), 1e-12);
    EXPECT_FALSE(sample.wall_pressure[2] || sample.wall_pressure[3] || sample.pressure);
    EXPECT_NEAR(*sample.wall_collision_rate, 20 / 80.0, 1e-12);
    EXPECT_NEAR(*sample.temperature, 3 * 4 / 2.0, 1e-12);  // held by walls: two degrees of freedom
}

// Where nothing holds the centre of mass its motion is no heat: two balls have two degrees of freedom left.
TEST(Observer, DriftIsNoHeat) {
    Scene scene;
    scene.balls.resize(2);
    scene.balls[1].position = {5, 0};
    scene.balls[0].velocity = {100 - 3, 0};
    scene.balls[1].velocity = {100 + 3, 0};
    scene.until = 1;
    World world(scene, {.threads = 1});
    EXPECT_NEAR(*Observer(world).sample(world).temperature, 2 * 9 / 2.0, 1e-9);
}

TEST(Observer, RefusesOtherBallsAndEarlierTimes) {
    World world(test::gas(1, {.count = 16}), {.threads = 1});
    World other(test::gas(1, {.count = 25}), {.threads = 1});
    Observer observer(world);
    (void)observer.sample(world);
    EXPECT_THROW((void)observer.sample(world), std::invalid_argument);
    EXPECT_THROW((void)observer.sample(other), std::invalid_argument);
}

/// A world, an observer, and what it tells.
struct Watch {
    Watch(const Scene& scene, const WorldOptions& options, const ObserverOptions& wanted)
        : world(scene, options), observer(world, wanted) {
        listen();
    }
    Watch(const Scene& scene, const WorldOptions& options, const ObserverOptions& wanted, const Watch& before)
        : world(scene, options, before.world.snapshot()), observer(world, wanted) {
        observer.restore(before.observer.save());
        listen();
    }
    void listen() {
        world.on_collision([this](const Collision& c) { observer.record(c); });
    }
    void sample_at(double time) {
        world.advance_to(time);
        rows += to_csv(observer.sample(world));
    }
    World world;
    Observer observer;
    std::string rows = {};
};

// Saved between two samples, at a sample, before the first, and again; another world goes on by other
// options.
TEST(Observer, GoesOnFromWhatWasSaved) {
    const ObserverOptions wanted = {
        .records_collisions = true, .average_from = 0.5, .lags = 5, .tracked = 40};
    for (const Boundary boundary : {Boundary::kPeriodic, Boundary::kWall}) {
        const Scene scene = test::gas(5, {.boundary_x = boundary});
        Watch whole(scene, {.threads = 1}, wanted);
        for (int k = 0; k <= 20; ++k) whole.sample_at(0.2 * k);
        for (const double stop : {0.0, 0.1, 0.6, 0.75, 3.3}) {
            SCOPED_TRACE(stop);
            Watch first(scene, {.threads = 1}, wanted);
            int k = 0;
            for (; 0.2 * k <= stop && stop > 0; ++k) first.sample_at(0.2 * k);
            first.world.advance_to(stop);
            Watch second(scene, {.threads = 2, .domains = 3}, wanted, first);
            Watch third(scene, {.threads = 1}, wanted, second);
            for (; k <= 20; ++k) third.sample_at(0.2 * k);
            EXPECT_EQ(first.rows + third.rows, whole.rows);
            EXPECT_EQ(to_json(third.observer.structure()), to_json(whole.observer.structure()));
        }
    }
}

TEST(Observer, RefusesWordsThatAreNotItsOwn) {
    const ObserverOptions wanted = {.profile_bins = 3, .lags = 3, .tracked = 4};
    const Scene scene = test::gas(5, {.count = 16});
    Watch watch(scene, {.threads = 1}, wanted);
    for (int k = 0; k <= 6; ++k) watch.sample_at(k);
    const std::vector<std::uint64_t> words = watch.observer.save();
    const auto restore = [&](const ObserverOptions& options, std::span<const std::uint64_t> from) {
        Observer(watch.world, options).restore(from);
    };
    restore(wanted, words);
    for (std::size_t size = 0; size < words.size(); ++size)
        EXPECT_THROW(restore(wanted, std::span(words).first(size)), std::invalid_argument);
    std::vector<std::uint64_t> longer = words;
    longer.push_back(0);
    EXPECT_THROW(restore(wanted, longer), std::invalid_argument);
    for (const ObserverOptions& other :
         {ObserverOptions{.records_collisions = true, .profile_bins = 3, .lags = 3, .tracked = 4},
          {.average_from = 1, .profile_bins = 3, .lags = 3, .tracked = 4},
          {.profile_bins = 4, .lags = 3, .tracked = 4},
          {.profile_bins = 3, .lags = 2, .tracked = 4},
          {.profile_bins = 3, .lags = 3, .tracked = 5},
          {.profile_bins = 3, .lags = 3, .tracked = 4, .hexatic = false},
          {.profile_bins = 3, .lags = 3, .tracked = 4, .structure = false}})
        EXPECT_THROW(restore(other, words), std::invalid_argument);
    // Whatever a word becomes: taken or refused, and no more memory than the words fill.
    for (std::size_t at = 0; at < words.size(); ++at) {
        for (const std::uint64_t word : {~std::uint64_t{0}, std::uint64_t{1} << 40U, std::uint64_t{2}}) {
            std::vector<std::uint64_t> changed = words;
            changed[at] = word;
            try {
                restore(wanted, changed);
            } catch (const std::invalid_argument&) {
            }
        }
    }
}

TEST(Observer, LeavesOutStaticBallsAndEarlySamples) {
    Scene scene = test::gas(1, {.count = 16});
    scene.balls[3].is_static = true;
    scene.balls[3].velocity = Vec2::Zero();
    World world(scene, {.threads = 1});
    Observer observer(world, {.average_from = 1.5});
    for (int k = 0; k <= 3; ++k) {
        world.advance_to(k);
        (void)observer.sample(world);
    }
    const Structure s = observer.structure();
    EXPECT_EQ(s.samples, 2U);
    EXPECT_EQ(s.first_time, 2);
    double balls = 0;
    const double side = scene.domain->box.max.x();
    for (const double density : s.density_y.value) balls += density * side * side / 100;
    EXPECT_NEAR(balls, 15, 1e-9);
}

TEST(Observer, EmptyWorldsHaveNoFigures) {
    Scene scene;
    scene.balls.resize(1);
    scene.balls[0].is_static = true;
    scene.until = 1;
    World world(scene, {.threads = 1});
    Observer observer(world);
    const Sample sample = observer.sample(world);
    EXPECT_FALSE(sample.temperature || sample.hexatic_global);
    EXPECT_TRUE(observer.structure().radial_distribution.at.empty());
}

}  // namespace
}  // namespace carom
