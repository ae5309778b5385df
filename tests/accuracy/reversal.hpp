// Reversal of all velocities, with a fault on purpose where wanted.
#pragma once

#include "accuracy/systems.hpp"

namespace carom::accuracy {

struct ReversalCase {
    double packing;
    double collisions;  ///< a ball
    bool walled;        ///< with walls and gravity, else periodic without
};

std::vector<ReversalCase> reversal_cases();

/// `fault` is added to one ball's velocity when it turns.
Deviation reverse(const ReversalCase& c, double fault = 0);

}  // namespace carom::accuracy
