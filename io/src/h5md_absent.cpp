// A build without HDF5.
#include <carom/io/atomic_file.hpp>

#include "h5md.hpp"

namespace carom {

bool has_h5md() {
    return false;
}

std::unique_ptr<Trajectory> open_h5md(const std::filesystem::path& path, const KeptFrames&) {
    throw FileError(path, "this build has no HDF5");
}

}  // namespace carom
