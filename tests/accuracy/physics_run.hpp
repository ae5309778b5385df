// What the measurements of physics share: boxes filled with gas, and runs cut into blocks of equal time.
#pragma once

#include <functional>
#include <vector>

#include "accuracy/physics.hpp"

namespace carom::accuracy {

/// Side of the square in which so many discs have the packing.
double side_of(const GasRun& run, const Mixture& mixture);

/// A square box around the origin with both species in it, the first one's ids first, at k T = 1.
Scene filled_box(const GasRun& run, const Mixture& mixture, Boundary boundary);

/// Advances so many blocks of equal time, and hands over the world after each.
void run_blocks(World& world, int blocks, double block_time, const std::function<void()>& after_each);

/// The virial, and the collisions of two discs, in each block.
struct GasSeries {
    std::vector<double> virial, collisions;
    double block_time;
};
GasSeries measure_gas(World& world, int blocks, double block_time,
                      const std::function<void()>& after_each = {});

/// Z = 1 + W / (2 N k T t) of a periodic box.
Estimate compressibility_of(const GasSeries& series, std::size_t discs, double temperature);

/// k T of a periodic box, whose 2 (N - 1) velocities at rest as a whole share the energy.
double periodic_temperature(const World& world);

/// "1024 discs, packing 0.3", or so many discs of a mixture
std::string system_name(const GasRun& run, const Mixture& mixture = kEqualDiscs);

}  // namespace carom::accuracy
