// Trajectories as H5MD (de Buyl, Colberg and Hoefling 2014), where the build has HDF5.
#pragma once

#include <carom/io/trajectory.hpp>

namespace carom {

[[nodiscard]] bool has_h5md();
/// Precondition: has_h5md().
[[nodiscard]] std::unique_ptr<Trajectory> open_h5md(const std::filesystem::path& path,
                                                    const KeptFrames& kept);

}  // namespace carom
