// What comes before the first event: filling the grid's cells, finding overlaps, placing a fill's balls.
#include <cstdint>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <carom/broadphase/cell_lists.hpp>
#include <carom/broadphase/grid.hpp>
#include <carom/broadphase/overlap.hpp>
#include <carom/broadphase/placement.hpp>

#include "gas_scene.hpp"
#include "random_inputs.hpp"

namespace carom::bench {
namespace {

double packing_of(const benchmark::State& state) {
    return static_cast<double>(state.range(1)) / 100;
}

void count_balls(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

// Every ball into its cell, in the order of the ids, which is at random in space.
void grid_build(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const Domain domain = square(static_cast<double>(count), packing_of(state));
    const double side = domain.box.max.x();
    Uniform uniform(3);
    std::vector<Vec2> positions(count);
    for (Vec2& position : positions) position = {uniform(0, side), uniform(0, side)};
    for ([[maybe_unused]] const auto _ : state) {
        const Grid grid = choose_grid(domain, count, 1.0);
        CellLists lists(static_cast<std::size_t>(grid.cell_count()));
        for (std::uint32_t id = 0; id < count; ++id)
            lists.insert(grid.index(grid.coordinates(positions[id])), id);
        benchmark::DoNotOptimize(lists);
    }
    count_balls(state);
}
BENCHMARK(grid_build)
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{100000, 1000000}, {20, 70}})
    ->ArgNames({"balls", "packing%"});

// Equal discs. Below packing 0.5 they are put down at random, above they start from a dense arrangement.
void placement(benchmark::State& state) {
    const Scene scene = gas_scene(static_cast<std::uint64_t>(state.range(0)), packing_of(state));
    for ([[maybe_unused]] const auto _ : state) benchmark::DoNotOptimize(place_balls(scene));
    count_balls(state);
}
BENCHMARK(placement)
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{100000, 1000000}, {20, 50, 70}})
    ->ArgNames({"balls", "packing%"});

// Radii between 0.5 and 1 of the largest.
void placement_mixed(benchmark::State& state) {
    Scene scene = gas_scene(static_cast<std::uint64_t>(state.range(0)), packing_of(state));
    scene.fills[0].radius_min = scene.fills[0].radius_max / 2;
    for ([[maybe_unused]] const auto _ : state) benchmark::DoNotOptimize(place_balls(scene));
    count_balls(state);
}
BENCHMARK(placement_mixed)
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{100000, 1000000}, {20, 70}})
    ->ArgNames({"balls", "packing%"});

}  // namespace
}  // namespace carom::bench
