// Two sorts of discs in a periodic box: pressure, equipartition, who hits whom how often.
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "accuracy/physics_run.hpp"

namespace carom::accuracy {
namespace {

constexpr double kDilute = 0.05;  // packing up to which theory's rates of collisions are good to 1e-3

/// Discs of the first species have the first ids.
struct Species {
    const Mixture& mixture;
    std::size_t first, all;

    [[nodiscard]] double count(int s) const { return static_cast<double>(s == 0 ? first : all - first); }
    [[nodiscard]] double total_mass() const {
        return count(0) * mixture.mass[0] + count(1) * mixture.mass[1];
    }
    /// Share of the first species in the kinetic energy: a velocity of a disc at given total momentum has the
    /// variance k T / m (1 - m / M).
    [[nodiscard]] double energy_share() const {
        return count(0) * (1 - mixture.mass[0] / total_mass()) / static_cast<double>(all - 1);
    }
    [[nodiscard]] double energy_share_of(const World& world) const {
        const PlaneVectors v = world.velocities();
        double energy = 0;
        for (std::size_t i = 0; i < first; ++i) energy += mixture.mass[0] / 2 * length_squared(v[i]);
        return energy / world.kinetic_energy();
    }
    /// Collisions in a unit of time: each pair meets with 2 sigma_ij <v_ij> chi_ij / A, and the mean relative
    /// speed is sqrt(pi k T / (2 mu)) times what the fixed energy changes.
    [[nodiscard]] double rate(int i, int j, double packing, double area, double temperature) const {
        const double pairs = i == j ? count(i) * (count(i) - 1) / 2 : count(i) * count(j);
        const double inverse_mass = 1 / mixture.mass[i] + 1 / mixture.mass[j];
        const double speed = std::sqrt(std::numbers::pi * temperature * inverse_mass / 2) *
                             sphere_factor(2 * static_cast<double>(all - 1));
        return pairs * 2 * mixture.contact(i, j) * speed * contact_value(mixture, packing, i, j).value / area;
    }
};

/// Z to the third coefficient exactly, beyond by the formula, which is taken to be off by twice what it is
/// off by there. The shift for finite size is exact at low density.
Figure compressibility_figure(const GasRun& run, const Mixture& mixture, const GasSeries& series,
                              double temperature) {
    const Estimate z = compressibility_of(series, run.discs, temperature);
    const double eta = run.packing;
    const double second =
        1 + mixture.mean_diameter() * mixture.mean_diameter() / mixture.mean_diameter_squared();
    const double third = mixture_third(mixture), approximate = mixture_third_by_santos(mixture);
    const double formula = mixture_compressibility(mixture, eta);
    const double rest = formula - 1 - second * eta - approximate * eta * eta;
    const double shift = finite_size_shift(eta, static_cast<double>(run.discs));
    return {"Z from the virial", system_name(run, mixture), z,
            1 + second * eta + third * eta * eta + rest + shift,
            2 * std::abs(1 - third / approximate) * rest + 2 * eta * std::abs(shift)};
}

}  // namespace

std::vector<Figure> periodic_mixture(const GasRun& run, const Mixture& mixture) {
    World world(filled_box(run, mixture, Boundary::kPeriodic), run.options);
    const Species species{
        mixture, static_cast<std::size_t>(std::llround(static_cast<double>(run.discs) * mixture.share[0])),
        run.discs};
    const double usual = collision_rate(run.packing);
    constexpr double kRelaxation = 100;  // collisions of a disc
    world.advance_to(kRelaxation / usual);
    std::array<double, 3> hits{};  // of two of the first sort, one of each, two of the second
    world.on_collision([&](const Collision& c) {
        ++hits[static_cast<std::size_t>(c.i >= species.first) +
               static_cast<std::size_t>(c.j >= species.first)];
    });
    std::array<std::vector<double>, 3> hits_of_blocks;
    std::vector<double> shares;
    // Collisions of a disc in a block: the sorts have lost some of the energy that one had too much of.
    constexpr double kBetweenLooks = 4;
    const GasSeries series =
        measure_gas(world, static_cast<int>(run.collisions / kBetweenLooks), kBetweenLooks / usual, [&] {
            for (std::size_t k = 0; k < 3; ++k) hits_of_blocks[k].push_back(std::exchange(hits[k], 0));
            shares.push_back(species.energy_share_of(world));
        });
    const double temperature = periodic_temperature(world);
    const std::string system = system_name(run, mixture);
    std::vector<Figure> figures = {compressibility_figure(run, mixture, series, temperature),
                                   {"share of the first sort in the kinetic energy", system, mean_of(shares),
                                    species.energy_share(), 0}};
    if (run.packing > kDilute) return figures;
    const double area = std::pow(side_of(run, mixture), 2);
    const std::array<const char*, 3> names = {"first with first", "first with second", "second with second"};
    for (int k = 0; k < 3; ++k) {
        const int i = k / 2, j = (k + 1) / 2;
        const double rate = species.rate(i, j, run.packing, area, temperature);
        figures.push_back({std::string("collision rate over kinetic theory's, ") + names[k], system,
                           scaled(mean_of(hits_of_blocks[k]), 1 / (rate * series.block_time)), 1,
                           contact_value(mixture, run.packing, i, j).beyond / 5});
    }
    return figures;
}

}  // namespace carom::accuracy
