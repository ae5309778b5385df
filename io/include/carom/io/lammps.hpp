// Balls as LAMMPS has them: dump files, written; data files, read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <carom/io/xyz.hpp>

namespace carom {

/// Appends a frame of a text dump: id (from 1), type (1; 2 where static), x, y, z, vx, vy, vz, radius, mass,
/// and the time. Digits as in append_xyz. The domain becomes the box's bounds: p periodic, f walled, s open;
/// without one the bounds are those of the balls.
void append_lammps_dump(std::string& text, std::uint64_t step, double time, std::span<const Ball> balls,
                        const std::optional<Domain>& domain, Precision precision = Precision::kDouble);

/// A data file of atom style atomic or sphere, with the sections Masses, Atoms and Velocities; others are
/// passed over. z is ignored. Atoms are ordered by their ids. Without a style after `Atoms #` the number of
/// columns tells it. Of style sphere: radius is half the diameter, mass = density * 4/3 pi radius^3 as LAMMPS
/// has it; of style atomic: the radius is Ball's, the mass that of the type. Throws FileError when it cannot
/// be read, SceneError with `file:line`. Values are not judged.
[[nodiscard]] XyzFrame read_lammps_data(const std::filesystem::path& path);

/// The same from text; `name` stands for the file in errors.
[[nodiscard]] XyzFrame parse_lammps_data(std::string_view text, const std::string& name);

/// Balls from a file: a LAMMPS data file where its name ends in .data, .lmp or .lammps, else the last frame
/// of an extended XYZ file.
[[nodiscard]] XyzFrame read_balls(const std::filesystem::path& path);

}  // namespace carom
