// Samples as lines of CSV, structure as JSON.
#pragma once

#include <string>

#include <carom/observe/observer.hpp>

namespace carom {

/// The names of the columns and a line's end.
[[nodiscard]] std::string sample_header();
/// A line. Numbers read back with the same bits; what there is not is left empty.
[[nodiscard]] std::string to_csv(const Sample& sample);
/// One JSON object; what is not finite becomes null, and so does a curve that is empty.
[[nodiscard]] std::string to_json(const Structure& structure);

}  // namespace carom
