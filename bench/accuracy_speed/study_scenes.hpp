// The scenes of the study of speed against accuracy, and the settings that each is run with.
#pragma once

#include <string>
#include <vector>

#include <carom/core/scene.hpp>

#include "trace.hpp"

namespace carom::bench {

struct StudyScene {
    std::string name;
    Scene scene;  ///< its balls placed, melted where they were placed at random
    Course course;
    double unit = 0;  ///< of steps: smallest moving radius over root-mean-square speed at the start

    /// Whether turning all velocities leads back to the start.
    [[nodiscard]] bool is_reversible() const;
    /// Whether nothing changes the momentum.
    [[nodiscard]] bool keeps_momentum() const;
};

struct Setting {
    std::string name;
    Scene scene;
};

/// The names of all scenes.
[[nodiscard]] std::vector<std::string> study_names();

/// `small`: fewer balls and collisions. `scenes` is the folder of the screensaver's file.
[[nodiscard]] StudyScene study_scene(const std::string& name, bool small, const std::string& scenes);

/// The first is the event method in double: the reference. `few`: only some.
[[nodiscard]] std::vector<Setting> settings_of(const StudyScene& scene, bool few);

/// The scene by the empirical method with about the given step, so that a sample's time is a whole number of
/// steps, or where steps are longer a stretch is.
[[nodiscard]] Scene stepped(const StudyScene& scene, double step);

}  // namespace carom::bench
