// A ball dropped from height 1 with g = 2 onto a floor that takes some of its speed: its impacts end at the
// Zeno point (1 + e) / (1 - e).
#pragma once

#include <vector>

namespace carom::accuracy {

struct Impact {
    double time;
    double speed;  ///< after it; the flight lasts as long
};

/// All impacts after which the flight is at least an ulp of the Zeno point's time in seconds.
std::vector<Impact> impacts_of_dropped_ball(double restitution);

}  // namespace carom::accuracy
