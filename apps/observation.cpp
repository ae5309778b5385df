#include "observation.hpp"

#include <algorithm>

#include <carom/observe/text.hpp>

namespace carom::app {

Observation::Observation(const ObservationOptions& options) : options_(options) {
    if (!options.structure.empty()) structure_.emplace(options.structure);
    if (!options.observables.empty()) {
        rows_.emplace(options.observables);
        rows_->write(sample_header());
    }
}

bool Observation::begin(const World& world) {
    ObserverOptions wanted;
    wanted.average_from = options_.average_from;
    wanted.structure = structure_.has_value();
    wanted.hexatic = rows_.has_value();
    // Listening costs time, and only walled sides have a pressure to gain from it.
    wanted.records_collisions = rows_ && std::ranges::count(world.domain().boundary, Boundary::kWall) > 0;
    observer_.emplace(world, wanted);
    return wanted.records_collisions;
}

void Observation::sample(const World& world) {
    if (!observer_) return;
    const Sample sample = observer_->sample(world);
    if (rows_) rows_->write(to_csv(sample));
}

void Observation::commit() {
    if (rows_) rows_->sync();
    if (!structure_ || !observer_) return;
    structure_->write(to_json(observer_->structure()));
    structure_->commit();
}

}  // namespace carom::app
