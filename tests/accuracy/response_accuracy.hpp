// Measures the response: momentum, energy, the speed asked for, tangents; and the drift of millions of
// collisions. Sums are taken in 113 bits.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <carom/core/response.hpp>

#include "core/random.hpp"

namespace carom::accuracy {

struct ResponseQuery {
    Vec2 va, vb, offset;
    double mass_a, mass_b, e;
};

struct ResponseKind {
    std::string name;
    std::function<ResponseQuery(test::Random&)> make;
};

/// Approaching pairs of all sorts.
std::vector<ResponseKind> response_kinds();

struct ResponseTally {
    std::string kind;
    std::int64_t queries = 0;
    /// Change of the sum of the momenta, by component: in units of what storing the two velocities and
    /// dividing one impulse by two masses must round. Reasoning says <= 1.
    std::vector<float> momentum;
    /// Error of the energy afterwards (of its loss, where e < 1), in ulps of the energy before.
    std::vector<float> energy;
    /// Error of the speed of separation, e times that of approach; and of both tangential speeds, in ulps of
    /// the larger speed.
    std::vector<float> separation, tangent;
    /// Pairs that still approach, as the time of impact sees them.
    std::int64_t approaching = 0;
};

ResponseTally measure(const ResponseKind& kind, std::uint64_t seed, std::int64_t queries);

/// bounce() off a wall or a static disc at any slant, approach from 1e-15 of the speed up, with restitution
/// `e_least` to 1. No momentum is kept: that tally stays empty.
ResponseTally measure_bounce(const std::string& name, double e_least, std::uint64_t seed,
                             std::int64_t queries);

std::string response_header();
std::string response_line(ResponseTally& tally);

/// Relative change of the energy of `discs` elastic discs after each of `counts` (rising) collisions of
/// random pairs with random directions of impact.
std::vector<double> energy_changes(int discs, const std::vector<std::int64_t>& counts, std::uint64_t seed);

/// Standard deviation of that change if nothing but rounding acted, with no preferred direction: some twelve
/// roundings a collision, each uniform within half an ulp of its part of the pair's energy.
double random_walk(int discs, std::int64_t collisions);

}  // namespace carom::accuracy
