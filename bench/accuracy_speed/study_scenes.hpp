// The scenes of the study of speed against accuracy.
#pragma once

#include <string>
#include <vector>

#include <carom/core/scene.hpp>

#include <carom/trade/trace.hpp>

namespace carom::bench {

struct StudyScene {
    std::string name;
    Scene scene;  ///< its balls placed, melted where they were placed at random
    /// What errors are measured against: the scene by the event method, attractors' field renewed
    /// kFinerField times as often.
    Scene reference;
    static constexpr double kFinerField = 32;
    trade::Course course;
    double unit = 0;  ///< of steps: smallest moving radius over root-mean-square speed at the start

    /// Whether turning all velocities leads back to the start.
    [[nodiscard]] bool is_reversible() const;
    /// Whether nothing changes the momentum.
    [[nodiscard]] bool keeps_momentum() const;
};

/// The names of all scenes.
[[nodiscard]] std::vector<std::string> study_names();

/// `small`: fewer balls and collisions. `scenes` is the folder of the screensaver's file.
[[nodiscard]] StudyScene study_scene(const std::string& name, bool small, const std::string& scenes);

}  // namespace carom::bench
