// Domains side by side on scenes drawn at random: any number of domains, halo and frame gives the serial
// result to the bit, whatever the boundaries, sizes, speeds and the cells.
#include <gtest/gtest.h>

#include <tuple>

#include <carom/parallel/world.hpp>

#include "outcome.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

struct Draw {
    Scene scene;
    double until = 1;
    double step = 0;
    WorldOptions options;
};

std::size_t pick(std::mt19937_64& random, std::size_t count) {
    return static_cast<std::size_t>(random() % count);
}

/// Takes the balls out of part of the box, or moves some of them much faster than the others.
void unsettle(std::mt19937_64& random, Scene& s) {
    const Vec2 side = s.domain->box.max;
    const double kept = uniform(random, 0.3, 1.3);
    const int axis = static_cast<int>(pick(random, 2));
    std::erase_if(s.balls, [&](const Ball& b) { return b.position[axis] > kept * side[axis]; });
    const std::size_t every = 5 + pick(random, 60);
    const double faster = std::pow(10, uniform(random, 0, 2.5));
    for (std::size_t i = 0; i < s.balls.size(); i += every) s.balls[i].velocity *= faster;
    if (pick(random, 4) == 0)
        for (Ball& b : s.balls) b.velocity += Vec2(uniform(random, -20, 20), uniform(random, -20, 20));
    if (pick(random, 4) == 0)
        for (std::size_t i = 0; i < s.balls.size(); i += 2) s.balls[i].velocity.setZero();
}

/// A scene of some hundred balls, and how it is to be cut.
Draw draw(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    constexpr Boundary kBoundaries[] = {Boundary::kPeriodic, Boundary::kWall, Boundary::kOpen};
    const Boundary x = kBoundaries[pick(random, 3)];
    const Boundary y = kBoundaries[pick(random, 3)];
    const bool is_lossy = pick(random, 3) == 0;
    const GasOptions gas_options{.count = 60 + pick(random, 540),
                                 .packing = uniform(random, 0.02, 0.6),
                                 .boundary_x = x,
                                 .boundary_y = y,
                                 .restitution = is_lossy ? uniform(random, 0.5, 1) : 1,
                                 .radius_spread = pick(random, 2) == 0 ? 0 : uniform(random, 0, 0.9)};
    Draw d;
    d.scene = gas(random(), gas_options);
    if (y == Boundary::kWall && pick(random, 2) == 0) d.scene.gravity = {0, -uniform(random, 0.1, 3)};
    unsettle(random, d.scene);
    // Fast balls cross much, lossy piles collide often: as much as is to be seen in a short run.
    d.until = std::pow(10, uniform(random, -1, 0.3));
    d.step = pick(random, 2) == 0 ? 0 : d.until / double(1 + pick(random, 40));
    d.options = {.threads = 1 + static_cast<int>(pick(random, 2)),
                 .cell_size = pick(random, 2) == 0 ? 0 : uniform(random, 1.05, 4),
                 .domains = 2 + static_cast<int>(pick(random, 15)),
                 .halo = static_cast<int>(pick(random, 10))};
    return d;
}

// All comparisons are of bits: no bound.
TEST(RandomDomains, GiveTheSerialResult) {
    std::uint64_t collisions = 0;
    const std::uint64_t first = 1;
    const std::uint64_t last = 60;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        const Draw d = draw(seed);
        if (d.scene.balls.empty()) continue;
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(d.options.domains) +
                     " domains, halo of " + std::to_string(d.options.halo));
        const Outcome serial = run(d.scene, {.threads = 1, .domains = 1}, d.until);
        expect_equal(run(d.scene, d.options, d.until, d.step), serial);
        if (HasFailure()) return;
        collisions += serial.collisions.size();
    }
    EXPECT_GT(collisions, 1000 * (last - first) / 10);  // else there was little to compare
}

}  // namespace
}  // namespace carom::test
