// Trajectories in any of the formats that Carom writes: all balls at one time after another, in a file that
// grows and can be read while it does. docs/files.md has the formats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <carom/core/scene.hpp>

namespace carom {

class Trajectory {
 public:
    Trajectory() = default;
    virtual ~Trajectory() = default;
    Trajectory(const Trajectory&) = delete;
    Trajectory& operator=(const Trajectory&) = delete;

    /// Appends a frame. All have the same balls, domain and precision. Throws FileError.
    virtual void write(double time, std::span<const Ball> balls, const std::optional<Domain>& domain,
                       Precision precision) = 0;
    /// Forces the frames to the disk; gives the mark to go on after them with, > 0 where there are any.
    /// Throws FileError.
    virtual std::uint64_t sync() = 0;
};

/// What was left of a trajectory by a run that is gone on with.
struct KeptFrames {
    std::uint64_t mark = 0;    ///< as sync() gave it; 0: nothing, the file is begun anew
    std::uint64_t frames = 0;  ///< their number, which is the next one's step
};

/// What speaks against writing a trajectory under this name: another ending than .xyz, .h5, .lammpstrj and
/// .dump, or .h5 in a build without HDF5. Empty where nothing does.
[[nodiscard]] std::string fault_of_trajectory_path(const std::filesystem::path& path);

/// The format follows from the name's ending. Throws FileError, also where the file is not the one that was
/// left.
[[nodiscard]] std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path,
                                                          const KeptFrames& kept = {});

}  // namespace carom
