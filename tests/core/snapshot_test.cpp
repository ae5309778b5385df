// A snapshot that nobody has filled in: a world at its beginning.
#include <carom/core/snapshot.hpp>

#include <gtest/gtest.h>

namespace carom {
namespace {

TEST(Snapshot, BeginsWithNothing) {
    const Counts counts;
    EXPECT_EQ(counts.ball_collisions, 0U);
    EXPECT_EQ(counts.wall_collisions, 0U);
    EXPECT_EQ(counts.events, 0U);
    EXPECT_EQ(counts.windows, 0U);
    EXPECT_EQ(counts.window_retries, 0U);
    EXPECT_EQ(counts.copied_collisions, 0U);
    EXPECT_FALSE(counts.steps || counts.missed_collisions);
    const SavedAnchor anchor;
    EXPECT_EQ(anchor.time, Time());
    EXPECT_EQ(anchor.periods_x, 0);
    EXPECT_EQ(anchor.periods_y, 0);
    const SavedSum sum;
    EXPECT_EQ(sum.high, 0);
    EXPECT_EQ(sum.low, 0U);
    EXPECT_FALSE(sum.is_lost);
    EXPECT_EQ(SavedContact(), (SavedContact{0, 0, 0, 0}));
    const Snapshot snapshot;
    EXPECT_EQ(snapshot.scene_hash, 0U);
    EXPECT_EQ(snapshot.time, 0);
    EXPECT_EQ(snapshot.field_updates, 0U);
}

}  // namespace
}  // namespace carom
