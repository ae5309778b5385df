// How many steps the searches for a time of impact take, and that none is begun where a glance says that
// there is no impact: what no test of results can see.
#include <carom/core/disc_time.hpp>
#include <carom/core/wall_time.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "core/counted.hpp"
#include "core/random.hpp"

namespace carom {
namespace {

using test::Counted;
using test::Random;
using CountedVector = Vector2<Counted>;

/// Searches of which each takes `absolutes_a_step` absolute values a step: hardly any may take more steps
/// than `most`. Hardly: where rounding leaves two neighbours, the steps may go to and fro between them.
template <class Search>
void expect_few_steps(int most, int absolutes_a_step, Search&& search) {
    constexpr int kCount = 20000;
    int slow = 0;
    for (int i = 0; i < kCount; ++i) {
        Counted::absolutes = 0;
        search();
        slow += Counted::absolutes > most * absolutes_a_step ? 1 : 0;
    }
    EXPECT_LE(slow, kCount / 50);
}

// The start is above the root, by a factor of 3 if the term of first order is the largest of the three,
// 3^(1/2) if it is the second, and 2 * 3^(1/3) < 2.9 if it is the third. Newton's step divides what is above
// a cube's root x by 3/2 at least: 2.9, 1.98, 1.41, 1.11, 1.01; from there the digits double: 1e-4, 1e-8,
// 1e-16; and one step confirms. In any units.
TEST(Steps, OfTheLastRootOfACubic) {
    SCOPED_TRACE("seed 71");
    Random random(71);
    expect_few_steps(9, 2, [&] {
        const double unit = random.decades(-20, 20);
        const double scale = random.decades(-20, 20);
        const Cubic<Counted> g{-scale * random.decades(-3, 3), scale / unit * random.decades(-3, 3),
                               scale / unit / unit * random.decades(-3, 3), scale / unit / unit / unit};
        (void)detail::last_root<Counted>(g, 0);
    });
}

// The same from the bottom between two turning points on: there the first order is 0.
TEST(Steps, OfTheLastRootBeyondATurningPoint) {
    SCOPED_TRACE("seed 72");
    Random random(72);
    expect_few_steps(9, 2, [&] {
        const double c2 = random.sign() * random.decades(-3, 3);
        const double c1 = -c2 * c2 / 3 * random.uniform(0, 1);
        const double bottom = (-c2 + std::sqrt(c2 * c2 - 3 * c1)) / 3;
        (void)detail::last_root<Counted>({-random.decades(-3, 3), c1, c2, 1}, bottom);
    });
}

/// A time at which the discs of radii's sum 1 overlap, before they part again; 0 where none is found.
double time_in_overlap(const Vec2& r, const Vec2& v, const Vec2& a) {
    for (double t = 0; t < 100; t += 0.01) {
        const Vec2 x = r + v * t + a * (t * t / 2);
        if (x.dot(v + a * t) >= 0) return 0;
        if (x.squaredNorm() < 0.8) return t;
    }
    return 0;
}

// Third order: once one digit is right, 3, 9, 27 are, and a step confirms; five steps for the first digit.
TEST(Steps, OfARootOfTheQuartic) {
    SCOPED_TRACE("seed 73");
    Random random(73);
    int hits = 0;
    expect_few_steps(9, 1, [&] {
        const Vec2 r = random.direction(random.uniform(1.5, 10));
        const Vec2 v = -r * random.uniform(0.1, 2) + random.vector(1);
        const Vec2 a = random.direction(random.decades(-3, 0.5));
        const double inside = time_in_overlap(r, v, a);
        if (inside == 0) return;
        ++hits;
        const detail::DiscQuartic<Counted> quartic(CountedVector(r.x(), r.y()), CountedVector(v.x(), v.y()),
                                                   CountedVector(a.x(), a.y()), 1);
        (void)quartic.falling_root(0, inside);
    });
    EXPECT_GT(hits, 5000);
}

// A hundredth beyond what speed and acceleration bridge within the duration: no root is taken. A hundredth
// nearer one is.
TEST(Steps, NoneWhereTheDiscsCannotReachEachOther) {
    for (const double a : {0.0, 0.5, 30.0})
        for (const double duration : {0.1, 1.0, 7.0})
            for (const double share : {0.99, 1.01})
                for (const bool along_x : {true, false}) {
                    const double reach = share * (1 + 3 * duration + a * duration * duration / 2);
                    const auto along = [&](double x) {
                        return along_x ? CountedVector(x, 0) : CountedVector(0, x);
                    };
                    Counted::roots = 0;
                    (void)disc_time_of_impact<Counted>(along(reach), along(-3), along(-a), 1, duration);
                    EXPECT_EQ(Counted::roots == 0, share > 1) << a << ' ' << duration;
                }
}

// Away from a wall's line for ever, with the foot of the perpendicular on its way past both ends.
TEST(Steps, NoneWhereADiscLeavesAWallsLine) {
    const auto roots = [](double height, double speed) {
        Counted::roots = 0;
        (void)wall_time_of_impact<Counted>({{-3, height}, {1, speed}, {0.5, 0.25}}, 1, CountedVector(-2, 0),
                                           CountedVector(2, 0));
        return Counted::roots;
    };
    EXPECT_EQ(roots(1.5, 1), 0);
    EXPECT_EQ(roots(9, 0), 0);
    EXPECT_GT(roots(1.5, -2), 0);
}

}  // namespace
}  // namespace carom
