// What the study measures of a scene and a setting, and the lines of its CSV.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study_scenes.hpp"

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

/// Time of a setting over that of the reference, measured in turn: the median and the extremes.
struct TimeRatio {
    double median = 0, least = 0, most = 0;
};
[[nodiscard]] TimeRatio time_ratio(const Scene& setting, const Scene& reference, const Course& course,
                                   int rounds);

/// The reference of a scene and what is known of it.
struct Reference {
    Trace trace;
    std::optional<double> lyapunov;   ///< exponent, per time
    bool is_same_on_domains = false;  ///< cut in four, the same final hash
    std::optional<double> reversal;   ///< place error after a collision a ball, there and back
    double collisions_a_ball = 0;
};
[[nodiscard]] Reference reference_of(const StudyScene& scene);

/// Of the reference itself.
[[nodiscard]] Record record_of(const StudyScene& scene, const Reference& reference);
/// Of one setting.
[[nodiscard]] Record record_of(const StudyScene& scene, const Reference& reference, const Setting& setting,
                               const TimeRatio& time);

/// Missed and invented collisions in the first two of each ball; a time may differ by a tenth of the mean
/// time between two collisions of a ball.
[[nodiscard]] Matching matching_of(const StudyScene& scene, const Trace& reference, const Trace& other);

}  // namespace carom::bench
