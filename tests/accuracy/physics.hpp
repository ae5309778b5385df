// Measures what statistical mechanics knows of hard discs, through the whole engine: each function runs a
// system and returns figures, each with its standard error and the value that it should have. Discs have
// diameter 1 and mass 1 where nothing else is said, and k T is near 1. carom_accuracy prints the figures of
// long runs as a table of docs/accuracy.md, gas_physics_test keeps those of short ones.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/physics_statistics.hpp"
#include "accuracy/physics_theory.hpp"

namespace carom::accuracy {

struct Figure {
    std::string quantity, system;
    Estimate measured;
    double expected = 0;
    double systematic = 0;  ///< bound of what `expected` itself is off by

    /// (measured - expected) / standard error.
    [[nodiscard]] double deviation() const;
    /// Within three standard errors and the bound.
    [[nodiscard]] bool agrees() const;
};

struct GasRun {
    std::size_t discs;
    double packing;
    double collisions;  ///< that a disc has while it is measured, roughly
    std::uint64_t seed;
    WorldOptions options{.threads = 1};
};

/// Z of a periodic gas from the virial, against Kolafa and Rottner 2006 where their table has the packing;
/// and the rate of collisions over Enskog's, whose chi comes from the measured Z: 1 in equilibrium, where
/// velocities are independent of places.
std::vector<Figure> periodic_gas(const GasRun& run);

/// Two discs in a periodic box: Z = (1 - eta) / (1 - 2 eta) exactly, for the relative motion is one point
/// among one obstacle's images. Mean of so many runs of so much time.
Figure two_discs(double packing, int runs, double time, std::uint64_t seed);

/// Velocities of a gas that starts with equal speeds: chi-square of all components in classes that are
/// equally probable at the given energy and momentum, and their kurtosis.
std::vector<Figure> maxwell_distribution(const GasRun& run);

/// Gas in a reflecting box: what its walls take up against kinetic energy and virial. The first figure is P L
/// (L - 2 r) / (N k T), the second the same with the motion at both ends of the run taken into account, where
/// nothing is left but rounding. `discs` is shared among both species.
std::vector<Figure> walled_gas(const GasRun& run, const Mixture& mixture);

/// Gas over a floor under gravity, the packing that at the floor: what the floor takes up against the weight;
/// and the heights against those of an ideal gas of the given energy, or, where it is dense, the weight above
/// against the equation of state at the local density.
std::vector<Figure> dilute_column(const GasRun& run);
std::vector<Figure> dense_column(const GasRun& run);

/// Granular gas: loss of energy for each collision a disc has, and in time, ln(T0 / T) and Haff's 1 /
/// sqrt(T), as multiples of what van Noije and Ernst 1998 give. One figure of each sort for each row of
/// haff_cooling.csv; the errors from independent runs, that many.
std::vector<Figure> haff_cooling(std::size_t discs, int runs, std::uint64_t seed);

/// Periodic mixture: Z, equipartition, and, where it is dilute, the three rates of collisions over those of
/// kinetic theory.
std::vector<Figure> periodic_mixture(const GasRun& run, const Mixture& mixture);

/// A system of the page, and how long it is run: collisions of a disc, or a number of runs.
struct PhysicsSystem {
    std::string table, name;  ///< of the page and of the test
    double short_run, long_run;
    double largest_error;  ///< that a short run may leave in its first figure; 0: any
    std::function<std::vector<Figure>(double length)> measure;
};
const std::vector<PhysicsSystem>& physics_systems();

std::string physics_header();
std::string physics_line(const Figure& figure);

}  // namespace carom::accuracy
