// Systems whose course is known in closed form, through the whole engine: the rows of the table `systems` of
// docs/accuracy.md, each within its bound, and what is exact.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/dropped_ball.hpp"
#include "accuracy/galperin.hpp"
#include "accuracy/reversal.hpp"
#include "accuracy/systems.hpp"
#include "core/table.hpp"
#include "system_test.hpp"

namespace carom::accuracy {
namespace {

std::vector<System> all_systems() {
    std::vector<System> all;
    for (const auto& some :
         {line_systems(), mass_systems(), bounce_systems(), billiard_systems(), reversal_systems()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

// The bounds stand beside the functions that measure.
TEST_P(ExactSystem, StaysWithinItsBound) {
    expect_within_bound(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Systems, ExactSystem, testing::ValuesIn(all_systems()), name_of_system);

TEST(ExactSystems, GalperinCountsTheDigitsOfPi) {
    for (const test::Row& row : test::read_table("galperin.csv"))
        EXPECT_EQ(galperin_count(std::stod(row[0])), std::stoull(row[1]));
    // In base 4: floor(4^n pi).
    for (int n = 0; n <= 8; ++n)
        EXPECT_EQ(galperin_count(std::pow(16.0, n)),
                  static_cast<std::uint64_t>(std::pow(4.0L, n) * std::numbers::pi_v<long double>));
    for (const double ratio : {1.0, 16.0, 100.0, 65536.0, 1e4})
        for (const bool heavy_first : {false, true})
            for (const bool mirrored : {false, true}) {
                const Deviation d = galperin(ratio, heavy_first, mirrored);
                EXPECT_EQ(d.collisions, d.expected) << "mass ratio " << ratio;
                EXPECT_LE(d.error, d.bound) << "mass ratio " << ratio;
            }
}

// Five equal touching balls: as many leave as come, with all of the velocity, exactly.
TEST(ExactSystems, CradlePassesOnWhatComes) {
    for (const std::size_t incoming : {1U, 2U}) {
        Scene s;
        for (std::size_t i = 0; i < 5; ++i)
            s.balls.push_back(ball_at(double(i) - (i < incoming ? 2 : 0), 0, i < incoming ? 1 : 0, 0));
        World world(s);
        world.advance_to(10);
        EXPECT_EQ(world.counts().ball_collisions, incoming == 1 ? 4u : 6u);
        const PlaneVectors v = world.velocities();
        for (std::size_t i = 0; i < 5; ++i)
            EXPECT_EQ(v[i], Vec2(i + incoming >= 5 ? 1 : 0, 0))
                << "ball " << i << " of " << incoming << " in";
    }
}

// The table's figures have 20 digits; the engine's times half an ulp of a double, and its speeds k
// roundings.
TEST(ExactSystems, DroppedBallFollowsThePublishedSeries) {
    for (const test::Row& row : test::read_table("bouncing_ball.csv")) {
        const double e = std::stod(row[0]);
        const std::size_t k = std::stoul(row[1]);
        const double time = std::stod(row[2]);
        const std::vector<Impact> impacts = impacts_of_dropped_ball(e);
        ASSERT_GT(impacts.size(), k);
        const double rounding = kRounding * double(k + 1) * 6;
        EXPECT_NEAR(impacts[k].time, time, rounding * time) << "restitution " << e << ", impact " << k;
        EXPECT_NEAR(impacts[k].speed / std::stod(row[3]), 1, rounding + 1e-6)
            << "restitution " << e << ", impact " << k;
        // The table counts on until the flight is shorter than an ulp.
        EXPECT_NEAR(double(impacts.size()), std::stod(row[5]), 1);
    }
}

// What the reversal would see: one velocity off by a millionth of a millionth.
TEST(ExactSystems, ReversalSeesAFault) {
    int seen = 0;
    for (const ReversalCase& c : reversal_cases()) {
        if (c.packing < 0.1) continue;
        const Deviation d = reverse(c, 1e-6);
        EXPECT_GT(d.error, d.bound) << "packing " << c.packing << ", " << c.collisions << " collisions";
        ++seen;
    }
    EXPECT_GE(seen, 12);
}

}  // namespace
}  // namespace carom::accuracy
