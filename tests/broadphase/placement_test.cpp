// Placed balls: no two overlap, by brute force; counts, packing, radii, velocities; the same bits everywhere;
// clear refusals.
#include <carom/broadphase/placement.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <carom/broadphase/overlap.hpp>
#include "../../broadphase/src/placement_methods.hpp"
#include "../../broadphase/src/placement_random.hpp"

namespace carom {
namespace {

Scene box_scene(Boundary x, Boundary y, const Vec2& size = Vec2(20, 15)) {
    Scene scene;
    scene.domain = Domain{{Vec2(-3, 2), Vec2(-3, 2) + size}, {x, y}, 1};
    return scene;
}

Fill packed(double packing, double radius_min, double radius_max) {
    Fill fill;
    fill.packing_fraction = packing;
    fill.radius_min = radius_min;
    fill.radius_max = radius_max;
    return fill;
}

Fill packed(double packing, double radius = 0.5) {
    return packed(packing, radius, radius);
}

/// Adds to `counts`, of squares of side 1 in rows of so many, those that the balls of box_scene() are in.
void count_in_squares(const std::vector<Ball>& balls, std::size_t row, std::span<int> counts) {
    for (const Ball& ball : balls)
        ++counts[static_cast<std::size_t>(ball.position.x() + 3) +
                 row * static_cast<std::size_t>(ball.position.y() - 2)];
}

/// Of counts that should be equal but for chance.
double chi_squared_of(std::span<const int> counts) {
    const double mean =
        std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
    double sum = 0;
    for (const int k : counts) sum += (k - mean) * (k - mean) / mean;
    return sum;
}

Ball ball_at(const Vec2& position, double radius, bool is_static) {
    Ball ball;
    ball.position = position;
    ball.radius = radius;
    ball.is_static = is_static;
    return ball;
}

Box box_of(const Scene& scene) {
    return scene.domain.value_or(Domain{}).box;
}

double box_area(const Box& box) {
    return (box.max.x() - box.min.x()) * (box.max.y() - box.min.y());
}

double disc_area(const std::vector<Ball>& balls, std::size_t first = 0) {
    double area = 0;
    for (std::size_t i = first; i < balls.size(); ++i)
        area += std::numbers::pi * balls[i].radius * balls[i].radius;
    return area;
}

/// The difference along an axis, by the nearest of three images where the axis is periodic.
double difference(const Scene& scene, int axis, double a, double b) {
    double d = a - b;
    if (!scene.domain || scene.domain->boundary[axis] != Boundary::kPeriodic) return d;
    const double period = scene.domain->box.max[axis] - scene.domain->box.min[axis];
    for (const double image : {a - b - period, a - b + period})
        if (std::abs(image) < std::abs(d)) d = image;
    return d;
}

/// All pairs from ball `first` on against all: the contract itself, in double.
void expect_no_overlap(const std::vector<Ball>& balls, const Scene& scene, std::size_t first = 0) {
    for (std::size_t i = first; i < balls.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double x = difference(scene, 0, balls[i].position.x(), balls[j].position.x());
            const double y = difference(scene, 1, balls[i].position.y(), balls[j].position.y());
            const double sum = balls[i].radius + balls[j].radius;
            ASSERT_GE(x * x + y * y, sum * sum) << "balls " << j << " and " << i;
        }
        for (const Wall& wall : scene.walls) {
            const Vec2 d = wall.to - wall.from;
            const Vec2 a = balls[i].position - wall.from;
            const double share = std::min(1.0, std::max(0.0, a.dot(d) / d.dot(d)));
            ASSERT_GE((a - share * d).norm(), balls[i].radius) << "ball " << i;
        }
    }
}

/// Whole discs inside the sides that the axis has; centres inside [min, max) where it has none.
void expect_inside(const std::vector<Ball>& balls, const Box& box, std::array<bool, 2> wraps,
                   std::size_t first = 0) {
    for (std::size_t i = first; i < balls.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
            const double x = balls[i].position[axis];
            const double margin = wraps[axis] ? 0 : balls[i].radius;
            ASSERT_GE(x - box.min[axis], margin) << i;
            ASSERT_GE(box.max[axis] - x, margin) << i;
            if (!wraps[axis]) continue;
            ASSERT_LT(x, box.max[axis]) << i;
        }
    }
}

std::string refusal(const Scene& scene) {
    try {
        static_cast<void>(place_balls(scene));
    } catch (const SceneError& error) {
        return error.what();
    }
    return {};
}

TEST(Placement, NothingOverlapsInAnyBoxAtAnyPacking) {
    constexpr std::array kBoundaries = {Boundary::kOpen, Boundary::kPeriodic, Boundary::kWall};
    std::uint64_t seed = 0;
    for (const Boundary x : kBoundaries) {
        for (const Boundary y : kBoundaries) {
            for (const double packing : {0.02, 0.3, 0.5, 0.55, 0.7, 0.8}) {
                SCOPED_TRACE(testing::Message() << "seed " << ++seed << " packing " << packing);
                Scene scene = box_scene(x, y);
                scene.fills.push_back(packed(packing, 0.25));
                scene.fills[0].seed = seed;
                check(scene);
                const std::vector<Ball> balls = place_balls(scene);
                // The nearest count: off by half a disc at most.
                EXPECT_NEAR(disc_area(balls) / box_area(box_of(scene)), packing,
                            0.501 * disc_area({balls[0]}) / box_area(box_of(scene)));
                expect_no_overlap(balls, scene);
                expect_inside(balls, box_of(scene), {x == Boundary::kPeriodic, y == Boundary::kPeriodic});
            }
        }
    }
}

TEST(Placement, NothingOverlapsForMixedSizes) {
    for (const auto& [ratio, packing] :
         {std::pair(1.2, 0.75), {1.5, 0.6}, {2.0, 0.45}, {4.0, 0.75}, {20.0, 0.7}, {1000.0, 0.3}}) {
        for (const Boundary boundary : {Boundary::kPeriodic, Boundary::kWall}) {
            SCOPED_TRACE(testing::Message() << "ratio " << ratio << " packing " << packing);
            Scene scene = box_scene(boundary, boundary);
            Fill fill = packed(packing);
            fill.count = 400;
            fill.radius_max = fill.radius_min * ratio;
            scene.fills.push_back(fill);
            const std::vector<Ball> balls = place_balls(scene);
            ASSERT_EQ(balls.size(), 400U);
            EXPECT_NEAR(disc_area(balls) / box_area(box_of(scene)), packing, 1e-12);
            expect_no_overlap(balls, scene);
            expect_inside(balls, box_of(scene),
                          {boundary == Boundary::kPeriodic, boundary == Boundary::kPeriodic});
        }
    }
}

/// A region inside a domain with walls through it, static balls in it and across its sides, and a moving
/// ball.
Scene crowded_scene(Boundary boundary) {
    Scene scene = box_scene(boundary, boundary);
    scene.walls = {{Vec2(0, 3), Vec2(9, 12), 1}, {Vec2(10, 5), Vec2(10, 9), 1}};
    for (const auto& [x, y, radius] :
         {std::array{12.0, 12.0, 2.0}, {-2.5, 9.0, 0.4}, {3.0, 13.0, 1.0}, {3.5, 13.0, 1.0}})
        scene.balls.push_back(ball_at(Vec2(x, y), radius, true));
    scene.balls.push_back(ball_at(Vec2(16.5, 2.6), 0.5, false));
    return scene;
}

TEST(Placement, AvoidsWallsStaticBallsAndEarlierFills) {
    for (const Boundary boundary : {Boundary::kOpen, Boundary::kPeriodic, Boundary::kWall}) {
        for (const double packing : {0.1, 0.2, 0.3}) {
            SCOPED_TRACE(testing::Message() << "packing " << packing);
            Scene scene = crowded_scene(boundary);
            scene.fills = {packed(packing, 0.3), packed(packing, 0.1, 0.2)};
            const Box region{Vec2(1, 4), Vec2(12, 14)};
            scene.fills[1].region = region;
            check(scene);
            const std::vector<Ball> balls = place_balls(scene);
            ASSERT_GT(balls.size(), scene.balls.size() + 200);
            for (std::size_t i = 0; i < scene.balls.size(); ++i)
                EXPECT_EQ(balls[i].position, scene.balls[i].position);
            expect_no_overlap(balls, scene, scene.balls.size());
            EXPECT_NO_THROW(check_overlaps(balls, scene));  // across the sides: walls too
            const auto second = static_cast<std::size_t>(
                std::find_if(balls.begin() + 5, balls.end(), [](const Ball& b) { return b.radius < 0.3; }) -
                balls.begin());
            expect_inside(balls, region, {false, false}, second);
        }
    }
}

TEST(Placement, DenseAmongObstacles) {
    // Too dense for adsorption: by a lattice with sites left out, and where that has too few by pushing.
    for (const double packing : {0.55, 0.62}) {
        SCOPED_TRACE(testing::Message() << "packing " << packing);
        Scene scene = crowded_scene(Boundary::kPeriodic);
        scene.fills = {packed(packing, 0.15)};
        const std::vector<Ball> balls = place_balls(scene);
        expect_no_overlap(balls, scene, scene.balls.size());
        EXPECT_NO_THROW(check_overlaps(balls, scene));
    }
}

TEST(Placement, RegionAcrossAWholePeriodicAxisWrapsOnlyThere) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic);
    const Box region{Vec2(-3, 5), Vec2(17, 10)};
    scene.fills.push_back(packed(0.6, 0.3));
    scene.fills[0].region = region;
    // A static ball whose image reaches into the region's upper corner.
    scene.balls.push_back(ball_at(Vec2(16.9, 10.2), 0.5, true));
    const std::vector<Ball> balls = place_balls(scene);
    expect_no_overlap(balls, scene, 1);
    expect_inside(balls, region, {true, false}, 1);
    bool crosses = false;
    for (std::size_t i = 1; i < balls.size(); ++i)
        crosses = crosses || balls[i].position.x() + 3 < 0.3 || 17 - balls[i].position.x() < 0.3;
    EXPECT_TRUE(crosses);
}

TEST(Placement, DenseCrystalsOfEqualDiscsInAPeriodicBox) {
    // 1000 and 1001 discs: no count is special. The densest there is has packing 0.9069.
    for (const std::uint64_t count : {100U, 997U, 1000U, 1001U, 1024U, 5000U}) {
        SCOPED_TRACE(testing::Message() << "count " << count);
        Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, Vec2(10, 10));
        Fill fill = packed(count < 5000 ? 0.85 : 0.88);
        fill.count = count;
        scene.fills.push_back(fill);
        const std::vector<Ball> balls = place_balls(scene);
        ASSERT_EQ(balls.size(), count);
        expect_no_overlap(balls, scene);
    }
}

TEST(Placement, NoGapIsDegenerateInADenseStart) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kWall);
    scene.fills.push_back(packed(0.72, 0.2));
    const std::vector<Ball> balls = place_balls(scene);
    // Gaps in units of the diameter. Of some 3 N pairs the least is of the order of (mean gap) / 3 N; a
    // thousandth of that in one run of a thousand. A lattice would have all alike, a relaxed packing many
    // near 0.
    std::vector<double> gaps;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Vec2 offset(difference(scene, 0, balls[i].position.x(), balls[j].position.x()),
                              balls[i].position.y() - balls[j].position.y());
            if (offset.norm() < 0.4 * 1.05) gaps.push_back(offset.norm() / 0.4 - 1);
        }
    }
    std::sort(gaps.begin(), gaps.end());
    ASSERT_GT(gaps.size(), balls.size() / 2);  // the lattice has a gap of 12 %
    EXPECT_GT(gaps.front(), 0.1 / (3.0 * static_cast<double>(balls.size())) * 1e-3);
    EXPECT_EQ(std::unique(gaps.begin(), gaps.end()), gaps.end());
}

std::uint64_t hash_of(const std::vector<Ball>& balls) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a over the words
    const auto fold = [&](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3ULL; };
    for (const Ball& ball : balls)
        for (const double x : {ball.position.x(), ball.position.y(), ball.velocity.x(), ball.velocity.y(),
                               ball.radius, ball.mass})
            fold(x);
    return hash;
}

Scene golden_scene(std::uint64_t seed) {
    Scene scene = crowded_scene(Boundary::kPeriodic);
    scene.fills = {packed(0.2, 0.15, 0.25), packed(0.6, 0.07), packed(0.75, 0.05, 0.12)};
    scene.fills[0].region = Box{Vec2(-3, 2), Vec2(17, 8)};        // adsorbed
    scene.fills[1].region = Box{Vec2(-1, 9), Vec2(4, 16)};        // among obstacles
    scene.fills[2].region = Box{Vec2(12, 14.5), Vec2(16, 16.5)};  // relaxed
    for (Fill& fill : scene.fills) {
        fill.seed = seed;
        fill.temperature = 2;
        fill.density = 3;
    }
    return scene;
}

TEST(Placement, SameSeedSameBitsEverywhere) {
    const std::vector<Ball> balls = place_balls(golden_scene(1));
    EXPECT_EQ(hash_of(balls), hash_of(place_balls(golden_scene(1))));
    EXPECT_NE(hash_of(balls), hash_of(place_balls(golden_scene(2))));
    // Written down once from g++ -O3; every compiler, option and machine with IEEE doubles must give it.
    EXPECT_EQ(hash_of(balls), 6442668978519779938ULL);
}

TEST(Placement, TemperatureLeavesPlacesAndFillsOfOneSeedDiffer) {
    Scene scene = box_scene(Boundary::kOpen, Boundary::kOpen);
    scene.fills = {packed(0.1, 0.2), packed(0.1, 0.2)};
    const std::vector<Ball> cold = place_balls(scene);
    for (const Ball& ball : cold) EXPECT_EQ(ball.velocity, Vec2::Zero());
    scene.fills[0].temperature = scene.fills[1].temperature = 1;
    const std::vector<Ball> warm = place_balls(scene);
    ASSERT_EQ(cold.size(), warm.size());
    for (std::size_t i = 0; i < cold.size(); ++i) EXPECT_EQ(cold[i].position, warm[i].position);
    EXPECT_NE(warm[0].velocity, warm[warm.size() / 2].velocity);
}

TEST(Placement, VelocitiesAreNormalAndMomentumIsZero) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, Vec2(1000, 1000));
    Fill fill;
    fill.count = 100000;
    fill.radius_min = 0.2;
    fill.radius_max = 0.8;
    fill.temperature = 2.5;
    fill.density = 1.5;
    fill.restitution = 0.75;
    scene.fills.push_back(fill);
    const std::vector<Ball> balls = place_balls(scene);
    Vec2 momentum = Vec2::Zero();
    double scale = 0;
    std::array<double, 5> moment{};  // of sqrt(m / T) v, a standard normal number
    double radius = 0;
    double radius_squares = 0;
    for (const Ball& ball : balls) {
        ASSERT_DOUBLE_EQ(ball.mass, 1.5 * std::numbers::pi * ball.radius * ball.radius);
        ASSERT_EQ(ball.restitution, 0.75);
        ASSERT_FALSE(ball.is_static);
        ASSERT_TRUE(ball.radius >= 0.2 && ball.radius <= 0.8);
        momentum += ball.mass * ball.velocity;
        scale += ball.mass * ball.velocity.norm();
        for (const double v : {ball.velocity.x(), ball.velocity.y()})
            for (int k = 0; k < 5; ++k) moment[k] += std::pow(v * std::sqrt(ball.mass / 2.5), k);
        radius += ball.radius;
        radius_squares += (ball.radius - 0.5) * (ball.radius - 0.5);
    }
    const double n = static_cast<double>(balls.size());
    // A sum of n terms of random sign rounds like sqrt(n) times one; five of these.
    EXPECT_LT(momentum.norm(),
              5 * std::sqrt(n) * std::numeric_limits<double>::epsilon() * scale / std::sqrt(n));
    // Five sigma of the estimators from 2 n normal numbers: variances of z^2, z^3, z^4 are 2, 15, 96.
    EXPECT_NEAR(moment[2] / moment[0], 1, 5 * std::sqrt(2 / (2 * n)));
    EXPECT_NEAR(moment[3] / moment[0], 0, 5 * std::sqrt(15 / (2 * n)));
    EXPECT_NEAR(moment[4] / moment[0], 3, 5 * std::sqrt(96 / (2 * n)));
    // Uniform radii of width w = 0.6: variance w^2/12, and of the squared deviation w^4/180.
    EXPECT_NEAR(radius / n, 0.5, 5 * 0.6 / std::sqrt(12 * n));
    EXPECT_NEAR(radius_squares / n, 0.03, 5 * 0.36 / std::sqrt(180 * n));
}

TEST(PlacementRandom, LogarithmIsThatOfTheLibraryToFourUlp) {
    // Rounded: the quotient, the series' last steps, the product with ln 2 and the sum, half an ulp each, and
    // the library's own.
    detail::Random random(1, 0, detail::Stream::kPlaces);
    for (int k = 0; k < 100000; ++k) {
        const double x = std::ldexp(random.uniform() + 0x1p-60, -(k % 60));
        const double wanted = std::log(x);
        ASSERT_NEAR(detail::portable_log(x), wanted,
                    4 * std::numeric_limits<double>::epsilon() * std::abs(wanted))
            << x;
    }
    EXPECT_EQ(detail::portable_log(1), 0);
}

TEST(Placement, AdsorbedDiscsAreSpreadEvenly) {
    // Counts in 10 x 10 cells of a box without sides. Discs that cannot overlap fluctuate less than
    // Poisson's, so that the sum of (count - mean)^2 / mean, chi squared with 99 degrees of freedom at most,
    // lies below 99 + 5 sqrt(2 * 99).
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, Vec2(10, 10));
    Fill fill = packed(0.3);
    fill.count = 20000;
    scene.fills.push_back(fill);
    std::array<int, 100> count{};
    count_in_squares(place_balls(scene), 10, count);
    const double chi_squared = chi_squared_of(count);
    EXPECT_LT(chi_squared, 99 + 5 * std::sqrt(2 * 99.0));
    EXPECT_GT(chi_squared, 1);  // a lattice would have next to none
}

/// Pairs of discs of diameter 1 in a periodic square, by cells of at least that side.
class CloseDiscs {
 public:
    explicit CloseDiscs(double side)
        : side_(side), count_(static_cast<std::size_t>(side)), cells_(count_ * count_) {}

    void add(const Vec2& p) { cells_[column(p.y()) * count_ + column(p.x())].push_back(p); }

    /// Calls visit(dx, dy) for all within a diameter and more, itself among them if it is there.
    template <class Visit>
    void for_each_near(const Vec2& p, Visit visit) const {
        for (std::size_t row = count_ - 1; row < count_ + 2; ++row)
            for (std::size_t k = count_ - 1; k < count_ + 2; ++k)
                for (const Vec2& q :
                     cells_[(column(p.y()) + row) % count_ * count_ + (column(p.x()) + k) % count_])
                    visit(std::remainder(q.x() - p.x(), side_), std::remainder(q.y() - p.y(), side_));
    }

    /// Twice the pairs closer than a distance, those rather side by side and those rather one above the
    /// other.
    [[nodiscard]] std::array<double, 2> pairs_within(double distance) const {
        std::array<double, 2> pairs{};
        for (const std::vector<Vec2>& cell : cells_)
            for (const Vec2& p : cell)
                for_each_near(p, [&](double x, double y) {
                    const double squared = x * x + y * y;
                    if (squared > 0 && squared < distance * distance)
                        ++pairs[std::abs(x) < std::abs(y) ? 1 : 0];
                });
        return pairs;
    }

 private:
    [[nodiscard]] std::size_t column(double x) const {
        return std::min(static_cast<std::size_t>(x / side_ * static_cast<double>(count_)), count_ - 1);
    }

    double side_;
    std::size_t count_;
    std::vector<std::vector<Vec2>> cells_;
};

/// Random sequential adsorption as it is defined: a disc after the other, at the first of uniformly random
/// places that is clear.
CloseDiscs adsorbed_one_by_one(std::size_t count, double side, std::uint64_t seed) {
    CloseDiscs discs(side);
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> along(0, side);
    while (count > 0) {
        const double x = along(engine);
        const Vec2 p(x, along(engine));
        bool clear = true;
        discs.for_each_near(p, [&](double dx, double dy) { clear = clear && dx * dx + dy * dy >= 1; });
        if (!clear) continue;
        discs.add(p);
        --count;
    }
    return discs;
}

TEST(Placement, AdsorbedDiscsAreThoseOfOneAfterTheOther) {
    // Close pairs, which are what the order of adsorption shows in: with those of the definition, and side by
    // side with one above the other. A disc has less than one such neighbour, so that their number fluctuates
    // no more than Poisson's, and the difference of two by the root of their sum.
    constexpr std::size_t kDiscs = 40000;
    constexpr double kPacking = 0.47;
    constexpr double kClose = 1.04;
    const double side = std::sqrt(kDiscs * std::numbers::pi / 4 / kPacking);
    std::array<double, 2> ours{}, theirs{};
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        Scene scene;
        scene.domain = Domain{{Vec2(0, 0), Vec2(side, side)}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
        Fill fill = packed(kPacking);
        fill.count = kDiscs;
        fill.seed = seed;
        scene.fills.push_back(fill);
        CloseDiscs placed(side);
        for (const Ball& ball : place_balls(scene)) placed.add(ball.position);
        const std::array<double, 2> of_placed = placed.pairs_within(kClose);
        const std::array<double, 2> expected = adsorbed_one_by_one(kDiscs, side, seed).pairs_within(kClose);
        for (std::size_t k = 0; k < 2; ++k) {
            ours[k] += of_placed[k] / 2;
            theirs[k] += expected[k] / 2;
        }
    }
    const double all = ours[0] + ours[1];
    const double expected = theirs[0] + theirs[1];
    EXPECT_NEAR(all, expected, 5 * std::sqrt(all + expected));
    EXPECT_NEAR(ours[0], ours[1], 5 * std::sqrt(all));
}

TEST(Placement, FewDiscsAreSpreadEvenlyToo) {
    // Counts in 4 x 4 cells over many seeds, as above: chi squared with 15 degrees of freedom at most.
    for (const std::uint64_t count : {1400U, 2600U, 6000U}) {
        std::array<int, 16> counts{};
        constexpr int kSeeds = 30;
        for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
            Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, Vec2(4, 4));
            Fill fill = packed(0.001);
            fill.count = count;
            fill.seed = seed;
            scene.fills.push_back(fill);
            count_in_squares(place_balls(scene), 4, counts);
        }
        EXPECT_LT(chi_squared_of(counts), 15 + 5 * std::sqrt(2 * 15.0)) << count;
    }
}

TEST(Placement, LargeDiscsLieWhereSmallOnesDo) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, Vec2(100, 100));
    scene.fills.push_back(packed(0.4, 0.1, 0.5));
    const std::vector<Ball> balls = place_balls(scene);
    // Correlations of the radius with either coordinate: of independent ones, normal with variance 1 / N.
    const auto count = static_cast<double>(balls.size());
    for (int axis = 0; axis < 2; ++axis) {
        double r = 0, x = 0, rr = 0, xx = 0, rx = 0;
        for (const Ball& ball : balls) {
            const double place = ball.position[axis];
            r += ball.radius / count;
            x += place / count;
            rr += ball.radius * ball.radius / count;
            xx += place * place / count;
            rx += ball.radius * place / count;
        }
        EXPECT_LT(std::abs(rx - r * x) / std::sqrt((rr - r * r) * (xx - x * x)), 5 / std::sqrt(count));
    }
}

TEST(Placement, AdsorptionGoesOnWhereHalfOfTheRegionHasNoRoom) {
    constexpr double kSide = 600;
    Scene scene;
    scene.domain = Domain{{Vec2(0, 0), Vec2(kSide, kSide)}, {Boundary::kWall, Boundary::kWall}, 1};
    for (double y = 0.8; y < kSide / 2; y += 0.8) scene.walls.push_back({Vec2(0, y), Vec2(kSide, y), 1});
    const std::vector<double> radii(90000, 0.5);
    detail::Space space(scene, {}, scene.domain->box, radii);
    detail::Random random(1, 0, detail::Stream::kPlaces);
    EXPECT_TRUE(detail::adsorb(space, random).empty());
}

TEST(Placement, ADiscAsWideAsItsRegionIsPlacedOrRefused) {
    for (int k = 1; k < 200; ++k) {
        Scene scene;
        const double low = 0.1 * k;
        scene.domain = Domain{{Vec2(low, 0.1), Vec2(low + 0.2, 3.3)}, {Boundary::kWall, Boundary::kWall}, 1};
        Fill fill;
        fill.count = 1;
        fill.radius_min = fill.radius_max = (scene.domain->box.max.x() - scene.domain->box.min.x()) / 2;
        scene.fills.push_back(fill);
        if (refusal(scene).empty()) expect_inside(place_balls(scene), scene.domain->box, {false, false});
    }
}

TEST(Placement, TheWidestOfAChannelHaveHardlyAnyRoomAcross) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kWall, Vec2(400, 1.25));
    scene.fills.push_back(packed(0.35, 0.3, 0.6));
    const std::vector<Ball> balls = place_balls(scene);
    EXPECT_NEAR(disc_area(balls), 0.35 * 400 * 1.25, std::numbers::pi * 0.6 * 0.6);
    expect_no_overlap(balls, scene);
    expect_inside(balls, box_of(scene), {true, false});
}

TEST(Placement, CountsRadiiAndMassesFollowTheFill) {
    Scene scene = box_scene(Boundary::kOpen, Boundary::kOpen, Vec2(10, 10));
    Fill fill;
    fill.count = 7;
    fill.mass = 3;
    scene.fills.push_back(fill);
    const std::vector<Ball> balls = place_balls(scene);
    ASSERT_EQ(balls.size(), 7U);
    for (const Ball& ball : balls) {
        EXPECT_EQ(ball.radius, 0.5);
        EXPECT_EQ(ball.mass, 3);
    }
    scene.fills[0].mass.reset();
    EXPECT_EQ(place_balls(scene)[0].mass, 1);
    // 0.25 * 100 / (pi / 4) = 31.8
    scene.fills[0] = packed(0.25);
    EXPECT_EQ(place_balls(scene).size(), 32U);
    // Exactly as wide as a disc, which then has one place.
    scene.fills[0] = Fill{};
    scene.fills[0].count = 1;
    scene.fills[0].region = Box{Vec2(0, 3), Vec2(1, 4)};
    EXPECT_EQ(place_balls(scene)[0].position, Vec2(0.5, 3.5));
}

TEST(Placement, WhatDoesNotFitIsRefused) {
    Scene scene = box_scene(Boundary::kWall, Boundary::kWall, Vec2(10, 10));
    Fill fill;
    fill.count = 110;
    scene.fills = {packed(0.01, 0.2), fill};
    EXPECT_THAT(refusal(scene),
                testing::StartsWith("fill[1].count: must leave room for every disc: of 110 "));
    scene.fills = {packed(0.9, 0.2)};
    EXPECT_THAT(refusal(scene),
                testing::StartsWith("fill[0].packing_fraction: must leave room for every disc"));
    scene.fills = {packed(0.001, 0.5)};
    EXPECT_EQ(refusal(scene),
              "fill[0].packing_fraction: must be at least 0.00785398, for one disc in the region, is 0.001");
    scene.fills = {packed(0.9, 5.5)};
    EXPECT_EQ(refusal(scene),
              "fill[0].radius: must fit the region: its half width is 5, the largest radius 5.5");
    // Room for area, but none beside a ball that covers the region.
    scene.fills = {packed(0.1, 0.1)};
    scene.fills[0].region = Box{Vec2(0, 5), Vec2(2, 7)};
    scene.balls = {ball_at(Vec2(1, 6), 1.5, true)};
    EXPECT_THAT(refusal(scene), testing::HasSubstr(" 0 found a place"));
}

TEST(Placement, AMillionDiscsAtPackingSevenTenths) {
    Scene scene = box_scene(Boundary::kPeriodic, Boundary::kPeriodic, Vec2(1000, 1000));
    Fill fill = packed(0.7);
    fill.count = 1000000;
    scene.fills.push_back(fill);
    const std::vector<Ball> balls = place_balls(scene);
    ASSERT_EQ(balls.size(), 1000000U);
    EXPECT_EQ(max_overlap(balls, scene), 0);
}

}  // namespace
}  // namespace carom
