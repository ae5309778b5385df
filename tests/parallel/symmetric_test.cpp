// Thousands of hits at one instant. Where no ball takes part in two of them the result is as symmetric as the
// scene, to the bit. Where one does, the order of the ids decides which comes first, and the symmetry is
// lost: that is the rule, not an error.
#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include <carom/core/response.hpp>
#include <carom/parallel/world.hpp>

#include "accuracy/systems.hpp"
#include "outcome.hpp"

namespace carom::test {
namespace {

using accuracy::ball_at;

/// Blocks, each its own mirror image in both axes: four balls fly along x in pairs towards each other, four
/// along y at half the speed, and their ways cross.
Scene lattice_of_pairs(int blocks) {
    const double side = 16.0 * blocks;
    Scene s;
    s.domain =
        Domain{{{-side / 2, -side / 2}, {side / 2, side / 2}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    for (int row = 0; row < blocks; ++row)
        for (int column = 0; column < blocks; ++column) {
            const Vec2 corner = Vec2(16.0 * column, 16.0 * row) - Vec2::Constant(side / 2);
            for (const double x : {2.0, 14.0})
                for (const double y : {6.0, 10.0}) {
                    // Off towards each other through the middle of the block, and round the box.
                    s.balls.push_back(ball_at(corner.x() + x, corner.y() + y, x < 8 ? 1 : -1, 0));
                    s.balls.push_back(ball_at(corner.x() + y - 2 * (y > 8 ? -1 : 1), corner.y() + x, 0,
                                              x < 8 ? 0.5 : -0.5));
                }
        }
    return s;
}

/// Equal to the last bit to its mirror image in `axis`, which is ball by ball the same scene.
void expect_mirror(const World& world, const World& image, int axis) {
    const PlaneVectors x = world.positions(), v = world.velocities();
    const PlaneVectors mx = image.positions(), mv = image.velocities();
    for (std::size_t i = 0; i < x.size(); ++i)
        for (int k = 0; k < 2; ++k) {
            const double sign = k == axis ? -1 : 1;
            ASSERT_EQ(mx[i][k], sign * x[i][k]) << "ball " << i;
            ASSERT_EQ(mv[i][k], sign * v[i][k]) << "ball " << i;
        }
}

Scene mirrored(Scene s, int axis) {
    for (Ball& b : s.balls) {
        b.position[axis] = -b.position[axis];
        b.velocity[axis] = -b.velocity[axis];
    }
    return s;
}

TEST(Symmetric, ThousandsOfHitsAtOneInstantKeepTheSymmetry) {
    const Scene s = lattice_of_pairs(20);
    ASSERT_EQ(s.balls.size(), 3200U);
    constexpr double kEnd = 40.125;
    const Outcome serial = run(s, {.threads = 1, .domains = 1}, kEnd);
    EXPECT_GT(serial.balls, 5000U);
    for (const int domains : {2, 5, 9})
        expect_equal(run(s, {.threads = 2, .domains = domains}, kEnd), serial);
    for (int axis = 0; axis < 2; ++axis)
        for (const int domains : {1, 5}) {
            World world(s, {.threads = 2, .domains = 1});
            World image(mirrored(s, axis), {.threads = 2, .domains = domains});
            world.advance_to(kEnd);
            image.advance_to(kEnd);
            expect_mirror(world, image, axis);
            EXPECT_EQ(world.energy(), image.energy());
        }
}

/// Four balls come from the four sides and meet at one instant, each with both of its neighbours.
Scene four_at_once(const std::vector<int>& order) {
    const std::vector<Ball> sides = {ball_at(4, 0, -1, 0), ball_at(0, 4, 0, -1), ball_at(-4, 0, 1, 0),
                                     ball_at(0, -4, 0, 1)};
    Scene s;
    for (const int k : order) s.balls.push_back(sides[static_cast<std::size_t>(k)]);
    return s;
}

// The pair of the smallest ids comes first. It turns both of its balls, whose other pairs are then found
// anew, at the same instant but for the rounding of their places. What comes out is what the pairs give one
// after the other.
TEST(Symmetric, WhereOneBallIsHitTwiceTheIdsDecide) {
    for (const std::vector<int>& order : std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 2, 1, 3}}) {
        const Scene s = four_at_once(order);
        World world(s, {.threads = 1});
        std::vector<Collision> seen;
        world.on_collision([&seen](const Collision& c) { seen.push_back(c); });
        world.advance_to(10);
        ASSERT_GE(seen.size(), 4U);
        EXPECT_EQ(seen[0].i, 0U);
        EXPECT_EQ(seen[0].j, order[1] == 1 ? 1U : 2U);
        std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (std::size_t k = 0; k < 4; ++k) {
            // Twelve roundings of places up to 4, at a speed of 1/2 and more.
            EXPECT_NEAR(seen[k].time, seen[0].time, 12 * 4 * accuracy::kRounding / 0.5);
            pairs.emplace(seen[k].i, seen[k].j);
        }
        EXPECT_EQ(pairs.size(), 4U);
        std::vector<Vec2> v;
        for (const Ball& b : s.balls) v.push_back(b.velocity);
        for (const Collision& c : seen) {
            const auto after = collide<double>(v[c.i], v[c.j], c.normal, 1.0, 1.0, 1.0);
            v[c.i] = after.a;
            v[c.j] = after.b;
        }
        const PlaneVectors got = world.velocities();
        // The normal reported has been divided by its length: three roundings of it a collision.
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_LT((got[i] - v[i]).norm(), 16 * accuracy::kRounding * double(seen.size()));
        EXPECT_NEAR(world.energy(), 2, 16 * accuracy::kRounding * double(seen.size()));
        EXPECT_NEAR(world.momentum().norm(), 0, 16 * accuracy::kRounding * double(seen.size()));
        for (const int domains : {2, 3})
            expect_equal(run(s, {.threads = 2, .domains = domains}, 10),
                         run(s, {.threads = 1, .domains = 1}, 10));
    }
}

}  // namespace
}  // namespace carom::test
