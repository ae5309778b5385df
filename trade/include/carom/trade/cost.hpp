// How long one setting takes over another, by the clock.
#pragma once

#include <functional>

#include <carom/core/scene.hpp>

namespace carom::trade {

/// How to time: pairs of runs that are neighbours, so that what slows the machine down slows both.
struct Timing {
    int threads = 1;
    int least_rounds = 3;         ///< pairs of runs
    double enough_seconds = 0.3;  ///< for all of it: short runs are repeated until then
    std::function<bool()> goes_on = [] { return true; };  ///< asked between rounds; the first is made anyhow
};

struct TimeRatio {
    double median = 0, least = 0, most = 0;
    int rounds = 0;
    double seconds = 0;  ///< median of the reference's runs
};

/// Time of a setting from 0 to `duration` over that of the reference, without a listener and without the
/// count of what is missed. What is before time 0 is not timed.
[[nodiscard]] TimeRatio time_ratio(const Scene& setting, const Scene& reference, double duration,
                                   const Timing& timing);

}  // namespace carom::trade
