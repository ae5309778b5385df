// A part of a run between two edits, to be gone through again by the reference engine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

namespace carom::stress {

/// So many events of a leg are compared.
inline constexpr std::size_t kEventsOfReference = 300;

struct Leg {
    Scene scene;                     ///< as it was at the start
    std::optional<Snapshot> start;   ///< none at the scene's beginning
    std::vector<std::uint32_t> ids;  ///< of the scene's balls
    std::vector<std::uint32_t> wall_ids;
    std::vector<Collision> events;  ///< the first of them
    double end = 0;                 ///< until which all events have been told

    void take(const Collision& c) {
        if (events.size() < kEventsOfReference) events.push_back(c);
    }
};

/// The leg that begins where the world is; `is_edited` where it is no more at the scene's beginning.
[[nodiscard]] Leg leg_from(const Scene& scene, const World& world, bool is_edited);

/// Goes through it event by event with the engine that looks at all pairs. One line on the first event that
/// is another; empty where all agree, or where that engine does not know such scenes or would take too long.
[[nodiscard]] std::string find_difference(const Leg& leg);

}  // namespace carom::stress
