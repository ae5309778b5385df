// Checkpoints: a simulation at one moment as a file. docs/checkpoint-format.md describes the bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <carom/core/snapshot.hpp>

namespace carom {

/// What `carom run` needs beside the state in order to end as if it had never been stopped.
struct RunRecord {
    double energy_initial = 0;
    Vec2 momentum_initial = Vec2::Zero();
    double wall_seconds = 0;             ///< taken so far
    std::uint64_t trajectory_bytes = 0;  ///< whole frames; 0 where there is no trajectory
    std::uint64_t next_frame = 0;        ///< is due at so many frame intervals
    double frame_interval = 0;
    std::uint64_t events_bytes = 0;  ///< whole lines; 0 where no list of events is kept
};

/// What it has measured on the way.
struct MeasuresRecord {
    std::uint64_t observables_bytes = 0;  ///< whole rows; 0 where none are kept
    std::uint64_t next_sample = 0;        ///< is due at so many intervals
    double interval = 0;
    double last_sample = -1;  ///< a time; -1 before the first
};

struct Checkpoint {
    Snapshot snapshot = {};
    // Of `carom run`.
    std::optional<RunRecord> run = {};
    std::optional<std::uint64_t> sensings_bytes = {};  ///< whole lines of the list of sensings
    std::optional<MeasuresRecord> measures = {};
    std::optional<std::vector<std::uint64_t>> observer = {};  ///< as Observer::save() gives it
};

/// Puts a checkpoint in the file's place, whole or not at all: see AtomicFile. Throws FileError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Throws FileError where the file cannot be read, is none of Carom's or of a newer version, or is not whole
/// to the bit. Allocates no more than the file is long. Whether the state is one of the scene's World says.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);

/// The same from bytes; `name` stands for the file in errors.
[[nodiscard]] Checkpoint parse_checkpoint(std::string_view bytes, const std::string& name);

}  // namespace carom
