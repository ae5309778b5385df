// Galperin 2003: a heavy ball drives a light one against a wall; the collisions spell pi.
#pragma once

#include "accuracy/systems.hpp"

namespace carom::accuracy {

/// ceil(pi / atan(sqrt(1 / ratio))) - 1, or 0 where rounding may decide on the last one.
std::uint64_t galperin_count(double ratio);

/// The heavy ball's id before the light one's or after it; the wall on the left or, mirrored, on the right.
Deviation galperin(double ratio, bool heavy_first, bool mirrored);

}  // namespace carom::accuracy
