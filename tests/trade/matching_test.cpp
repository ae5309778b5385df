// Missed and invented collisions, on constructed lists.
#include <gtest/gtest.h>

#include <vector>

#include <carom/trade/matching.hpp>

namespace carom::trade {
namespace {

const std::vector<bool> kSixMove(6, true);
const MatchingRules kRules{.first = 2, .window = 0.1, .until = 10};

void expect(const Matching& m, std::size_t compared, std::size_t missed, std::size_t invented) {
    EXPECT_EQ(m.compared, compared);
    EXPECT_EQ(m.missed, missed);
    EXPECT_EQ(m.invented, invented);
}

TEST(Matching, OfAListWithItselfFindsNothing) {
    const std::vector<Meeting> list = {{1, 0, 1}, {2, 1, 2}, {3, 4, 6}, {4, 0, 2}};
    expect(match(list, list, kSixMove, kRules), 4, 0, 0);
}

// The bodies' order and small errors of time make no difference; two far ones may change places.
TEST(Matching, ForgivesTimesWithinTheWindow) {
    expect(match({{1, 0, 1}, {1.01, 2, 3}}, {{1.02, 3, 2}, {1.05, 1, 0}}, kSixMove, kRules), 2, 0, 0);
    expect(match({{1, 0, 1}}, {{1.2, 0, 1}}, kSixMove, kRules), 1, 1, 0);
}

// 0 and 1 miss each other. All that 0, 1 and whom they meet do later differs for that reason alone.
TEST(Matching, CountsAMissedOneOnce) {
    const std::vector<Meeting> reference = {{1, 0, 1}, {2, 0, 2}, {3, 4, 5}};
    const std::vector<Meeting> other = {{2.1, 1, 3}, {3, 4, 5}, {3.5, 0, 3}};
    expect(match(reference, other, kSixMove, kRules), 2, 1, 0);
    EXPECT_EQ(match(reference, other, kSixMove, kRules).first_fault, 1);
    EXPECT_FALSE(match(reference, reference, kSixMove, kRules).first_fault);
}

TEST(Matching, CountsAnInventedOneOnce) {
    const std::vector<Meeting> reference = {{2, 0, 2}, {3, 4, 5}};
    const std::vector<Meeting> other = {{1, 0, 1}, {2.5, 1, 2}, {3, 4, 5}};
    expect(match(reference, other, kSixMove, kRules), 1, 0, 1);
}

// A second meeting of the same pair is another collision than the first.
TEST(Matching, TellsTheFirstMeetingFromTheSecond) {
    expect(match({{1, 0, 1}, {1.05, 0, 1}}, {{1, 0, 1}}, kSixMove, kRules), 2, 1, 0);
}

// Wall 6 and the static ball 5 are met by many: that is no history of theirs.
TEST(Matching, WallsAndStaticBallsHaveNoHistory) {
    std::vector<bool> moves = kSixMove;
    moves[5] = false;
    const std::vector<Meeting> reference = {{1, 0, 6}, {1, 0, 5}, {2, 1, 6}, {2.5, 1, 5},
                                            {3, 2, 6}, {4, 2, 5}, {5, 3, 5}};
    std::vector<Meeting> other = reference;
    other.erase(other.begin());
    // Without the first of ball 0 its second is no longer compared; the other balls' are.
    expect(match(reference, other, moves, kRules), 6, 1, 0);
}

TEST(Matching, ComparesTheFirstOfEachBallUntilATime) {
    const std::vector<Meeting> reference = {{1, 0, 6}, {2, 0, 6}, {3, 0, 6}, {11, 1, 6}};
    expect(match(reference, {{1, 0, 6}, {2, 0, 6}}, kSixMove, kRules), 2, 0, 0);
}

}  // namespace
}  // namespace carom::trade
