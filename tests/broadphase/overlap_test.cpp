// Overlaps against all pairs by brute force, with every image tried.
#include <carom/broadphase/overlap.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace carom {
namespace {

class Source {  // uniform numbers that every library makes alike
 public:
    explicit Source(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    bool one_in(std::uint64_t n) { return engine_() % n == 0; }

 private:
    std::mt19937_64 engine_;
};

Scene box_scene(Boundary x, Boundary y, double side = 10) {
    Scene scene;
    scene.domain = Domain{{Vec2(-side / 2, 0), Vec2(side / 2, side)}, {x, y}, 1};
    return scene;
}

/// The distance by trying all images one period away.
double distance_by_images(const Scene& scene, const Vec2& a, const Vec2& b) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            Vec2 shift = Vec2::Zero();
            for (int axis = 0; axis < 2; ++axis) {
                const int turns = axis == 0 ? x : y;
                if (turns == 0) continue;
                if (!scene.domain || scene.domain->boundary[axis] != Boundary::kPeriodic)
                    shift[axis] = std::numeric_limits<double>::infinity();
                else
                    shift[axis] = turns * (scene.domain->box.max[axis] - scene.domain->box.min[axis]);
            }
            nearest = std::min(nearest, (a - b + shift).norm());
        }
    }
    return nearest;
}

std::vector<Overlap> brute_force(const std::vector<Ball>& balls, const Scene& scene) {
    std::vector<Overlap> found;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        for (std::size_t j = i + 1; j < balls.size(); ++j) {
            if (balls[i].is_static && balls[j].is_static) continue;
            const double sum = balls[i].radius + balls[j].radius;
            const double depth = sum - distance_by_images(scene, balls[i].position, balls[j].position);
            if (depth > 1e-12 * sum) found.push_back({i, j, depth});
        }
    }
    return found;
}

void expect_same(const std::vector<Overlap>& found, const std::vector<Overlap>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].i, wanted[k].i);
        EXPECT_EQ(found[k].j, wanted[k].j);
        // Distances of numbers below 100, each rounded a few times.
        EXPECT_NEAR(found[k].depth, wanted[k].depth, 1e-13);
    }
}

std::string refusal(const std::vector<Ball>& balls, const Scene& scene,
                    const Selection* selection = nullptr) {
    try {
        if (selection != nullptr)
            check_overlaps(balls, scene, *selection);
        else
            check_overlaps(balls, scene);
    } catch (const SceneError& error) {
        return error.what();
    }
    return {};
}

Ball ball_at(double x, double y, double radius = 0.5) {
    Ball ball;
    ball.position = {x, y};
    ball.radius = radius;
    return ball;
}

TEST(Overlap, EqualsBruteForceInEveryBox) {
    constexpr std::array kBoundaries = {Boundary::kOpen, Boundary::kPeriodic, Boundary::kWall};
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Source source(seed);
        const Scene scene = box_scene(kBoundaries[seed % 3], kBoundaries[seed / 3 % 3]);
        // From one size to radii of 1 : 10^4, which span fourteen grids.
        const double octaves = seed % 4 == 0 ? 13.3 : seed % 4 == 1 ? 0 : 2;
        std::vector<Ball> balls;
        balls.reserve(300);
        for (int k = 0; k < 300; ++k) {
            Ball ball = ball_at(source.uniform(-5, 5), source.uniform(0, 10),
                                std::exp2(-source.uniform(0, octaves)) * 0.7);
            ball.is_static = source.one_in(5);
            balls.push_back(ball);
        }
        expect_same(find_overlaps(balls, scene), brute_force(balls, scene));
    }
}

TEST(Overlap, EqualsBruteForceInNarrowPeriodicBoxes) {
    // One, two and three cells a side: neighbours across a side are the same cell twice.
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Source source(seed);
        const double side = source.uniform(1.05, 5);
        const Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, side);
        std::vector<Ball> balls;
        balls.reserve(6);
        for (int k = 0; k < 6; ++k)
            balls.push_back(ball_at(source.uniform(-side / 2, side / 2), source.uniform(0, side),
                                    source.uniform(0.1, 0.5)));
        expect_same(find_overlaps(balls, scene), brute_force(balls, scene));
    }
}

TEST(Overlap, FindsPairsFarApartFromOneAnotherWithoutADomain) {
    Source source(7);
    std::vector<Ball> balls;
    balls.reserve(200);
    for (int k = 0; k < 200; ++k) {
        // Clusters at up to 1e12 radii from the origin; a power of two, so that the offsets in a cluster are
        // exact.
        const double far =
            std::ldexp(1.0, static_cast<int>(source.uniform(0, 40))) * (source.one_in(2) ? 1 : -1);
        balls.push_back(ball_at(far + std::floor(source.uniform(-2, 3)),
                                -far + std::floor(source.uniform(-2, 3)), 0.625));
    }
    const std::vector<Overlap> wanted = brute_force(balls, {});
    const std::vector<Overlap> found = find_overlaps(balls, {});
    // The tolerance grows with the coordinates, but these overlaps are of 0.25 at least or none.
    expect_same(found, wanted);
    EXPECT_FALSE(wanted.empty());
}

TEST(Overlap, NamesTheFirstPairAndItsDepth) {
    const std::vector<Ball> balls = {ball_at(9, 0), ball_at(5, 0),  ball_at(2, 0),   ball_at(0, 0),
                                     ball_at(7, 0), ball_at(-3, 0), ball_at(4.5, 0), ball_at(0.75, 0)};
    EXPECT_EQ(refusal(balls, {}), "balls[1]: overlaps balls[6] by 0.5 (distance 0.5, radii's sum 1)");
    EXPECT_EQ(refusal({balls[0], balls[2], balls[4], balls[3], balls[5], balls[7]}, {}),
              "balls[3]: overlaps balls[5] by 0.25 (distance 0.75, radii's sum 1)");
    EXPECT_EQ(refusal({balls[0], balls[1]}, {}), "");
}

TEST(Overlap, FirstPairIsTheSmallestOfAll) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Source source(seed);
        const Scene scene = box_scene(Boundary::kPeriodic, Boundary::kOpen, 40);
        std::vector<Ball> balls;
        balls.reserve(200);
        for (int k = 0; k < 200; ++k)
            balls.push_back(
                ball_at(source.uniform(-20, 20), source.uniform(0, 40), std::exp2(-source.uniform(0, 5))));
        const std::vector<Overlap> all = brute_force(balls, scene);
        ASSERT_FALSE(all.empty());
        const std::string start =
            "balls[" + std::to_string(all[0].i) + "]: overlaps balls[" + std::to_string(all[0].j) + "] ";
        EXPECT_THAT(refusal(balls, scene), testing::StartsWith(start));
    }
}

// Few that are selected are looked at apart from the others, many are not.
TEST(Overlap, OfTheSelectedNamesTheFirstPair) {
    constexpr std::array kBoundaries = {Boundary::kOpen, Boundary::kPeriodic, Boundary::kWall};
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Source source(seed);
        const Scene scene = box_scene(kBoundaries[seed % 3], kBoundaries[seed / 3 % 3], 40);
        std::vector<Ball> balls;
        Selection selection;
        constexpr std::array kSelected = {1, 2, 5, 16, 17, 40};
        for (int k = 0; k < 200; ++k) {
            // Some of them lie a period or two beyond the box.
            Ball ball =
                ball_at(source.uniform(-19, 19), source.uniform(1, 39), std::exp2(-source.uniform(1, 6)));
            if (seed % 3 == 1) ball.position.x() += 40 * std::floor(source.uniform(-2, 3));
            ball.is_static = source.one_in(5);
            balls.push_back(ball);
            selection.balls.push_back(source.one_in(200) ? 1 : 0);
            selection.ball_ids.push_back(static_cast<std::uint32_t>(3 * k + 1));
        }
        for (int k = 0; k < kSelected[seed % kSelected.size()]; ++k)
            selection.balls[static_cast<std::size_t>(source.uniform(0, 200))] = 1;
        std::string wanted;
        for (const Overlap& o : find_overlaps(balls, scene)) {
            if (selection.balls[o.i] == 0 && selection.balls[o.j] == 0) continue;
            wanted = "balls[" + std::to_string(3 * o.i + 1) + "]: overlaps balls[" +
                     std::to_string(3 * o.j + 1) + "] ";
            break;
        }
        const std::string told = refusal(balls, scene, &selection);
        refused += wanted.empty() ? 0 : 1;
        EXPECT_EQ(told.empty(), wanted.empty()) << told;
        EXPECT_THAT(told, testing::StartsWith(wanted));
    }
    EXPECT_GT(refused, 20);
    EXPECT_LT(refused, 180);
}

TEST(Overlap, AHeapOnOnePointIsRefusedInLinearTime) {
    const std::vector<Ball> balls(500000, ball_at(1, 2));  // all pairs would be 10^11
    EXPECT_EQ(refusal(balls, {}), "balls[0]: overlaps balls[1] by 1 (distance 0, radii's sum 1)");
}

TEST(Overlap, TouchingBallsInDecimalsPass) {
    for (const double start : {0.1, 1234.7, -98765.4}) {
        std::vector<Ball> cradle;
        cradle.reserve(50);
        for (int k = 0; k < 50; ++k) cradle.push_back(ball_at(start + 0.2 * k, 0.3, 0.1));
        EXPECT_EQ(refusal(cradle, {}), "");
    }
    // Twice the tolerance, and half of it.
    EXPECT_NE(refusal({ball_at(0, 0), ball_at(1 - 4e-12, 0)}, {}), "");
    EXPECT_EQ(refusal({ball_at(0, 0), ball_at(1 - 5e-13, 0)}, {}), "");
}

TEST(Overlap, StaticBallsMayOverlapStaticBallsWallsAndSides) {
    Scene scene = box_scene(Boundary::kWall, Boundary::kWall);
    scene.walls = {{Vec2(0, 0), Vec2(0, 10), 1}};
    std::vector<Ball> balls = {ball_at(0, 1), ball_at(0.3, 1), ball_at(-5, 3)};
    for (Ball& ball : balls) ball.is_static = true;
    EXPECT_EQ(refusal(balls, scene), "");
    EXPECT_EQ(max_overlap(balls, scene), 0);
    balls.push_back(ball_at(0.75, 1));
    EXPECT_THAT(refusal(balls, scene), testing::StartsWith("balls[0]: overlaps balls[3] by 0.25"));
}

TEST(Overlap, ABallWiderThanAPeriodMeetsItself) {
    const Scene scene = box_scene(Boundary::kOpen, Boundary::kPeriodic, 0.75);
    EXPECT_EQ(refusal({ball_at(0, 0.25)}, scene),
              "balls[0]: overlaps its own periodic image by 0.25 (distance 0.75, radii's sum 1)");
}

TEST(WallOverlap, NamesBallAndWall) {
    Scene scene;
    scene.walls = {{Vec2(0, 5), Vec2(4, 5), 1}, {Vec2(0, 0), Vec2(4, 0), 1}};
    EXPECT_EQ(refusal({ball_at(2, 3), ball_at(2, 0.25)}, scene),
              "balls[1]: overlaps walls[1] by 0.25 (distance 0.25, radius 0.5)");
    // At an end: 3-4-5.
    EXPECT_EQ(refusal({ball_at(4.375, 0.5, 0.75)}, scene),
              "balls[0]: overlaps walls[1] by 0.125 (distance 0.625, radius 0.75)");
    EXPECT_EQ(refusal({ball_at(4.375, 0.5, 0.625)}, scene), "");
}

TEST(WallOverlap, SidesAreNamedAndPeriodicSidesCrossed) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kWall);
    EXPECT_EQ(refusal({ball_at(0, 9.75)}, scene),
              "balls[0]: overlaps the domain's upper side by 0.25 (distance 0.25, radius 0.5)");
    EXPECT_EQ(refusal({ball_at(0, 9.5)}, scene), "");
    scene.walls = {{Vec2(4.75, 2), Vec2(4.75, 8), 1}};
    const std::vector<Overlap> found = find_wall_overlaps({ball_at(-5, 5), ball_at(-4.5, 5)}, scene);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].i, 0U);
    EXPECT_EQ(found[0].depth, 0.25);
}

TEST(WallOverlap, EqualsBruteForceForManyWalls) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Source source(seed);
        Scene scene = box_scene(seed % 2 == 0 ? Boundary::kPeriodic : Boundary::kOpen, Boundary::kOpen);
        for (int k = 0; k < 100; ++k) {
            const Vec2 from(source.uniform(-5, 5), source.uniform(0, 10));
            const double length = source.one_in(10) ? 8 : 0.5;
            const Vec2 to = from + Vec2(source.uniform(-length, length), source.uniform(-length, length));
            scene.walls.push_back({from, to.cwiseMax(Vec2(-5, 0)).cwiseMin(Vec2(5, 10)), 1});
        }
        std::vector<Ball> balls;
        balls.reserve(200);
        for (int k = 0; k < 200; ++k)
            balls.push_back(ball_at(source.uniform(-5, 5), source.uniform(0, 10), source.uniform(0.01, 0.6)));
        std::vector<Overlap> wanted;
        double deepest = 0;
        for (std::size_t i = 0; i < balls.size(); ++i) {
            for (std::size_t j = 0; j < scene.walls.size(); ++j) {
                double distance = std::numeric_limits<double>::infinity();
                for (int turn = seed % 2 == 0 ? -1 : 0; turn <= (seed % 2 == 0 ? 1 : 0); ++turn) {
                    const Vec2 p = balls[i].position + Vec2(10.0 * turn, 0);
                    // Distance to the line between the ends' normals, to the ends beyond: not the projection
                    // of the library.
                    const Vec2 d = scene.walls[j].to - scene.walls[j].from;
                    const Vec2 a = p - scene.walls[j].from;
                    const Vec2 b = p - scene.walls[j].to;
                    const bool beside = a.dot(d) > 0 && b.dot(d) < 0;
                    distance = std::min(distance, beside ? std::abs(cross<double>(d, a)) / d.norm()
                                                         : std::min(a.norm(), b.norm()));
                }
                const double depth = balls[i].radius - distance;
                deepest = std::max(deepest, depth / balls[i].radius);
                if (depth > 1e-12) wanted.push_back({i, j, depth});
            }
        }
        expect_same(find_wall_overlaps(balls, scene), wanted);
        for (const Overlap& o : brute_force(balls, scene))
            deepest = std::max(deepest, o.depth / (balls[o.i].radius + balls[o.j].radius));
        EXPECT_NEAR(max_overlap(balls, scene), deepest, 1e-12);
    }
}

TEST(MaxOverlap, IsRelativeToTheRadiiSum) {
    EXPECT_EQ(max_overlap({ball_at(0, 0), ball_at(3, 0)}, {}), 0);
    EXPECT_EQ(max_overlap({}, {}), 0);
    EXPECT_EQ(max_overlap({ball_at(0, 0), ball_at(0.75, 0), ball_at(10, 0, 4), ball_at(17, 0, 4)}, {}), 0.25);
    const Scene scene = box_scene(Boundary::kWall, Boundary::kOpen);
    EXPECT_EQ(max_overlap({ball_at(4.25, 0, 1)}, scene), 0.25);
}

}  // namespace
}  // namespace carom
