// The queue of next events against a sorted set, on patterns of keys that are hard on a calendar.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <carom/core/event_queue.hpp>

#include "core/limits.hpp"
#include "core/random.hpp"

namespace carom::test {
namespace {

/// A queue and the set that says what it has to answer.
class Checked {
 public:
    explicit Checked(std::uint32_t count) : queue(count) { restart(count); }

    void restart(std::uint32_t count) {
        keys_.assign(count, kInfinity);
        order_.clear();
    }
    void append() { keys_.push_back(kInfinity); }
    void remember(std::uint32_t id, double key) {
        if (keys_[id] < kInfinity) order_.erase({keys_[id], id});
        if (key < kInfinity) order_.insert({key, id});
        keys_[id] = key;
    }
    void put(std::uint32_t id, double key) {
        remember(id, key);
        queue.put(id, key);
    }
    void set(std::uint32_t id, double key) {
        remember(id, key);
        queue.set(id, key);
    }
    [[nodiscard]] double least() const { return order_.empty() ? kInfinity : order_.begin()->first; }
    [[nodiscard]] std::uint32_t first() const { return order_.begin()->second; }

    /// Takes the first entry out.
    void take() {
        const std::uint32_t id = first();
        remember(id, kInfinity);
        queue.take(id);
    }

    /// Whether every answer is the set's.
    void check() {
        ASSERT_EQ(queue.first_key(), least());
        if (order_.empty()) return;
        const EventQueue::Front front = queue.front();
        ASSERT_EQ(front.key, least());
        ASSERT_EQ(keys_[front.id], least());
        ASSERT_EQ(queue.first(), first());
        const auto second = std::next(order_.begin());
        const bool is_tied = second != order_.end() && second->first == least();
        if (!is_tied) return;
        ASSERT_TRUE(front.other != front.id || front.may_be_more);
        const auto third = std::next(second);
        ASSERT_TRUE(front.may_be_more || third == order_.end() || third->first > least());
        std::set<std::uint32_t> told;
        queue.for_each_first([&](std::uint32_t id) { ASSERT_TRUE(told.insert(id).second); });
        std::uint32_t last = 0;
        auto place = order_.begin();
        for (const std::uint32_t id : told) {
            ASSERT_TRUE(place != order_.end() && *place == std::pair(least(), id));
            last = (place++)->second;
        }
        ASSERT_TRUE(place == order_.end() || place->first > least());
        ASSERT_EQ(queue.first([](std::uint32_t id) { return ~id; }), last);  // ranks the other way round
    }

    EventQueue queue;

 private:
    std::vector<double> keys_;
    std::set<std::pair<double, std::uint32_t>> order_;
};

/// What the first entry's key becomes, at a time `now` that is its old one.
using Next = double (*)(Random& random, double now);

/// As an engine does: the first entry and sometimes another one get new keys, none in the past.
void run(std::uint32_t count, int changes, Next next) {
    Random random(count);
    Checked q(count);
    for (std::uint32_t id = 0; id < count; ++id) q.put(id, next(random, 0));
    q.queue.rebuild();
    for (int k = 0; k < changes && q.least() < kInfinity; ++k) {
        ASSERT_NO_FATAL_FAILURE(q.check()) << "change " << k << " of " << count;
        const double now = q.least();
        const std::uint32_t first = q.first();
        if (k % 2 == 0) q.take();
        if (k % 5 == 0) {
            ASSERT_NO_FATAL_FAILURE(q.check()) << "in change " << k << " of " << count;
        }
        q.set(first, next(random, now));
        if (k % 3 == 0) q.set(static_cast<std::uint32_t>(random.uniform(0, 1) * count), next(random, now));
    }
}

TEST(EventQueueAgainstASet, SteadyKeys) {
    for (const std::uint32_t count : {1U, 2U, 5U, 64U, 1000U})
        run(count, 20'000, [](Random& r, double now) { return now + r.uniform(0, 1); });
}

TEST(EventQueueAgainstASet, KeysThatAreAllEqual) {
    for (const std::uint32_t count : {3U, 64U, 1000U})
        run(count, 5'000, [](Random&, double now) { return std::floor(now) + 1; });
}

TEST(EventQueueAgainstASet, KeysThatRiseByOneUlp) {
    for (const std::uint32_t count : {2U, 64U, 1000U})
        run(count, 10'000, [](Random& r, double now) {
            return now == 0 ? 1 : r.sign() > 0 ? now : std::nextafter(now, kInfinity);
        });
}

// A thousand events within 10^-9 of a time, then nothing for a time 10^12 as long.
TEST(EventQueueAgainstASet, Bursts) {
    run(300, 20'000, [](Random& r, double now) {
        return r.uniform(0, 1) < 1e-3 ? now + 1000 : now + 1e-12 * r.uniform(0, 1);
    });
}

TEST(EventQueueAgainstASet, StepsOfAllSizes) {
    for (const std::uint32_t count : {7U, 500U})
        run(count, 20'000, [](Random& r, double now) { return now + r.decades(-30, 5); });
}

// Times at which doubles have run out of digits, and the largest of them.
TEST(EventQueueAgainstASet, KeysAtTheEndsOfTheRange) {
    run(100, 5'000, [](Random& r, double now) { return now + 1e-320 * r.uniform(0, 9); });
    run(100, 5'000, [](Random& r, double) { return r.uniform(0, std::numeric_limits<double>::max()); });
}

TEST(EventQueueAgainstASet, KeysBelowThePresentDay) {
    for (const std::uint32_t count : {10U, 400U}) {
        Random random(count);
        Checked q(count);
        for (int k = 0; k < 20'000; ++k) {
            q.set(static_cast<std::uint32_t>(random.uniform(0, count)),
                  random.sign() * random.decades(-3, 3));
            ASSERT_NO_FATAL_FAILURE(q.check());
        }
    }
}

TEST(EventQueueAgainstASet, UsedAgainWithAnotherCount) {
    Checked q(1);
    Random random(11);
    for (const std::uint32_t count : {1000U, 3U, 1U, 64U, 5000U, 2U}) {
        q.queue.reset(count);
        q.restart(count);
        for (std::uint32_t id = 0; id < count; id += 2) q.put(id, random.uniform(5, 6));
        q.queue.rebuild();
        for (int k = 0; k < 2000; ++k) {
            ASSERT_NO_FATAL_FAILURE(q.check());
            q.set(q.first(), q.least() + random.uniform(0, 0.01));
        }
    }
}

// What is entered then must find its day among the few of now; only checked indices tell where it does not.
TEST(EventQueueAgainstASet, UsedAgainByFewerWithNothingToCome) {
    Checked q(1000);
    for (std::uint32_t id = 0; id < 1000; ++id) q.put(id, id);
    q.queue.rebuild();
    ASSERT_NO_FATAL_FAILURE(q.check());
    q.queue.reset(3);
    q.restart(3);
    q.queue.rebuild();
    ASSERT_NO_FATAL_FAILURE(q.check());
    for (const double key : {kInfinity, 2000.0, 999.0, kInfinity, -1.0}) {
        q.set(1, key);
        ASSERT_NO_FATAL_FAILURE(q.check());
    }
}

TEST(EventQueueAgainstASet, GrowsWhileItRuns) {
    Checked q(5);
    Random random(13);
    for (std::uint32_t id = 0; id < 5; ++id) q.put(id, random.uniform(0, 1));
    q.queue.rebuild();
    for (std::uint32_t count = 5; count < 2000; ++count) {
        q.queue.append();
        q.append();
        ASSERT_NO_FATAL_FAILURE(q.check());
        q.set(count, q.least() + random.uniform(0, 1));
        for (int k = 0; k < 3; ++k) {
            ASSERT_NO_FATAL_FAILURE(q.check());
            q.set(q.first(), q.least() + random.uniform(0, 1));
        }
    }
}

// The last key before a year's end, whose day rounds up to one beyond the year: 0 and a median that is the
// year's length, then two ids with the largest key below it, the second set when the last day is at hand.
TEST(EventQueueAgainstASet, ATieAtTheEndOfAYear) {
    constexpr std::uint32_t kCount = 22;  // as many days, no power of two
    Random random(12);
    int beyond = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const double end = random.uniform(1.5, 2);
        const double last = std::nextafter(end, 0);
        if (last * (kCount / end) >= kCount) ++beyond;
        Checked q(kCount);
        for (std::uint32_t id = 0; id < kCount; ++id) q.put(id, id == 0 ? 0 : id == 7 ? last : end);
        q.queue.rebuild();
        q.check();
        q.set(0, kInfinity);
        q.check();  // now the last day is at hand
        q.set(3, last);
        ASSERT_NO_FATAL_FAILURE(q.check()) << "year of " << end;
        q.set(5, 2 * end);  // what lies beyond the year stays there
        q.set(5, 3 * end);
        ASSERT_NO_FATAL_FAILURE(q.check()) << "year of " << end;
    }
    EXPECT_GT(beyond, 0);  // else nothing was tried
}

// Keys that differ are not said to be tied, be they in one day or in the crowd: whoever asks would look at
// them for nothing.
TEST(EventQueue, TellsNoTiesWhereThereAreNone) {
    for (const double far : {0.02, 1e12}) {  // and so the days are short, or long
        constexpr std::uint32_t kCount = 200;
        EventQueue queue(kCount);
        for (std::uint32_t id = 0; id < kCount; ++id)
            queue.put(id, id < kCount / 4 ? (id * 7 % 50 + 1) / 50.0 : far * (1 + id));
        queue.rebuild();
        EXPECT_EQ(queue.crowd() > 0, far > 1);
        for (std::uint32_t k = 0; k < kCount / 4; ++k) {
            const EventQueue::Front front = queue.front();
            ASSERT_EQ(front.key, (k + 1) / 50.0);
            ASSERT_EQ(front.other, front.id);
            ASSERT_FALSE(front.may_be_more);
            queue.take(front.id);
        }
    }
}

// Three that move among 10^5 that rest, and one: a year costs all of them and must bring many events. The
// first may bring one; from then on it is as long as the last step and grows fourfold each time that it
// brings too few: past all 20,000 steps within log4(20,000) + 3 years, and twice as many where one was short.
TEST(EventQueue, BeginsFewYearsWhereFewMove) {
    for (const std::uint32_t movers : {1U, 3U}) {
        constexpr std::uint32_t kCount = 100'000;
        EventQueue queue(kCount);
        for (std::uint32_t k = 0; k < movers; ++k) queue.put(1777 + 31'001 * k, 1 + 0.1 * k);
        queue.rebuild();
        const std::uint64_t before = queue.years();
        Random random(movers);
        for (int k = 0; k < 20'000; ++k) {
            const std::uint32_t id = queue.first();
            const double now = queue.first_key();
            ASSERT_EQ(id % 31'001, 1777U);
            queue.take(id);
            queue.set(id, now + random.uniform(0, 1));
        }
        EXPECT_LT(queue.years() - before, 24U);
    }
}

// Of 1000 keys spread evenly, in no order, a year's first guess is up to the median of a sample of 64: the
// middle, by 4 sigma of such a median (1/16 of all) and a half of what a stride of whole numbers leaves out
// (64 of 1000). Keys that never come are no part of it, nor do the unit and the start matter.
TEST(EventQueue, BeginsWithAYearOfHalfTheKeys) {
    constexpr std::uint32_t kCount = 1000;
    for (const double unit : {1e-9, 1.0, 1e9})
        for (const double start : {0.0, 1e6})
            for (const std::uint32_t coming : {1000U, 400U}) {
                EventQueue queue(kCount);
                for (std::uint32_t id = 0; id < kCount; ++id) {
                    const std::uint32_t place = id * 7919 % kCount;  // 7919 and 1000 have no common factor
                    queue.put(id, place < coming ? (start + place) * unit : kInfinity);
                }
                queue.rebuild();
                EXPECT_NEAR(static_cast<double>(queue.entries()), coming / 2.0, (0.25 + 0.032) * coming);
                EXPECT_EQ(queue.first_key(), start * unit);
                EXPECT_EQ(queue.crowd(), 0U) << "keys are spread over the days, no more than two in one";
            }
}

// A year brings one event for each entry. Its length follows the last one's number of events, whose scatter
// of sqrt(1000) averages out over a hundred years; the first few years and the guess with which they begin
// weigh some per cent.
TEST(EventQueue, AYearBringsOneEventForEachEntry) {
    constexpr std::uint32_t kCount = 1000;
    constexpr int kEvents = 100'000;
    for (const double unit : {1e-6, 1.0, 1e6}) {
        EventQueue queue(kCount);
        Random random(14);
        for (std::uint32_t id = 0; id < kCount; ++id) queue.put(id, random.uniform(0, unit));
        queue.rebuild();
        EXPECT_EQ(queue.years(), 2U) << "one that brings nothing, at the construction";
        std::size_t most = 0;
        for (int k = 0; k < kEvents; ++k) {
            const std::uint32_t id = queue.first();
            const double now = queue.first_key();
            queue.take(id);
            queue.set(id, now + random.uniform(0, unit));
            most = std::max(most, queue.entries());
        }
        EXPECT_NEAR(static_cast<double>(queue.years()), kEvents / double(kCount), 10);
        // An id has one entry in the year, and the crowd what is stale as well.
        EXPECT_LE(most, kCount + kCount / 2);
    }
}

// Of keys so near each other that all find their day full, the crowd keeps four an id at most before the
// year begins anew, and 64.
TEST(EventQueue, KeepsTheCrowdSmall) {
    for (const std::uint32_t count : {10U, 1000U}) {
        EventQueue queue(count);
        for (std::uint32_t id = 0; id < count; ++id) queue.put(id, id == 0 ? 1 : 1e9);
        queue.rebuild();
        Random random(15);
        std::size_t most = 0;
        for (int k = 0; k < 100'000; ++k) {
            queue.set(1 + static_cast<std::uint32_t>(random.uniform(0, count - 1)),
                      1 + random.uniform(0, 1e-9));
            ASSERT_GE(queue.first_key(), 1);
            most = std::max(most, queue.crowd());
        }
        EXPECT_GT(most, count);
        EXPECT_LE(most, 4 * count + 64 + 1);
    }
}

// The same where keys are far apart.
TEST(EventQueue, StaysSmall) {
    for (const std::uint32_t count : {10U, 1000U}) {
        EventQueue queue(count);
        Random random(13);
        std::size_t most = 0;
        for (int k = 0; k < 500'000; ++k) {
            const auto id = static_cast<std::uint32_t>(random.uniform(0, count));
            queue.set(id, queue.first_key() < kInfinity ? queue.first_key() + random.uniform(0, 1) : 1);
            most = std::max(most, queue.entries());
        }
        EXPECT_LE(most, count + 4 * count + 64 + 1);
    }
}

}  // namespace
}  // namespace carom::test
