// How fast the quartic's time of impact is beside a library's solution of the same quartic.
#pragma once

#include <string>
#include <vector>

namespace carom::accuracy {

struct SpeedRow {
    std::string mix;
    double hits;  ///< share of the queries
    double carom_ns, eigen_ns;
    double eigen_wrong;  ///< share of the queries that the library misses, invents or errs on by 1e-9
};

/// Both on the same queries, in turn; the best of several rounds.
std::vector<SpeedRow> compare_speed();

}  // namespace carom::accuracy
