// Movies of a world: pictures at exact times, one after the other into a file.
#pragma once

#include <filesystem>
#include <optional>

#include <carom/core/scene.hpp>
#include <carom/io/movie_file.hpp>
#include <carom/parallel/world.hpp>

#include "driver.hpp"
#include "world_picture.hpp"

namespace carom::app {

/// From where to where in simulated time, and how it passes: frame k shows the time from + k speed / fps, a
/// product, so that no rounding adds up, and all that are before `until`.
struct MovieTimes {
    double from = 0;
    double until = 0;
    double frames_per_second = 30;
    double speed = 1;  ///< simulated time in a second of the movie

    /// Time between two frames.
    [[nodiscard]] double step() const { return speed / frames_per_second; }
};

/// Digits of the time in the title, so that each frame's differs from the one before.
[[nodiscard]] int time_digits(const MovieTimes& times);

/// The colours' upper end in a movie: where it is not given it follows the balls, smoothly, so that it does
/// not flicker.
class ColourTop {
 public:
    explicit ColourTop(double frames_per_second) : share_(std::min(1.0, 2 / frames_per_second)) {}
    /// The end for the next frame, whose own would be `top`.
    double next(double top);

 private:
    double share_;
    double top_ = -1;  // none yet
};

/// Draws all frames. False where an interrupt ended it before: nothing is written then. Throws FileError.
bool write_movie(World& world, const Scene& scene, const MovieTimes& times, const PictureLook& look,
                 const std::optional<PictureSize>& size, const std::filesystem::path& out, MovieFormat format,
                 Driver& driver);

}  // namespace carom::app
