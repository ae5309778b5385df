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

/// What roundings of places up to `side` can come to in so many collisions a ball: on the way back they have
/// those to grow in. At the mean they grow as exp(growth k); but the collisions of one ball scatter as
/// Poisson's law has it, and the chain of those that meet most counts: three standard deviations more.
double error_after(const ReversalCase& c, double side);

/// `fault` is added to one ball's velocity when it turns.
Deviation reverse(const ReversalCase& c, double fault = 0);

}  // namespace carom::accuracy
