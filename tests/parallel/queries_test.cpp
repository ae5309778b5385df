// What is where: answers against a look at every ball and every image.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <random>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"

namespace carom::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The shifts of a ball that may matter within `reach` periods of the box.
std::vector<Vec2> images(const Domain& domain, int reach) {
    std::vector<Vec2> all;
    const Vec2 width = domain.box.max - domain.box.min;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            if ((x == 0 || domain.boundary[0] == Boundary::kPeriodic) &&
                (y == 0 || domain.boundary[1] == Boundary::kPeriodic))
                all.emplace_back(x * width.x(), y * width.y());
    return all;
}

Vec2 point_about(std::mt19937_64& random, const Domain& domain) {
    const Vec2 width = domain.box.max - domain.box.min;
    return domain.box.min +
           Vec2(uniform(random, -0.5, 1.5) * width.x(), uniform(random, -0.5, 1.5) * width.y());
}

class Queries : public testing::TestWithParam<NamedScene> {
 protected:
    Queries() : world_(GetParam().scene) {
        world_.advance_to(1.5);
        world_.remove_ball(world_.ball_ids()[world_.ball_count() / 2]);  // so that ids are not indices
    }
    World world_;
    std::mt19937_64 random_{11};
};

TEST_P(Queries, BallsInBoxesAndDiscs) {
    const std::vector<Ball> balls = world_.balls();
    const std::vector<std::uint32_t> ids = world_.ball_ids();
    const std::vector<Vec2> shifts = images(world_.domain(), 3);
    for (int k = 0; k < 100; ++k) {
        const Vec2 p = point_about(random_, world_.domain());
        const Vec2 size(uniform(random_, 0, 4), uniform(random_, 0, k % 10 == 0 ? 60 : 4));
        const double radius = k % 3 == 0 ? 0 : uniform(random_, 0, 3);
        std::vector<std::uint32_t> in_box, in_disc;
        for (std::size_t i = 0; i < balls.size(); ++i) {
            bool is_in_box = false, is_in_disc = false;
            for (const Vec2& shift : shifts) {
                const Vec2 c = balls[i].position + shift;
                const Vec2 nearest = c.cwiseMax(p).cwiseMin(p + size);
                is_in_box = is_in_box || (c - nearest).norm() <= balls[i].radius;
                is_in_disc = is_in_disc || (c - p).norm() <= radius + balls[i].radius;
            }
            if (is_in_box) in_box.push_back(ids[i]);
            if (is_in_disc) in_disc.push_back(ids[i]);
        }
        EXPECT_EQ(world_.balls_in({p, p + size}), in_box);
        EXPECT_EQ(world_.balls_at(p, radius), in_disc);
    }
}

TEST_P(Queries, NearestBall) {
    const std::vector<Ball> balls = world_.balls();
    const std::vector<Vec2> shifts = images(world_.domain(), 3);
    for (int k = 0; k < 100; ++k) {
        const Vec2 p = point_about(random_, world_.domain());
        double least = kInfinity;
        for (const Ball& b : balls)
            for (const Vec2& shift : shifts)
                least = std::min(least, (b.position + shift - p).norm() - b.radius);
        const std::optional<NearestBall> found = world_.nearest_ball(p);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, least, 1e-12 * 100);  // coordinates of up to 100
        const std::vector<std::uint32_t> at = world_.balls_at(p, std::max(0.0, least + 1e-9));
        EXPECT_THAT(at, testing::Contains(found->id));
    }
}

TEST_P(Queries, NearestBallButOne) {
    const std::vector<Ball> balls = world_.balls();
    const std::vector<std::uint32_t> ids = world_.ball_ids();
    const std::vector<Vec2> shifts = images(world_.domain(), 3);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        double least = kInfinity;
        for (std::size_t j = 0; j < balls.size(); ++j)
            for (const Vec2& shift : shifts)
                if (j != i)
                    least = std::min(
                        least, (balls[j].position + shift - balls[i].position).norm() - balls[j].radius);
        const std::optional<NearestBall> found = world_.nearest_ball(balls[i].position, ids[i]);
        ASSERT_TRUE(found);
        EXPECT_NE(found->id, ids[i]);
        EXPECT_NEAR(found->distance, least, 1e-12 * 100);  // coordinates of up to 100
    }
    EXPECT_THROW(static_cast<void>(world_.nearest_ball({0, 0}, 1'000'000)), std::out_of_range);
}

/// When a walk along the ray, in pieces of 1e-3, first stands in a disc or has crossed a wall or side.
TEST_P(Queries, RaysMeetWhatAWalkMeets) {
    const std::vector<Ball> balls = world_.balls();
    const Domain& domain = world_.domain();
    const std::vector<Vec2> shifts = images(domain, 2);
    constexpr double kLength = 12;
    for (int k = 0; k < 40; ++k) {
        const Vec2 width = domain.box.max - domain.box.min;
        const Vec2 from = domain.box.min + Vec2(uniform(random_, 0.01, 0.99) * width.x(),
                                                uniform(random_, 0.01, 0.99) * width.y());
        const Vec2 direction = random_velocity(random_, 1).normalized();
        double first =
            kInfinity;  // by solving for every image of every ball, in other words than the library
        for (const Ball& b : balls) {
            for (const Vec2& shift : shifts) {
                const Vec2 r = b.position + shift - from;
                if (r.norm() <= b.radius) first = 0;
                const double along = r.dot(direction);
                const double off = std::sqrt(std::max(0.0, r.squaredNorm() - along * along));
                if (off >= b.radius || along < 0) continue;
                first = std::min(first, along - std::sqrt(b.radius * b.radius - off * off));
            }
        }
        for (int axis = 0; axis < 2; ++axis) {
            if (domain.boundary[axis] != Boundary::kWall || direction[axis] == 0) continue;
            const double side = direction[axis] > 0 ? domain.box.max[axis] : domain.box.min[axis];
            first = std::min(first, (side - from[axis]) / direction[axis]);
        }
        for (const Wall& wall : world_.walls()) {
            for (const Vec2& shift : shifts) {
                Eigen::Matrix2d m;
                m << direction, wall.from - wall.to;
                if (std::abs(m.determinant()) < 1e-12) continue;
                const Vec2 s = m.inverse() * (wall.from + shift - from);
                if (s.x() >= 0 && s.y() >= 0 && s.y() <= 1) first = std::min(first, s.x());
            }
        }
        first = std::max(first, 0.0);
        const std::optional<RayHit> hit = world_.cast_ray(from, 2 * direction, kLength);
        ASSERT_EQ(hit.has_value(), first <= kLength) << "ray " << k << " meets at " << first;
        if (!hit) continue;
        // Near a grazing the root loses half of the digits.
        EXPECT_NEAR(hit->distance, first, 1e-6);
        EXPECT_NEAR(hit->normal.norm(), 1, 1e-12);
        EXPECT_LE(hit->normal.dot(direction), 1e-12);
        if (hit->kind == CollisionKind::kBall && hit->distance > 0) {
            const Ball b = world_.ball(hit->id);
            double least = kInfinity;
            for (const Vec2& shift : shifts)
                least = std::min(least, std::abs((hit->point - b.position - shift).norm() - b.radius));
            EXPECT_LT(least, 1e-9);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Queries, testing::ValuesIn(feature_scenes()), kNameOfScene);

TEST(Query, AnswersAreOfTheTimeAndOfTheEdits) {
    Scene scene;
    scene.balls = {{.position = {0, 0}, .velocity = {1, 0}}};
    World world(scene);
    EXPECT_THAT(world.balls_at({0, 0}), testing::ElementsAre(0));
    world.advance_to(5);
    EXPECT_THAT(world.balls_at({0, 0}), testing::IsEmpty());
    EXPECT_THAT(world.balls_at({5.4, 0}), testing::ElementsAre(0));
    world.set_position(0, {-7, 0});
    EXPECT_THAT(world.balls_at({5.4, 0}), testing::IsEmpty());
    EXPECT_THAT(world.balls_in({{-8, -1}, {-7.5, 1}}), testing::ElementsAre(0));
    const std::optional<RayHit> hit = world.cast_ray({-7, 4}, {0, -3}, 10);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->distance, 3.5);
    EXPECT_EQ(hit->point, Vec2(-7, 0.5));
    EXPECT_EQ(hit->normal, Vec2(0, 1));
    EXPECT_FALSE(world.cast_ray({-7, 4}, {0, -3}, 3.4));
    world.remove_ball(0);
    EXPECT_FALSE(world.nearest_ball({0, 0}));
}

TEST(Query, RefusesWhatIsNoPlace) {
    World world(gas(1, {.count = 10, .packing = 0.1}));
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(static_cast<void>(world.balls_at({kNan, 0})), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(world.nearest_ball({0, kInfinity})), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(world.cast_ray({0, 0}, {0, 0}, 1)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(world.cast_ray({0, 0}, {1, 0}, -1)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(world.cast_ray({0, 0}, {1, 0}, kInfinity)), std::invalid_argument);
}

}  // namespace
}  // namespace carom::test
