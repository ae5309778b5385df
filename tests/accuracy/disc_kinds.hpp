// The kinds of query that the time of impact of two discs is measured on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/disc_oracle.hpp"
#include "core/random.hpp"

namespace carom::accuracy {

struct DiscKind {
    std::string name;
    std::function<DiscQuery(test::Random&)> make;
};

/// Without relative acceleration: a quadratic.
std::vector<DiscKind> straight_kinds();
/// With: a quartic.
std::vector<DiscKind> curved_kinds();

/// A straight motion that hits in most cases, for the seam between quadratic and quartic.
DiscQuery straight_query(test::Random& random);

}  // namespace carom::accuracy
