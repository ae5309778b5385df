// The same scene at the origin and 10^8 radii from it.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/reversal.hpp"
#include "accuracy/systems.hpp"
#include "outcome.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

using accuracy::ball_at;

constexpr double kFar = 0x1p26;  // 1.3e8 radii

Scene moved(Scene s, const Vec2& by) {
    for (Ball& b : s.balls) b.position += by;
    for (Wall& w : s.walls) {
        w.from += by;
        w.to += by;
    }
    s.domain->box.min += by;
    s.domain->box.max += by;
    return s;
}

/// Rows that move along x and columns that move along y, each ball at -1, 0 or 1 from an integer place: every
/// meeting is at a multiple of 1/2, so that no rounding happens at the origin or afar.
Scene exact_rows_and_columns() {
    std::mt19937_64 random(84);
    Scene s;
    s.domain = Domain{{{0, 0}, {64, 32}}, {Boundary::kWall, Boundary::kWall}, 1};
    for (int line = 0; line < 16; ++line)
        for (int k = 0; k < 16; ++k) {
            const double speed = double(random() % 3) - 1;
            const double across = 2 * line + 1;
            if (k % 3 != 2) s.balls.push_back(ball_at(1 + 2 * (k % 16), across, speed, 0));
            if (k % 3 != 1) s.balls.push_back(ball_at(32 + across, 1 + 2 * k, 0, speed));
        }
    s.walls = {{{32, 0}, {32, 32}, 1}};
    return s;
}

TEST(FarPlace, ExactMotionIsTheSameToTheBit) {
    constexpr double kEnd = 100.25;
    const Scene s = exact_rows_and_columns();
    const Outcome here = run(s, {.threads = 1, .domains = 1}, kEnd);
    ASSERT_GT(here.balls, 500U);
    ASSERT_GT(here.walls, 500U);
    World near(s, {.threads = 1});
    near.advance_to(kEnd);
    for (const Vec2& by : {Vec2(kFar, 0), Vec2(-kFar, kFar), Vec2(-kFar - 3, -3 * kFar)}) {
        World far(moved(s, by), {.threads = 1});
        far.advance_to(kEnd);
        for (std::size_t i = 0; i < s.balls.size(); ++i) {
            ASSERT_EQ(far.positions()[i], near.positions()[i] + by) << "ball " << i;
            ASSERT_EQ(far.velocities()[i], near.velocities()[i]) << "ball " << i;
        }
        for (const int domains : {1, 2, 5}) {
            const Outcome there = run(moved(s, by), {.threads = 2, .domains = domains}, kEnd);
            EXPECT_TRUE(there.collisions == here.collisions) << domains << " domains";
            EXPECT_EQ(there.virial, here.virial);
        }
    }
}

/// A gas of random balls from dyadic places meets in the same order for as long as the places' last bits, now
/// 2^-27, have not grown to the gaps between meetings.
TEST(FarPlace, AGasMeetsInTheSameOrder) {
    Scene s = gas(85, {.count = 100, .packing = 0.3});
    for (Ball& b : s.balls)
        for (int axis = 0; axis < 2; ++axis) b.position[axis] = accuracy::dyadic(b.position[axis]);
    for (int axis = 0; axis < 2; ++axis) s.domain->box.max[axis] = accuracy::dyadic(s.domain->box.max[axis]);
    const Vec2 by(kFar, -kFar);
    World near(s, {.threads = 1});
    World far(moved(s, by), {.threads = 1});
    std::vector<std::pair<std::uint32_t, std::uint32_t>> met_near, met_far;
    near.on_collision([&](const Collision& c) { met_near.emplace_back(c.i, c.j); });
    far.on_collision([&](const Collision& c) { met_far.emplace_back(c.i, c.j); });
    double time = 0;
    while (met_near.size() < 50) near.advance_to(time += 0x1p-7);
    far.advance_to(time);
    EXPECT_TRUE(met_near == met_far);
    const double bound = accuracy::error_after({0.3, 1, false}, kFar);
    for (std::size_t i = 0; i < s.balls.size(); ++i)
        for (int axis = 0; axis < 2; ++axis) {
            const double error = std::remainder(
                far.positions()[i][axis] - near.positions()[i][axis] - by[axis], s.domain->box.max[axis]);
            EXPECT_LT(std::abs(error), bound) << "ball " << i;
        }
}

}  // namespace
}  // namespace carom::test
