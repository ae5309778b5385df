// What float costs: the same figures for runs in double, read in float, and simulated in float.
#pragma once

#include <string>
#include <vector>

namespace carom::accuracy {

struct PrecisionRow {
    std::string figure;
    std::string in_double, read_in_float, in_float;
};

/// The rows of the table: some seconds.
[[nodiscard]] std::vector<PrecisionRow> measure_precision();

}  // namespace carom::accuracy
