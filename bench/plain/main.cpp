// carom_plain: the speed of the baseline on a hard-disc gas, in one line.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "gas.hpp"
#include "plain.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void measure(double count, double packing, double seconds) {
    const carom::plain::Gas gas = carom::plain::make_gas(count, packing);
    const std::size_t discs = gas.positions.size();
    carom::PlainSimulation simulation(gas.positions, gas.velocities, 1.0, gas.side);
    simulation.run_events(3 * discs);  // the lattice melts

    const double energy = simulation.kinetic_energy(), time_0 = simulation.time(),
                 virial_0 = simulation.virial();
    const std::uint64_t collisions_0 = simulation.collisions(), crossings_0 = simulation.crossings(),
                        wakings_0 = simulation.wakings();
    const Clock::time_point start = Clock::now();
    double elapsed = 0;
    do {
        simulation.run_events(2000);
        elapsed = seconds_since(start);
    } while (elapsed < seconds);

    const auto collisions = static_cast<double>(simulation.collisions() - collisions_0);
    // kT = E / (N - 1), since the momentum is fixed at zero
    const double kinetic = energy / static_cast<double>(discs - 1) * static_cast<double>(discs);
    std::printf(
        "discs=%zu packing=%.2f collisions_per_second=%.4g crossings=%.2f wakings=%.2f Z=%.4f "
        "energy_change=%.1e\n",
        discs, packing, collisions / elapsed,
        static_cast<double>(simulation.crossings() - crossings_0) / collisions,
        static_cast<double>(simulation.wakings() - wakings_0) / collisions,
        1 + (simulation.virial() - virial_0) / (2 * kinetic * (simulation.time() - time_0)),
        simulation.kinetic_energy() / energy - 1);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 4) {
        std::fputs("usage: carom_plain COUNT PACKING [SECONDS]\n", stderr);
        return 2;
    }
    try {
        measure(std::atof(argv[1]), std::atof(argv[2]), argc > 3 ? std::atof(argv[3]) : 3);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "carom_plain: %s\n", error.what());
        return 1;
    }
    return 0;
}
