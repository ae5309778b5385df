// The invariants that promise the same bits: threads, frames, cells; and that reading changes nothing.
#include <gtest/gtest.h>

#include <carom/parallel/world.hpp>

#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

constexpr double kEnd = kIsSanitized ? 1.5 : 6.25;

std::uint64_t hash_of(const Scene& scene, const WorldOptions& options,
                      const std::vector<double>& stops = {}) {
    World world(scene, options);
    for (const double t : stops) world.advance_to(t);
    world.advance_to(kEnd);
    return world.state_hash();
}

class Invariance : public testing::TestWithParam<NamedScene> {};

TEST_P(Invariance, OfThreads) {
    const std::uint64_t one = hash_of(GetParam().scene, {.threads = 1});
    for (const int threads : {2, 3, 8})
        EXPECT_EQ(hash_of(GetParam().scene, {.threads = threads}), one) << threads << " threads";
}

/// With a thread for each domain their loops stay from window to window.
int threads_for(int domains, int halo) {
    return (domains + halo / 2) % 2 == 0 ? domains : 1;
}

TEST_P(Invariance, OfDomains) {
    const std::uint64_t one = hash_of(GetParam().scene, {.threads = 1, .domains = 1});
    for (const int domains : {2, 3, 5, 8, 16})
        for (const int halo : {0, 2})
            EXPECT_EQ(hash_of(GetParam().scene,
                              {.threads = threads_for(domains, halo), .domains = domains, .halo = halo}),
                      one)
                << domains << " domains with halo " << halo;
}

TEST_P(Invariance, OfFrames) {
    const std::uint64_t whole = hash_of(GetParam().scene, {.threads = 1});
    std::vector<double> frames;
    for (int k = 1; k / 60.0 < kEnd; ++k) frames.push_back(k / 60.0);
    EXPECT_EQ(hash_of(GetParam().scene, {.threads = 1}, frames), whole) << "frames of 1/60";

    EXPECT_EQ(hash_of(GetParam().scene, {.threads = 2, .domains = 4}, frames), whole) << "frames and domains";

    constexpr std::uint64_t kSeed = 7;
    std::mt19937_64 random(kSeed);
    std::vector<double> irregular;
    for (double t = 0; t < kEnd; t += std::exp2(uniform(random, -20, 1))) irregular.push_back(t);
    EXPECT_EQ(hash_of(GetParam().scene, {.threads = 1}, irregular), whole)
        << "irregular steps of seed " << kSeed;
}

TEST_P(Invariance, OfCells) {
    const std::uint64_t chosen = hash_of(GetParam().scene, {.threads = 1});
    for (const double size : {1.02, 1.7, 4.0, 1e9})
        EXPECT_EQ(hash_of(GetParam().scene, {.threads = 1, .cell_size = size}), chosen) << size;
}

TEST_P(Invariance, OfReading) {
    World world(GetParam().scene, {.threads = 1});
    for (double t = 0; t < kEnd; t += 0.5) {
        world.advance_to(t);
        const std::uint64_t before = world.state_hash();
        (void)world.positions();
        (void)world.velocities();
        (void)world.energy();
        EXPECT_TRUE(world.validate().empty()) << world.validate().front().what;
        EXPECT_EQ(world.state_hash(), before);
    }
    world.advance_to(kEnd);
    EXPECT_EQ(world.state_hash(), hash_of(GetParam().scene, {.threads = 1}));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Invariance, testing::ValuesIn(all_scenes()), kNameOfScene);
INSTANTIATE_TEST_SUITE_P(Empirical, Invariance, testing::ValuesIn(by_steps(all_scenes())), kNameOfScene);

TEST(StateHash, ChangesWithTheLastBitOfOneVelocity) {
    Scene scene = gas(1, {});
    const std::uint64_t before = World(scene).state_hash();
    scene.balls[17].velocity.y() = std::nextafter(scene.balls[17].velocity.y(), 10.0);
    EXPECT_NE(World(scene).state_hash(), before);
}

TEST(StateHash, ChangesWhenTwoBallsSwap) {
    Scene scene = gas(1, {});
    const std::uint64_t before = World(scene).state_hash();
    std::swap(scene.balls[3], scene.balls[4]);
    EXPECT_NE(World(scene).state_hash(), before);
}

}  // namespace
}  // namespace carom::test
