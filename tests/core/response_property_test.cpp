// Properties of the response on random pairs: momentum, energy, the speed asked for, and no pair left
// approaching, for all masses.
#include <carom/core/response.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/limits.hpp"
#include "core/many_digits.hpp"
#include "core/random.hpp"

namespace carom {
namespace {

using test::Big;
using test::BigVector;
using test::kEpsilon;
using test::Random;

struct Pair {
    Vec2 va, vb, offset;
    double mass_a, mass_b, e;
};

Pair approaching_pair(Random& random, double mass_decades) {
    Pair p{random.vector(1),
           random.vector(1),
           random.direction(random.decades(-3, 3)),
           random.decades(-mass_decades, mass_decades),
           random.decades(-mass_decades, mass_decades),
           random.sign() > 0 ? 1.0 : random.uniform(0, 1)};
    if (dot<double>(p.offset, Vec2(p.va - p.vb)) > 0) p.offset = -p.offset;
    return p;
}

PairVelocities<double> respond(const Pair& p, double separation_speed = 0) {
    return collide<double>(p.va, p.vb, p.offset, p.mass_a, p.mass_b, p.e, separation_speed);
}

// Each new component is one rounding of an impulse of a few roundings: a few ulp of the largest momentum,
// mass by mass.
TEST(ResponseProperty, KeepsMomentumAndElasticEnergy) {
    SCOPED_TRACE("seed 41");
    Random random(41);
    for (int i = 0; i < 20000; ++i) {
        const Pair p = approaching_pair(random, i % 2 == 0 ? 1 : 15);
        const auto after = respond(p);
        const Big ma(p.mass_a);
        const Big mb(p.mass_b);
        const BigVector before = test::big(p.va) * ma + test::big(p.vb) * mb;
        const BigVector change = test::big(after.a) * ma + test::big(after.b) * mb - before;
        const double scale = std::max(p.mass_a * std::max(p.va.norm(), after.a.norm()),
                                      p.mass_b * std::max(p.vb.norm(), after.b.norm()));
        ASSERT_LE(abs(change.x()), 4 * kEpsilon * scale) << i;
        ASSERT_LE(abs(change.y()), 4 * kEpsilon * scale) << i;
        if (p.e < 1) continue;
        const auto energy = [&](const Vec2& a, const Vec2& b) {
            return Big(ma * dot<Big>(test::big(a), test::big(a)) + mb * dot<Big>(test::big(b), test::big(b)));
        };
        const Big first = energy(p.va, p.vb);
        // The light body may gain from the heavy one's hoard: rounding of the larger energy counts.
        ASSERT_LE(abs(energy(after.a, after.b) - first), 32 * kEpsilon * first) << i;
    }
}

TEST(ResponseProperty, GivesTheSpeedAskedForAndTurnsNoTangent) {
    SCOPED_TRACE("seed 42");
    Random random(42);
    for (int i = 0; i < 20000; ++i) {
        const Pair p = approaching_pair(random, 2);
        const double least = i % 2 == 0 ? 0 : random.decades(-6, 0);
        const auto after = respond(p, least);
        const BigVector n = test::big(p.offset) / sqrt(dot<Big>(test::big(p.offset), test::big(p.offset)));
        const Big approach = -dot<Big>(n, BigVector(test::big(p.va) - test::big(p.vb)));
        const Big parting = dot<Big>(n, BigVector(test::big(after.a) - test::big(after.b)));
        const Big asked = std::max(Big(p.e * approach), Big(least));
        ASSERT_LE(abs(parting - asked), 32 * kEpsilon) << i;
        ASSERT_LE(abs(cross<Big>(n, test::big(after.a)) - cross<Big>(n, test::big(p.va))), 32 * kEpsilon)
            << i;
        ASSERT_LE(abs(cross<Big>(n, test::big(after.b)) - cross<Big>(n, test::big(p.vb))), 32 * kEpsilon)
            << i;
    }
}

// Fast together and slow towards each other: the impulse is below the rounding of the velocities.
Pair hardly_approaching_pair(Random& random) {
    Pair p = approaching_pair(random, 15);
    p.va = random.direction(random.decades(-3, 12));
    p.vb = p.va + random.direction(p.va.norm() * random.decades(-17, -12));
    if (dot<double>(p.offset, Vec2(p.va - p.vb)) > 0) p.offset = -p.offset;
    if (random.sign() > 0) p.e = 0;
    return p;
}

TEST(ResponseProperty, NeverLeavesAPairApproaching) {
    SCOPED_TRACE("seed 43");
    Random random(43);
    for (int i = 0; i < 100000; ++i) {
        const Pair p = i % 2 == 0 ? hardly_approaching_pair(random) : approaching_pair(random, 15);
        const auto after = respond(p);
        const double rate = dot<double>(p.offset, Vec2(after.a - after.b));
        ASSERT_GE(rate, 0) << i;
        ASSERT_TRUE(rate > 0 || p.e == 0 || dot<double>(p.offset, Vec2(p.va - p.vb)) == 0) << i;
        const auto parted = respond(p, p.va.norm() * random.decades(-30, -10));
        ASSERT_GT(dot<double>(p.offset, Vec2(parted.a - parted.b)), 0) << i;
        // Not thrown apart either: some ulp of the velocities beyond the approach.
        const double approach = (p.va - p.vb).norm();
        ASSERT_LE((after.a - after.b).norm(), 8 * (approach + kEpsilon * p.va.norm())) << i;
    }
}

TEST(ResponseProperty, NeverLeavesABallApproachingAWall) {
    SCOPED_TRACE("seed 44");
    Random random(44);
    for (int i = 0; i < 100000; ++i) {
        const Vec2 normal = random.direction(random.decades(-3, 3));
        const Vec2 tangent(-normal.y(), normal.x());
        const Vec2 v = tangent * random.uniform(-1, 1) - normal * random.decades(-20, 0);
        const double e = i % 3 == 0 ? 1 : (i % 3 == 1 ? 0 : random.uniform(0, 1));
        const Vec2 after = bounce<double>(v, normal, e);
        ASSERT_GE(dot<double>(normal, after), 0) << i;
        ASSERT_GT(dot<double>(normal, bounce<double>(v, normal, e, v.norm() * 1e-20)), 0) << i;
        ASSERT_TRUE(e < 1 || std::abs(after.norm() - v.norm()) <= 8 * kEpsilon * v.norm()) << i;
    }
}

// Two elastic discs collide half a million times: with a normalised normal the energy would drift by some
// 1e-10, with a plain division by |offset|^2 by 2e-11 where that is 1 (4e-17 a collision).
TEST(ResponseProperty, EnergyDoesNotDrift) {
    SCOPED_TRACE("seed 45");
    constexpr int kCollisions = 500000;
    for (const double radius_sum : {1.0, 0.7, 1.3}) {
        for (const double mass : {1.0, 0.3, 7.1}) {
            Random random(45);
            Vec2 va(1, 0.3);
            Vec2 vb(-0.4, -0.2);
            const auto energy = [&] { return va.squaredNorm() + mass * vb.squaredNorm(); };
            const double first = energy();
            for (int i = 0; i < kCollisions; ++i) {
                Vec2 offset = random.direction(radius_sum);
                if (dot<double>(offset, Vec2(va - vb)) > 0) offset = -offset;
                const auto after = collide<double>(va, vb, offset, 1.0, mass, 1.0);
                va = after.a;
                vb = after.b;
            }
            // Some twelve roundings a collision, uniform within half an ulp (sigma eps / 3.5), walk at
            // random: four sigma. A drift of eps / 32 a collision is let pass; the two errors named above are
            // five and more times that.
            const double sigma = std::sqrt(12.0 * kCollisions) * kEpsilon / 3.5;
            EXPECT_NEAR(energy() / first, 1, 4 * sigma + kCollisions * kEpsilon / 32)
                << "radius sum " << radius_sum << ", mass " << mass;
        }
    }
}

}  // namespace
}  // namespace carom
