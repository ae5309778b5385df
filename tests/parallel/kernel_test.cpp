// What a world says that it runs: each feature of a scene asks for its part of the engine and no other.
#include <carom/parallel/world.hpp>

#include <gtest/gtest.h>

#include <functional>

#include "scenes.hpp"

namespace carom::test {
namespace {

std::string described(const Scene& scene, const WorldOptions& options = {}) {
    return describe(World(scene, options).kernel());
}

/// The plain gas with one thing changed.
Scene changed(const std::function<void(Scene&)>& change) {
    Scene s = gas(61, {});
    change(s);
    return s;
}

TEST(Kernel, OfThePlainGasHasNothingMore) {
    EXPECT_EQ(described(gas(61, {})),
              "no acceleration, equal radii, equal masses, elastic, periodic; bounds on vectors: yes");
}

TEST(Kernel, OfEachFeatureSaysSoAndNothingElse) {
    const auto expect = [](const std::string& kernel, const std::function<void(Scene&)>& change) {
        EXPECT_EQ(described(changed(change)), kernel);
    };
    expect(
        "uniform acceleration (gravity), equal radii, equal masses, elastic, periodic; bounds on vectors: "
        "yes",
        [](Scene& s) { s.gravity = {0, -0.1}; });
    expect(
        "acceleration per ball (the balls' own), equal radii, equal masses, elastic, periodic; bounds on "
        "vectors: no (accelerations differ from ball to ball)",
        [](Scene& s) { s.balls[3].acceleration = {0.1, 0}; });
    expect(
        "acceleration per ball (attractors), equal radii, equal masses, elastic, periodic; bounds on "
        "vectors: no (accelerations differ from ball to ball)",
        [](Scene& s) {
            s.attractors.push_back({{1, 1}, 1, 1});
            s.gravity = {0, -0.1};
        });
    expect("no acceleration, mixed radii, equal masses, elastic, periodic; bounds on vectors: yes",
           [](Scene& s) { s.balls[3].radius = 0.4; });
    expect("no acceleration, equal radii, mixed masses, elastic, periodic; bounds on vectors: yes",
           [](Scene& s) { s.balls[3].mass = 2; });
    expect(
        "no acceleration, equal radii, equal masses, elastic, contact time, periodic; bounds on vectors: yes",
        [](Scene& s) { s.contact_time = 0.01; });
    expect("no acceleration, equal radii, equal masses, losses, periodic; bounds on vectors: yes",
           [](Scene& s) {
               s.balls[3].restitution = 0.9;
               s.contact_time = 0;
           });
    expect(
        "no acceleration, equal radii, equal masses, losses, contact time, periodic; bounds on vectors: yes",
        [](Scene& s) { s.balls[3].restitution = 0.9; });
    expect(
        "no acceleration, equal radii, equal masses, elastic, x periodic, y walled; bounds on vectors: yes",
        [](Scene& s) { s.domain->boundary[1] = Boundary::kWall; });
    expect(
        "no acceleration, equal radii, equal masses, elastic, periodic, static balls; bounds on vectors: yes",
        [](Scene& s) {
            s.balls[3].is_static = true;
            s.balls[3].velocity.setZero();
        });
    expect(
        "no acceleration, equal radii, equal masses, elastic, periodic, rounds to float; bounds on vectors: "
        "yes",
        [](Scene& s) { s.precision = Precision::kFloat; });
    expect("no acceleration, equal radii, equal masses, elastic, open, walls; bounds on vectors: yes",
           [](Scene& s) {
               s.domain.reset();
               s.walls.push_back({{-3, 0}, {-3, 9}, 1});
           });
}

TEST(Kernel, CountsBallsWiderThanACell) {
    Scene s = gas(62, {});
    Ball big;
    big.radius = 3;
    big.position = {-4, -4};
    s.domain->box.min = {-8, -8};  // room beside the others
    s.balls.push_back(big);
    EXPECT_EQ(World(s).kernel().large_balls, 1U);
    EXPECT_NE(described(s).find("mixed radii, 1 wider than a cell (one domain)"), std::string::npos);
}

// With fewer than six cells along a period the nearest image need not be the one in the cell.
TEST(Kernel, HasNoBoundsInFewCells) {
    const Scene s = gas(63, {});
    const double side = s.domain->box.max.x();
    EXPECT_TRUE(World(s, {.cell_size = side / 6.001}).kernel().bounds_on_vectors);
    EXPECT_FALSE(World(s, {.cell_size = side / 5.001}).kernel().bounds_on_vectors);
    EXPECT_NE(described(s, {.cell_size = side / 5.001}).find("no (too few cells"), std::string::npos);
}

}  // namespace
}  // namespace carom::test
