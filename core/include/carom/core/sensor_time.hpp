// When a ball in free flight is in a sensor.
#pragma once

#include <vector>

#include <carom/core/motion.hpp>
#include <carom/core/scene.hpp>

namespace carom {

/// From a time on, and until another; `to` may be infinity.
struct Stretch {
    double from;
    double to;
};

/// The stretches of t >= 0 in which a disc of that radius, moving so, overlaps the sensor: in order, apart
/// from each other, all that begin before `horizon` or at it. Each end is where the sign of a distance
/// changes in double, so good to the rounding of the place there; what a graze shorter than that does is not
/// told. An end depends on the motion alone, to the bit, and not on the horizon.
[[nodiscard]] std::vector<Stretch> stretches_inside(const Motion<double>& motion, double radius,
                                                    const Sensor& sensor, double horizon);

/// The stretches that are in either of two lists, such as of two images of one sensor.
[[nodiscard]] std::vector<Stretch> united(std::vector<Stretch> a, const std::vector<Stretch>& b);

}  // namespace carom
