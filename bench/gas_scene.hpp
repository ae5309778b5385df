// Scenes of a hard-disc gas for the benchmarks, and the time scale that they are measured on.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <carom/core/scene.hpp>

namespace carom::bench {

/// Mean time between two collisions of one disc, diameter 1, mass 1, temperature 1: Enskog's rate with the
/// contact value of Henderson, Mol. Phys. 30, 971 (1975); good to a percent or two below packing 0.65. Only
/// the length of runs depends on it.
[[nodiscard]] inline double mean_free_time(double packing) {
    const double contact_value = (1 - 7 * packing / 16) / ((1 - packing) * (1 - packing));
    return std::sqrt(std::numbers::pi) / (8 * packing * contact_value);
}

/// The square that `count` discs of diameter 1 fill to `packing`.
[[nodiscard]] inline Domain square(double count, double packing, Boundary boundary = Boundary::kPeriodic) {
    const double side = std::sqrt(count * std::numbers::pi / 4 / packing);
    return {{{0, 0}, {side, side}}, {boundary, boundary}, 1};
}

/// Equal discs placed at random, diameter 1, temperature 1, periodic on both axes.
[[nodiscard]] inline Scene gas_scene(std::uint64_t count, double packing) {
    Scene scene;
    scene.domain = square(static_cast<double>(count), packing);
    Fill fill;
    fill.count = count;
    fill.packing_fraction = packing;
    fill.temperature = 1;
    scene.fills.push_back(fill);
    return scene;
}

}  // namespace carom::bench
