// Measures the time of impact of two discs, kind by kind.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "accuracy/disc_kinds.hpp"
#include "accuracy/tally.hpp"

namespace carom::accuracy {

/// A time this many units away is another root.
inline constexpr Wide kOtherRoot = 1000;

struct Effort {
    std::int64_t queries;
    /// One query in so many goes to the slow oracles too.
    std::int64_t check_every;
};

/// Compares `queries` random queries with the oracle. What disagrees is decided in exact fractions.
Tally measure(const DiscKind& kind, std::uint64_t seed, const Effort& effort);

/// One stretch of accelerations of the seam between the quartic and the quadratic.
struct Seam {
    double low, high;  ///< decades of |a|
    std::int64_t queries = 0, hits = 0, verdicts_differ = 0;
    /// Largest errors in units of the condition, of the quartic's time; and its largest relative distance
    /// from the quadratic's time less what the acceleration truly changes.
    double worst_in_units = 0, worst_seam = 0;
};
Seam measure_seam(double low, double high, std::uint64_t seed, std::int64_t queries);

}  // namespace carom::accuracy
