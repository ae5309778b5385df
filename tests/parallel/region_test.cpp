// The cells of a domain and its halo, against counting them one by one.
#include "region.hpp"

#include <gtest/gtest.h>

#include <set>

namespace carom::test {
namespace {

constexpr std::int32_t kCells = 12;

GridAxis axis(bool periodic) {
    return {0, kCells, kCells, periodic};
}

/// How far a cell of a periodic axis is from the nearest of [first, last), in any image.
std::int32_t distance_round(std::int32_t k, Span own) {
    std::int32_t least = kCells;
    for (std::int32_t j = own.first; j < own.last; ++j)
        for (const std::int32_t turn : {-kCells, 0, kCells}) least = std::min(least, std::abs(k - j + turn));
    return least;
}

class PeriodicRegion : public testing::TestWithParam<std::tuple<Span, std::int32_t>> {};

TEST_P(PeriodicRegion, HoldsTheCellsWithinTheHalo) {
    const auto [own, halo] = GetParam();
    const RegionAxis region(axis(true), own, halo);
    const bool is_whole = own.size() + 2 * halo >= kCells;
    std::set<std::int32_t> places;
    std::set<std::int32_t> marks;
    for (std::int32_t k = 0; k < kCells; ++k) {
        const std::int32_t distance = distance_round(k, own);
        SCOPED_TRACE("cell " + std::to_string(k));
        EXPECT_EQ(region.covers(k), is_whole || distance <= halo);
        EXPECT_EQ(region.meets(Span{k, k + 1}), region.covers(k));
        if (!region.covers(k)) continue;
        for (const std::int32_t turns : {-3, -1, 0, 1, 2}) {  // balls fly many periods between two events
            const std::int32_t flown = k + turns * kCells;
            const std::int32_t framed = flown + region.frame_of(flown);
            EXPECT_TRUE(region.contains(framed));
            EXPECT_EQ(region.depth(framed), distance);
            EXPECT_EQ(RegionAxis::folded(framed, kCells), k);
            places.insert(region.place(framed));
            marks.insert(region.mark(framed));
            if (region.is_deep_inside(framed, 2)) {
                EXPECT_EQ(distance, 0);
                for (const std::int32_t d : {-2, -1, 1, 2})
                    EXPECT_EQ(distance_round(RegionAxis::folded(k + d, kCells), own), 0);
            }
        }
    }
    EXPECT_EQ(std::int64_t(places.size()), std::int64_t{region.size()});
    EXPECT_EQ(places.size(), marks.size());
    EXPECT_GE(*places.begin(), 0);
    EXPECT_LT(*places.rbegin(), region.size());
    EXPECT_LT(*marks.rbegin(), region.mark_count());
}

INSTANTIATE_TEST_SUITE_P(Spans, PeriodicRegion,
                         testing::Combine(testing::Values(Span{0, 1}, Span{0, 5}, Span{4, 9}, Span{7, 12},
                                                          Span{0, 12}),
                                          testing::Values(0, 1, 2, 3, 5, 20)));

constexpr std::int32_t kFar = GridAxis::kFarthest;

class EdgedRegion : public testing::TestWithParam<std::tuple<Span, std::int32_t>> {};

/// On walled and open axes balls may be cells beyond the box; a domain at the edge owns all of them.
TEST_P(EdgedRegion, TellsItsCellsApart) {
    const auto [own, halo] = GetParam();
    const RegionAxis region(axis(false), own, halo);
    std::set<std::int32_t> marks;
    for (std::int32_t k = -kCells; k < 2 * kCells; ++k) {
        SCOPED_TRACE("cell " + std::to_string(k));
        const std::int32_t distance = k < own.first ? own.first - k : std::max(0, k - own.last + 1);
        EXPECT_EQ(region.frame_of(k), 0);
        EXPECT_EQ(region.covers(k), distance <= halo);
        EXPECT_EQ(region.contains(k), distance <= halo);
        EXPECT_EQ(region.meets(Span{k, k + 1}), distance <= halo);
        EXPECT_EQ(region.place(k) >= 0, distance <= halo);
        if (distance > halo) continue;
        EXPECT_EQ(region.depth(k), distance);
        EXPECT_LT(region.place(k), region.size());
        EXPECT_LT(region.mark(k), region.mark_count());
        // Neighbours never share a place, so that a ball that comes to the next cell is seen to come.
        if (region.contains(k + 1)) {
            EXPECT_NE(region.place(k), region.place(k + 1));
        }
        // Only cells that are all the domain's own share a mark.
        const bool is_new = marks.insert(region.mark(k)).second;
        EXPECT_TRUE(is_new || distance == 0);
        EXPECT_EQ(region.is_deep_inside(k, 2), distance == 0 && k - own.first >= 2 && own.last - 1 - k >= 2);
    }
}

INSTANTIATE_TEST_SUITE_P(Spans, EdgedRegion,
                         testing::Combine(testing::Values(Span{-kFar, kFar}, Span{-kFar, 5}, Span{-kFar, 0},
                                                          Span{-kFar, -2}, Span{5, kFar}, Span{13, kFar},
                                                          Span{4, 5}, Span{3, 9}),
                                          testing::Values(0, 1, 3, 20)));

}  // namespace
}  // namespace carom::test
