// The ways of putting a fill's discs into its region.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "placement_random.hpp"
#include "placement_space.hpp"

namespace carom::detail {

/// The fill's discs in the order in which they are adsorbed.
[[nodiscard]] std::vector<std::uint32_t> largest_first(const Space& space);

/// Where in the region the centre of a disc of a radius may lie.
class Places {
 public:
    Places(const Space& space, double radius)
        : space_(space),
          low_{space.low(0, radius), space.low(1, radius)},
          high_{space.high(0, radius), space.high(1, radius)} {}

    /// The place at these shares, in [0, 1], of the way from the lowest to the highest.
    [[nodiscard]] Vec2 at(double share_x, double share_y) const {
        return space_.wrapped({along(0, share_x), along(1, share_y)});
    }

 private:
    [[nodiscard]] double along(std::size_t axis, double share) const {
        return std::min(low_[axis] + share * (high_[axis] - low_[axis]), high_[axis]);
    }

    const Space& space_;
    std::array<double, 2> low_, high_;
};

/// Random sequential adsorption, the largest disc first: each at a uniformly random clear place. Returns the
/// discs for which a bounded number of tries found no place, the largest first; none where all are in place.
std::vector<std::uint32_t> adsorb(Space& space, Random& random);

/// The sites of a lattice of rows, at least `wanted` of them clear for discs of the given radius; their order
/// is from row to row. Empty if there is no such lattice whose sites are more than `spacing` apart (0: any).
[[nodiscard]] std::vector<Vec2> lattice_sites(const Space& space, std::size_t wanted, double radius,
                                              double spacing);

/// Pushes overlapping discs of the fill apart until none overlaps anything; whether it came to that within a
/// bounded effort.
bool relax(Space& space, Random& random);

/// Monte Carlo of hard discs, sweep after sweep: each disc tries a small random move, and makes it where the
/// way out is clear.
void shake(Space& space, Random& random);

/// What came of a dense placement.
struct DenseResult {
    bool complete = false;   ///< all discs are in place
    std::size_t placed = 0;  ///< else: so many of them found room in the best of the tries
    double packing = 0;      ///< and all of them, were they so much smaller that they had this packing
};

/// All discs at once, above the packing that adsorption reaches.
DenseResult place_dense(Space& space, Random& random);

}  // namespace carom::detail
