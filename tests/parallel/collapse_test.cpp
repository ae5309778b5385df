// Inelastic collapse: where it is known to happen it is refused or ended by the contact time, and where it is
// known not to happen nothing is changed.
#include <gtest/gtest.h>

#include <cmath>

#include <carom/parallel/world.hpp>

#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

/// Three discs in a line, their surfaces placed like the points at -1, 0 and 1.5, moving at 1, 0 and -1.
Scene three(double restitution, std::optional<double> contact_time) {
    Scene s;
    s.until = 100;
    s.contact_time = contact_time;
    s.balls.resize(3);
    const double x[] = {-2, 0, 2.5};
    for (int i = 0; i < 3; ++i) {
        s.balls[i].position = {x[i], 0};
        s.balls[i].velocity = {1.0 - i, 0};
        s.balls[i].restitution = restitution;
    }
    return s;
}

struct Points {
    std::uint64_t collisions = 0;
    long double v[3] = {1, 0, -1};
};

/// The three points on their own: pairs meet in turn until none approaches.
Points points(long double restitution) {
    Points p;
    long double x[] = {-1, 0, 1.5L};
    for (;;) {
        const auto until = [&](int k) {
            return p.v[k] > p.v[k + 1] ? (x[k + 1] - x[k]) / (p.v[k] - p.v[k + 1]) : HUGE_VALL;
        };
        const int k = until(0) <= until(1) ? 0 : 1;
        const long double t = until(k);
        if (t == HUGE_VALL) return p;
        for (int i = 0; i < 3; ++i) x[i] += t * p.v[i];
        const long double mean = (p.v[k] + p.v[k + 1]) / 2;
        const long double apart = restitution * (p.v[k] - p.v[k + 1]) / 2;
        p.v[k] = mean - apart;
        p.v[k + 1] = mean + apart;
        ++p.collisions;
    }
}

// Three points collapse below a restitution of 7 - 4 sqrt(3) = 0.0718 (McNamara and Young 1992). Above it
// they part after a finite number of collisions, and no contact time is needed to see it.
TEST(Collapse, ThreeAboveTheThresholdPart) {
    for (const double restitution : {0.0728, 0.08, 0.1, 0.3}) {
        World world(three(restitution, 0.0));
        world.advance_to(100);
        const Points expected = points(restitution);
        EXPECT_EQ(world.counts().ball_collisions, expected.collisions) << restitution;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(world.velocities()[i].x(), double(expected.v[i]), 1e-13) << restitution;
    }
}

// Below it the rounds shrink by a factor each, and without a contact time go on until the velocities differ
// by rounding only. Either the row is then at rest, or its hits at one instant never end and are refused.
TEST(Collapse, ThreeBelowTheThresholdRestOrAreRefusedWithoutAContactTime) {
    if (kIsSanitized) GTEST_SKIP() << "millions of the same collision";
    for (const double restitution : {0.03, 0.0708}) {
        World world(three(restitution, 0.0));
        try {
            world.advance_to(100);
            EXPECT_GT(world.counts().ball_collisions, 10u) << restitution;
            EXPECT_TRUE(world.validate().empty());
            for (const Vec2& v : world.velocities()) EXPECT_NEAR(v.x(), 0, 1e-15) << restitution;
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find("loses energy without a contact_time"),
                      std::string::npos)
                << error.what();
        }
    }
}

// Each round of a collapse is shorter than the one before by a factor, so that the number of collisions until
// the rounds last no longer than the contact time grows with its logarithm; those after it are elastic, and
// three elastic points have three collisions at most.
TEST(Collapse, ThreeBelowTheThresholdEndWithAContactTime) {
    for (const double restitution : {0.0, 0.03, 0.0708}) {
        for (const double contact_time : {1e-2, 1e-6, 1e-10}) {
            World world(three(restitution, contact_time));
            world.advance_to(100);
            EXPECT_LT(world.counts().ball_collisions, 200u) << restitution << ", " << contact_time;
            EXPECT_TRUE(world.validate().empty());
            const PlaneVectors v = world.velocities();
            EXPECT_LE(v[0].x(), v[1].x());
            EXPECT_LE(v[1].x(), v[2].x());
            // A frozen row moves with its centre of mass, which is at rest.
            EXPECT_NEAR(v[0].x() + v[1].x() + v[2].x(), 0, 1e-15);
        }
    }
}

/// Variance over mean of the numbers of balls in 8 x 8 equal squares: below 1 for a gas of discs.
double clustering(const World& world) {
    constexpr int kSquares = 8;
    std::vector<double> counts(kSquares * kSquares);
    const Box& box = world.domain().box;
    for (const Vec2& x : world.positions()) {
        const Vec2 share = (x - box.min).cwiseQuotient(box.max - box.min) * kSquares;
        counts[static_cast<std::size_t>(share.y()) * kSquares + static_cast<std::size_t>(share.x())] += 1;
    }
    const double mean = double(world.ball_count()) / double(counts.size());
    double variance = 0;
    for (const double n : counts) variance += (n - mean) * (n - mean) / double(counts.size());
    return variance / mean;
}

// A gas of restitution 0.6 cools into clusters, in which it would collapse. A ball has at most six
// neighbours; with 30 collisions in a contact time there is room for the waves that run through a cluster.
TEST(Collapse, CoolingGasClustersAndGoesOn) {
    constexpr double kMostPerContactTime = 30;
    const Scene s = gas(81, {.count = 1600, .packing = 0.2, .restitution = 0.6});
    World world(s, {.threads = 1});
    EXPECT_LT(clustering(world), 1);
    const double balls = double(world.ball_count());
    const double energy = world.kinetic_energy();
    double collisions = 0;
    double step = 1;
    while (collisions < 40 * balls) {
        world.step(step);
        const double now = double(world.counts().ball_collisions);
        EXPECT_LT((now - collisions) / balls / step * world.contact_time(), kMostPerContactTime);
        collisions = now;
        step *= 1.1;  // it slows down
    }
    EXPECT_GT(clustering(world), 2);
    EXPECT_LT(world.kinetic_energy(), energy / 100);
    EXPECT_TRUE(world.validate().empty());
}

}  // namespace
}  // namespace carom::test
