// The gas that the programs of this folder run: the same start for the baseline and for Carom.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

namespace carom::plain {

/// Discs of diameter 1 and mass 1 in the periodic box [0, side)^2.
struct Gas {
    double side;
    std::vector<std::array<double, 2>> positions;
    std::vector<std::array<double, 2>>
        velocities;  ///< normal, variance 1 a component, total momentum removed
};

/// `count` is rounded to a square; the discs start on staggered rows, a lattice that holds up to packing 0.78
/// and melts within a few collisions a disc below 0.7. The same bits wherever log and sqrt round alike.
/// Throws std::invalid_argument when the discs would overlap or are none.
inline Gas make_gas(double count, double packing, std::uint64_t seed = 1) {
    constexpr double kPi = 3.14159265358979323846;
    const auto across = std::llround(std::sqrt(count));
    if (!(across >= 2) || !(packing > 0 && packing <= 0.78)) {
        throw std::invalid_argument("a gas has 2 discs or more, and a packing above 0 and up to 0.78");
    }
    const double discs = static_cast<double>(across) * static_cast<double>(across);
    Gas gas{std::sqrt(discs * kPi / 4 / packing), {}, {}};
    const double spacing = gas.side / static_cast<double>(across);

    // Marsaglia's polar method on the generator's top 53 bits: std::normal_distribution differs between
    // libraries.
    std::mt19937_64 bits(seed);
    const auto uniform = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1; };
    std::array<double, 2> total = {0, 0};
    for (long long row = 0; row < across; ++row) {
        const double shift = row % 2 == 0 ? 0.25 : 0.75;
        for (long long column = 0; column < across; ++column) {
            gas.positions.push_back({(static_cast<double>(column) + shift) * spacing,
                                     (static_cast<double>(row) + 0.5) * spacing});
            double u = 0, v = 0, square = 0;
            do {
                u = uniform(), v = uniform(), square = u * u + v * v;
            } while (square >= 1 || square == 0);
            const double scale = std::sqrt(-2 * std::log(square) / square);
            gas.velocities.push_back({u * scale, v * scale});
            total[0] += u * scale, total[1] += v * scale;
        }
    }
    for (auto& [vx, vy] : gas.velocities) vx -= total[0] / discs, vy -= total[1] / discs;
    return gas;
}

}  // namespace carom::plain
