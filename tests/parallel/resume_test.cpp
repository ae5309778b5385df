// A snapshot holds all that the future depends on: what goes on from it is what would have been, to the bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>

#include <carom/parallel/world.hpp>

#include "outcome.hpp"
#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

constexpr double kEnd = kIsSanitized ? 1.5 : 6.25;

/// One way through a scene: with other options from each stop on.
struct Leg {
    double until;
    WorldOptions options;
};

/// Goes from leg to leg by way of a snapshot, in worlds that know nothing of each other. All collisions are
/// listened to: one that is told twice or never is a fault of the list.
Outcome run_in_legs(const Scene& scene, const std::vector<Leg>& legs) {
    Outcome out;
    Snapshot snapshot;
    for (std::size_t k = 0; k < legs.size(); ++k) {
        World world = k == 0 ? World(scene, legs[k].options) : World(scene, legs[k].options, snapshot);
        world.on_collision(
            [&out](const Collision& c) { out.collisions.emplace_back(c.time, c.i, c.j, c.impulse); });
        world.advance_to(legs[k].until);
        EXPECT_TRUE(world.validate().empty()) << world.validate().front().what;
        snapshot = world.snapshot();
        take_counts(world, out);
    }
    return out;
}

const std::vector<WorldOptions>& ways() {
    static const std::vector<WorldOptions> all = {{.threads = 1, .domains = 1},
                                                  {.threads = 2, .domains = 5},
                                                  {.threads = 3, .domains = 3, .halo = 2},
                                                  {.threads = 1, .cell_size = 2.9, .domains = 8}};
    return all;
}

class Resume : public testing::TestWithParam<NamedScene> {};

TEST_P(Resume, OnceWithAnyThreadsAndDomainsOnEitherSide) {
    const Scene& scene = GetParam().scene;
    const Outcome whole = run(scene, ways()[0], kEnd);
    const auto stop_at = [&](double stop, const WorldOptions& before, const WorldOptions& after) {
        SCOPED_TRACE(testing::Message()
                     << "stop " << stop << ", domains " << before.domains << " then " << after.domains);
        expect_equal(run_in_legs(scene, {{stop, before}, {kEnd, after}}), whole);
    };
    for (const WorldOptions& before : ways())
        for (const WorldOptions& after : ways()) stop_at(0.496 * kEnd, before, after);
    for (const double stop : {0.0, 0.37, kEnd}) {
        stop_at(stop, ways()[0], ways()[1]);
        stop_at(stop, ways()[1], ways()[0]);
    }
}

// A stop at the time of an event, an ulp before and an ulp after it: nothing is lost and nothing is twice.
TEST_P(Resume, AtTheTimeOfAnEvent) {
    const Scene& scene = GetParam().scene;
    const Outcome whole = run(scene, ways()[0], kEnd);
    ASSERT_FALSE(whole.collisions.empty());
    for (const std::size_t share : {0U, 3U, 7U}) {
        const double time = std::get<0>(whole.collisions[share * whole.collisions.size() / 8]);
        for (const double stop : {std::nextafter(time, 0.0), time, std::nextafter(time, kEnd)})
            for (const int way : {0, 1}) {
                SCOPED_TRACE(testing::Message() << "stop " << stop << " way " << way);
                expect_equal(run_in_legs(scene, {{stop, ways()[std::size_t(way)]}, {kEnd, ways()[0]}}),
                             whole);
            }
    }
}

TEST_P(Resume, AgainAndAgain) {
    constexpr std::uint64_t kSeed = 9;
    std::mt19937_64 random(kSeed);
    std::vector<Leg> legs;
    for (double t = 0; t < kEnd; t += uniform(random, 0, 0.8)) legs.push_back({t, ways()[random() % 4]});
    legs.push_back({kEnd, ways()[1]});
    SCOPED_TRACE(testing::Message() << "seed " << kSeed);
    expect_equal(run_in_legs(GetParam().scene, legs), run(GetParam().scene, ways()[0], kEnd));
}

// The same moment gives the same data, whoever has come there, and however often one started anew.
TEST_P(Resume, SnapshotsDoNotTellHowTheyWereReached) {
    const Scene& scene = GetParam().scene;
    World plain(scene, ways()[0]);
    plain.advance_to(2.2);
    World cut(scene, ways()[1]);
    cut.advance_to(0.9);
    cut = World(scene, ways()[2], cut.snapshot());
    cut.advance_to(2.2);
    const Snapshot a = plain.snapshot();
    const Snapshot b = cut.snapshot();
    EXPECT_EQ(a.scene_hash, b.scene_hash);
    EXPECT_EQ(a.field_updates, b.field_updates);
    EXPECT_EQ(a.virial.high, b.virial.high);
    EXPECT_EQ(a.virial.low, b.virial.low);
    EXPECT_EQ(a.last_collisions, b.last_collisions);
    EXPECT_EQ(a.contacts.has_value(), GetParam().scene.method == Method::kEmpirical);
    EXPECT_EQ(a.contacts, b.contacts);
    EXPECT_EQ(a.accelerations, b.accelerations);
    ASSERT_EQ(a.anchors.size(), b.anchors.size());
    for (std::size_t i = 0; i < a.anchors.size(); ++i) {
        EXPECT_EQ(a.anchors[i].position, b.anchors[i].position) << i;
        EXPECT_EQ(a.anchors[i].velocity, b.anchors[i].velocity) << i;
        EXPECT_EQ(a.anchors[i].time, b.anchors[i].time) << i;
        EXPECT_EQ(a.anchors[i].periods_x, b.anchors[i].periods_x) << i;
        EXPECT_EQ(a.anchors[i].periods_y, b.anchors[i].periods_y) << i;
    }
}

// A game's quick load: back in the same world, as often as one likes.
TEST_P(Resume, RestoreGoesBackInTheSameWorld) {
    World world(GetParam().scene, ways()[1]);
    world.advance_to(1);
    const Snapshot start = world.snapshot();
    std::vector<std::uint64_t> told(2, 0);
    std::size_t round = 0;
    world.on_collision([&](const Collision& c) { told[round] += std::bit_cast<std::uint64_t>(c.time); });
    world.advance_to(3.3);
    const std::uint64_t hash = world.state_hash();
    const double energy = world.energy();
    round = 1;
    world.restore(start);
    EXPECT_EQ(world.time(), 1);
    world.advance_to(3.3);
    EXPECT_EQ(world.state_hash(), hash);
    EXPECT_EQ(world.energy(), energy);
    EXPECT_EQ(told[0], told[1]) << "the listener stays";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Resume, testing::ValuesIn(all_scenes()), kNameOfScene);
INSTANTIATE_TEST_SUITE_P(Empirical, Resume, testing::ValuesIn(by_steps(all_scenes())), kNameOfScene);

TEST(SceneHash, TellsScenesApart) {
    const Scene scene = gas(1, {});
    const auto hash_with = [&scene](auto&& change) {
        Scene other = scene;
        change(other);
        return World(other, {.threads = 1}).scene_hash();
    };
    const std::uint64_t hash = hash_with([](Scene&) {});
    EXPECT_EQ(hash_with([](Scene& s) { s.until = 77; }), hash);
    EXPECT_EQ(hash_with([](Scene& s) { s.name = "other"; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.balls[3].radius *= 0.99; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.balls[3].velocity.y() *= -1; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.balls[3].is_static = true, s.balls[3].velocity.setZero(); }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.gravity.y() = 1e-300; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.precision = Precision::kFloat; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.contact_time = 1e-9; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { s.domain->box.max.x() += 1; }), hash);
    EXPECT_NE(hash_with([](Scene& s) { std::swap(s.balls[3], s.balls[4]); }), hash);
    EXPECT_NE(hash_with([](Scene& s) {
                  s.walls.push_back({{-9, 0}, {-9, 1}, 1});
                  s.domain->boundary = {Boundary::kOpen, Boundary::kOpen};
              }),
              hash);
}

TEST(Restore, RefusesWhatIsNoStateOfTheScene) {
    Scene scene = gas(6, {.restitution = 0.8});
    scene.attractors = {{{10, 10}, 1, 1}};
    World world(scene, {.threads = 1});
    world.advance_to(1);
    const Snapshot good = world.snapshot();
    const std::uint64_t hash = world.state_hash();
    const auto refused = [&](auto&& change) {
        Snapshot bad = good;
        change(bad);
        EXPECT_THROW(world.restore(bad), SnapshotError);
        EXPECT_EQ(world.state_hash(), hash) << "the world stays as it was";
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    refused([](Snapshot& s) { s.scene_hash += 1; });
    refused([](Snapshot& s) { s.method = "empirical"; });
    refused([](Snapshot& s) { s.time = -1; });
    refused([](Snapshot& s) { s.time = kNan; });
    refused([](Snapshot& s) { s.time = 1e300; });
    refused([](Snapshot& s) { s.time = 0.5; });  // before the anchors
    refused([](Snapshot& s) { s.field_updates += 1; });
    refused([](Snapshot& s) { s.anchors.pop_back(); });
    refused([](Snapshot& s) { s.last_collisions.clear(); });
    refused([](Snapshot& s) { s.accelerations.clear(); });
    refused([](Snapshot& s) { s.anchors[7].position.x() = kNan; });
    refused([](Snapshot& s) { s.anchors[7].velocity.y() = HUGE_VAL; });
    refused([](Snapshot& s) { s.accelerations[7].y() = -HUGE_VAL; });
    refused([](Snapshot& s) { s.anchors[7].position.x() = 1e300; });
    refused([](Snapshot& s) { s.anchors[7].time.offset = -1; });
    refused([](Snapshot& s) { s.anchors[7].time.offset = kNan; });
    refused([](Snapshot& s) { s.anchors[7].time.epoch = -1; });
    refused([](Snapshot& s) { s.last_collisions[7] = {std::int64_t{1} << 40, 0}; });
    world.restore(good);
    EXPECT_EQ(world.state_hash(), hash);
}

// What a step has left overlapping is part of the state, and whatever a file may say of it is looked at.
TEST(Restore, RefusesContactsThatCannotBe) {
    Scene scene;
    scene.method = Method::kEmpirical;
    scene.step = 0.1;
    scene.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kPeriodic}};
    scene.walls = {{{8, 1}, {8, 2}}};
    // 0 and 1 overlap and part, 2 stands still, 3 is far.
    scene.allows_overlap = true;
    scene.balls = {{.position = {2, 2}, .velocity = {-0.01, 0}, .radius = 0.5},
                   {.position = {2.9, 2}, .velocity = {0.01, 0}, .radius = 0.5},
                   {.position = {2, 9.8}, .radius = 0.5, .is_static = true},
                   {.position = {6, 6}, .radius = 0.5}};
    World world(scene);
    world.advance_to(0.25);
    const Snapshot good = world.snapshot();
    ASSERT_EQ(good.contacts, (std::vector<SavedContact>{{0, 1, 0, 0}}));
    const std::uint64_t hash = world.state_hash();
    for (const SavedContact& bad : std::vector<SavedContact>{{1, 0, 0, 0},   // not in order
                                                             {0, 0, 0, 0},   // itself
                                                             {2, 3, 0, 0},   // stands still
                                                             {99, 1, 0, 0},  // not there
                                                             {0, 3, 0, 0},   // apart
                                                             {0, 1, 0, 1},   // apart, a period away
                                                             {0, 1, 1, 0},   // the same, of no period
                                                             {3, 4, 0, 0},   // apart from the wall
                                                             {0, 7, 0, 0},   // a side that is no wall
                                                             {0, 9, 0, 0},   // beyond the last side
                                                             {0, 1, 1 << 30, -(1 << 30)}}) {
        Snapshot s = good;
        s.contacts->push_back(bad);
        EXPECT_THROW(world.restore(s), SnapshotError) << bad.ball << " and " << bad.partner;
        EXPECT_EQ(world.state_hash(), hash);
    }
    Snapshot at_times = good;
    at_times.anchors[1].time.offset /= 2;
    EXPECT_THROW(world.restore(at_times), SnapshotError);
    for (auto&& change : std::vector<std::function<void(Scene&)>>{
             [](Scene& s) { s.step = 0.11; }, [](Scene& s) { s.max_travel = 0.1; },
             [](Scene& s) { s.tolerance = 1e-4; }, [](Scene& s) { s.method = Method::kEvent; }}) {
        Scene other = scene;
        change(other);
        EXPECT_THROW(World(other, {}, good), SnapshotError);
    }
}

// The energy is read over all periods passed, and the virial's sum is exact: neither starts anew.
TEST(Restore, KeepsWhatTheSummaryTells) {
    Scene scene = gas(1, {.packing = 0.4, .speed = 4});
    World world(scene, {.threads = 1});
    world.advance_to(20);
    const World again(scene, {.threads = 2, .domains = 4}, world.snapshot());
    EXPECT_EQ(again.compressibility_factor(), world.compressibility_factor());
    EXPECT_EQ(again.virial(), world.virial());
    EXPECT_EQ(again.energy(), world.energy());
    EXPECT_EQ(again.momentum(), world.momentum());
    EXPECT_EQ(again.max_overlap(), world.max_overlap());
    EXPECT_EQ(again.counts().events, world.counts().events);
}

// A fall through a periodic side costs potential energy each time: the periods passed count.
TEST(Restore, KeepsTheEnergyOverPeriods) {
    Scene scene = gas(1, {.packing = 0.1});
    scene.gravity = {2, 0};
    World world(scene, {.threads = 1});
    world.advance_to(10);
    const World again(scene, {.threads = 2, .domains = 4}, world.snapshot());
    EXPECT_EQ(again.energy(), world.energy());
}

TEST(Restore, TakesASceneInWhichNothingMoves) {
    Scene scene = gas(1, {.count = 4});
    for (Ball& b : scene.balls) b.is_static = true, b.velocity.setZero();
    World world(scene, {.threads = 1});
    world.advance_to(3);
    World again(scene, {}, world.snapshot());
    again.advance_to(5);
    world.advance_to(5);
    EXPECT_EQ(again.state_hash(), world.state_hash());
}

}  // namespace
}  // namespace carom::test
