// Domains side by side: what they promise is one result, and that what goes wrong in a window is found and
// mended.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <carom/parallel/world.hpp>

#include "outcome.hpp"
#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

/// Scenes in which load, speed and place are as uneven as they get.
std::vector<NamedScene> uneven_scenes() {
    std::vector<NamedScene> all;
    const auto kWall = Boundary::kWall;
    const auto kOpen = Boundary::kOpen;

    Scene corner = gas(31, {.count = 900, .packing = 0.5});
    corner.domain->boundary = {kWall, kWall};
    corner.domain->box.max *= 6;
    all.push_back({"all in one corner", corner});

    Scene fast = gas(32, {.count = 900, .packing = 0.3});
    for (std::size_t i = 0; i < fast.balls.size(); i += 100) fast.balls[i].velocity *= 300;
    all.push_back({"a few fast balls", fast});

    Scene pour =
        gas(33, {.count = 900, .packing = 0.4, .boundary_x = kWall, .boundary_y = kWall, .restitution = 0.7});
    pour.domain->box.max.y() *= 3;
    pour.gravity = {0, -1};
    pour.walls = {{{0, 8}, {12, 3}, 0.7}, {{30, 10}, {18, 5}, 0.7}};
    std::erase_if(pour.balls, [&](const Ball& b) { return b.position.y() < 13; });
    all.push_back({"pour onto slanted walls", pour});

    Scene burst = gas(34, {.count = 900, .packing = 0.5, .boundary_x = kOpen, .boundary_y = kOpen});
    all.push_back({"burst into the open", burst});

    Scene half = gas(35, {.count = 900, .packing = 0.55, .boundary_y = kWall});
    std::erase_if(half.balls, [&](const Ball& b) { return b.position.x() > 0.4 * half.domain->box.max.x(); });
    all.push_back({"half empty", half});

    Scene still = gas(36, {.count = 900, .packing = 0.5});
    for (Ball& b : still.balls) b.velocity.setZero();
    still.balls[450].velocity = {40, 7};
    all.push_back({"one moves at first", still});

    // What matters in the scenes below shows with few domains, at the edges of the plane.
    Scene crossing = gas(101, {.count = 400, .packing = 0.3, .boundary_x = kWall, .boundary_y = kWall});
    for (std::size_t i = 0; i < crossing.balls.size(); i += 7) crossing.balls[i].velocity *= 30;
    all.push_back({"fast ones from afar between walls", crossing});

    Scene drifting = gas(102, {.count = 400, .packing = 0.5, .boundary_x = kOpen, .boundary_y = kOpen});
    for (Ball& b : drifting.balls) b.velocity = 0.3 * b.velocity + Vec2(12, 0);
    all.push_back({"a cloud leaves the box as a whole", drifting});

    std::mt19937_64 random(5);
    Scene thin;
    thin.domain = Domain{{{0, 0}, {300, 1.02}}, {kOpen, kOpen}, 1};
    for (int i = 0; i < 150; ++i) {
        Ball b;
        b.position = {1.0 + 2 * i, 0.51};
        b.velocity = random_velocity(random, 1).cwiseProduct(Vec2(i % 4 == 0 ? 30 : 1, 0.3));
        thin.balls.push_back(b);
    }
    thin.walls = {{{-50, -4}, {350, -4}, 1}, {{-50, 5}, {350, 5}, 1}};
    all.push_back({"a box one cell thick", thin});
    return all;
}

/// Scenes in which many events share one instant, and the order among them counts.
std::vector<NamedScene> simultaneous_scenes() {
    std::vector<NamedScene> all;
    const auto at = [](double x, double y, double vx, double vy) {
        Ball b;
        b.position = {x, y};
        b.velocity = {vx, vy};
        return b;
    };
    const auto box = [](double side) {
        Scene s;
        s.domain = Domain{{{0, 0}, {side, side}}, {Boundary::kWall, Boundary::kWall}, 1};
        return s;
    };
    // All of a row move at the instant at which its first is hit, however long it is.
    for (const bool backwards : {false, true}) {
        Scene row = box(150);
        for (int i = 0; i < 100; ++i) row.balls.push_back(at(backwards ? 119 - i : 20 + i, 10, 0, 0));
        row.balls.push_back(at(15, 10, 10, 0));
        for (int i = 0; i < 30; ++i) row.balls.push_back(at(3 + 4.7 * i, 14 + i % 3, 2 + 0.1 * i, 3));
        all.push_back({backwards ? "row of falling ids" : "row of rising ids", row});
    }

    std::mt19937_64 random(1);
    Scene lattice = box(48);
    for (int k = 0; k < 24 * 24; ++k) {
        if (random() % 4 == 0) continue;
        const double vx = double(random() % 3) - 1;
        lattice.balls.push_back(at(1 + 2 * (k % 24), 1 + 2 * (k / 24), vx, double(random() % 3) - 1));
    }
    all.push_back({"lattice", lattice});

    std::mt19937_64 other(2);
    Scene touching = box(26);
    for (int k = 0; k < 24 * 24; ++k) {
        const double vx = double(other() % 3) - 1;
        const double vy = double(other() % 3) - 1;
        const double moves = other() % 8 == 0 ? 1 : 0;
        touching.balls.push_back(at(1 + k % 24, 1 + k / 24, moves * vx, moves * vy));
    }
    all.push_back({"lattice of touching balls", touching});
    // A static ball's id is as good as a moving one's where ids decide.
    Scene posts = lattice;
    for (std::size_t k = 0; k < posts.balls.size(); k += 5) {
        posts.balls[k].is_static = true;
        posts.balls[k].velocity = Vec2::Zero();
    }
    all.push_back({"lattice among static balls", posts});
    return all;
}

// One event after 3 * 10^8 crossing times of nothing, and then nothing for ever: as many windows as there is
// something to do.
TEST(QuietDomains, SkipWhatIsEmpty) {
    Scene far;
    far.domain = Domain{{{0, 0}, {1e9, 1e9}}, {Boundary::kWall, Boundary::kWall}, 1};
    far.until = 1e9;
    far.balls.resize(2);
    far.balls[0].position = {5, 5};
    far.balls[0].velocity = {1, 0};
    far.balls[1].position = {3e8, 5};
    Scene open;
    open.until = 1e3;
    open.balls.resize(2);
    open.balls[1].position = {3, 0};
    open.balls[1].velocity = {1e9, 0};
    for (Scene s : {far, open}) {
        const Outcome serial = run(s, {.threads = 1, .domains = 1}, s.until);
        const Outcome outcome = run(s, {.threads = 2, .domains = 4}, s.until);
        expect_equal(outcome, serial);
        EXPECT_LT(outcome.counts.windows, 10'000u);
        expect_equal(run(s, {.threads = 2, .domains = 4}, s.until, s.until / 7), serial);
    }
}

/// Where each domain has a thread its loop stays from window to window, else it is filled anew.
std::vector<int> few_and_enough(int domains) {
    return domains > 2 ? std::vector{2, domains} : std::vector{1, domains};
}

class Domains : public testing::TestWithParam<NamedScene> {};

TEST_P(Domains, GiveTheSerialResult) {
    constexpr double kEnd = kIsSanitized ? 2 : 5;
    const Outcome serial = run(GetParam().scene, {.threads = 1, .domains = 1}, kEnd);
    ASSERT_GT(serial.collisions.size(), 50U);
    for (const int domains : {2, 3, 5, 8, 16}) {
        for (const int threads : few_and_enough(domains)) {
            SCOPED_TRACE(std::to_string(domains) + " domains, threads " + std::to_string(threads));
            expect_equal(run(GetParam().scene, {.threads = threads, .domains = domains}, kEnd), serial);
        }
    }
}

TEST_P(Domains, GiveTheSerialResultInFrames) {
    constexpr double kEnd = 2;
    const Outcome serial = run(GetParam().scene, {.threads = 1, .domains = 1}, kEnd);
    for (const int threads : few_and_enough(6))
        expect_equal(run(GetParam().scene, {.threads = threads, .domains = 6}, kEnd, 1.0 / 60), serial);
}

/// With a halo of one or two cells what happens beyond it reaches the domain at once: the comparison must see
/// it, and the repairs must lead to the serial result.
TEST_P(Domains, MendAHaloThatIsTooThin) {
    // A halo of one cell may ask for a hundred thousand windows in a time of 1.
    constexpr double kEnd = kIsSanitized ? 0.3 : 1;
    const Outcome serial = run(GetParam().scene, {.threads = 1, .domains = 1}, kEnd);
    std::uint64_t retries = 0;
    for (const int halo : {1, 2, 3}) {
        SCOPED_TRACE("halo of " + std::to_string(halo));
        for (const int domains : {2, 3, 9}) {
            for (const int threads : few_and_enough(domains)) {
                SCOPED_TRACE(std::to_string(domains) + " domains, threads " + std::to_string(threads));
                const Outcome thin =
                    run(GetParam().scene, {.threads = threads, .domains = domains, .halo = halo}, kEnd);
                expect_equal(thin, serial);
                retries += thin.counts.window_retries;
            }
        }
    }
    EXPECT_GT(retries, 0U);
}

std::string name_of(const testing::TestParamInfo<NamedScene>& param) {
    std::string name = param.param.name;
    std::ranges::replace(name, ' ', '_');
    return name;
}
INSTANTIATE_TEST_SUITE_P(Uneven, Domains, testing::ValuesIn(uneven_scenes()), name_of);

class SimultaneousInDomains : public testing::TestWithParam<NamedScene> {};

/// One collision brings about the next at the same instant, over any distance. The comparison must not take
/// equal times for equal histories, the order must be the serial one, and time must go on.
TEST_P(SimultaneousInDomains, GiveTheSerialResult) {
    constexpr double kEnd = 1;
    const Outcome serial = run(GetParam().scene, {.threads = 1, .domains = 1}, kEnd);
    ASSERT_GT(serial.collisions.size(), 50U);
    for (const int domains : {2, 3, 7}) {
        if (kIsSanitized && domains != 3) continue;
        for (const int halo : {0, 1, 3}) {
            const int threads = few_and_enough(domains)[halo == 1 ? 0 : 1];
            SCOPED_TRACE(std::to_string(domains) + " domains, halo of " + std::to_string(halo) +
                         ", threads " + std::to_string(threads));
            expect_equal(run(GetParam().scene, {.threads = threads, .domains = domains, .halo = halo}, kEnd),
                         serial);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Ties, SimultaneousInDomains, testing::ValuesIn(simultaneous_scenes()), name_of);

TEST(DomainsOfAGas, RetryRarely) {
    const Scene scene = gas(37, {.count = 10000, .packing = 0.5});
    World world(scene, {.threads = 2, .domains = 4});
    world.advance_to(10);
    const Counts early = world.counts();
    world.advance_to(40);
    const Counts late = world.counts();
    ASSERT_GT(late.windows - early.windows, 200U);
    EXPECT_LT(double(late.window_retries - early.window_retries),
              0.05 * double(late.windows - early.windows));
}

// A gas, and beyond a wall as many balls at rest. Domains of as many balls each would leave one thread with
// all there is to do.
TEST(DomainsOfUnevenLoad, ShareTheCollisions) {
    const Boundary kWall = Boundary::kWall;
    Scene scene = gas(41, {.count = 2000, .packing = 0.5, .boundary_x = kWall, .boundary_y = kWall});
    const Vec2 size = scene.domain->box.max - scene.domain->box.min;
    const auto moving = static_cast<std::uint32_t>(scene.balls.size());
    scene.walls = {{scene.domain->box.min + Vec2(size.x(), 0), scene.domain->box.max, 1}};
    for (std::uint32_t k = 0; k < moving; ++k) {
        Ball still = scene.balls[k];
        still.position.x() += size.x();
        still.velocity = Vec2::Zero();
        scene.balls.push_back(still);
    }
    scene.domain->box.max.x() += size.x();
    for (const int domains : {2, 3}) {
        World world(scene, {.threads = domains, .domains = domains});
        std::vector<std::uint64_t> of_ball(scene.balls.size());
        world.advance_to(4);  // windows have grown, and have shown what there is to do
        world.on_collision([&of_ball](const Collision& c) { ++of_ball[c.i]; });
        world.advance_to(6);
        std::vector<double> of_domain(static_cast<std::size_t>(domains));
        double all = 0;
        const std::vector<std::uint32_t> domain_of = world.domains_of_balls();
        for (std::uint32_t k = 0; k < moving; ++k) {
            of_domain[domain_of[k]] += double(of_ball[k]);
            all += double(of_ball[k]);
        }
        ASSERT_GT(all, 2000);
        // A ball at rest costs something as well: up to a third of what one of the gas does. So the share of
        // the domain that has none of them is at most 4 / 3 of what is due.
        EXPECT_LT(std::ranges::max(of_domain), 1.45 / domains * all) << domains << " domains";
    }
}

// All fall side by side, so that windows become as long as they can be, and then they land. The window that
// sees that is too long by far; those after it are to have as many collisions as others, in a gas one a ball.
TEST(DomainsOfUnevenLoad, AWindowTooLongDoesNotShortenTheOthers) {
    const Boundary kWall = Boundary::kWall;
    constexpr std::uint64_t kCount = kIsSanitized ? 1000 : 4000;
    Scene scene = gas(42, {.count = kCount, .packing = 0.5, .boundary_x = kWall, .boundary_y = kWall});
    for (Ball& b : scene.balls) b.velocity = Vec2::Zero();
    const double height = scene.domain->box.max.y() - scene.domain->box.min.y();
    scene.domain->box.min.y() -= height;
    scene.gravity = {0, -1};
    const double end = 1.2 * std::sqrt(2 * height);  // they land at five sixths of that
    const Outcome serial = run(scene, {.threads = 1, .domains = 1}, end);
    ASSERT_GT(serial.balls, 20 * kCount);
    for (const int threads : {1, 2}) {
        const Outcome outcome = run(scene, {.threads = threads, .domains = 2}, end);
        expect_equal(outcome, serial);
        EXPECT_GT(2 * outcome.balls, kCount / 2 * (outcome.counts.windows / 2)) << threads << " threads";
    }
}

// Trains of touching balls meet, all at one instant: each ball of one hits each of the other. No window is
// short enough for so many collisions, and none is given up for them.
TEST(DomainsOfUnevenLoad, CollisionsAtOneInstantDoNotMakeAWindowTooLong) {
    constexpr int kRows = 60;
    constexpr int kTrain = 30;
    Scene scene;
    scene.domain = Domain{{{0, 0}, {80, 2 * kRows + 2}}, {Boundary::kWall, Boundary::kWall}, 1};
    for (int row = 0; row < kRows; ++row) {
        for (int k = 0; k < kTrain; ++k) {
            for (const int way : {1, -1}) {
                Ball b;
                b.position = {40.0 - way * (2.5 + k), 2.0 + 2 * row};
                b.velocity = {double(way), 0};
                scene.balls.push_back(b);
            }
        }
    }
    const Outcome serial = run(scene, {.threads = 1, .domains = 1}, 3);
    ASSERT_EQ(serial.balls, std::uint64_t{kRows} * kTrain * kTrain);
    for (const int threads : {1, 2}) {
        const Outcome outcome = run(scene, {.threads = threads, .domains = 2}, 3);
        expect_equal(outcome, serial);
        EXPECT_EQ(outcome.counts.window_retries, 0U) << threads << " threads";
    }
}

// What is asked for once at a time is read from the engine alone, what is asked for again is kept; in the
// midst of a window a ball is where an anchor has it that an event ahead has overwritten.
TEST(DomainsOfAGas, ShowWhatOneLoopShowsHoweverOftenItIsAskedFor) {
    Scene scene = gas(39, {.count = 2000, .packing = 0.4, .boundary_y = Boundary::kWall, .restitution = 0.9});
    for (std::size_t k = 0; k < scene.balls.size(); k += 50) {
        scene.balls[k].is_static = true;
        scene.balls[k].velocity = Vec2::Zero();
    }
    World serial(scene, {.threads = 1, .domains = 1});
    World parted(scene, {.threads = 2, .domains = 5});
    for (int k = 1; k <= 60; ++k) {
        for (World* world : {&serial, &parted}) world->advance_to(0.05 * k);
        const auto part = [k](const World& world) {
            if (k % 3 == 0) return world.velocities();
            return k % 3 == 1 ? world.positions() : world.unwrapped_positions();
        };
        const PlaneVectors first = part(serial);
        EXPECT_TRUE(part(parted) == first) << k;
        EXPECT_TRUE(part(parted) == first) << k;
        EXPECT_TRUE(part(serial) == first) << k;
        const std::vector<Ball> balls = parted.balls();
        const PlaneVectors places = parted.positions();
        for (std::size_t i = 0; i < balls.size(); ++i) ASSERT_TRUE(places[i] == balls[i].position) << k;
        if (k % 7 == 0)
            for (World* world : {&serial, &parted}) world->set_velocity(1, {0.1, 0.2});
    }
}

// Windows of a sparse gas are about as long as the clock's epochs and go over their ends: time and again what
// lies before and what lies behind one is looked into, undone by an edit, and gone through again with more
// balls around.
TEST(DomainsOfASparseGas, GoOverTheEndsOfEpochs) {
    constexpr double kStep = 3.7;  // an epoch is 16 long
    constexpr int kSteps = kIsSanitized ? 15 : 50;
    const Scene scene = gas(40, {.count = 900, .packing = 0.03, .boundary_y = Boundary::kWall});
    const auto states_of = [&scene](const WorldOptions& options) {
        World world(scene, options);
        std::vector<PlaneVectors> states;
        for (int k = 1; k <= kSteps; ++k) {
            world.advance_to(kStep * k);
            states.push_back(world.unwrapped_positions());
            if (k % 9 == 0) world.set_velocity(static_cast<std::uint32_t>(k), {0.3, -1.1});
        }
        Outcome end;
        take_counts(world, end);
        return std::pair(states, end);
    };
    const auto [states, end] = states_of({.threads = 1, .domains = 1});
    ASSERT_GT(end.balls, kIsSanitized ? 1'000U : 5'000U);
    std::uint64_t retries = 0;
    for (const int domains : {2, 3, 5}) {
        for (const int threads : few_and_enough(domains)) {
            for (const int halo : {0, 2}) {
                SCOPED_TRACE(std::to_string(domains) + " domains, halo of " + std::to_string(halo) +
                             ", threads " + std::to_string(threads));
                const auto [own_states, own_end] =
                    states_of({.threads = threads, .domains = domains, .halo = halo});
                expect_equal(own_end, end);
                for (std::size_t k = 0; k < states.size(); ++k)
                    ASSERT_TRUE(own_states[k] == states[k]) << "step " << k;
                retries += own_end.counts.window_retries;
            }
        }
    }
    EXPECT_GT(retries, 0U);
}

TEST(DomainsOfAGas, AListenerMayComeAndGo) {
    const Scene scene = gas(38, {.count = 2000, .packing = 0.4});
    const auto listened = [&scene](int domains) {
        World world(scene, {.threads = 2, .domains = domains});
        std::vector<std::pair<double, std::uint32_t>> heard;
        for (int k = 1; k <= 20; ++k) {
            if (k % 3 == 0)
                world.on_collision([&heard](const Collision& c) { heard.emplace_back(c.time, c.i); });
            else if (k % 3 == 1)
                world.on_collision({});
            world.advance_to(0.13 * k);
        }
        return std::tuple(heard, world.state_hash(), world.counts().ball_collisions, world.virial());
    };
    EXPECT_TRUE(listened(1) == listened(5));
}

}  // namespace
}  // namespace carom::test
