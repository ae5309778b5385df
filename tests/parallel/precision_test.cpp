// States held in float: what that means, and that it changes nothing but digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"

namespace carom::test {
namespace {

Scene in_float(Scene scene) {
    scene.precision = Precision::kFloat;
    return scene;
}

bool is_float(const Vec2& v) {
    return v == rounded_to_float(v);
}

TEST(Precision, EveryStateThatIsReadIsAFloat) {
    for (const NamedScene& named : feature_scenes()) {
        World world(in_float(named.scene));
        for (const double t : {0.0, 0.7, 3.1}) {
            world.advance_to(t);
            for (const Ball& b : world.balls()) {
                ASSERT_TRUE(is_float(b.position)) << named.name;
                ASSERT_TRUE(is_float(b.velocity)) << named.name;
            }
        }
    }
}

// Each collision rounds four velocity components by at most 2^-24 of themselves, at random signs; an energy
// of N / 2 times the mean square then changes by no more than that walk. Six standard deviations, and as much
// again for the parting pairs whose speed is raised by an ulp.
TEST(Precision, EnergyOfAnElasticGasWalksByTheRoundingOfFloat) {
    World world(in_float(gas(61, {.count = 400, .packing = 0.5})));
    const double energy = world.energy();
    world.advance_to(20);
    const auto collisions = double(world.counts().ball_collisions);
    ASSERT_GT(collisions, 4000);
    const double change = std::abs(world.energy() / energy - 1);
    EXPECT_LT(change, 12 * 0x1p-24 * std::sqrt(8 * collisions) / 400);
    EXPECT_GT(change, 1e-11) << "not rounded at all";
    EXPECT_TRUE(world.validate().empty());
}

// Equal balls in a line with velocities 1, 0 and -1: every number is a small dyadic one, so a float. Nothing
// is rounded, and the two precisions agree to the bit.
TEST(Precision, AgreesWithDoubleWhereNothingIsRounded) {
    Scene s;
    s.until = 64;
    s.domain = Domain{{{0, 0}, {16, 16}}, {Boundary::kWall, Boundary::kPeriodic}, 1};
    s.balls.resize(3);
    for (int i = 0; i < 3; ++i) {
        s.balls[i].position = {2.25 + 4.5 * i, 8};
        s.balls[i].velocity = {1.0 - i, 0};
    }
    World in_double(s);
    World other(in_float(s));
    in_double.advance_to(64);
    other.advance_to(64);
    EXPECT_GT(other.counts().events, 20u);
    EXPECT_EQ(other.state_hash(), in_double.state_hash());
}

TEST(Precision, ReadsDoubleStatesAsFloats) {
    World world(gas(62, {}));
    world.advance_to(1);
    const PlaneVectors x = world.positions();
    const PlaneVectors v = world.velocities();
    const std::vector<Vector2<float>> x_float = world.positions_in_float();
    const std::vector<Vector2<float>> v_float = world.velocities_in_float();
    ASSERT_EQ(x_float.size(), x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_EQ(x_float[i], Vector2<float>(x[i].cast<float>()));
        EXPECT_EQ(v_float[i], Vector2<float>(v[i].cast<float>()));
    }
}

// A column at rest in float: the hops are shorter than the rounding of a height, and yet nothing hangs.
TEST(Precision, RestingPileEnds) {
    Scene s;
    s.precision = Precision::kFloat;
    s.gravity = {0, -9.81};
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.until = 2;
    for (int i = 0; i < 20; ++i) {
        s.balls.emplace_back();
        s.balls.back().position = {1.1 + 1.02 * (i % 8), 0.6 + 1.05 * (i / 8)};
        s.balls.back().restitution = 0.3;
    }
    World world(s, {.threads = 1});
    world.advance_to(2);
    const double contacts = 2 / world.contact_time();
    EXPECT_LT(double(world.counts().ball_collisions), 30 * 20 * contacts);
    EXPECT_TRUE(world.validate().empty());
}

// Two that are pulled together bounce on the spot while they move along, thousands of times a second, each in
// a step much like the one before: rounding errs to the same side and drives them into each other, by up to
// half an ulp of their places along either axis and event. How far depends on the last digits, so here are
// many.
TEST(Precision, APairMovingAlongInContactSinksByItsRoundingAndNoMore) {
    Scene s;
    s.precision = Precision::kFloat;
    s.until = 2;
    for (int k = 0; k < 36; ++k) {
        const Vec2 n{std::cos(0.175 * k), std::sin(0.175 * k)};
        Ball b;
        b.radius = 1;
        b.restitution = 0;
        b.velocity = {8, 2};  // all the same
        b.position = {64 + 6 * (k % 6), 64 + 6 * (k / 6)};
        s.balls.push_back(b);
        b.position += (2 + 0x1p-13) * n;
        b.acceleration = -0.01 * n;
        s.balls.push_back(b);
    }
    s.balls.resize(2000);
    for (int i = 0; i < 1928; ++i) s.balls[72 + i].position = {3.0 * (i % 40), -3.0 - 3 * (i / 40)};
    for (const int domains : {1, 3}) {
        World world(s, {.domains = domains});
        std::vector<int> collisions(s.balls.size());
        world.on_collision([&](const Collision& c) { ++collisions[c.i]; });
        world.advance_to(1);
        const Snapshot half_way = world.snapshot();
        world.advance_to(2);
        const double each = std::numbers::sqrt2 * 0x1p-23 * 128 / 2;  // two centres, half an ulp of 64 to 128
        EXPECT_GT(world.max_overlap(), 1e-4) << "does not sink: another scene is needed";
        EXPECT_LT(world.max_overlap(), each / 2 * std::ranges::max(collisions));
        EXPECT_TRUE(world.validate().empty());
        World resumed(s, {.domains = domains}, half_way);
        resumed.advance_to(1.0625);
        EXPECT_TRUE(resumed.validate().empty()) << "the events before the snapshot have rounded too";
    }
}

TEST(Precision, RefusesWhatFloatCannotHold) {
    Scene s;
    s.until = 1;
    s.balls.resize(2);
    s.balls[1].position = {0, 1e31};
    EXPECT_NO_THROW(World{s});
    s.precision = Precision::kFloat;
    try {
        const World world(s);
        FAIL() << "accepted";
    } catch (const SceneError& error) {
        EXPECT_STREQ(
            error.what(),
            "balls[1].position: must lie within -1e30 and 1e30 where precision is float, is [0, 1e+31]");
    }
}

}  // namespace
}  // namespace carom::test
