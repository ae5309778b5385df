// A pile at rest neither creeps nor heats up nor sinks, at a bounded number of collisions; and what float
// costs it and a gas. The tables of docs/accuracy.md say the same of larger ones.
#include <gtest/gtest.h>

#include "accuracy/rest.hpp"

namespace carom::accuracy {
namespace {

// Contacts reopen for one contact time at most, in which a ball falls g t_c^2 / 2 and gains m (g t_c)^2 / 2:
// a pile at rest keeps a random motion of that size. Its total only ever falls, but for what the floor gives
// back to the balls that lie on it, and so its height and energy stay within a few of those.
void expect_rest(const RestCase& rest) {
    SCOPED_TRACE(rest.name + ", contact time " + std::to_string(*rest.scene.contact_time));
    const Rest r = measure(rest);
    EXPECT_LT(r.most, kMostInContactTime);
    EXPECT_GT(r.collisions, 0.5) << "nothing to measure";
    EXPECT_LT(r.energy_change, 1) << "it heats up";
    EXPECT_LT(r.height_change, 1) << "it grows";
    EXPECT_LT(r.overlap, 1e-12);
    if (!rest.settles) return;
    EXPECT_LT(r.kinetic_1, 3);
    EXPECT_GT(r.energy_change, -1) << "it has not come to rest";
    EXPECT_GT(r.height_change, -1) << "it sinks";
}

TEST(Rest, PilesKeepTheirEnergyAndHeight) {
    for (const RestCase& rest : rest_cases(false)) expect_rest(rest);
}

TEST(Rest, PilesInFloatToo) {
    RestCase rest = resting_pile();
    rest.scene.precision = Precision::kFloat;
    expect_rest(rest);
}

}  // namespace
}  // namespace carom::accuracy
