// What is measured during a run: a row a sample as the run goes, the structure at its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

/// Throws std::invalid_argument where what was saved was measured otherwise than these options ask for.
void require_same_measures(const ObservationOptions& options, const World& world,
                           const std::vector<std::uint64_t>& saved);

class Observation {
 public:
    /// Opens the files; that of the rows goes on after its first `kept` bytes. Throws FileError, as do the
    /// others.
    Observation(const ObservationOptions& options, std::uint64_t kept);

    /// To be called before the first sample, with what was saved where a run is gone on with. Gives whether
    /// collisions are to be recorded. Precondition: that was measured so.
    bool begin(const World& world, const std::optional<std::vector<std::uint64_t>>& saved);
    void record(const Collision& collision) {
        if (observer_) observer_->record(collision);
    }
    /// After begin().
    void sample(const World& world);
    /// Forces the rows to the disk and gives the bytes that they take; 0 where there are none.
    std::uint64_t sync();
    /// What an observer goes on from; nothing before begin().
    [[nodiscard]] std::vector<std::uint64_t> save() const {
        return observer_ ? observer_->save() : std::vector<std::uint64_t>();
    }
    void commit();

 private:
    ObservationOptions options_;
    std::optional<AtomicFile> structure_;
    std::optional<GrowingFile> rows_;
    std::optional<Observer> observer_;
};

}  // namespace carom::app
