// A domain: the balls in a rectangle of cells, and what came of the window that it went through last.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "event_loop.hpp"

namespace carom {

/// Where a ball's record was at the start of a window: the domain that held it and its index there.
struct Origin {
    std::uint32_t domain = 0;
    std::uint32_t index = 0;
    friend auto operator<=>(const Origin&, const Origin&) = default;
};

/// A ball on its way to a domain that owns it now, or simulates a copy of it.
struct BallMessage {
    BallRecord record;
    BallExtra extra;
    Origin origin;
    std::int32_t depth = 0;  ///< cells beyond the receiver's own, 0 inside
};

/// A domain's copy of a foreign ball, after the window.
struct CopyOutcome {
    Origin origin;
    std::uint64_t history = 0;
    std::int32_t mark = 0;  ///< of its cell in the region, at the start of the window
    bool is_lost = false;   ///< given up before the window's end
};

/// A copy in another cell of the region.
struct CopyVisit {
    std::uint32_t copy = 0;
    std::int32_t mark = 0;
};

/// A domain's own ball in another cell.
struct OwnVisit {
    Origin origin;
    CellCoordinates cell;  ///< folded into the box on periodic axes
};

struct DomainState {
    Span x, y;  ///< its own cells

    // At the start of the window: the balls that it simulated last, wherever they are now.
    std::vector<BallRecord> records;
    std::vector<BallExtra> extras;           ///< one a record where the scene needs them
    std::vector<CellCoordinates> cells;      ///< of the records, folded into the box on periodic axes
    Span cells_x, cells_y;                   ///< that hold them all
    std::vector<std::uint32_t> near_border;  ///< those that halos as wide as all start with may hold
    std::vector<std::uint64_t> histories;    ///< of the records in the window, written by their owners

    // After the window: its own balls.
    std::vector<BallRecord> results;
    std::vector<BallExtra> result_extras;
    std::vector<CellCoordinates> result_cells;  ///< of the results, folded into the box on periodic axes
    std::vector<OverwrittenAnchor> overwritten;
    std::vector<std::uint32_t> last_overwritten;  ///< one a result
    std::vector<CollisionNote> notes;
    std::vector<Collision> collisions;  ///< one a note where somebody listens
    std::size_t told = 0;               ///< so many of the notes lie in the past
    std::uint64_t events = 0;
    std::uint64_t copied_collisions = 0;

    // For the comparison.
    Region region;
    std::int32_t halo = 0;
    std::vector<CopyOutcome> copies;  ///< in the order of their origins
    std::vector<CopyVisit> copy_visits;
    std::vector<OwnVisit> visits;
    std::vector<std::uint8_t> touched;
    bool failed = false;
    bool is_full = false;  ///< failed for there was no room for all its collisions

    /// Forgets what the last window came to.
    void clear_outcome() {
        const auto empty = [](auto&... tables) { (tables.clear(), ...); };
        empty(results, result_extras, result_cells, overwritten, last_overwritten, notes, collisions, copies,
              copy_visits, visits);
        told = 0;
        events = copied_collisions = 0;
    }
};

}  // namespace carom
