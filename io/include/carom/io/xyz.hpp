// Balls as extended XYZ text, readable by OVITO and ASE: frames one after the other, each with a count, a
// comment of key=value pairs and a line a ball.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom {

struct XyzFrame {
    std::optional<double> time;        ///< Time=
    std::optional<Box> box;            ///< Lattice= and Origin=, where the lattice is a rectangle
    std::vector<Ball> balls;           ///< in the order of their ids, or of the lines where there are none
    std::vector<std::uint64_t> lines;  ///< the line of the file that each ball stands on, from 1
};

// Columns are named by the comment's Properties, in any order and in any case: pos (or position, positions),
// velo (vel, velocity, velocities), acceleration, radius, mass (masses), restitution, static, id (ids);
// others are skipped. Vectors have two columns or three, of which the third is ignored; a plain XYZ file
// without Properties has species and pos. What is absent has Ball's defaults. Ids order the balls; they must
// be whole numbers and differ, but may leave gaps.

/// The last frame of a file. Throws FileError when it cannot be read, SceneError with `file:line` when it is
/// no XYZ. Values are not judged: see check(Scene).
[[nodiscard]] XyzFrame read_xyz(const std::filesystem::path& path);

/// The last frame of a text; `name` stands for the file in errors.
[[nodiscard]] XyzFrame parse_xyz(std::string_view text, const std::string& name);

/// Every frame of a file in turn, until `take` returns false.
void for_each_xyz_frame(const std::filesystem::path& path, const std::function<bool(const XyzFrame&)>& take);

/// Appends a frame to `text`: id, species (X), position, velocity, radius and mass, and those of
/// acceleration, restitution and static that differ from Ball's defaults somewhere. Positions have a third
/// column of zeros. The domain, where given, becomes Lattice, Origin and pbc. Digits are the fewest that read
/// back as the same bits, of doubles or, for positions and velocities, of the nearest floats. About a
/// microsecond a ball.
void append_xyz(std::string& text, double time, std::span<const Ball> balls,
                const std::optional<Domain>& domain, Precision precision = Precision::kDouble);

/// A file of one frame, written whole or not at all. Throws FileError.
void write_xyz(const std::filesystem::path& path, double time, std::span<const Ball> balls,
               const std::optional<Domain>& domain);

}  // namespace carom
