// The scenes that come with the program do what they promise, through the reader and the engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

namespace carom::test {
namespace {

Scene shipped(const std::string& name) {
    return read_scene(std::filesystem::path(CAROM_SOURCE_DIR) / "scenes" / (name + ".json"));
}

/// Runs to the scene's end in ten parts and looks at everything in between.
void expect_sound(World& world, double until) {
    const Box& box = world.domain().box;
    for (int part = 1; part <= 10; ++part) {
        world.advance_to(until * part / 10);
        ASSERT_THAT(world.validate(), testing::IsEmpty())
            << world.validate().front().what << " at time " << world.time();
        ASSERT_LT(world.max_overlap(), 1e-12);
        const std::vector<Ball> balls = world.balls();
        for (std::size_t i = 0; i < balls.size(); ++i) {
            if (balls[i].is_static) continue;
            for (int axis = 0; axis < 2; ++axis) {
                if (world.domain().boundary[static_cast<std::size_t>(axis)] == Boundary::kOpen) continue;
                ASSERT_GE(balls[i].position[axis], box.min[axis]) << "balls[" << i << "]";
                ASSERT_LE(balls[i].position[axis], box.max[axis]) << "balls[" << i << "]";
            }
        }
    }
}

class ShippedScene : public testing::TestWithParam<const char*> {};

TEST_P(ShippedScene, StaysSoundToItsEnd) {
    const Scene scene = shipped(GetParam());
    World world(scene);
    expect_sound(world, scene.until);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScene,
                         testing::Values("screensaver", "break-shot", "newtons-cradle", "funnel", "galperin",
                                         "gas-1e3", "granular-gas", "mixture"),
                         [](const auto& param) {
                             std::string name = param.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(ShippedScene, ScreensaverHasItsBlackHoles) {
    const Scene scene = shipped("screensaver");
    EXPECT_EQ(scene.attractors.size(), 2u);
    EXPECT_EQ(scene.until, 60);
    EXPECT_FALSE(scene.walls.empty());
}

// The cradle passes on one ball's motion without loss: the energy is exact, and one ball moves at a time
// between the touches.
TEST(ShippedScene, CradleKeepsItsEnergyExactly) {
    const Scene scene = shipped("newtons-cradle");
    World world(scene);
    const double energy = world.energy();
    world.advance_to(scene.until);
    EXPECT_EQ(world.energy(), energy);
    EXPECT_GT(world.counts().ball_collisions, 4u);
}

TEST(ShippedScene, GalperinCounts) {
    const Scene scene = shipped("galperin");
    World world(scene);
    world.advance_to(scene.until);
    const double heavy = std::max(scene.balls[0].mass, scene.balls[1].mass);
    const double light = std::min(scene.balls[0].mass, scene.balls[1].mass);
    const Counts counts = world.counts();
    EXPECT_EQ(double(counts.ball_collisions + counts.wall_collisions),
              std::floor(3.14159265358979 * std::sqrt(heavy / light)));
}

TEST(ShippedScene, FunnelEmpties) {
    const Scene scene = shipped("funnel");
    World world(scene);
    double mouth = scene.walls.front().from.y();
    for (const Wall& w : scene.walls) mouth = std::min({mouth, w.from.y(), w.to.y()});
    world.advance_to(scene.until);
    const PlaneVectors x = world.positions();
    const auto above = std::ranges::count_if(x, [mouth](const Vec2& p) { return p.y() > mouth + 1; });
    EXPECT_LT(double(above), 0.2 * double(x.size())) << "most of the balls have fallen through";
}

}  // namespace
}  // namespace carom::test
