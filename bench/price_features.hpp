// What the price list prices: features of a scene, each on top of one plain gas.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

#include "gas_scene.hpp"

namespace carom::bench {

/// The gas that all features share: equal elastic discs of diameter 1, mass 1 and temperature 1 in a periodic
/// square.
struct PlainGas {
    std::uint64_t count = 10000;
    double packing = 0.5;
    [[nodiscard]] double free_time() const { return mean_free_time(packing); }
};

/// How the world is run.
struct Running {
    bool listens = false;
    double frame = 0;    ///< length of a step; 0: all in one
    bool reads = false;  ///< all positions after each step
};

/// Each part may be absent. `lay_out` changes the scene before its balls are placed, `alter` the placed
/// balls; the gas then melts. `force` changes what happens from there on: features of that kind alone start
/// from the plain gas's very state.
struct Feature {
    std::string name;
    void (*lay_out)(Scene& scene) = nullptr;
    void (*alter)(Scene& scene) = nullptr;
    void (*force)(Scene& scene, const PlainGas& gas) = nullptr;
    Running running = {};

    [[nodiscard]] bool starts_from_plain_gas() const { return lay_out == nullptr && alter == nullptr; }
};

[[nodiscard]] const std::vector<Feature>& features();

/// The feature's scene without its forces, its balls placed and melted for a few collisions a ball.
[[nodiscard]] Scene melted(const PlainGas& gas, const Feature& feature);

}  // namespace carom::bench
