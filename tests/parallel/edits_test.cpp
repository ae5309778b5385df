// Edits of a running world: exact, the same bits however the world is stepped and cut, nothing half done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <carom/parallel/world.hpp>

#include "outcome.hpp"
#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

using testing::ElementsAre;

Scene lone(const Vec2& position, const Vec2& velocity) {
    Scene scene;
    scene.balls = {{.position = position, .velocity = velocity}};
    return scene;
}

TEST(Edits, AddedBallIsHitWhenItMustBe) {
    World world(lone({0, 0}, {2, 0}));
    std::vector<Collision> told;
    world.on_collision([&told](const Collision& c) { told.push_back(c); });
    world.advance_to(1);
    EXPECT_EQ(world.add_ball({.position = {12, 0}}), 1);
    world.advance_to(10);
    ASSERT_EQ(told.size(), 1);
    EXPECT_EQ(told[0].time, 5.5);  // centres 1 apart: 12 - 1 = 2 t
    EXPECT_EQ(told[0].approach_speed, 2);
    EXPECT_EQ(world.ball(0).velocity, Vec2(0, 0));
    EXPECT_EQ(world.ball(1).velocity, Vec2(2, 0));
}

TEST(Edits, RemovedBallIsMetByNobody) {
    Scene scene = lone({0, 0}, {1, 0});
    scene.balls.push_back({.position = {10, 0}});
    scene.balls.push_back({.position = {20, 0}});
    World world(scene);
    world.advance_to(1);
    world.remove_ball(1);
    EXPECT_THAT(world.ball_ids(), ElementsAre(0, 2));
    EXPECT_FALSE(world.has_ball(1));
    std::vector<Collision> told;
    world.on_collision([&told](const Collision& c) { told.push_back(c); });
    world.advance_to(30);
    ASSERT_EQ(told.size(), 1);
    EXPECT_EQ(told[0].i, 0);
    EXPECT_EQ(told[0].j, 2);
    EXPECT_EQ(told[0].time, 19);
    EXPECT_EQ(world.add_ball({.position = {50, 50}}), 1);  // the least id that nobody has
    EXPECT_THAT(world.ball_ids(), ElementsAre(0, 1, 2));
}

// The flight began long before the wall stood there: it must not be hit in the past.
TEST(Edits, WallAcrossTheWayFlownSoFarIsNotHit) {
    World world(lone({0, 0}, {1, 0}));
    world.advance_to(10);
    const std::uint32_t behind = world.add_wall({.from = {5, -5}, .to = {5, 5}});
    const std::uint32_t ahead = world.add_wall({.from = {20, -5}, .to = {20, 5}});
    std::vector<Collision> told;
    world.on_collision([&told](const Collision& c) { told.push_back(c); });
    world.advance_to(30);
    ASSERT_EQ(told.size(), 1);
    EXPECT_EQ(told[0].time, 19.5);
    EXPECT_EQ(told[0].approach_speed, 1);
    EXPECT_EQ(told[0].j, ahead);
    world.remove_wall(ahead);
    world.advance_to(40);  // back to x = 5.5 at 33.5
    ASSERT_EQ(told.size(), 2);
    EXPECT_EQ(told[1].time, 33.5);
    EXPECT_EQ(told[1].j, behind);
}

TEST(Edits, GrownBallIsHitAtItsNewSize) {
    Scene scene = lone({0, 0}, {1, 0});
    scene.balls.push_back({.position = {5, 3}});  // passed at a distance of 3
    scene.balls.push_back({.position = {20, 0}});
    World world(scene);
    world.advance_to(8);
    world.set_radius(0, 2.6);  // it would have hit the second ball
    world.advance_to(9.5);
    EXPECT_EQ(world.counts().ball_collisions, 0);
    std::vector<double> times;
    world.on_collision([&times](const Collision& c) { times.push_back(c.time); });
    world.advance_to(18);
    ASSERT_EQ(times.size(), 1);
    EXPECT_NEAR(times[0], 16.9, 4e-15);  // an ulp
}

TEST(Edits, ForcesBendEveryWayFromThenOn) {
    World world(lone({0, 0}, {1, 0}));
    world.advance_to(2);
    world.set_gravity({0, -2});
    world.advance_to(5);
    EXPECT_EQ(world.ball(0).position, Vec2(5, -9));
    world.set_gravity({0, 0});
    world.set_acceleration(0, {-6, 0});
    world.advance_to(6);
    EXPECT_EQ(world.ball(0).position, Vec2(5 + 1 - 3, -9 - 6));
    world.set_acceleration(0, {0, 0});
    world.set_mass(0, 4);
    world.apply_impulse(0, {20, 24});
    EXPECT_EQ(world.ball(0).velocity, Vec2(-5 + 5, -6 + 6));
}

TEST(Edits, AttractorsPullFromThenOn) {
    World world(lone({0, 0}, {0, 0}));
    world.advance_to(0.5);
    world.set_attractors({{.position = {10, 0}, .strength = 100}});
    world.advance_to(0.52);  // the field is held for 0.02, and its first stretch ends here
    const double speed = world.ball(0).velocity.x();
    EXPECT_NEAR(speed, 0.02, 2e-16);  // an ulp of 0.52, times an acceleration of 1
    world.set_attractors({});
    world.advance_to(10);
    EXPECT_EQ(world.ball(0).velocity.x(), speed);
}

TEST(Edits, LossesBringAContactTime) {
    Scene scene = lone({0, 0}, {1, 0});
    scene.gravity = {0, -1};
    scene.domain = Domain{{{-10, -10}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    World world(scene);
    EXPECT_EQ(world.contact_time(), 0);
    world.set_restitution(0, 0.5);
    EXPECT_GT(world.contact_time(), 0);
    world.advance_to(200);  // without one the bounces would never end
    EXPECT_NEAR(world.ball(0).position.y(), -9.5, 1e-3);
}

TEST(Edits, AreRefusedWhole) {
    Scene scene = gas(3, {.count = 60, .packing = 0.3});
    scene.walls = {{.from = {1, 1}, .to = {2, 1}}};
    scene.allows_overlap = false;
    scene.walls.clear();
    World world(scene);
    world.advance_to(1);
    const std::uint64_t hash = world.state_hash();
    const Vec2 taken = world.ball(5).position;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto refuse = [&](const Edits& edits, const std::string& what) {
        try {
            static_cast<void>(world.apply(edits));
            ADD_FAILURE() << "not refused: " << what;
        } catch (const std::exception& e) {
            EXPECT_THAT(e.what(), testing::StartsWith(what));
        }
        EXPECT_EQ(world.state_hash(), hash);
        EXPECT_EQ(world.ball_count(), 60);
    };
    refuse({.added_balls = {{.position = taken, .radius = 0.1}}}, "balls[5]: overlaps balls[60] by");
    refuse({.changed_balls = {{.id = 7, .position = taken}}}, "balls[5]: overlaps balls[7] by");
    refuse({.changed_balls = {{.id = 60, .velocity = Vec2(1, 1)}}}, "balls[60]: is not there");
    refuse({.changed_balls = {{.id = 7, .velocity = Vec2(kNan, 1)}}}, "balls[7].velocity: must be finite");
    refuse({.changed_balls = {{.id = 7, .position = Vec2(kInfinity, 1)}}}, "balls[7].position: must be");
    refuse({.changed_balls = {{.id = 7, .position = Vec2(-1, 1)}}}, "balls[7].position: must lie inside");
    refuse({.changed_balls = {{.id = 7, .radius = -1}}}, "balls[7].radius: must be > 0");
    refuse({.changed_balls = {{.id = 7, .radius = 5e-324}}}, "balls[7].radius: must be at least");
    refuse({.changed_balls = {{.id = 7, .radius = 1000}}}, "balls[7].radius: must be at most half");
    refuse({.changed_balls = {{.id = 7, .mass = 0}}}, "balls[7].mass: must be > 0");
    refuse({.changed_balls = {{.id = 7, .restitution = 1.5}}}, "balls[7].restitution: must lie in [0, 1]");
    refuse({.removed_balls = {1, 60}}, "balls[60]: is not there");
    refuse({.removed_balls = {1, 1}}, "balls[1]: is removed twice");
    refuse({.removed_walls = {0}}, "walls[0]: is not there");
    refuse({.added_walls = {{.from = {1, 1}, .to = {1, 1}}}}, "walls[0]: must have a length");
    refuse({.added_walls = {{.from = taken, .to = taken + Vec2(0.1, 0)}}}, "balls[");
    refuse({.attractors = std::vector<Attractor>{{.softening = -1}}}, "attractors[0].softening: must be");
    refuse({.gravity = Vec2(kNan, 0)}, "gravity: must be finite");
    // A good edit beside a bad one is not made either.
    refuse({.changed_balls = {{.id = 7, .velocity = Vec2(1, 1)}}, .removed_balls = {99}}, "balls[99]");
    EXPECT_THROW(static_cast<void>(world.ball(60)), std::out_of_range);
    EXPECT_THROW(world.set_user_data(60, 1), std::out_of_range);
}

// In float every place is a float, that of a static ball too, which no event rounds.
TEST(Edits, AddedStaticBallIsHeldAsASceneHasIt) {
    const Ball pin{.position = {5.1, 0.1}, .is_static = true};
    Scene scene = lone({0, 0}, {1, 0});
    scene.precision = Precision::kFloat;
    Scene whole = scene;
    whole.balls.push_back(pin);
    World from_the_start(whole);
    World edited(scene);
    EXPECT_EQ(edited.add_ball({.position = {5.1, 7.1}, .is_static = true}), 1);
    edited.set_position(1, pin.position);
    EXPECT_EQ(edited.ball(1).position, rounded_to_float(pin.position));
    from_the_start.advance_to(20);
    edited.advance_to(20);
    EXPECT_EQ(edited.state_hash(), from_the_start.state_hash());
}

TEST(Edits, UserDataStaysWithItsBall) {
    World world(gas(3, {.count = 20, .packing = 0.1}));
    EXPECT_EQ(world.user_data(4), 0);
    world.set_user_data(4, 44);
    world.set_user_data(9, 99);
    world.remove_ball(4);
    EXPECT_EQ(world.user_data(9), 99);
    EXPECT_THROW(static_cast<void>(world.user_data(4)), std::out_of_range);
    const Vec2 room = world.ball(0).position;
    world.remove_ball(0);
    EXPECT_EQ(world.add_ball({.position = room, .radius = 0.01}), 0);
    EXPECT_EQ(world.user_data(0), 0);
}

TEST(Edits, FiltersLetBallsPass) {
    Scene scene = lone({0, 0}, {1, 0});
    scene.balls.push_back({.position = {5, 0}, .filter = {.category = 2, .mask = 2}});
    scene.balls.push_back({.position = {10, 0}});
    scene.walls = {{.from = {7, -1}, .to = {7, 1}, .filter = {.category = 4, .mask = 6}}};
    World world(scene);
    std::vector<Collision> told;
    world.on_collision([&told](const Collision& c) { told.push_back(c); });
    world.advance_to(2);
    static_cast<void>(world.apply({.changed_balls = {{.id = 0, .filter = CollisionFilter{1, 3}}}}));
    world.advance_to(5);  // through the second ball, which does not look for it
    EXPECT_EQ(world.max_overlap(), 0);
    EXPECT_TRUE(world.validate().empty());
    EXPECT_TRUE(told.empty());
    // Colliding again while they overlap is refused; apart it is taken.
    EXPECT_THROW(
        static_cast<void>(world.apply({.changed_balls = {{.id = 0, .filter = CollisionFilter{3, 3}}}})),
        SceneError);
    world.advance_to(12);
    ASSERT_EQ(told.size(), 1);  // and through the wall
    EXPECT_EQ(told[0].time, 9);
    EXPECT_EQ(told[0].j, 2);
}

// A force that is felt only later brings the time of rest with it.
TEST(Edits, AForceThatIsFeltLaterWedgesNobody) {
    Scene scene;
    scene.attractors = {{.position = {0, 0}, .strength = 1}};
    scene.field_interval = 0.01;
    scene.balls = {{.position = {0, 0}}};  // nothing pulls it in the middle
    scene.walls = {{.from = {-50, 3}, .to = {50, 3}}};
    World world(scene);
    world.advance_to(1);
    world.set_position(0, {0, 3.5});  // it is pressed against the wall from now on
    world.advance_to(2);
    EXPECT_TRUE(world.validate().empty());
}

TEST(Edits, OfTheEmpiricalMethodAreCheckedWhereTheStepEnds) {
    Scene scene;
    scene.method = Method::kEmpirical;
    scene.step = 1;
    scene.domain = Domain{{{0, 0}, {20, 20}}, {Boundary::kWall, Boundary::kWall}, 1};
    scene.balls = {{.position = {2, 5}, .velocity = {2, 0}}, {.position = {4, 5}}, {.position = {15, 15}}};
    World world(scene);
    int told = 0;
    world.on_collision([&](const Collision&) {
        ++told;
        EXPECT_THROW(static_cast<void>(world.positions()), std::logic_error);
    });
    world.advance_to(0.99);
    world.set_position(2, {3.99, 5.5});  // where the first ball would be had it met nobody
    EXPECT_EQ(told, 1);
    EXPECT_NEAR(world.ball(0).position.x(), 3, 1e-6);  // the tolerance
}

// What is shown after an edit does not depend on whether somebody looked before.
TEST(Edits, LookingBeforeAnEditChangesNothing) {
    Scene scene = gas(6, {.count = 100, .packing = 0.3});
    scene.gravity = {0.3, -0.1};
    World looked_at(scene);
    World plain(scene);
    std::mt19937_64 random(1);
    for (int k = 1; k <= 100; ++k) {
        looked_at.advance_to(0.05 * k);
        plain.advance_to(0.05 * k);
        static_cast<void>(looked_at.energy());
        const auto ball = static_cast<std::uint32_t>(random() % 100);
        const Vec2 velocity = k % 9 == 0 ? Vec2(-0.0, -0.0) : random_velocity(random, 1);
        looked_at.set_velocity(ball, velocity);
        plain.set_velocity(ball, velocity);
        EXPECT_EQ(looked_at.energy(), plain.energy());
        EXPECT_EQ(looked_at.unwrapped_positions(), plain.unwrapped_positions());
        EXPECT_EQ(looked_at.state_hash(), plain.state_hash());
    }
}

// The nearest floats of places at a periodic side that is none itself.
TEST(Edits, PlacesInFloatAreThoseOfAWorldMadeAnew) {
    Scene scene;
    scene.precision = Precision::kFloat;
    scene.domain = Domain{{{0.7, 0.1}, {4, 10.3}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.balls = {{.position = {2, 5}, .radius = 0.1}, {.position = {2, 8}, .radius = 0.1}};
    for (const double x : {0.7, std::nextafter(0.7, 1.0), 3.9999999999999996, 3.99999999, 2.1})
        for (const double y : {0.1, 0.10000000000000002, std::nextafter(10.3, 0.0), 5.3}) {
            World in_place(scene);
            World anew(scene);
            in_place.set_position(0, {x, y});
            static_cast<void>(
                anew.apply({.changed_balls = {{.id = 0, .position = Vec2(x, y)}, {.id = 1, .mass = 1}}}));
            EXPECT_EQ(in_place.positions(), anew.positions());
            EXPECT_EQ(in_place.state_hash(), anew.state_hash());
        }
}

// A listener's exception leaves the balls on their way; nothing goes on from there but what was kept.
TEST(Edits, AreRefusedWhereAListenerHasEndedTheStep) {
    for (const int domains : {1, 3}) {
        World world(gas(3, {.count = 36, .packing = 0.4}), {.threads = 1, .domains = domains});
        const Snapshot start = world.snapshot();
        world.on_collision([](const Collision& c) {
            if (c.time > 1) throw std::runtime_error("enough");
        });
        EXPECT_THROW(world.advance_to(5), std::runtime_error);
        if (domains == 1) {
            EXPECT_THROW(world.set_velocity(0, {1, 1}), SnapshotError);
        }
        world.on_collision(nullptr);
        world.restore(start);
        world.set_velocity(0, {1, 1});
        world.advance_to(5);
        World plain(gas(3, {.count = 36, .packing = 0.4}));
        plain.set_velocity(0, {1, 1});
        plain.advance_to(5);
        EXPECT_EQ(world.state_hash(), plain.state_hash());
    }
}

// Between two times balls are where their last events have put them, each at another time.
TEST(Edits, ListenersMustNotLookAtTheBalls) {
    for (const int domains : {1, 3}) {
        World world(gas(3, {.count = 60, .packing = 0.4}), {.threads = 1, .domains = domains});
        world.set_sensors({{.corners = {{0, 0}, {0, 100}}}});
        int refused = 0;
        const auto look = [&] {
            EXPECT_THROW(static_cast<void>(world.ball(0)), std::logic_error);
            EXPECT_THROW(static_cast<void>(world.positions()), std::logic_error);
            EXPECT_THROW(static_cast<void>(world.energy()), std::logic_error);
            EXPECT_THROW(static_cast<void>(world.snapshot()), std::logic_error);
            EXPECT_THROW(static_cast<void>(world.balls_at({0, 0})), std::logic_error);
            EXPECT_THROW(static_cast<void>(world.balls_in_sensor(0)), std::logic_error);
            EXPECT_THROW(world.on_collision(nullptr), std::logic_error);
            EXPECT_THROW(world.set_sensors({}), std::logic_error);
            ++refused;
        };
        world.on_collision([&look](const Collision&) { look(); });
        world.advance_to(1);
        ASSERT_GT(refused, 0);
        const int hits = refused;
        world.on_collision(nullptr);
        world.on_sensing([&look](const Sensing&) { look(); });
        world.advance_to(2);
        EXPECT_GT(refused, hits);
        World plain(gas(3, {.count = 60, .packing = 0.4}), {.threads = 1});
        plain.advance_to(2);
        EXPECT_EQ(world.positions(), plain.positions());
    }
}

TEST(Edits, AreRefusedFromAListener) {
    World world(gas(3, {.count = 60, .packing = 0.4}), {.threads = 1});
    const Snapshot start = world.snapshot();
    int refused = 0;
    world.on_collision([&](const Collision&) {
        EXPECT_THROW(world.set_velocity(0, {1, 1}), std::logic_error);
        EXPECT_THROW(world.step(1), std::logic_error);
        EXPECT_THROW(world.restore(start), std::logic_error);
        ++refused;
    });
    world.advance_to(1);
    ASSERT_GT(refused, 0);
    EXPECT_EQ(refused, world.counts().ball_collisions);
    world.set_velocity(0, {1, 1});  // afterwards it is taken
    EXPECT_EQ(world.ball(0).velocity, Vec2(1, 1));
}

// By steps of 1 the balls, 1.5 apart, meet at 0.75. A step that ends at the edit finds that, and the steps go
// on at whole seconds from there.
TEST(Edits, EndAStepOfTheEmpiricalMethod) {
    Scene scene;
    scene.method = Method::kEmpirical;
    scene.step = 1;
    scene.tolerance = 1e-12;
    scene.balls = {{.position = {0, 0}, .velocity = {1, 0}, .radius = 0.5},
                   {.position = {2.5, 0}, .velocity = {-1, 0}, .radius = 0.5},
                   {.position = {0, 5}, .radius = 0.5}};
    World world(scene);
    std::vector<double> told;
    world.on_collision([&told](const Collision& c) { told.push_back(c.time); });
    world.advance_to(0.8);
    EXPECT_TRUE(told.empty()) << "it is found at the step's end";
    world.set_velocity(2, {0, 1});
    ASSERT_EQ(told.size(), 1);
    EXPECT_NEAR(told[0], 0.75, 1e-11);
    EXPECT_EQ(world.ball(0).velocity, Vec2(-1, 0));
    EXPECT_NEAR(world.ball(0).position.x(), 0.7, 1e-11);
    EXPECT_EQ(world.counts().steps, 1);
    world.advance_to(3.5);
    EXPECT_EQ(world.counts().steps, 4);
    EXPECT_EQ(told.size(), 1);
    EXPECT_NEAR(world.ball(0).position.x(), -2, 1e-11);
    EXPECT_NEAR(world.ball(2).position.y(), 7.7, 1e-11);
}

// Refused, it ends no step and tells nobody.
TEST(Edits, EndNoStepWhereTheyAreRefused) {
    Scene scene = gas(3, {.count = 60, .packing = 0.4});
    scene.method = Method::kEmpirical;
    scene.step = 0.3;
    World plain(scene);
    World asked(scene);
    std::vector<double> told;
    asked.on_collision([&told](const Collision& c) { told.push_back(c.time); });
    for (const double stop : {0.4, 0.75, 1.3}) {
        asked.advance_to(stop);
        const std::size_t before = told.size();
        EXPECT_THROW(asked.set_position(7, asked.ball(8).position), SceneError);
        EXPECT_THROW(asked.remove_ball(99), std::out_of_range);
        EXPECT_EQ(told.size(), before);
    }
    plain.advance_to(2);
    asked.advance_to(2);
    EXPECT_EQ(asked.state_hash(), plain.state_hash());
    EXPECT_EQ(asked.counts().steps, plain.counts().steps);
    EXPECT_EQ(told.size(), plain.counts().ball_collisions);
}

/// One random edit, the same for worlds in the same state.
Edits random_edit(const World& world, std::mt19937_64& random) {
    const std::vector<std::uint32_t> ids = world.ball_ids();
    const std::uint32_t id = ids[random() % ids.size()];
    const Box& box = world.domain().box;
    const auto place = [&] {
        return Vec2(uniform(random, box.min.x(), box.max.x()), uniform(random, box.min.y(), box.max.y()));
    };
    const Ball ball = world.ball(id);
    switch (random() % 10) {
        case 0:
            return {.added_balls = {{.position = place(),
                                     .velocity = random_velocity(random, 1),
                                     .radius = uniform(random, 0.05, 0.6),
                                     .mass = uniform(random, 0.5, 2)}}};
        case 1:
            return {.removed_balls = {id}};
        case 2:
            return {.changed_balls = {{.id = id, .radius = ball.radius * uniform(random, 0.5, 1)}}};
        case 3:
            return {.changed_balls = {{.id = id, .mass = ball.mass * 1.5}}};
        case 4:
            if (ball.is_static) return {};
            return {.changed_balls = {{.id = id, .acceleration = random_velocity(random, 0.5)}}};
        case 5:
            return {.changed_balls = {{.id = id, .position = place()}}};
        case 6: {
            const Vec2 from = place();
            const Vec2 middle = (box.min + box.max) / 2;
            return {.added_walls = {{.from = from, .to = from + 0.05 * (middle - from)}}};
        }
        case 7:
            return {.gravity = random_velocity(random, 0.2)};
        case 8:
            return {.attractors =
                        std::vector<Attractor>{{.position = place(), .strength = 1, .softening = 1}}};
        default:
            if (ball.is_static) return {};
            return {.changed_balls = {{.id = id, .velocity = random_velocity(random, 2)}}};
    }
}

/// Runs a scene through random edits; where one is refused nothing has changed.
Outcome run_with_edits(const Scene& scene, const WorldOptions& options, std::uint64_t seed, double frame) {
    constexpr double kEnd = kIsSanitized ? 2 : 4;
    std::mt19937_64 random(seed);
    Outcome out;
    World world(scene, options);
    world.on_collision(
        [&out](const Collision& c) { out.collisions.emplace_back(c.time, c.i, c.j, c.impulse); });
    for (int k = 1; k <= 12; ++k) {
        const double stop = kEnd * k / 12;
        while (frame > 0 && world.time() + frame < stop) world.step(frame);
        world.advance_to(stop);
        const Edits edits = random_edit(world, random);
        const std::uint64_t before = world.state_hash();
        try {
            static_cast<void>(world.apply(edits));
        } catch (const SceneError&) {
            EXPECT_EQ(world.state_hash(), before);
        }
        const std::vector<Violation> found = world.validate();
        EXPECT_TRUE(found.empty()) << found.front().what;
    }
    take_counts(world, out);
    return out;
}

class EditedScenes : public testing::TestWithParam<NamedScene> {};
class EditedSteps : public testing::TestWithParam<NamedScene> {};

void expect_same_bits_with_edits(const Scene& scene) {
    for (const std::uint64_t seed : {1, 2}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const Outcome one = run_with_edits(scene, {.threads = 1, .domains = 1}, seed, 0);
        EXPECT_GT(one.balls, 0);
        expect_equal(run_with_edits(scene, {.threads = 2, .domains = 5}, seed, 0), one);
        expect_equal(run_with_edits(scene, {.threads = 1, .cell_size = 2.9, .domains = 3}, seed, 0.07), one);
        expect_equal(run_with_edits(scene, {.threads = 1, .domains = 1}, seed, 0.013), one);
    }
}

TEST_P(EditedScenes, SameBitsForThreadsDomainsCellsAndFrames) {
    expect_same_bits_with_edits(GetParam().scene);
}

TEST_P(EditedSteps, SameBitsForThreadsCellsAndFrames) {
    expect_same_bits_with_edits(GetParam().scene);
}

// An edit that edits nothing is as good as none.
TEST_P(EditedScenes, EmptyEditChangesNoBit) {
    const Scene& scene = GetParam().scene;
    Outcome edited;
    World world(scene, {.threads = 2, .domains = 3});
    world.on_collision(
        [&edited](const Collision& c) { edited.collisions.emplace_back(c.time, c.i, c.j, c.impulse); });
    for (const double stop : {0.0, 0.7, 1.9, 1.9, 3.0}) {
        world.advance_to(stop);
        static_cast<void>(world.apply({}));
        world.set_mass(0, scene.balls[0].mass);
    }
    take_counts(world, edited);
    expect_equal(edited, run(scene, {.threads = 1, .domains = 1}, 3.0));
}

/// Other places and velocities for some balls, two of them named twice.
Edits random_starts(const World& world, std::mt19937_64& random) {
    const std::vector<std::uint32_t> ids = world.ball_ids();
    const Box& box = world.domain().box;
    Edits edits;
    for (std::uint64_t k = 0, count = 1 + random() % 6; k < count; ++k) {
        BallChange& c = edits.changed_balls.emplace_back();
        c.id = ids[random() % ids.size()];
        const Ball ball = world.ball(c.id);
        const std::uint64_t kind = random() % 4;
        if (kind == 0) {
            const double x = uniform(random, box.min.x(), box.max.x());
            c.position = Vec2(x, uniform(random, box.min.y(), box.max.y()));
        }
        if (kind == 1) c.position = ball.position;  // it is there, and starts anew
        if (kind != 1 && !ball.is_static) c.velocity = random_velocity(random, 2);
        if (random() % 8 == 0) edits.changed_balls.push_back({.id = c.id});
    }
    return edits;
}

/// What a world shows that is edited so, and what sensors tell of it; in place where that can be.
std::pair<Outcome, std::vector<std::tuple<double, std::uint32_t, std::uint32_t, bool>>> run_with_starts(
    const Scene& scene, const WorldOptions& options, bool in_place, std::vector<std::string>& refusals) {
    std::mt19937_64 random(3);
    Outcome out;
    std::vector<std::tuple<double, std::uint32_t, std::uint32_t, bool>> sensings;
    World world(scene, options);
    const Box& box = world.domain().box;
    world.set_sensors({{.corners = {box.min, box.max}}, {.corners = {(box.min + box.max) / 2}, .radius = 2}});
    world.on_sensing([&](const Sensing& s) { sensings.emplace_back(s.time, s.sensor, s.ball, s.enters); });
    world.on_collision(
        [&out](const Collision& c) { out.collisions.emplace_back(c.time, c.i, c.j, c.impulse); });
    for (int k = 1; k <= 40; ++k) {
        if (k % 3 != 0) world.advance_to(0.1 * k);  // else twice at one time
        Edits edits = random_starts(world, random);
        // Of the bodies themselves nothing changes, but the world does not know that.
        if (!in_place) edits.changed_balls.push_back({.id = 0, .mass = world.ball(0).mass});
        try {
            static_cast<void>(world.apply(edits));
        } catch (const SceneError& e) {
            refusals.emplace_back(e.what());
        }
        const std::vector<Violation> found = world.validate();
        EXPECT_TRUE(found.empty()) << found.front().what;
        if (k % 7 == 0) world.restore(world.snapshot());
    }
    world.step(1);
    take_counts(world, out);
    return {out, sensings};
}

// Balls that start anew are edited in place; whoever is edited otherwise makes all anew. The bits are one.
TEST_P(EditedScenes, SameBitsInPlaceAndMadeAnew) {
    const Scene& scene = GetParam().scene;
    std::vector<std::string> refusals;
    const auto anew = run_with_starts(scene, {.threads = 1, .domains = 1}, false, refusals);
    EXPECT_GT(anew.first.balls, 0);
    for (const WorldOptions& options : {WorldOptions{.threads = 1, .domains = 1},
                                        {.threads = 2, .domains = 4},
                                        {.threads = 1, .cell_size = 2.9, .domains = 3}}) {
        std::vector<std::string> refused;
        const auto in_place = run_with_starts(scene, options, true, refused);
        expect_equal(in_place.first, anew.first);
        EXPECT_TRUE(in_place.second == anew.second) << "the lists of sensings differ";
        EXPECT_EQ(refused, refusals);
    }
}

INSTANTIATE_TEST_SUITE_P(All, EditedScenes, testing::ValuesIn(feature_scenes()), kNameOfScene);
INSTANTIATE_TEST_SUITE_P(All, EditedSteps, testing::ValuesIn(by_steps(feature_scenes())), kNameOfScene);

// A world that starts from the edited one's balls goes the same way, as long as rounding has not grown: two
// collisions a ball, each of which makes an error some ten times larger.
TEST(Edits, GoOnAsAWorldThatStartsThere) {
    std::mt19937_64 random(5);
    World world(gas(5, {.count = 200, .packing = 0.4}));
    world.advance_to(3);
    for (int k = 0; k < 40; ++k) {
        try {
            static_cast<void>(world.apply(random_edit(world, random)));
        } catch (const SceneError&) {  // no room
        }
    }
    world.set_attractors({});  // their clock started with the first world
    Scene scene;
    scene.domain = world.domain();
    scene.balls = world.balls();
    scene.walls = world.walls();
    scene.gravity = world.gravity();
    World fresh(scene);
    const auto record = [](World& w, std::vector<std::tuple<double, Vec2, double>>& into) {
        const double start = w.time();
        w.on_collision(
            [&into, start](const Collision& c) { into.emplace_back(c.time - start, c.point, c.impulse); });
        w.advance_to(start + 0.5);
    };
    std::vector<std::tuple<double, Vec2, double>> goes_on, starts;
    record(world, goes_on);
    record(fresh, starts);
    ASSERT_GT(starts.size(), 50);
    ASSERT_EQ(goes_on.size(), starts.size());
    for (std::size_t k = 0; k < starts.size(); ++k) {
        EXPECT_NEAR(std::get<0>(goes_on[k]), std::get<0>(starts[k]), 1e-9);
        EXPECT_LT((std::get<1>(goes_on[k]) - std::get<1>(starts[k])).norm(), 1e-9);
        EXPECT_NEAR(std::get<2>(goes_on[k]), std::get<2>(starts[k]), 1e-9);
    }
}

TEST(Edits, SnapshotsKnowTheirBodies) {
    const Scene scene = gas(7, {.count = 80, .packing = 0.3});
    World world(scene, {.threads = 2, .domains = 3});
    world.advance_to(1);
    const Snapshot before = world.snapshot();
    world.remove_ball(17);
    world.set_velocity(3, {5, 5});
    world.advance_to(2);
    const Snapshot edited = world.snapshot();
    world.advance_to(3);
    const std::uint64_t end = world.state_hash();

    world.restore(before);
    EXPECT_EQ(world.ball_count(), 80);
    world.advance_to(3);
    World plain(scene);
    plain.advance_to(3);
    EXPECT_EQ(world.state_hash(), plain.state_hash());

    world.restore(edited);
    EXPECT_EQ(world.ball_count(), 79);
    world.advance_to(3);
    EXPECT_EQ(world.state_hash(), end);

    World other(scene, {.threads = 1, .domains = 1}, edited);
    other.advance_to(3);
    EXPECT_EQ(other.state_hash(), end);

    World foreign(gas(8, {.count = 80, .packing = 0.3}));
    EXPECT_THROW(foreign.restore(edited), SnapshotError);
}

}  // namespace
}  // namespace carom::test
