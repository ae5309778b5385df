// Times as epoch and offset, against many digits; and the queue of next events against a sorted list.
#include <carom/core/clock.hpp>

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <random>

#include <carom/core/event_queue.hpp>

namespace carom::test {
namespace {

using Many = boost::multiprecision::cpp_bin_float_100;

double uniform(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * (double(random() >> 11) * 0x1p-53);
}

Many exact(const Clock& clock, const Time& t) {
    return Many(clock.epoch_length()) * t.epoch + Many(t.offset);
}

TEST(Clock, EpochIsAPowerOfTwo) {
    EXPECT_EQ(Clock(1).epoch_length(), 1);
    EXPECT_EQ(Clock(1.99).epoch_length(), 1);
    EXPECT_EQ(Clock(100).epoch_length(), 64);
    EXPECT_EQ(Clock(0.3).epoch_length(), 0.25);
}

TEST(Clock, AfterRoundsOnceAndStaysInTheEpoch) {
    constexpr std::uint64_t kSeed = 1;
    std::mt19937_64 random(kSeed);
    const Clock clock(16);
    for (int k = 0; k < 100'000; ++k) {
        const Time t{static_cast<std::int32_t>(random() % 1'000'000), uniform(random, 0, 16)};
        const double duration = uniform(random, 0, 1) * std::exp2(uniform(random, -40, 20));
        const Time later = clock.after(t, duration);
        ASSERT_GE(later.offset, 0);
        ASSERT_LT(later.offset, 16);
        // One rounding of offset + duration, half an ulp of the sum.
        const double rounding = (t.offset + duration) * 0x1p-53;
        ASSERT_LE(abs(exact(clock, later) - exact(clock, t) - Many(duration)), Many(rounding));
        ASSERT_GE(later, t);
    }
}

TEST(Clock, TheEndOfAnEpochIsTheStartOfTheNext) {
    const Clock clock(16);
    EXPECT_EQ(clock.after({3, 12}, 4), (Time{4, 0}));
    EXPECT_EQ(clock.after({3, 0}, 32), (Time{5, 0}));
}

TEST(Clock, BeginsAtZeroWithEpochsOfOne) {
    EXPECT_EQ(Time(), (Time{0, 0}));
    EXPECT_EQ(Clock().epoch_length(), 1);
    EXPECT_EQ(Clock().after({0, 0.5}, 2), (Time{2, 0.5}));
}

TEST(Clock, CountsSeconds) {
    const Clock clock(16);
    EXPECT_EQ(clock.from_seconds(100), (Time{6, 4}));
    EXPECT_EQ(clock.to_seconds({6, 4}), 100);
    EXPECT_EQ(clock.since_epoch({6, 4}, 1), 84);
}

TEST(Clock, OrdersTimes) {
    const Time t{3, 0.5};
    EXPECT_FALSE(t < t || t > t);
    EXPECT_TRUE(t <= t && t >= t);
    EXPECT_TRUE((Time{3, 0.25} < t) && (Time{2, 0.75} < t) && (Time{4, 0} > t));
}

TEST(Clock, DifferenceUndoesAfter) {
    constexpr std::uint64_t kSeed = 2;
    std::mt19937_64 random(kSeed);
    const Clock clock(4);
    for (int k = 0; k < 100'000; ++k) {
        const Time t{static_cast<std::int32_t>(random() % 1'000'000), uniform(random, 0, 4)};
        const Time later = clock.after(t, uniform(random, 0, 100));
        const Many difference = exact(clock, later) - exact(clock, t);
        ASSERT_LE(abs(Many(clock.difference(later, t)) - difference),
                  Many(4 * 0x1p-53) + difference * 0x1p-53);
    }
}

TEST(Clock, NeverComesAfterAll) {
    const Clock clock(1);
    EXPECT_EQ(clock.after({5, 0.5}, std::numeric_limits<double>::infinity()), kNever);
    EXPECT_EQ(clock.after({5, 0.5}, 1e300), kNever);
    EXPECT_EQ(clock.after({kNever.epoch - 1, 0.5}, 1), kNever);
    EXPECT_LT((Time{kNever.epoch - 1, 0.5}), kNever);
    constexpr std::int64_t kEnd = std::int64_t(1) << 52;
    EXPECT_EQ(clock.after({kEnd - 2, 0.5}, 1), (Time{kEnd - 1, 0.5}));
    EXPECT_EQ(clock.after({kEnd - 1, 0.5}, 1), kNever);
    EXPECT_EQ(clock.since_epoch(kNever, 3), std::numeric_limits<double>::infinity());
}

TEST(Clock, SecondsSinceAnEpochKeepTheOrder) {
    constexpr std::uint64_t kSeed = 3;
    std::mt19937_64 random(kSeed);
    const Clock clock(8);
    for (int k = 0; k < 100'000; ++k) {
        const Time a{static_cast<std::int32_t>(random() % 3), uniform(random, 0, 8)};
        const Time b{static_cast<std::int32_t>(random() % 3), k % 5 == 0 ? a.offset : uniform(random, 0, 8)};
        if (a < b) {
            ASSERT_LE(clock.since_epoch(a, 1), clock.since_epoch(b, 1));
        }
        ASSERT_EQ(clock.since_epoch({1, a.offset}, 1), a.offset);
    }
}

TEST(EventQueue, KnowsWhatMayComeAfterTheFirst) {
    constexpr std::uint32_t kCount = 800;
    EventQueue queue(kCount);
    EXPECT_LT(queue.coming(), kCount);
    for (std::uint32_t id = 0; id < kCount; ++id) queue.put(id, kCount - id);
    queue.rebuild();
    std::uint32_t right = 0;
    for (std::uint32_t id = kCount - 1; id > 0; --id) {
        ASSERT_EQ(queue.first(), id);
        queue.take(id);
        ASSERT_EQ(queue.key(id), std::numeric_limits<double>::infinity());
        ASSERT_LT(queue.coming(), kCount);
        right += queue.coming() == id - 1 ? 1 : 0;
    }
    EXPECT_GE(right, kCount / 2);  // not where a year ends, or days are empty
}

TEST(EventQueue, HandsOutTheEarliestAndOfEqualsTheSmallestId) {
    constexpr std::uint64_t kSeed = 4;
    std::mt19937_64 random(kSeed);
    for (const std::uint32_t count : {1u, 2u, 3u, 7u, 8u, 100u}) {
        EventQueue queue(count);
        std::vector<double> keys(count, std::numeric_limits<double>::infinity());
        for (int step = 0; step < 5'000; ++step) {
            const auto id = static_cast<std::uint32_t>(random() % count);
            keys[id] = random() % 10 == 0 ? std::numeric_limits<double>::infinity()
                                          : double(random() % 50);  // many equal
            if (step % 100 == 99) {
                queue.put(id, keys[id]);
                queue.rebuild();
            } else {
                queue.set(id, keys[id]);
            }
            const auto least = std::min_element(keys.begin(), keys.end());
            ASSERT_EQ(queue.first_key(), *least);
            ASSERT_EQ(queue.first(), std::uint32_t(least - keys.begin()));
            ASSERT_EQ(queue.key(id), keys[id]);
        }
    }
}

}  // namespace
}  // namespace carom::test
