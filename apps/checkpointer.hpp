// What a run tells of itself beside the world's state, and its checkpoints.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <carom/io/checkpoint.hpp>
#include <carom/parallel/world.hpp>

#include "run.hpp"

namespace carom::app {

class Checkpointer {
 public:
    /// Goes on with the records of a run that was stopped, or begins them.
    Checkpointer(const World& world, const RunOptions& options, const Checkpoint& before);

    [[nodiscard]] bool is_wanted() const { return !path_.empty(); }
    /// Between two checkpoints, simulated; > 0.
    [[nodiscard]] double interval(double until) const;
    void start_clock() { started_ = std::chrono::steady_clock::now(); }
    /// Since the run's first start, the time between an end and a resumption left out.
    [[nodiscard]] double wall_seconds() const;
    /// Puts the present state in the file's place, once the outputs that it covers are on the disk.
    void save(const World& world, RunOutputs& outputs);

    RunRecord record;
    MeasuresRecord measures;

 private:
    std::string path_;
    std::optional<double> every_;
    double seconds_before_ = 0;
    std::chrono::steady_clock::time_point started_;
};

}  // namespace carom::app
