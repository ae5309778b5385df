// What is measured during a run: a row a sample as the run goes, the structure at its end.
#pragma once

#include <optional>
#include <string>

#include <carom/io/atomic_file.hpp>
#include <carom/io/growing_file.hpp>
#include <carom/observe/observer.hpp>
#include <carom/parallel/world.hpp>

namespace carom::app {

/// The command line's part of it. An empty path: not wanted.
struct ObservationOptions {
    std::string observables;
    std::string structure;
    double average_from = 0;

    [[nodiscard]] bool is_wanted() const { return !observables.empty() || !structure.empty(); }
};

class Observation {
 public:
    /// Opens the files. Throws FileError, as do the others.
    explicit Observation(const ObservationOptions& options);

    /// To be called before the first sample. Gives whether collisions are to be recorded.
    bool begin(const World& world);
    void record(const Collision& collision) {
        if (observer_) observer_->record(collision);
    }
    /// After begin().
    void sample(const World& world);
    void commit();

 private:
    ObservationOptions options_;
    std::optional<AtomicFile> structure_;
    std::optional<GrowingFile> rows_;
    std::optional<Observer> observer_;
};

}  // namespace carom::app
