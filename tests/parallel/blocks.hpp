// Means over blocks of a run, with the standard error that their scatter gives.
#pragma once

#include <cmath>
#include <vector>

#include <carom/parallel/world.hpp>

namespace carom::test {

/// Advances until every ball has had so many collisions on average since the last call.
inline void run_collisions(World& world, double per_ball) {
    const auto start = double(world.counts().ball_collisions);
    while (2 * (double(world.counts().ball_collisions) - start) < per_ball * double(world.ball_count()))
        world.step(0.05);
}

struct BlockMean {
    double mean;
    double error;  ///< standard error
};

inline BlockMean block_mean(const std::vector<double>& blocks) {
    const auto count = double(blocks.size());
    double mean = 0;
    for (const double z : blocks) mean += z / count;
    double variance = 0;
    for (const double z : blocks) variance += (z - mean) * (z - mean) / (count - 1);
    return {mean, std::sqrt(variance / count)};
}

/// PA / NkT of an elastic gas at rest as a whole, from the virial of each block of so many collisions a ball.
inline BlockMean compressibility_in_blocks(World& world, int blocks, double per_ball) {
    const auto discs = double(world.ball_count());
    const double temperature = world.kinetic_energy() / (discs - 1);
    std::vector<double> z;
    for (int k = 0; k < blocks; ++k) {
        const double virial = world.virial();
        const double time = world.time();
        run_collisions(world, per_ball);
        z.push_back(1 + (world.virial() - virial) / (2 * discs * temperature * (world.time() - time)));
    }
    return block_mean(z);
}

}  // namespace carom::test
