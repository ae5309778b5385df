// The engine on gases: collisions a second by size, packing and threads, and short frames. What features
// cost is carom_price's.
//
// An iteration advances by one mean free time, in which a ball has one collision (a collision counts once,
// for two balls). `items_per_second` is collisions a second.
#include <algorithm>
#include <cstdint>

#include <benchmark/benchmark.h>
#include <carom/parallel/world.hpp>

#include "gas_scene.hpp"

namespace carom::bench {
namespace {

constexpr double kWarmUp = 6;  // collisions a ball, until the start has melted

std::uint64_t collisions_of(const World& world) {
    const Counts counts = world.counts();
    return counts.ball_collisions + counts.wall_collisions;
}

// Warms the world up, then advances it by `duration` an iteration.
void run(benchmark::State& state, World world, double warm_up, double duration) {
    world.step(warm_up);
    const Counts counts_0 = world.counts();
    const std::uint64_t collisions_0 = collisions_of(world);
    for ([[maybe_unused]] const auto _ : state) world.step(duration);
    const auto collisions =
        static_cast<double>(std::max<std::uint64_t>(1, collisions_of(world) - collisions_0));
    state.SetItemsProcessed(static_cast<std::int64_t>(collisions));
    state.counters["events/collision"] =
        static_cast<double>(world.counts().events - counts_0.events) / collisions;
    state.counters["threads"] = world.threads();
}

WorldOptions on_threads(std::int64_t threads) {
    WorldOptions options;
    options.threads = static_cast<int>(threads);
    return options;
}

// The time for 100,000 collisions or one a ball, whichever is longer: small gases too give the clock work.
double long_enough(double count, double packing) {
    return mean_free_time(packing) * std::max(1.0, 200000 / count);
}

void engine_gas(benchmark::State& state) {
    const double packing = static_cast<double>(state.range(1)) / 100;
    run(state,
        World(gas_scene(static_cast<std::uint64_t>(state.range(0)), packing), on_threads(state.range(2))),
        kWarmUp * mean_free_time(packing), long_enough(static_cast<double>(state.range(0)), packing));
}
// A fixed number of iterations: the library would otherwise place and warm up a world for each guess at one.
BENCHMARK(engine_gas)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(5)
    ->ArgNames({"balls", "packing%", "threads"})
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {20, 50, 70}, {1, 0}});

// All pairs of a lattice meet head on at one instant, again and again: an iteration is two such instants.
void engine_simultaneous(benchmark::State& state) {
    const auto across = static_cast<int>(state.range(0));
    Scene scene;
    const Vec2 size(2.0 * across, 2.0 * across);
    scene.domain = Domain{{{0, 0}, size}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    for (int k = 0; k < across * across; ++k) {
        Ball& ball = scene.balls.emplace_back();
        ball.position = {2.0 * (k % across) + 1, 2.0 * static_cast<double>(k / across) + 1};
        ball.velocity = {k % 2 == 0 ? 1.0 : -1.0, 0};
    }
    run(state, World(scene, on_threads(state.range(1))), 0.25, 2);
}
BENCHMARK(engine_simultaneous)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(5)
    ->ArgNames({"across", "threads"})
    ->ArgsProduct({{32, 100, 320}, {1, 0}});

// Frames of a hundredth of a mean free time: what step() costs beyond the events. An iteration is a frame.
void engine_frames(benchmark::State& state) {
    constexpr double kPacking = 0.3;
    run(state,
        World(gas_scene(static_cast<std::uint64_t>(state.range(0)), kPacking), on_threads(state.range(1))),
        kWarmUp * mean_free_time(kPacking), mean_free_time(kPacking) / 100);
}
BENCHMARK(engine_frames)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime()
    ->Iterations(200)
    ->ArgNames({"balls", "threads"})
    ->ArgsProduct({{1000, 10000, 100000}, {1, 0}});

// Frames of a tenth of a mean free time in which a player has a hand: one ball's velocity, edited in place,
// or its mass, which makes the world anew.
enum class Edit : std::uint8_t { kNone, kVelocity, kMass };
void engine_edited_frames(benchmark::State& state) {
    constexpr double kPacking = 0.3;
    const auto balls = static_cast<std::uint32_t>(state.range(0));
    World world(gas_scene(balls, kPacking), on_threads(state.range(1)));
    world.step(kWarmUp * mean_free_time(kPacking));
    std::uint32_t ball = 0;
    for ([[maybe_unused]] const auto _ : state) {
        ball = (ball + 7919) % balls;
        if (state.range(2) == static_cast<std::int64_t>(Edit::kVelocity)) world.set_velocity(ball, {1, 1});
        if (state.range(2) == static_cast<std::int64_t>(Edit::kMass)) world.set_mass(ball, 1);
        world.step(mean_free_time(kPacking) / 10);
    }
}
BENCHMARK(engine_edited_frames)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime()
    ->Iterations(200)
    ->ArgNames({"balls", "threads", "edit"})
    ->ArgsProduct({{1000, 10000, 100000}, {1, 2}, {0, 1, 2}});

// Reading all positions, in balls a second, after a step so short that nothing happens in it: at one time
// twice costs less.
void engine_read_positions(benchmark::State& state) {
    World world(gas_scene(static_cast<std::uint64_t>(state.range(0)), 0.3), {.threads = 1});
    world.step(mean_free_time(0.3));
    for ([[maybe_unused]] const auto _ : state) {
        world.step(1e-9 * mean_free_time(0.3));
        benchmark::DoNotOptimize(world.positions());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(engine_read_positions)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime()
    ->ArgName("balls")
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000);

// From a scene to the first event.
void engine_build(benchmark::State& state) {
    const Scene scene = gas_scene(static_cast<std::uint64_t>(state.range(0)), 0.5);
    for ([[maybe_unused]] const auto _ : state) {
        const World world(scene);
        benchmark::DoNotOptimize(world.time());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(engine_build)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgName("balls")
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000);

}  // namespace
}  // namespace carom::bench
