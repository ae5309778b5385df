#include "checkpointer.hpp"

#include <cmath>

namespace carom::app {

Checkpointer::Checkpointer(const World& world, const RunOptions& options,
                           const std::optional<RunRecord>& before)
    : path_(options.checkpoint), every_(options.checkpoint_every) {
    if (before) {
        record = *before;
    } else {
        record.energy_initial = world.energy();
        record.momentum_initial = world.momentum();
    }
    seconds_before_ = record.wall_seconds;
    if (record.trajectory_bytes > 0) return;
    record.frame_interval = options.every.value_or(1);
    record.next_frame = static_cast<std::uint64_t>(std::ceil(world.time() / record.frame_interval));
}

double Checkpointer::interval(double until) const {
    constexpr double kCheckpointsOfRun = 10;
    return every_.value_or(until > 0 ? until / kCheckpointsOfRun : 1);
}

double Checkpointer::wall_seconds() const {
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - started_;
    return seconds_before_ + since.count();
}

void Checkpointer::save(const World& world, RunOutputs& outputs) {
    record.trajectory_bytes = outputs.trajectory ? outputs.trajectory->sync() : 0;
    record.events_bytes = outputs.events ? outputs.events->sync() : 0;
    record.wall_seconds = wall_seconds();
    write_checkpoint(path_, {world.snapshot(), record});
}

}  // namespace carom::app
