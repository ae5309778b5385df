// Which format a trajectory's name asks for, and those of text.
#include <carom/io/trajectory.hpp>

#include <fmt/format.h>

#include <carom/io/atomic_file.hpp>
#include <carom/io/lammps.hpp>
#include <carom/io/xyz.hpp>

#include "h5md.hpp"
#include "text_trajectory.hpp"

namespace carom {
namespace {

bool is_lammps_dump(const std::string& extension) {
    return extension == ".lammpstrj" || extension == ".dump";
}

void append_as_xyz(std::string& text, const TextFrame& frame) {
    append_xyz(text, frame.time, frame.balls, frame.domain, frame.precision);
}

void append_as_lammps(std::string& text, const TextFrame& frame) {
    append_lammps_dump(text, frame.step, frame.time, frame.balls, frame.domain, frame.precision);
}

}  // namespace

TextTrajectory::TextTrajectory(const std::filesystem::path& path, const KeptFrames& kept, Append append)
    : step_(kept.frames), append_(append) {
    if (kept.mark > 0)
        file_ = std::make_unique<GrowingFile>(path, kept.mark);
    else
        file_ = std::make_unique<GrowingFile>(path);
}

void TextTrajectory::write(double time, std::span<const Ball> balls, const std::optional<Domain>& domain,
                           Precision precision) {
    text_.clear();
    append_(text_, {step_, time, balls, domain, precision});
    file_->write(text_);
    ++step_;
}

std::uint64_t TextTrajectory::sync() {
    file_->sync();
    return file_->size();
}

std::string fault_of_trajectory_path(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".xyz" || is_lammps_dump(extension)) return "";
    if (extension != ".h5")
        return fmt::format("unknown format '{}' (known: .xyz, .h5, .lammpstrj, .dump)", extension);
    return has_h5md() ? "" : "this build cannot write .h5: HDF5 was not there (libhdf5-dev)";
}

std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path, const KeptFrames& kept) {
    if (const std::string fault = fault_of_trajectory_path(path); !fault.empty())
        throw FileError(path, fault);
    const std::string extension = path.extension().string();
    if (extension == ".h5") return open_h5md(path, kept);
    return std::make_unique<TextTrajectory>(path, kept,
                                            is_lammps_dump(extension) ? append_as_lammps : append_as_xyz);
}

}  // namespace carom
