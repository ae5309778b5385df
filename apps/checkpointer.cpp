#include "checkpointer.hpp"

namespace carom::app {

Checkpointer::Checkpointer(const World& world, const RunOptions& options, const Checkpoint& before)
    : path_(options.checkpoint), every_(options.checkpoint_every) {
    if (before.run) {
        record = *before.run;
    } else {
        record.energy_initial = world.energy();
        record.momentum_initial = world.momentum();
    }
    seconds_before_ = record.wall_seconds;
    const double interval = options.every.value_or(1);
    auto next = static_cast<std::uint64_t>(world.time() / interval);
    while (double(next) * interval < world.time()) ++next;
    if (record.trajectory_bytes == 0) {
        record.frame_interval = interval;
        record.next_frame = next;
    }
    measures = before.measures.value_or(MeasuresRecord{.next_sample = next, .interval = interval});
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
    Checkpoint checkpoint{.snapshot = world.snapshot(), .run = record};
    if (outputs.sensings) checkpoint.sensings_bytes = outputs.sensings->sync();
    if (outputs.observation) {
        measures.observables_bytes = outputs.observation->sync();
        checkpoint.measures = measures;
        checkpoint.observer = outputs.observation->save();
    }
    write_checkpoint(path_, checkpoint);
}

}  // namespace carom::app
