#include "observation_options.hpp"

#include <utility>

#include "options.hpp"

namespace carom::app {

void add_observation_options(CLI::App& command, ObservationOptions& options) {
    const char* const group = "Measures";
    command
        .add_option("--observables", options.observables,
                    "Temperature, pressure, rates and the like at times 0, DT, 2 DT, ... and at the end")
        ->option_text("FILE.csv")
        ->group(group);
    command
        .add_option("--structure", options.structure,
                    "At the end: g(r), density profiles, displacement and velocity correlation, means over "
                    "the samples")
        ->option_text("FILE.json")
        ->group(group);
    command
        .add_option("--average-from", options.average_from,
                    "The means begin at this time (default: 0), when the system has settled")
        ->option_text("T")
        ->check(number_from_zero())
        ->group(group);
}

// --every belongs to any of several options.
void require_fitting(const RunOptions& options) {
    const bool observes = options.observation.is_wanted();
    if (options.every && options.trajectory.empty() && !observes)
        throw CLI::RequiresError("--every", "--trajectory, --observables or --structure");
    for (const auto& [name, path] : {std::pair("--trajectory", &options.trajectory),
                                     std::pair("--observables", &options.observation.observables),
                                     std::pair("--structure", &options.observation.structure)})
        if (!path->empty() && !options.every) throw CLI::RequiresError(name, "--every");
    if (options.observation.average_from > 0 && options.observation.structure.empty())
        throw CLI::RequiresError("--average-from", "--structure");
}

}  // namespace carom::app
