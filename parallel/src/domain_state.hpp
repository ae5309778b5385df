// A domain: the balls in a rectangle of cells, and what came of the window that it went through last.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
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
    Origin before;           ///< its origin in the window before
    std::int32_t depth = 0;  ///< cells beyond the receiver's own, 0 inside
};

/// A ball after the window, as the domain tells that owned it.
struct BallOutcome {
    std::uint64_t history = 0;
    std::uint32_t owner = 0;
};

/// A domain's copy of a foreign ball, after the window.
struct CopyOutcome {
    Origin origin;
    std::uint64_t history = 0;
    bool is_lost = false;  ///< given up before the window's end
};

/// A ball of the domain's own whose next event is with a copy.
struct PartnerOfCopy {
    std::uint32_t ball = 0;  ///< index in `end`
    std::uint32_t copy = 0;
};

/// The marks of all collisions with the balls of one other domain, in any order.
struct SumOfMeetings {
    std::uint32_t domain = 0;
    std::uint64_t sum = 0;
};

/// A cell touched by the domain, in which a foreign ball was that did something else here or was not here.
struct UnseenVisit {
    std::uint32_t owner = 0;  ///< the ball's
    CellCoordinates cell;     ///< folded into the box on periodic axes
};

/// A domain's own ball in another cell.
struct OwnVisit {
    Origin origin;
    CellCoordinates cell;  ///< folded into the box on periodic axes
};

/// What a domain works with while it goes through a window.
struct Workshop {
    std::unique_ptr<EventLoop> loop;
    std::vector<std::uint32_t> own;     ///< places in the loop of the domain's own balls
    std::vector<std::uint32_t> copies;  ///< of the others, in the order of their origins
    std::vector<Origin> origins;        ///< one a place in the loop

    // While it is filled.
    std::vector<BallMessage> message;              ///< of a few balls, one after the other
    std::vector<std::uint32_t> residents;          ///< where the domain's records are in the loop
    std::vector<std::vector<std::uint32_t>> here;  ///< where copies are, by their last origins
    /// A ball that a message brought.
    struct Arrival {
        Origin origin;
        std::uint32_t place = 0;  ///< in the loop; kNowhere where it was not there
        bool is_own = false;
    };
    std::vector<Arrival> arrivals;
    std::vector<BallMessage> newcomers;  ///< those that were not there
    std::vector<std::uint32_t> unknown;  ///< whose next event is to be looked for
    std::vector<std::uint32_t> copy_of;  ///< when it has gone: the copies' numbers, by their places
    std::thread::id thread;              ///< that used it last
};

/// The balls that a domain has simulated last, at the end of a window, wherever they are.
struct Roster {
    std::vector<BallRecord> records;
    std::vector<BallExtra> extras;           ///< one a record where the scene needs them
    std::vector<Origin> origins;             ///< of the records in what led here; empty where not known
    std::vector<std::uint32_t> places;       ///< in that window's loop, likewise
    std::vector<CellCoordinates> cells;      ///< of the records, folded into the box on periodic axes
    Span cells_x, cells_y;                   ///< that hold them all
    std::vector<std::uint32_t> near_border;  ///< those that halos as wide as all start with may hold
    std::vector<std::uint32_t> unknown;      ///< whose next event is kUnknown, as the window has left it

    void clear() { empty(records, extras, origins, places, cells, near_border, unknown); }
    /// One more than the last of `places`.
    [[nodiscard]] std::uint32_t places_end() const {
        return places.empty() ? 0 : std::ranges::max(places) + 1;
    }
};

struct DomainState {
    Span x, y;                          ///< its own cells
    Roster start;                       ///< of the window
    Roster end;                         ///< the domain's own balls after it
    std::vector<BallOutcome> outcomes;  ///< of the balls of `start`, written by their owners

    // What came of the window.
    AsideTable<OverwrittenAnchor> overwritten;
    std::vector<std::uint32_t> last_overwritten;  ///< one a ball of `end`
    AsideTable<NotePart> notes;
    std::vector<Collision> collisions;  ///< one a note where somebody listens
    std::size_t told = 0;               ///< so many of the notes lie in the past
    std::uint64_t events = 0;
    std::uint64_t copied_collisions = 0;
    double load = 0;  ///< of the last windows since the plane was cut, see WindowedEngine::weigh_window()

    // For the comparison.
    Region region;
    std::int32_t halo = 0;
    std::vector<CopyOutcome> copies;  ///< in the order of their origins
    std::vector<PartnerOfCopy> partners_of_copies;
    std::vector<Meeting> meetings;             ///< with places in `copies`
    std::vector<Visit> visits;                 ///< of its own balls, by their places in the loop
    std::vector<OwnVisit> visits_near_border;  ///< those that halos as wide as all start with may reach
    std::vector<std::uint8_t> touched;
    std::vector<SumOfMeetings> sums;  ///< one a domain met
    std::vector<UnseenVisit> unseen;
    bool failed = false;
    bool is_full = false;       ///< failed for there were too many collisions, or no room for them
    Time full_at;               ///< up to when they are there
    std::uint64_t in_turn = 0;  ///< collisions that may have come one after the other

    /// Of its own where each thread has one domain: what it holds when a window has ended is there for the
    /// next.
    std::unique_ptr<Workshop> workshop;
    bool can_go_on = false;  ///< the workshop holds what the last window came to

    /// Tables that a loop fills change hands, before the window so that it fills the same ones each time: few
    /// lie in the cache.
    void swap_tables(EventLoop& loop) {
        swap_notes(loop);
        std::swap(overwritten, loop.overwritten);
        std::swap(touched, loop.touched);
        std::swap(meetings, loop.meetings);
        std::swap(visits, loop.visits);
    }
    void swap_notes(EventLoop& loop) {
        std::swap(notes, loop.notes);
        std::swap(collisions, loop.collisions);
    }
    [[nodiscard]] std::size_t note_count() const {
        return notes.size() == 0 ? 0 : NotePart::kMost * (notes.size() - 1) + notes[notes.size() - 1].count;
    }
    [[nodiscard]] const CollisionNote& note(std::size_t k) const {
        return notes[k / NotePart::kMost].notes[k % NotePart::kMost];
    }
    /// Adds what has happened since it was last told, to `until`; whole parts, for notes lie in no cache.
    void tell(const Time& until, Tally& sum) {
        const std::size_t count = note_count();
        while (told < count) {
            const NotePart& part = notes[told / NotePart::kMost];
            if (told % NotePart::kMost == 0 && part.end <= until) {
                sum.count(part.tally);
                told += part.count;
            } else if (note(told).time <= until) {
                sum.count(note(told++));
            } else {
                return;
            }
        }
    }
    void forget_notes() {
        empty(notes, collisions);
        told = 0;
    }
    /// Forgets what the last window came to, but for `end`.
    void clear_outcome() {
        forget_notes();
        empty(overwritten, last_overwritten, copies, partners_of_copies, meetings, visits,
              visits_near_border);
        events = copied_collisions = 0;
    }
};

}  // namespace carom
