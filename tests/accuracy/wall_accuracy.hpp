// Measures the time of impact of a disc on a wall, kind by kind. The oracle knows the wall as a shape, all
// that is within a radius of the segment: two discs and a strip, the first entry of any counts. That is not
// how the code goes about it, which follows the foot of the perpendicular.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <carom/core/wall_time.hpp>

#include "accuracy/disc_accuracy.hpp"

namespace carom::accuracy {

struct WallQuery {
    Motion<double> centre;
    double radius;
    Vec2 from, to;
};

struct WallKind {
    std::string name;
    std::function<WallQuery(test::Random&)> make;
};

std::vector<WallKind> wall_kinds();

struct WallTruth {
    Verdict verdict = Verdict::kUndecided;
    Quad time = 0;
};

/// The first entry, with `extra` added to the radius; kUndecided where rounding of 113 bits could matter.
/// Precondition: starts outside.
WallTruth wall_truth(const WallQuery& q, Quad extra);

/// Queries that start in contact or overlap are left out.
Tally measure(const WallKind& kind, std::uint64_t seed, const Effort& effort);

}  // namespace carom::accuracy
