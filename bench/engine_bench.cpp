// The engine on gases: collisions a second by size, packing and threads, the price of features and short
// frames.
//
// An iteration advances by one mean free time, in which a ball has one collision (a collision counts once,
// for two balls). `items_per_second` is collisions a second.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

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

// What a feature costs: a gas of 20,000 balls at packing 0.3 with one feature more, against `nothing`.
struct Feature {
    const char* name;
    void (*add)(Scene&, Domain&);
};

void add_nothing(Scene&, Domain&) {}
void mix_sizes(Scene& scene, Domain&) {
    scene.fills[0].radius_min = scene.fills[0].radius_max / 2;
}
void lose_energy(Scene& scene, Domain&) {
    scene.fills[0].restitution = 0.99;
}
void enclose(Scene&, Domain& domain) {
    domain.boundary = {Boundary::kWall, Boundary::kWall};
}

// Weak, so that the gas stays nearly even: m g h over the whole height is a tenth of kT.
void enclose_and_pull(Scene& scene, Domain& domain) {
    enclose(scene, domain);
    scene.gravity = {0, -0.1 / domain.box.max.y()};
}

void enclose_and_attract(Scene& scene, Domain& domain) {
    enclose(scene, domain);
    const Vec2 centre = domain.box.max / 2;
    scene.attractors.push_back({centre, 0.1, centre.x() / 4});
    scene.field_interval = mean_free_time(0.3) / 2;
}

// A hundred segments of many slants, spread over the box; the fill keeps clear of them.
void add_walls(Scene& scene, Domain& domain) {
    constexpr int kAcross = 10;
    const double pitch = domain.box.max.x() / kAcross;
    for (int row = 0; row < kAcross; ++row) {
        for (int column = 0; column < kAcross; ++column) {
            const double angle = row * kAcross + column;
            const Vec2 middle((column + 0.5) * pitch, (row + 0.5) * pitch);
            const Vec2 half(0.2 * pitch * std::cos(angle), 0.2 * pitch * std::sin(angle));
            scene.walls.push_back({middle - half, middle + half, 1});
        }
    }
}

constexpr Feature kFeatures[] = {{"nothing", add_nothing},
                                 {"restitution", lose_energy},
                                 {"mixed_sizes", mix_sizes},
                                 {"walls", add_walls},
                                 {"sides", enclose},
                                 {"sides_and_gravity", enclose_and_pull},
                                 {"sides_and_attractor", enclose_and_attract}};

void engine_feature(benchmark::State& state) {
    constexpr double kPacking = 0.3;
    constexpr std::uint64_t kCount = 20000;
    const Feature& feature = kFeatures[state.range(0)];
    Scene scene = gas_scene(kCount, kPacking);
    Domain domain = square(kCount, kPacking);
    feature.add(scene, domain);
    scene.domain = domain;
    state.SetLabel(feature.name);
    run(state, World(scene, on_threads(1)), kWarmUp * mean_free_time(kPacking),
        long_enough(kCount, kPacking));
}
BENCHMARK(engine_feature)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(10)
    ->ArgName("feature")
    ->DenseRange(0, static_cast<int>(std::size(kFeatures)) - 1);

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

// Reading all positions, in balls a second.
void engine_read_positions(benchmark::State& state) {
    World world(gas_scene(static_cast<std::uint64_t>(state.range(0)), 0.3));
    world.step(mean_free_time(0.3));
    for ([[maybe_unused]] const auto _ : state) benchmark::DoNotOptimize(world.positions());
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(engine_read_positions)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime()
    ->ArgName("balls")
    ->Arg(10000)
    ->Arg(100000);

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
