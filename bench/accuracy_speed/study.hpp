// What the study measures of a scene and a setting, and the lines of its CSV.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <carom/trade/cost.hpp>
#include <carom/trade/trace.hpp>

#include "study_scenes.hpp"
#include "study_settings.hpp"

namespace carom::bench {

/// A quantity's name and its value as text, empty where there is none.
struct Field {
    std::string name;
    std::string value;
};
using Record = std::vector<Field>;

/// Names or values of a record, separated by commas; a value with a comma in quotes.
[[nodiscard]] std::string names_of(const Record& record);
[[nodiscard]] std::string values_of(const Record& record);

/// The reference of a scene and what is known of it.
struct Reference {
    trade::Trace trace;
    std::optional<double> lyapunov;   ///< exponent, per time
    bool is_same_on_domains = false;  ///< cut in four, the same final hash
    std::optional<double> reversal;   ///< place error after a collision a ball, there and back
    std::optional<double> field;      ///< place error of the field renewed half as often, after a stretch
    double collisions_a_ball = 0;
};
[[nodiscard]] Reference reference_of(const StudyScene& scene);

/// Of the reference itself.
[[nodiscard]] Record record_of(const StudyScene& scene, const Reference& reference);
/// Of one setting; `time` is none where it is no choice.
[[nodiscard]] Record record_of(const StudyScene& scene, const Reference& reference, const Setting& setting,
                               const std::optional<trade::TimeRatio>& time);

}  // namespace carom::bench
