#include "observation.hpp"

#include <algorithm>

#include <carom/observe/text.hpp>

namespace carom::app {

namespace {

ObserverOptions observer_options(const ObservationOptions& options, const World& world) {
    ObserverOptions wanted;
    wanted.average_from = options.average_from;
    wanted.structure = !options.structure.empty();
    wanted.hexatic = !options.observables.empty();
    // Listening costs time, and only walled sides have a pressure to gain from it.
    wanted.records_collisions =
        wanted.hexatic && std::ranges::count(world.domain().boundary, Boundary::kWall) > 0;
    return wanted;
}

}  // namespace

void require_same_measures(const ObservationOptions& options, const World& world,
                           const std::vector<std::uint64_t>& saved) {
    Observer(world, observer_options(options, world)).restore(saved);
}

Observation::Observation(const ObservationOptions& options, std::uint64_t kept) : options_(options) {
    if (!options.structure.empty()) structure_.emplace(options.structure);
    if (options.observables.empty()) return;
    if (kept > 0) {
        rows_.emplace(options.observables, kept);
    } else {
        rows_.emplace(options.observables);
        rows_->write(sample_header());
    }
}

bool Observation::begin(const World& world, const std::optional<std::vector<std::uint64_t>>& saved) {
    const ObserverOptions wanted = observer_options(options_, world);
    observer_.emplace(world, wanted);
    if (saved) observer_->restore(*saved);
    return wanted.records_collisions;
}

void Observation::sample(const World& world) {
    if (!observer_) return;
    const Sample sample = observer_->sample(world);
    if (rows_) rows_->write(to_csv(sample));
}

std::uint64_t Observation::sync() {
    if (!rows_) return 0;
    rows_->sync();
    return rows_->size();
}

void Observation::commit() {
    if (rows_) rows_->sync();
    if (!structure_ || !observer_) return;
    structure_->write(to_json(observer_->structure()));
    structure_->commit();
}

}  // namespace carom::app
