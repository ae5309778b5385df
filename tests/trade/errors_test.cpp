// Errors of a run against its reference, on constructed figures; the clock's ratio where it is known.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <carom/trade/cost.hpp>
#include <carom/trade/errors.hpp>
#include <carom/trade/settings.hpp>

namespace carom::trade {
namespace {

// exp(3 t) between 1e-10 and 1e-2; what lies outside, and after the first excess, is not looked at.
TEST(Errors, GrowthIsTheSlopeOfTheLogarithm) {
    std::vector<double> times;
    std::vector<double> norms;
    for (int k = 0; k < 100; ++k) {
        times.push_back(0.1 * k);
        norms.push_back(k < 10 ? 1e-11 : k > 70 ? 0.005 + (k % 2) : 1e-11 * std::exp(3 * times.back()));
    }
    // Some sixty points of a straight line: rounding alone.
    EXPECT_NEAR(growth_of(times, norms, 1e-10, 1e-2).value(), 3, 1e-12);
    EXPECT_FALSE(growth_of({0, 1}, {1e-5, 1e-4}, 1e-10, 1e-2));
}

TEST(Errors, DistancesCrossPeriodicSides) {
    Scene s;
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kPeriodic, Boundary::kWall}, 1};
    s.balls.resize(2);
    const std::vector<double> d = distances({{0.5, 1}, {1, 1}}, {{9.5, 1}, {1, 9}}, s);
    EXPECT_EQ(d, (std::vector<double>{1, 8}));
    EXPECT_EQ(place_error({0.25, 8}, s), 0.75);  // half a radius, and more than one
    s.balls[1].is_static = true;
    EXPECT_EQ(place_error({0.25, 8}, s), 0.5);
}

// Three balls; the stretch is 1, so that a time may differ by 0.05 and collisions after 0.95 do not count.
TEST(Errors, AreThoseOfTheFirstStretch) {
    Scene s;
    s.balls.resize(3);
    const Course course{.stretch = 1};
    Trace reference;
    reference.after_stretch = {{0, 0}, {5, 0}, {9, 0}};
    reference.meetings = {{0.2, 0, 1}, {0.5, 1, 2}, {0.98, 0, 2}};
    reference.energy_after_stretch = 7;
    reference.most_kinetic_energy = 4;
    Trace other = reference;
    EXPECT_EQ(errors_of(s, course, reference, other).largest(), 0);
    other.energy_after_stretch = 6;
    other.meetings = {{0.2, 0, 1}};
    other.after_stretch[0].x() = 0.125;  // a quarter of a radius, of three balls
    other.max_overlap = 0.0625;
    const Errors e = errors_of(s, course, reference, other);
    EXPECT_EQ(e.energy, 0.25);
    EXPECT_EQ(e.collisions, 0.5);
    EXPECT_DOUBLE_EQ(e.places, 0.25 / 3);
    EXPECT_EQ(e.overlap, 0.0625);
    EXPECT_EQ(e.largest(), 0.5);
    EXPECT_EQ(divergence_time(s, course, reference, other), 0.5);
    EXPECT_FALSE(divergence_time(s, course, reference, reference));
}

// A ball of radius 0.5 and speed 2 between walls: the trace has its hits, at 0.25 and each 0.5 later, and
// its places.
TEST(Trace, TellsOfABallBetweenWalls) {
    Scene s;
    s.domain = Domain{{{0, 0}, {2, 2}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls.resize(1);
    s.balls[0].position = {1, 1};
    s.balls[0].velocity = {2, 0};
    const Course course{.stretch = 1, .stretches = 2};
    const Trace t = trace(s, course);
    ASSERT_TRUE(t.is_whole);
    ASSERT_EQ(t.meetings.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(t.meetings[k].time, 0.25 + 0.5 * double(k), 1e-15);
        EXPECT_EQ(t.meetings[k].b, k % 2 == 0 ? 2u : 1u);  // the sides right and left, after one ball
    }
    ASSERT_EQ(t.places.size(), 33u);
    EXPECT_NEAR(t.places[2][0].x(), 1.25, 1e-8);  // at 2/16; the samples are a billionth late
    EXPECT_EQ(t.most_kinetic_energy, 2);
    // Steps of a sample's time end at the samples: the bounces are a tolerance late at most.
    Scene by_steps = stepped(s, course, course.time_of(1));
    EXPECT_DOUBLE_EQ(*by_steps.step, 1.0 / 16);
    const Trace other = trace(by_steps, course);
    EXPECT_LT(errors_of(s, course, t, other).largest(), 1e-5);
    EXPECT_GT(other.overlap_between, 0.01);  // read between two steps a ball stands in the wall
    // One that is told to stop says so.
    int asked = 0;
    EXPECT_FALSE(trace(s, course, {.goes_on = [&] { return ++asked < 5; }}).is_whole);
}

// As many rounds as asked for, in order; nothing is said of the clock itself.
TEST(Cost, IsTheMedianOfRounds) {
    Scene s;
    s.domain = Domain{{{0, 0}, {2, 2}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls.resize(1);
    s.balls[0].position = {1, 1};
    s.balls[0].velocity = {2, 1};
    const TimeRatio r = time_ratio(s, s, 100, {.least_rounds = 4, .enough_seconds = 0});
    EXPECT_EQ(r.rounds, 4);
    EXPECT_LE(r.least, r.median);
    EXPECT_LE(r.median, r.most);
    EXPECT_GT(r.seconds, 0);
    EXPECT_EQ(time_ratio(s, s, 100, {.goes_on = [] { return false; }}).rounds, 1);
}

}  // namespace
}  // namespace carom::trade
