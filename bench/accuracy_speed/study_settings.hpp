// The settings that each scene of the study is run with.
#pragma once

#include <string>
#include <vector>

#include "study_scenes.hpp"

namespace carom::bench {

struct Setting {
    std::string name;
    Scene scene;
    bool is_choice = true;  ///< else a yardstick: nobody would run it, and its time says nothing
};

/// The first is the event method in double, as the scene has it: all times are over its time. `few`: only
/// some. The last is the reference moved a little: what chaos alone makes of it.
[[nodiscard]] std::vector<Setting> settings_of(const StudyScene& scene, bool few);

}  // namespace carom::bench
