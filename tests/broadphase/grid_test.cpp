// The grid's geometry against dense sampling and brute force.
#include <carom/broadphase/grid.hpp>

#include <gtest/gtest.h>

#include <map>
#include <set>

#include <carom/broadphase/cell_lists.hpp>
#include <carom/broadphase/obstacles.hpp>

#include "core/sensor_distance.hpp"
#include "parallel/scenes.hpp"

namespace carom::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(GridAxis, FoldsAnyCoordinate) {
    const GridAxis axis(-3, 10, 7, true);
    for (std::int32_t k = -50; k < 50; ++k) {
        EXPECT_GE(axis.fold(k), 0);
        EXPECT_LT(axis.fold(k), 7);
        EXPECT_EQ(axis.fold(k), axis.fold(k + 7));
    }
    EXPECT_EQ(axis.fold(3), 3);
}

TEST(GridAxis, CoordinateLiesBetweenItsBorders) {
    constexpr std::uint64_t kSeed = 11;
    std::mt19937_64 random(kSeed);
    const GridAxis axis(-3, 10, 7, false);
    for (int k = 0; k < 100'000; ++k) {
        const double x = uniform(random, -1e3, 1e3);
        const std::int32_t c = axis.coordinate(x);
        const double rounding = 1e-12;
        EXPECT_GE(x, axis.border(c) - rounding);
        EXPECT_LE(x, axis.border(c + 1) + rounding);
    }
}

TEST(GridAxis, OuterCellsGrowAndEnd) {
    const GridAxis axis(0, 10, 10, false);
    for (const double x : {35.0, 1e12, 1e300}) {
        for (const double y : {x, -x}) {
            const std::int32_t c = axis.coordinate(y);
            EXPECT_LE(axis.border(c), y * (1 - std::copysign(1e-12, y)) + 1e-12 * x * 2);
            EXPECT_GE(axis.border(c + 1), y - 1e-12 * x);
            EXPECT_LE(std::abs(c), 30 + std::log2(x) + 1) << "few cells on the way to " << y;
            EXPECT_GE(axis.border(c + 1) - axis.border(c), axis.width());
        }
    }
    for (std::int32_t c = -40; c < 50; ++c)
        EXPECT_GE(axis.border(c + 1) - axis.border(c), axis.width() * (1 - 1e-12)) << c;
    EXPECT_EQ(axis.border(axis.coordinate(std::numeric_limits<double>::max()) + 2), kInfinity);
}

TEST(GridAxis, WrapsIntoTheHalfOpenBox) {
    constexpr std::uint64_t kSeed = 12;
    std::mt19937_64 random(kSeed);
    const double length = 9.7;
    const GridAxis axis(-1.3, length, 7, true);
    const auto check = [&](double x) {
        std::int32_t n = 5;
        const double inside = axis.wrapped(x, n);
        EXPECT_GE(inside, -1.3) << x;
        EXPECT_LT(inside, -1.3 + length) << x;
        EXPECT_NEAR(inside + (n - 5) * length, x, 1e-12 * (1 + std::abs(x)));
    };
    for (int k = 0; k < 10'000; ++k) check(uniform(random, -1e3, 1e3));
    for (const double edge : {-1.3, -1.3 + length, -1.3 - length, -1.3 + 3 * length})
        for (const double x : {edge, std::nextafter(edge, 1e9), std::nextafter(edge, -1e9)}) check(x);
    std::int32_t n = 0;
    EXPECT_EQ(GridAxis(0, 1, 1, false).wrapped(7.5, n), 7.5);
    EXPECT_EQ(n, 0);
}

TEST(ChooseGrid, KeepsTheMarginAndTheBox) {
    for (const Boundary boundary : {Boundary::kWall, Boundary::kPeriodic, Boundary::kOpen})
        for (const double side : {1.1, 3.0, 100.0})
            for (const std::size_t count : {1, 100, 100'000})
                for (const double asked : {0.0, 0.1, 2.0, 1e9}) {
                    const Domain d{{{0, 0}, {side, 2 * side}}, {boundary, boundary}, 1};
                    const Grid grid = choose_grid(d, count, 1, asked);
                    for (const GridAxis& axis : {grid.x, grid.y}) {
                        if (axis.count() > 1 || boundary != Boundary::kPeriodic) {
                            EXPECT_GE(axis.width(), 1 + kCellMargin);
                        }
                        EXPECT_GE(axis.count(), 1);
                    }
                    if (boundary == Boundary::kPeriodic) {
                        EXPECT_EQ(grid.x.length(), side);
                        EXPECT_EQ(grid.y.length(), 2 * side);
                    }
                    EXPECT_LE(grid.cell_count(), 8.0 * double(count) + 8);
                }
}

// Walks the parabola in small steps and looks for the first passing outwards after `since`.
double sampled_leave(double distance, double speed, double acceleration, double since, double end) {
    constexpr int kSteps = 200'000;
    const auto ahead = [&](double t) { return distance - t * (speed + t * acceleration / 2); };
    for (int k = 0; k < kSteps; ++k) {
        const double t0 = since + (end - since) * k / kSteps;
        const double t1 = since + (end - since) * (k + 1) / kSteps;
        if (ahead(t0) >= 0 && ahead(t1) < 0) return t1;
    }
    return kInfinity;
}

TEST(TimeToLeave, AgreesWithSampling) {
    constexpr std::uint64_t kSeed = 13;
    std::mt19937_64 random(kSeed);
    constexpr double kEnd = 20;
    for (int k = 0; k < 300; ++k) {
        const double distance = uniform(random, 0.01, 2);
        const double speed = uniform(random, -2, 2);
        const double acceleration = k % 3 == 0 ? 0 : uniform(random, -2, 2);
        const double got = time_to_leave(distance, speed, acceleration, 0);
        const double sampled = sampled_leave(distance, speed, acceleration, 0, kEnd);
        if (got > kEnd) {
            EXPECT_EQ(sampled, kInfinity) << distance << ' ' << speed << ' ' << acceleration;
        } else {
            EXPECT_NEAR(got, sampled, 2 * kEnd / 200'000) << distance << ' ' << speed << ' ' << acceleration;
        }
    }
}

// A point thrown at a border so that it turns within an ulp of it must end on the side where it is, after a
// bounded number of crossings.
TEST(TimeToLeave, TurningPointOnTheBorderDoesNotPingPong) {
    constexpr std::uint64_t kSeed = 14;
    std::mt19937_64 random(kSeed);
    for (int k = 0; k < 100'000; ++k) {
        const double speed = uniform(random, 0.01, 3);
        const double acceleration = -uniform(random, 0.01, 3);
        double distance = -speed * speed / (2 * acceleration);
        for (std::int64_t ulps = std::int64_t(random() % 9) - 4; ulps != 0; ulps += ulps < 0 ? 1 : -1)
            distance = std::nextafter(distance, ulps < 0 ? -kInfinity : kInfinity);
        bool inside = true;
        double now = 0;
        int crossings = 0;
        for (; crossings < 10; ++crossings) {
            const double t = inside ? time_to_leave(distance, speed, acceleration, now)
                                    : time_to_leave(-distance, -speed, -acceleration, now);
            if (t == kInfinity) break;
            ASSERT_GE(t, now);
            now = t;
            inside = !inside;
        }
        EXPECT_LE(crossings, 2) << speed << ' ' << acceleration << ' ' << distance;
        EXPECT_TRUE(inside) << "it falls back in the end";
    }
}

TEST(CellLists, AgreeWithSets) {
    constexpr std::uint64_t kSeed = 15;
    std::mt19937_64 random(kSeed);
    CellLists lists(3);
    std::map<std::int32_t, std::set<std::uint32_t>> expected;
    std::map<std::uint32_t, std::int32_t> where;
    for (int step = 0; step < 20'000; ++step) {
        const auto id = static_cast<std::uint32_t>(random() % 50);
        const auto cell = static_cast<std::int32_t>(random() % 3);
        if (const auto it = where.find(id); it != where.end()) {
            lists.remove(it->second, id);
            expected[it->second].erase(id);
            where.erase(it);
        } else {
            lists.insert(cell, id);
            expected[cell].insert(id);
            where[id] = cell;
        }
        for (std::int32_t c = 0; c < 3; ++c) {
            std::multiset<std::uint32_t> got;
            lists.for_each(c, [&](std::uint32_t k) { got.insert(k); });
            ASSERT_TRUE(std::equal(got.begin(), got.end(), expected[c].begin(), expected[c].end()))
                << "step " << step << " cell " << c;
        }
    }
}

/// Whether a ball with its centre at p touches the obstacle moved by the shift.
bool touches(const Vec2& p, double radius, const Scene& s, std::uint32_t id, const Vec2& shift) {
    if (id < s.balls.size()) return (p - s.balls[id].position - shift).norm() <= radius + s.balls[id].radius;
    const Wall& w = s.walls[id - s.balls.size()];
    return distance_to_segment(p, w.from + shift, w.to + shift) <= radius;
}

TEST(ObstacleMap, ListsWhatABallCouldTouch) {
    constexpr std::uint64_t kSeed = 16;
    std::mt19937_64 random(kSeed);
    for (const Boundary boundary : {Boundary::kPeriodic, Boundary::kWall, Boundary::kOpen}) {
        Scene s;
        s.domain = Domain{{{0, 0}, {20, 15}}, {boundary, boundary}, 1};
        for (int k = 0; k < 12; ++k) {
            Ball b;
            b.is_static = true;
            b.radius = uniform(random, 0.1, 3);
            b.position = {uniform(random, 0, 20), uniform(random, 0, 15)};
            s.balls.push_back(b);
            const Vec2 from = {uniform(random, 0, 20), uniform(random, 0, 15)};
            s.walls.push_back(
                {from, from + Vec2(uniform(random, -9, 9), k % 3 == 0 ? 0 : uniform(random, -9, 9)), 1});
        }
        if (boundary != Boundary::kPeriodic) {  // from side to side, and out of the box
            s.walls.push_back({{3, 0}, {11, 15}, 1});
            s.walls.push_back({{-40, -22}, {70, 31}, 1});
            s.walls.push_back({{20, 7}, {0, 8}, 1});
        }
        const Grid grid = choose_grid(*s.domain, 500, 1);
        const ObstacleMap map(grid, s.balls, s.walls, 0.5);
        const int periods = boundary == Boundary::kPeriodic ? 1 : 0;
        for (int k = 0; k < 20'000; ++k) {
            const Vec2 p = {uniform(random, 0, 20), uniform(random, 0, 15)};
            const auto entries = map.at(grid.index(grid.coordinates(p)));
            for (std::uint32_t id = 0; id < s.balls.size() + s.walls.size(); ++id)
                for (int nx = -periods; nx <= periods; ++nx)
                    for (int ny = -periods; ny <= periods; ++ny) {
                        if (!touches(p, 0.5, s, id, {20.0 * nx, 15.0 * ny})) continue;
                        const bool listed =
                            std::any_of(entries.begin(), entries.end(), [&](const ObstacleEntry& e) {
                                return e.id == id && e.shift_x == nx && e.shift_y == ny;
                            });
                        ASSERT_TRUE(listed) << "obstacle " << id << " moved by " << nx << ", " << ny << " at "
                                            << p.transpose();
                    }
        }
    }
}

}  // namespace
}  // namespace carom::test
