// Every ball touches its neighbours from the start.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/systems.hpp"
#include "outcome.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

using accuracy::ball_at;
using accuracy::kRounding;

/// A hexagon of the triangular lattice, `rings` around the middle, at contact to the last bit that the root
/// of 3 leaves.
Scene hexagon(int rings) {
    Scene s;
    for (int row = -rings; row <= rings; ++row)
        for (int k = 0; k < 2 * rings + 1 - std::abs(row); ++k)
            s.balls.push_back(ball_at(k - rings + 0.5 * std::abs(row), row * std::numbers::sqrt3 / 2, 0, 0));
    return s;
}

void expect_sound(const Scene& s, double end, std::uint64_t most_collisions) {
    World world(s, {.threads = 1});
    const double energy = world.energy();
    const Vec2 momentum = world.momentum();
    double of_all = 0;
    for (const Ball& b : s.balls) of_all += b.velocity.norm();
    for (int k = 1; k <= 4; ++k) {
        world.advance_to(end * k / 4);
        EXPECT_LT(world.max_overlap(), 1e-13) << "each event rounds places of some ten by an ulp";
    }
    const auto collisions = double(world.counts().ball_collisions);
    EXPECT_GT(world.counts().ball_collisions, s.balls.size());
    EXPECT_LT(world.counts().ball_collisions, most_collisions);
    // Each collision rounds the energy and the momentum of two by a few ulp: in a chain at one instant one
    // pair may have it all.
    EXPECT_NEAR(world.energy() / energy, 1, 8 * kRounding * collisions);
    EXPECT_NEAR((world.momentum() - momentum).norm(), 0, 8 * kRounding * collisions * of_all);
    const Outcome serial = run(s, {.threads = 1, .domains = 1}, end);
    for (const int domains : {2, 3, 7}) expect_equal(run(s, {.threads = 2, .domains = domains}, end), serial);
}

// In the open they fly apart. Of n elastic balls there is a largest number of collisions (Burago, Ferleger
// and Kononenko 1998), but far above what happens: a touching row has n^2 / 4.
TEST(Touching, HexagonWithRandomVelocitiesFliesApart) {
    for (const std::uint64_t seed : {91, 92, 93}) {
        std::mt19937_64 random(seed);
        Scene s = hexagon(6);
        for (Ball& b : s.balls) b.velocity = random_velocity(random, 1);
        const std::size_t n = s.balls.size();
        expect_sound(s, 40, n * n / 4);
    }
}

TEST(Touching, HexagonHitByOneBall) {
    for (const double aim : {0.0, 0.25, 0.4999}) {
        Scene s = hexagon(6);
        s.balls.push_back(ball_at(aim, -12, 0, 10));
        const std::size_t n = s.balls.size();
        expect_sound(s, 10, n * n / 4);
    }
}

TEST(Touching, RowHitAtItsEndPassesTheVelocityOn) {
    for (const int domains : {1, 4}) {
        Scene s;
        for (int k = 0; k < 500; ++k) s.balls.push_back(ball_at(k, 0, 0, 0));
        s.balls.push_back(ball_at(-3, 0, 2, 0));
        World world(s, {.threads = 2, .domains = domains});
        world.advance_to(2);
        EXPECT_EQ(world.counts().ball_collisions, 500U);
        const PlaneVectors v = world.velocities();
        for (std::size_t i = 0; i < s.balls.size(); ++i)
            EXPECT_EQ(v[i], Vec2(i == 499 ? 2 : 0, 0)) << "ball " << i;
        EXPECT_EQ(world.positions()[500], Vec2(-1, 0));
        EXPECT_EQ(world.positions()[499], Vec2(501, 0));
    }
}

}  // namespace
}  // namespace carom::test
