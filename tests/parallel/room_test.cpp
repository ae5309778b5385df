// Balls that come to rest hop thousands of millions of times a second where the contact time is short. What
// is kept of collisions, in windows and for who follows flights, must fit the memory all the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include <carom/parallel/world.hpp>

#include "engine.hpp"
#include "engine_state.hpp"
#include "outcome.hpp"
#include "physics.hpp"
#include "sanitized.hpp"

namespace carom::test {
namespace {

constexpr std::size_t kBalls = 40;

std::vector<int> domain_counts() {
    if (kIsSanitized) return {2};
    return {2, 3};
}

/// Balls that fall on a floor side by side, each a little later than the one before. Ball k hits it after
/// 1 + k / 100 seconds, and with half the speed after each hit it would lie still after three times that.
Scene falling(double contact_time) {
    Scene s;
    s.domain = Domain{{{0, 0}, {80, 4}}, {Boundary::kWall, Boundary::kWall}, 0.5};
    s.gravity = {0, -1};
    s.contact_time = contact_time;
    s.until = 10;
    for (std::size_t k = 0; k < kBalls; ++k) {
        const double fall = 1 + double(k) / 100;
        Ball b;
        b.restitution = 0.5;
        b.position = {1 + 2 * double(k), b.radius + fall * fall / 2};
        s.balls.push_back(b);
    }
    return s;
}

/// A heavy ball drives a light one against a wall: pi times the root of the masses' ratio hits in all, most
/// of them within a hundred-thousandth of the time until the first. The others lie still.
Scene driven(double gap) {
    Scene s;
    s.domain = Domain{{{0, 0}, {80, 40}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.until = 100;
    s.balls.resize(kBalls);
    for (std::size_t k = 0; k < kBalls; ++k) s.balls[k].position = {1 + 1.9 * double(k), 30};
    s.balls[0].position = {0.5 + gap, 5};
    s.balls[1].position = {1.5 + 3 * gap, 5};
    s.balls[1].velocity = {-1, 0};
    s.balls[1].mass = 1e10;
    return s;
}

struct Burst {
    Scene scene;
    double until;
};
/// Scenes with many collisions in little time.
std::vector<Burst> bursts() {
    if (kIsSanitized) return {{falling(1e-6), 3.05}, {driven(5e-4), 1}};
    return {{falling(1e-6), 3.05}, {falling(1e-9), 3.0001}, {driven(20), 60}, {driven(5e-4), 1}};
}

// A window looks beyond the time that is asked for. What lies there must not hold it up: 10^13 hops a second.
TEST(Room, AWindowDoesNotLookIntoACollapse) {
    const Scene scene = falling(1e-13);
    for (const double until : {2.9, 2.999, 2.9999999}) {
        const Outcome serial = run(scene, {.threads = 1, .domains = 1}, until);
        ASSERT_GT(serial.collisions.size(), kBalls);
        for (const int domains : {2, 4}) {
            expect_equal(run(scene, {.threads = 2, .domains = domains}, until), serial);
            expect_equal(run(scene, {.threads = 2, .domains = domains}, until, 0.1), serial);
        }
    }
}

// Where time has to go through it, it does so in many windows.
TEST(Room, ManyCollisionsOfFewBallsTakeManyWindows) {
    for (const auto& [scene, until] : bursts()) {
        const Outcome serial = run(scene, {.threads = 1, .domains = 1}, until);
        ASSERT_GT(serial.collisions.size(), 30'000U);
        for (const int domains : domain_counts()) {
            expect_equal(run(scene, {.threads = 2, .domains = domains}, until), serial);
            expect_equal(run(scene, {.threads = 2, .domains = domains}, until, 0.01), serial);
        }
    }
}

// Nor is a window held up by a ball that flies through thousands of millions of cells, as it may where an
// edit has brought a pull for which the scene's own scales of time are long.
TEST(Room, AWindowDoesNotFollowAFallThroughAllCells) {
    Scene scene = driven(20);
    scene.domain->boundary = {Boundary::kWall, Boundary::kPeriodic};
    const auto fallen = [&scene](int domains) {
        World world(scene, {.threads = 2, .domains = domains});
        world.advance_to(1);
        world.set_gravity({0, 1e16});
        world.advance_to(1 + 1e-6);
        Outcome out;
        take_counts(world, out);
        return out;
    };
    const Outcome serial = fallen(1);
    for (const int domains : domain_counts()) expect_equal(fallen(domains), serial);
}

// A follower is told before more flights are there than a window may have collisions, of which each ends two
// at most.
TEST(Room, FewFlightsAreKeptForAFollower) {
    for (const auto& [scene, until] : bursts()) {
        const Physics physics = derive_physics(scene, scene.balls);
        const Bodies bodies(physics, scene.balls, scene.walls, scene.attractors,
                            choose_grid(physics.domain, kBalls, 1, 0));
        const Executor executor(1);
        for (const int domains : {1, 2}) {
            SCOPED_TRACE(testing::Message() << "until " << until << ", " << domains << " domains");
            const std::unique_ptr<Engine> engine =
                make_engine(bodies, start_at_zero(bodies, scene.balls), executor, {.domains = domains});
            std::size_t all = 0, most = 0;
            Stop seen{{0, 0}};
            engine->follow([&](const Stop& stop) {
                std::atomic<std::size_t> flights = 0;
                engine->visit_flights(seen, stop.time, [&](std::uint32_t, std::span<const Flight> ways) {
                    flights += ways.size();
                });
                all += flights;
                most = std::max(most, flights.load());
                seen = stop;
            });
            const Time end = physics.clock.from_seconds(until);
            engine->advance_to(end, end);
            EXPECT_GT(all, 50'000U);
            EXPECT_LT(most, 2 * (10'000 + 32 * kBalls) * static_cast<unsigned>(domains));
        }
    }
}

}  // namespace
}  // namespace carom::test
