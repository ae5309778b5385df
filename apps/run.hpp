// A run: a world moved to its end, and what is written on the way and there.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <carom/core/scene.hpp>
#include <carom/io/atomic_file.hpp>
#include <carom/io/checkpoint.hpp>
#include <carom/io/events_csv.hpp>
#include <carom/io/trajectory.hpp>
#include <carom/parallel/world.hpp>

#include "observation.hpp"
#include "sensings_csv.hpp"

namespace carom::app {

/// The command line of `carom run`. An empty path: not wanted.
struct RunOptions {
    std::string scene;
    std::optional<double> until;
    int threads = 0;
    std::optional<double> step;    ///< of the empirical method; else between two stops of the run
    std::optional<Method> method;  ///< none: the scene's, as the next two
    std::optional<double> tolerance;
    std::optional<double> max_travel;
    std::optional<double> contact_time;    ///< none: the scene's, as the next
    std::optional<double> field_interval;  ///< given only where there are attractors
    bool count_missed = true;
    std::optional<Precision> precision;         ///< none: the scene's
    std::optional<Precision> output_precision;  ///< none: the simulation's
    double cell_size = 0;
    int domains = 0;
    int halo = 0;
    bool check_memory = true;
    std::string trajectory;
    std::optional<double> every;  ///< given exactly when `trajectory` or an observation is
    ObservationOptions observation;
    std::string events;
    std::string sensings;
    std::string final_state;
    std::string picture;
    std::string summary = "-";
    std::string checkpoint;
    std::optional<double> checkpoint_every;  ///< none: a tenth of the run
    std::string resume;
    bool quiet = false;
};

/// The files of a run. All are opened at the start, so that one that cannot be written is known then and not
/// after an hour; what `done` covers of the trajectory and the list of events is gone on with. Throws
/// FileError.
struct RunOutputs {
    RunOutputs(const RunOptions& options, const Checkpoint& done);

    std::unique_ptr<Trajectory> trajectory;
    std::optional<Observation> observation;
    std::optional<EventsCsv> events;
    std::optional<SensingsCsv> sensings;
    std::optional<AtomicFile> final_state;
    std::optional<AtomicFile> picture;
    std::optional<AtomicFile> summary;  ///< none: standard output
};

/// Moves the world to `until` and writes the outputs, also when an interrupt ends it earlier: then false.
/// `before` has the records of the run before, none at its start. Throws what the outputs throw.
bool run_world(World& world, const Scene& scene, double until, const RunOptions& options,
               const Checkpoint& before, RunOutputs& outputs);

}  // namespace carom::app
