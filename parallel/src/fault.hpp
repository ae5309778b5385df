// Faults that a test puts in on purpose, to see that `carom stress` finds them. Only a library built with
// CAROM_FAULTS has them, and none of it is installed: in every other build is_active() is false before the
// compiler looks, and no instruction is left of it.
#pragma once

#include <cstdint>

namespace carom {

enum class Fault : std::uint8_t {
    kNone,
    kLateBound,      ///< a partner is passed over though it may come sooner
    kStalePartner,   ///< a partner that has gone another way is hit all the same
    kEnergyGain,     ///< an elastic collision gives 1e-6 of its speed too much
    kSwappedMasses,  ///< each ball of a pair is taken for as heavy as the other
    kUnseenLarge,    ///< small balls do not see those that are larger than a cell
    kUnlikeCopies,   ///< domains do not compare what their copies did
    kBlindDomains,   ///< of a collision that both balls' domains miss nobody asks
    kOldForecasts,   ///< a ball beside one that its domain has not followed is not predicted anew
    kForgottenHit,   ///< a restored ball does not know when it collided last
    kOneMask,        ///< of two bodies only the first one's category is looked at
    kOldFlights,     ///< a wall that is added is hit by flights where it did not stand yet
};

#ifdef CAROM_FAULTS
inline Fault active_fault = Fault::kNone;  // set before a world is made
[[nodiscard]] inline bool is_active(Fault fault) {
    return active_fault == fault;
}
#else
[[nodiscard]] constexpr bool is_active(Fault) {
    return false;
}
#endif

}  // namespace carom
