// The claims of docs/accuracy.md with small counts, one test a kind: no impact is missed or invented where
// the inputs' own rounding does not decide, times are right to a few units of the problem's condition, the
// oracles agree with each other, the response keeps what it must.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <carom/core/disc_time.hpp>

#include "accuracy/exact.hpp"
#include "accuracy/response_accuracy.hpp"
#include "accuracy/wall_accuracy.hpp"

namespace carom::accuracy {

// GoogleTest's name for a kind where a test fails.
void PrintTo(const DiscKind& kind, std::ostream* out) {
    *out << kind.name;
}
void PrintTo(const WallKind& kind, std::ostream* out) {
    *out << kind.name;
}
void PrintTo(const ResponseKind& kind, std::ostream* out) {
    *out << kind.name;
}

namespace {

constexpr Effort kEffort{2000, 100};

/// A kind's name in the letters that a test's name may have.
template <class Kind>
std::string name_of(const testing::TestParamInfo<Kind>& info) {
    std::string name;
    for (const char c : info.param.name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

void expect_no_wrong_verdict(const Tally& tally) {
    EXPECT_EQ(tally.missed, 0);
    EXPECT_EQ(tally.invented, 0);
    EXPECT_EQ(tally.unconfirmed, 0) << "the oracles contradict each other";
    // Else the test has lost its subject.
    EXPECT_GT(tally.hits, tally.queries / 10);
}

class Straight : public testing::TestWithParam<DiscKind> {};

// c, D, its root, b, their sum and the quotient: each at most two roundings of half an ulp, twice that where
// the time's mantissa is small, and what is lost in b and D the unit counts as change of an input.
TEST_P(Straight, TimesAreRightToAFewUnits) {
    SCOPED_TRACE("seed 51");
    Tally tally = measure(GetParam(), 51, kEffort);
    expect_no_wrong_verdict(tally);
    EXPECT_LE(quantile(tally.in_units, 1), 8);
    EXPECT_LE(quantile(tally.in_units, 0.5), 1);
    // The unit forgives much near contact and in a graze; the code does not need it: six roundings of either
    // sign come to an ulp, two half ulps, now and then. A gap of 1e-17 has lost digits even in twice as many.
    if (GetParam().name != "start in contact") {
        EXPECT_LE(quantile(tally.relative, 0.5), 2);
    }
}

INSTANTIATE_TEST_SUITE_P(DiscAccuracy, Straight, testing::ValuesIn(straight_kinds()), name_of<DiscKind>);

class Curved : public testing::TestWithParam<DiscKind> {};

// The search ends within an ulp of a root of f in twice the digits: two units at most. A turning point in
// overlap is a root of a cubic whose four coefficients are rounded up to three times: four.
TEST_P(Curved, TimesAreRightToAFewUnits) {
    SCOPED_TRACE("seed 52");
    Tally tally = measure(GetParam(), 52, kEffort);
    expect_no_wrong_verdict(tally);
    EXPECT_LE(quantile(tally.in_units, 1), 4);
    EXPECT_LE(quantile(tally.in_units, 0.5), 0.5);
    // In most cases the root rounded, half an ulp away at the most.
    EXPECT_LE(quantile(tally.relative, 0.5), 1);
}

INSTANTIATE_TEST_SUITE_P(DiscAccuracy, Curved, testing::ValuesIn(curved_kinds()), name_of<DiscKind>);

class Walls : public testing::TestWithParam<WallKind> {};

// The face's direction, the height above it and the speed towards it: some three roundings each of sums of
// two products, where the unit has two of the largest coordinate.
TEST_P(Walls, TimesAreRightToAFewUnits) {
    SCOPED_TRACE("seed 53");
    Tally tally = measure(GetParam(), 53, kEffort);
    expect_no_wrong_verdict(tally);
    EXPECT_EQ(tally.open, 0);
    EXPECT_LE(quantile(tally.in_units, 1), 6);
    EXPECT_LE(quantile(tally.in_units, 0.5), 0.5);
}

INSTANTIATE_TEST_SUITE_P(WallAccuracy, Walls, testing::ValuesIn(wall_kinds()), name_of<WallKind>);

// Two methods that share nothing, on what the tables rest on; a hit, a touch, a miss, and four roots.
TEST(Oracle, ExactFractionsKnowTheClosedForms) {
    const auto exact = [](const DiscQuery& q) { return exact_truth(q); };
    EXPECT_EQ(static_cast<double>(exact({{-5, 0}, {2, 0}, {0, 0}, 1}).time), 2);
    EXPECT_EQ(exact({{3, 1}, {-1, 0}, {0, 0}, 1}).verdict, Verdict::kMiss);
    EXPECT_EQ(exact({{3, 2}, {-1, 0}, {0, 0}, 1}).verdict, Verdict::kMiss);
    EXPECT_EQ(static_cast<double>(exact({{-3, -16}, {1, 12}, {0, -4}, 1}).time), 2);
    const Truth turning = exact({{0, 0.5}, {0, 0.25}, {0, -1}, 1});
    EXPECT_TRUE(turning.turning);
    EXPECT_EQ(static_cast<double>(turning.time), 0.25);
}

TEST(Oracle, QuadAndExactFractionsAgreeOnEveryKind) {
    SCOPED_TRACE("seed 54");
    for (const auto& kinds : {straight_kinds(), curved_kinds()}) {
        for (const DiscKind& kind : kinds) {
            test::Random random(54);
            for (int i = 0; i < 5; ++i) {
                const DiscQuery q = kind.make(random);
                const Truth fast = quad_truth(q);
                if (fast.verdict == Verdict::kUndecided) continue;
                const Truth slow = exact_truth(q);
                ASSERT_EQ(fast.verdict, slow.verdict) << kind.name << ", case " << i;
                if (fast.verdict != Verdict::kHit || slow.time == 0) continue;
                // What the fast one promises.
                ASSERT_LE(static_cast<Wide>(magnitude(fast.time - slow.time)),
                          1e-4L * condition(q, slow).time)
                    << kind.name << ", case " << i;
            }
        }
    }
}

// The quartic's time is right to two units on both sides of where it hands over to the quadratic (2^-485),
// and the quadratic's to eight.
TEST(Seam, QuarticJoinsTheQuadratic) {
    for (const double low : {-300, -200, -150, -146, -140, -100, -30, -10}) {
        const Seam seam = measure_seam(low, low + 6, 55, 1500);
        EXPECT_EQ(seam.verdicts_differ, 0) << low;
        EXPECT_LE(seam.worst_in_units, low < -140 ? 8 : 2) << low;
        // Both within some ulp of the truth, so of each other.
        EXPECT_LE(seam.worst_seam, 8 * std::numeric_limits<double>::epsilon()) << low;
        EXPECT_GT(seam.hits, 1000) << low;
    }
}

class Response : public testing::TestWithParam<ResponseKind> {};

// Momentum: one impulse, so that only the quotients by the masses and the stored velocities round; the unit
// is the sum of just these. Energy and speeds: twelve roundings, of velocities up to twice those before.
TEST_P(Response, KeepsMomentumEnergyAndSpeeds) {
    SCOPED_TRACE("seed 56");
    ResponseTally tally = measure(GetParam(), 56, 20000);
    EXPECT_LE(quantile(tally.momentum, 1), 1.001);
    EXPECT_LE(quantile(tally.energy, 1), 12);
    EXPECT_LE(quantile(tally.energy, 0.5), 1);
    EXPECT_LE(quantile(tally.separation, 1), 12);
    EXPECT_LE(quantile(tally.tangent, 1), 6);
    EXPECT_EQ(tally.approaching, 0);
}

INSTANTIATE_TEST_SUITE_P(ResponseAccuracy, Response, testing::ValuesIn(response_kinds()),
                         name_of<ResponseKind>);

TEST(Bounce, KeepsEnergyAndSpeeds) {
    SCOPED_TRACE("seed 59");
    for (const double e_least : {1.0, 0.0}) {
        ResponseTally tally = measure_bounce("", e_least, 59, 20000);
        EXPECT_LE(quantile(tally.energy, 1), 12);
        EXPECT_LE(quantile(tally.energy, 0.5), 1);
        EXPECT_LE(quantile(tally.separation, 1), 12);
        EXPECT_LE(quantile(tally.tangent, 1), 6);
        EXPECT_EQ(tally.approaching, 0);
    }
}

// A duration cuts off what comes later, and nothing else: not by an ulp.
TEST(Duration, NeverCutsOffAHit) {
    SCOPED_TRACE("seed 60");
    for (const auto& kinds : {straight_kinds(), curved_kinds()}) {
        for (const DiscKind& kind : kinds) {
            test::Random random(60);
            for (int i = 0; i < 5000; ++i) {
                const DiscQuery q = kind.make(random);
                const double t = disc_time_of_impact<double>(q.r, q.v, q.a, q.s);
                const auto within = [&](double duration) {
                    return disc_time_of_impact<double>(q.r, q.v, q.a, q.s, duration);
                };
                ASSERT_EQ(within(t), t) << kind.name << ", case " << i;
                if (t < kNever && t > 0) {
                    ASSERT_EQ(within(std::nextafter(t, 0.0)), kNever) << kind.name << ", case " << i;
                }
            }
        }
    }
}

// Sixteen runs: their root mean square stays within a random walk's sigma (which counts every rounding at its
// largest) and four of its standard errors (sigma / sqrt(32)); their mean shows no way that it prefers.
TEST(Drift, EnergyWalksNoFasterThanRounding) {
    constexpr int kRuns = 16;
    const std::vector<std::int64_t> counts = {3000, 30000};
    for (const int discs : {2, 256}) {
        std::vector<double> squares(counts.size()), mean(counts.size());
        for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
            const std::vector<double> changes = energy_changes(discs, counts, 57 + seed);
            for (std::size_t i = 0; i < counts.size(); ++i) {
                squares[i] += changes[i] * changes[i] / kRuns;
                mean[i] += changes[i] / kRuns;
            }
        }
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const double sigma = random_walk(discs, counts[i]);
            EXPECT_LE(std::sqrt(squares[i]), sigma * (1 + 4 / std::sqrt(2.0 * kRuns))) << discs << ", " << i;
            EXPECT_LE(std::abs(mean[i]), 4 * sigma / std::sqrt(kRuns)) << discs << ", " << i;
        }
    }
}

// Every rule gives a number between the two (the product below both), each to its roundings.
TEST(Restitution, RulesAreRightToTheirRoundings) {
    test::Random random(58);
    for (int i = 0; i < 20000; ++i) {
        const double a = random.sign() > 0 ? random.uniform(0, 1) : 1 - random.decades(-16, 0);
        const double b = random.sign() > 0 ? random.uniform(0, 1) : random.decades(-300, 0);
        const auto by = [&](RestitutionRule rule) { return pair_restitution<double>(rule, a, b); };
        const Quad product = Quad(a) * Quad(b);
        ASSERT_EQ(by(RestitutionRule::kMin), std::min(a, b));
        ASSERT_EQ(by(RestitutionRule::kMax), std::max(a, b));
        ASSERT_EQ(by(RestitutionRule::kProduct), static_cast<double>(product));
        ASSERT_EQ(by(RestitutionRule::kMean), static_cast<double>((Quad(a) + Quad(b)) / 2));
        const double geometric = by(RestitutionRule::kGeometric);
        // Two roundings, the first halved by the root: less than an ulp.
        ASSERT_LE(magnitude(Quad(geometric) - square_root(product)), Quad(0x1p-52) * Quad(geometric))
            << a << ' ' << b;
        ASSERT_GE(geometric, std::min(a, b) * (1 - 0x1p-52));
        ASSERT_LE(geometric, std::max(a, b) * (1 + 0x1p-52));
    }
}

}  // namespace
}  // namespace carom::accuracy
