// Edits of a running world: drawn from a seed, a number and the world as it is when their time comes; and
// what must hold of any edit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

namespace carom::stress {

/// So many edits a trial may have; they are called by their numbers.
inline constexpr std::uint32_t kMostEdits = 12;

/// All of them, or those that the seed of a drawn scene gives it: none at all, or the first few.
[[nodiscard]] std::vector<std::uint32_t> all_edits();
[[nodiscard]] std::vector<std::uint32_t> drawn_edits(std::uint64_t seed);

/// Before which of so many stretches of time the edit takes place.
[[nodiscard]] std::size_t stretch_of_edit(std::uint64_t seed, std::uint32_t number, std::size_t stretches);

/// The edit, for a world of `scene`. It may be one that must be refused. The same for the same state of the
/// world, whatever the number of its threads or domains.
[[nodiscard]] Edits draw_edits(std::uint64_t seed, std::uint32_t number, const Scene& scene,
                               const World& world);

/// What became of edits.
struct Edited {
    std::string answer;  ///< the ids that were given, or why it was refused
    std::string fault;   ///< what must not be, one line; empty where all is well
    bool is_refused = false;
};

/// Applies them and looks at all balls before and after: whole or refused, what is not named as it was, the
/// least free ids for who comes.
[[nodiscard]] Edited apply_edits(World& world, const Edits& edits);

/// The scene that a world has become: its balls, walls and forces now.
[[nodiscard]] Scene scene_now(const Scene& scene, const World& world);

}  // namespace carom::stress
