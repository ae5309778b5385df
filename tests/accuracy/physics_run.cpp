#include "accuracy/physics_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace carom::accuracy {

double side_of(const GasRun& run, const Mixture& mixture) {
    const double discs =
        static_cast<double>(run.discs) * std::numbers::pi / 4 * mixture.mean_diameter_squared();
    return std::sqrt(discs / run.packing);
}

Scene filled_box(const GasRun& run, const Mixture& mixture, Boundary boundary) {
    Scene scene;
    const double half = side_of(run, mixture) / 2;
    scene.domain = Domain{{{-half, -half}, {half, half}}, {boundary, boundary}, 1};
    scene.until = 1;
    const auto first =
        static_cast<std::uint64_t>(std::llround(static_cast<double>(run.discs) * mixture.share[0]));
    for (const std::size_t species : {0, 1}) {
        Fill fill;
        fill.count = species == 0 ? first : run.discs - first;
        if (*fill.count == 0) continue;
        fill.radius_min = fill.radius_max = mixture.diameter[species] / 2;
        fill.mass = mixture.mass[species];
        fill.temperature = 1;
        fill.seed = run.seed;
        scene.fills.push_back(fill);
    }
    return scene;
}

void run_blocks(World& world, int blocks, double block_time, const std::function<void()>& after_each) {
    const double start = world.time();
    for (int k = 1; k <= blocks; ++k) {
        world.advance_to(start + k * block_time);
        if (after_each) after_each();
    }
}

GasSeries measure_gas(World& world, int blocks, double block_time, const std::function<void()>& after_each) {
    GasSeries series{{}, {}, block_time};
    double virial = world.virial();
    auto collisions = static_cast<double>(world.counts().ball_collisions);
    run_blocks(world, blocks, block_time, [&] {
        const double virial_now = world.virial();
        const auto collisions_now = static_cast<double>(world.counts().ball_collisions);
        series.virial.push_back(virial_now - virial);
        series.collisions.push_back(collisions_now - collisions);
        virial = virial_now;
        collisions = collisions_now;
        if (after_each) after_each();
    });
    return series;
}

Estimate compressibility_of(const GasSeries& series, std::size_t discs, double temperature) {
    Estimate z = scaled(mean_of(series.virial),
                        1 / (2 * static_cast<double>(discs) * temperature * series.block_time));
    z.value += 1;
    return z;
}

double periodic_temperature(const World& world) {
    return world.kinetic_energy() / static_cast<double>(world.ball_count() - 1);
}

std::string system_name(const GasRun& run, const Mixture& mixture) {
    return fmt::format("{} {}, packing {}", run.discs, mixture.name, run.packing);
}

}  // namespace carom::accuracy
