// One ulp decides: past the end of a wall, and through a gap that is as wide as the ball or a bit narrower.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/systems.hpp"

namespace carom::test {
namespace {

using accuracy::ball_at;

// A ball that falls past the end of a wall: one ulp decides between a miss and a hit.
TEST(ExactGap, OneUlpDecidesAtTheEndOfAWall) {
    const auto hits = [](double x) {
        Scene s;
        s.balls = {ball_at(x, 2, 0, -1)};
        s.walls = {{{-5, 0}, {0, 0}, 1}};
        World world(s);
        world.advance_to(10);
        return world.counts().wall_collisions;
    };
    EXPECT_EQ(hits(0.5), 0u) << "a touch is no hit";
    EXPECT_EQ(hits(std::nextafter(0.5, 1.0)), 0u);
    EXPECT_EQ(hits(std::nextafter(0.5, 0.0)), 1u);
}

enum class Gate { kWallEnds, kStaticBalls };

/// A ball of diameter 1 falls from height 2 above a gap at `place`, from `place` - `left` to `place` +
/// `right`.
Scene gate(Gate kind, const Vec2& place, double left, double right) {
    Scene s;
    s.balls = {ball_at(place.x(), place.y() + 2, 0, -1)};
    if (kind == Gate::kWallEnds) {
        s.walls = {{place - Vec2(5, 0), place - Vec2(left, 0), 1},
                   {place + Vec2(right, 0), place + Vec2(5, 0), 1}};
        return s;
    }
    for (const double x : {-left - 0.5, right + 0.5}) {
        s.balls.push_back(ball_at(place.x() + x, place.y(), 0, 0));
        s.balls.back().is_static = true;
    }
    return s;
}

struct Passage {
    double height;  ///< above the gap
    std::uint64_t hits;
    double energy;
    double overlap;
};

Passage fall(const Scene& s, double base, double time) {
    World world(s, {.threads = 1});
    world.advance_to(time);
    const Counts counts = world.counts();
    return {world.positions()[0].y() - base, counts.ball_collisions + counts.wall_collisions,
            world.kinetic_energy(), world.max_overlap()};
}

/// Two arcs of the radius of contact R, at which the centre turns, cross at the height sqrt(R^2 - (R - d)^2)
/// where the gap is narrower by 2 d: a corner of the half angle of which that, over R, is the sine. Straight
/// sides would turn the ball back after pi / (2 angle) hits; as the arcs open, after a few less.
double corner_hits(double narrower, double contact) {
    const double angle = std::sqrt(narrower / contact);  // sqrt(2 d / R) with narrower = 2 d
    return std::numbers::pi / 2 / angle;
}

struct Place {
    Gate kind;
    double offset;

    friend std::ostream& operator<<(std::ostream& out, const Place& p) {
        return out << (p.kind == Gate::kWallEnds ? "wall ends" : "static balls") << " at " << p.offset;
    }
};

class Gap : public testing::TestWithParam<Place> {};

// A touch is no hit: what is as wide as the ball, or wider by an ulp, lets it through untouched.
TEST_P(Gap, AsWideAsTheBallLetsItThrough) {
    const auto [kind, offset] = GetParam();
    const Vec2 place = Vec2::Constant(offset);
    const double wider = std::nextafter(offset + 0.5, 2 * offset + 1) - offset;
    for (const auto& [left, right] : std::vector<std::pair<double, double>>{{0.5, 0.5}, {0.5, wider}}) {
        const Passage p = fall(gate(kind, place, left, right), offset, 10);
        EXPECT_EQ(p.hits, 0u);
        EXPECT_EQ(p.height, -8.0);
    }
}

// At large coordinates an ulp of the place is much for the ball, so that the hits in the corner have their
// turns. At the origin they would follow each other every 2 d / pi, far below an ulp of the time: no time
// passes, and the engine says so.
TEST_P(Gap, NarrowerByAnUlpTurnsItBackOrIsRefused) {
    const auto [kind, offset] = GetParam();
    const double contact = kind == Gate::kWallEnds ? 0.5 : 1;
    // Of the coordinate of the end, or of the static ball's centre.
    const double ulp = std::nextafter(offset + contact, 2 * offset + 2) - (offset + contact);
    const Scene s = gate(kind, Vec2::Constant(offset), 0.5, 0.5 - ulp);
    if (offset == 0) {
        try {
            fall(s, offset, 10);
            FAIL() << "passed, or had its hundred million hits";
        } catch (const std::runtime_error& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with("balls[0]: is wedged: ")) << error.what();
        }
        return;
    }
    const double expected = corner_hits(ulp, contact);
    const Passage p = fall(s, offset, 10);
    EXPECT_GT(p.height, 7) << "it has passed, or come to a stop";
    EXPECT_LT(double(p.hits), expected + 2);
    EXPECT_GT(double(p.hits), expected / 2);
    // Each hit rounds the energy by a few ulp, and the place by one of the largest coordinate.
    EXPECT_NEAR(p.energy, 0.5, 8 * accuracy::kRounding * double(p.hits));
    EXPECT_LT(p.overlap, 8 * accuracy::kRounding * (offset + 8));
}

INSTANTIATE_TEST_SUITE_P(Places, Gap,
                         testing::Values(Place{Gate::kWallEnds, 0}, Place{Gate::kWallEnds, 0x1p20},
                                         Place{Gate::kWallEnds, 0x1p30}, Place{Gate::kStaticBalls, 0},
                                         Place{Gate::kStaticBalls, 0x1p20},
                                         Place{Gate::kStaticBalls, 0x1p30}));

// Narrower by a millionth, symmetrically: the hits are those of the corner.
TEST(ExactGap, CornerHitsAreCounted) {
    for (const Gate kind : {Gate::kWallEnds, Gate::kStaticBalls}) {
        const double half = 0.5 * (1 - 1e-6);
        const Passage p = fall(gate(kind, {0, 0}, half, half), 0, 10);
        EXPECT_GT(p.height, 0);
        EXPECT_NEAR(double(p.hits), corner_hits(1e-6, kind == Gate::kWallEnds ? 0.5 : 1), 2);
    }
}

}  // namespace
}  // namespace carom::test
