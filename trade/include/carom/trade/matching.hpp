// Which collisions one list has and another has not, as far as the two tell of the same trajectories.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace carom::trade {

/// A collision of two bodies: balls by their ids, walls numbered after the balls.
struct Meeting {
    double time = 0;
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

struct Matching {
    std::size_t compared = 0;           ///< collisions of the reference that the other list had to have
    std::size_t missed = 0;             ///< of them those that it has not
    std::size_t invented = 0;           ///< that it has and the reference has not
    std::optional<double> first_fault;  ///< time of the first of either
};

struct MatchingRules {
    std::uint32_t first = 2;  ///< collisions of each ball that are compared
    double window = 0;        ///< by which a time may differ
    double until = 0;         ///< later collisions are not compared; both lists must go on for a window
};

/// Compares two lists, each in the order of time. A collision is the same in both where the same bodies meet,
/// it is the n-th of either ball in both, and the times differ by at most the window. One that only one list
/// has is counted once, and its balls are not compared from there on, nor is a ball that one of those meets:
/// what differs later differs for that reason. `moves` tells which balls have a history at all; static ones
/// and walls have none. Linear but for sorting.
[[nodiscard]] Matching match(const std::vector<Meeting>& reference, const std::vector<Meeting>& other,
                             const std::vector<bool>& moves, const MatchingRules& rules);

}  // namespace carom::trade
