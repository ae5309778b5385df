// One domain in time order: every ball knows its next event, a queue hands out the earliest, and after a
// collision only its two balls are predicted anew.
//
// What the rest of the engine relies on:
// - A ball's anchor changes at its own events only; crossing a cell's border is not one.
// - A predicted time is a function of the two anchors and the periodic image alone, computed from the smaller
//   id to the larger.
// - A ball's entry in the queue is never later than its true next event. It may be stale, when the partner
//   has had another event since; that is noticed when the entry comes up, and the ball is predicted anew. Of
//   two balls that meet next at least one has the event, or an earlier one, as its entry.
// - Events come in the order of (time, smaller id, larger id), walls numbered after the balls and the
//   domain's sides after the walls.
//
// A loop holds the balls that its domain owns and, where there are other domains, copies of the foreign balls
// around. Copies follow the same rules as far as their surroundings are known; windowed_domain.cpp decides
// afterwards whether what they did was right. Balls are numbered in the order in which they were added; their
// ids decide every order that shows.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <carom/broadphase/cell_lists.hpp>
#include <carom/core/event_queue.hpp>
#include <carom/core/motion.hpp>
#include <carom/parallel/world.hpp>

#include "ball_record.hpp"
#include "bodies.hpp"
#include "executor.hpp"
#include "ordered_sum.hpp"
#include "put_aside.hpp"
#include "region.hpp"
#include "sights.hpp"

namespace carom {

/// Empties tables, which keep their memory.
template <class... Tables>
void empty(Tables&... tables) {
    (tables.clear(), ...);
}

/// A collision as the loop notes it, enough to count it and to put it in order.
struct CollisionNote {
    Time time;
    std::uint32_t lower = 0;         ///< id of the ball, the smaller of two moving ones
    std::uint32_t higher = 0;        ///< number of the other body
    std::uint32_t lower_stamp = 0;   ///< of the ball before it
    std::uint32_t higher_stamp = 0;  ///< of the other one, where it moves
    bool is_wall = false;
    double virial = 0;
};

/// What collisions come to, whatever their order.
struct Tally {
    std::uint64_t ball_collisions = 0;
    std::uint64_t wall_collisions = 0;
    OrderedSum virial;

    void count(const CollisionNote& note) {
        ++(note.is_wall ? wall_collisions : ball_collisions);
        if (!note.is_wall) virial += note.virial;
    }
    void count(const Tally& other) {
        ball_collisions += other.ball_collisions;
        wall_collisions += other.wall_collisions;
        virial += other.virial;
    }
};

/// Some notes, one after the other, and what they come to.
struct alignas(64) NotePart {
    static constexpr std::uint32_t kMost = 32;
    std::uint32_t count = 0;  ///< kMost in all parts but the last
    Time end;                 ///< of the last note
    Tally tally;
    std::array<CollisionNote, kMost> notes;
};

/// What a collision does to a ball.
struct Hit {
    Vec2 normal;            ///< unit vector towards the ball
    double impulse;         ///< along it
    double approach_speed;  ///< of the two surfaces just before
    double virial;
};

/// A collision as listeners are told of it. `centre` is ball `id`'s, `partner` the other body's number.
[[nodiscard]] Collision collision_of(const Bodies& bodies, double seconds, std::uint32_t id,
                                     std::uint32_t partner, const Vec2& centre, const Hit& hit);

/// What an event has overwritten of ball `ball`'s anchor, and the index of what was before it: kNowhere if
/// nothing was, kAtStart if the ball's anchor at the window's start, which is kept elsewhere. One cache line.
struct alignas(64) OverwrittenAnchor {
    double x, y, vx, vy;
    Time time;
    Periods periods;
    std::uint32_t previous = kNowhere;
    std::uint32_t ball = kNowhere;
};
static_assert(sizeof(OverwrittenAnchor) == 64);
inline constexpr std::uint32_t kAtStart = kNowhere - 1;
/// Which overwritten anchors are kept: the first one of each ball is the one that a window started with.
/// Where it is not kept the others are put aside: call finish_aside() before another thread reads them.
enum class Keeps : std::uint8_t { kNone, kAllButFirst, kAll };
/// As far as the way from there on depends on it.
[[nodiscard]] inline Anchor anchor_of(const OverwrittenAnchor& o) {
    return {o.x, o.y, o.vx, o.vy, o.time, 0, 0, {}};
}

/// A ball that starts anew: elsewhere, at another velocity, or both.
struct NewStart {
    std::uint32_t ball = 0;
    std::optional<Vec2> position = {};
    std::optional<Vec2> velocity = {};
    BallState state = {};  ///< where it is then: set by who starts it
};
/// Anchors it at `t`.
void start_anew(const Bodies& bodies, Anchor& anchor, Periods& periods, const Vec2& acceleration,
                const Time& t, const NewStart& start);

/// A collision of a ball of the domain's own with a copy.
struct Meeting {
    std::uint32_t copy = 0;
    std::uint64_t mark = 0;  ///< of its time, of who met and of their ways there
};

/// A ball that has come to another cell.
struct Visit {
    std::uint32_t ball = 0;
    CellCoordinates cell;  ///< in the frame of the region
};

class EventLoop {
 public:
    explicit EventLoop(const Bodies& bodies);
    virtual ~EventLoop() = default;

    // ---- Filling: clear(), add() for every ball, then start() or predict_all().
    /// Empties the loop for a region. `now` is the time up to which the balls have been advanced.
    void clear(const Region& region, const Time& now);
    /// Adds a ball whose cell lies in the region, `crossing_time` since the epoch of `now`. A copy is
    /// simulated until `end`.
    void add(const BallRecord& record, const BallExtra* extra, bool is_owned, const Time& end = kNever);
    // ---- Going on for one more window from where the last one ended, instead of filling.
    /// Whether the loop, which has not failed and was not full, holds the balls of this region at `now`.
    [[nodiscard]] bool can_go_on(const Region& region, const Time& now) const {
        return region == region_ && bodies_.large.empty() && time_now() == now;
    }
    /// Forgets what the last window came to; the balls, whose traces are taken already, stay.
    void go_on() { forget_window(); }
    /// Ball i as its owner has it now; it is a copy, or was one until now.
    virtual void renew(std::uint32_t i, const BallRecord& record, const BallExtra& extra, bool is_owned,
                       const Time& end) = 0;
    /// A ball that was not here, in place of one that was removed if there is one. Gives its place in the
    /// loop.
    virtual std::uint32_t enter(const BallRecord& record, const BallExtra& extra, bool is_owned,
                                const Time& end) = 0;
    /// Ball i, one of the domain's own, is a copy from now on, simulated until `end`.
    virtual void hand_over(std::uint32_t i, const Time& end) = 0;
    /// Takes ball i out. Events of others that name it are dropped when they come up.
    virtual void remove(std::uint32_t i) = 0;
    /// Finds the next events of these balls from what is around them now.
    virtual void look_again(std::span<const std::uint32_t> balls) = 0;

    /// Balls i and j may be each the other's partner: then i need not look for it.
    void suggest_partner(std::uint32_t i, std::uint32_t j) {
        if (records_[i].next.partner == records_[j].id()) records_[i].next.local = j;
    }
    /// Takes the balls' next events as they are, and finds those that are not known.
    virtual void start() = 0;
    /// Predicts all of them anew.
    virtual void predict_all(const Executor* executor) = 0;

    // ---- Running.
    /// Resolves all events before `end`, and at it where `inclusive`; fewer where the loop is full. Throws
    /// std::runtime_error when a ball is wedged.
    virtual void advance_to(const Time& end, bool inclusive) = 0;
    /// Anchors every ball at `t`, no event being left before it, with a new acceleration: gravity, its own
    /// and the field's. Call predict_all() next.
    virtual void renew_field(const Time& t) = 0;
    /// Anchors balls at `t` by new starts, no event being left up to it; by their place in the loop, none
    /// twice. Precondition: the region is the whole plane.
    virtual void start_anew(const Time& t, std::span<const NewStart> starts) = 0;

    // ---- Reading.
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(records_.size()); }
    [[nodiscard]] std::uint32_t id(std::uint32_t i) const { return records_[i].id(); }
    [[nodiscard]] std::span<const BallRecord> records() const { return records_; }
    /// The anchor of ball i that was overwritten last: index into `overwritten`, or kAtStart.
    [[nodiscard]] std::uint32_t last_overwritten(std::uint32_t i) const {
        return locals_[i].last_overwritten;
    }
    [[nodiscard]] BallExtra extra(std::uint32_t i) const;
    /// Ball i's state at `t` >= its anchor.
    [[nodiscard]] BallState state(std::uint32_t i, const Time& t) const;
    /// A mark of all that ball i has done since the window's start, and the same as last_overwritten().
    struct Trace {
        std::uint64_t history = 0;
        std::uint32_t last_overwritten = kNowhere;
    };
    /// Gives it and forgets it, for the next window.
    [[nodiscard]] Trace take_trace(std::uint32_t i) {
        return {std::exchange(locals_[i].history, 0), std::exchange(locals_[i].last_overwritten, kNowhere)};
    }
    void forget_anchors();
    /// Whether a copy was given up before `end`.
    [[nodiscard]] bool is_lost(std::uint32_t i, const Time& end) const {
        return locals_[i].end < bodies_.physics.clock.since_epoch(end, epoch_);
    }
    /// Whether a ball of its own went where the loop cannot follow.
    [[nodiscard]] bool has_failed() const { return failed_; }
    /// Whether there were too many collisions, or no room for more: then all events up to and including
    /// time_now() are resolved, no later one.
    [[nodiscard]] bool is_full() const { return full_; }
    /// Of so many collisions as many as can have come one after the other: with those that share an instant a
    /// shorter window has as many.
    [[nodiscard]] std::uint64_t in_turn(std::uint64_t of) const { return std::min(of, instants_); }
    [[nodiscard]] Time time_now() const { return clock_.after({epoch_, 0}, now_); }
    /// The first broken rule of this file's head comment found for each ball.
    virtual void audit(std::vector<Violation>& found) const = 0;

    bool listens = false;      ///< whether collisions are kept in full
    bool keeps_notes = false;  ///< whether notes go to `notes` rather than to `on_note`
    /// Whether a ball without room to move is an error only after very many events at one instant; else the
    /// loop fails after a few.
    bool is_patient = true;
    bool keeps_window = false;  ///< whether visits and histories are kept
    Keeps keeps_anchors = Keeps::kNone;
    /// What is kept of events must fit the memory: when the load is as high as that, the loop stops before
    /// time goes on, or tells `on_part`, which makes room.
    std::uint64_t room = kEndless;
    /// With more collisions since the window's start, those at one instant aside, the loop is full as well.
    /// It looks a few times on the way through an epoch.
    std::uint64_t most_collisions = kEndless;
    static constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max();
    /// Room for so many collisions a ball from now on, and for what few balls may have.
    [[nodiscard]] std::uint64_t room_for(std::uint64_t collisions_of_ball) const {
        return load() + kLoadOfCollision * (10'000 + collisions_of_ball * size());
    }
    /// Told the end of each part of an epoch where anchors are kept without the rest of a window, and may
    /// call forget_anchors() then.
    std::function<void(const Time&)> on_part;
    std::function<void(const CollisionNote&, const Collision*)>
        on_note;                                ///< without the second unless it listens
    AsideTable<NotePart> notes;                 ///< of collisions that count here, in order: put aside
    std::vector<Collision> collisions;          ///< the same in full, where the loop listens
    AsideTable<OverwrittenAnchor> overwritten;  ///< of owned balls
    std::vector<Visit> visits;                  ///< of owned balls
    std::vector<Meeting> meetings;
    std::vector<std::uint8_t>
        touched;  ///< one a mark of the region: whether a ball of its own was in the cell or beside
    std::uint64_t events = 0;             ///< of owned balls: collisions, cell crossings, stale predictions
    std::uint64_t collisions_of_all = 0;  ///< copies' included, for the price of the halo

    [[nodiscard]] bool is_owned(std::uint32_t i) const { return locals_[i].owned != 0; }

 protected:
    // What is kept of a collision takes some times as much as what is of a ball that comes to another cell.
    static constexpr std::uint64_t kLoadOfCollision = 16;
    /// Of all events so far, copies' included.
    [[nodiscard]] std::uint64_t load() const { return kLoadOfCollision * collisions_of_all + turns_; }
    void begin();
    void forget_window();
    void seat(std::uint32_t i, const BallExtra* extra, bool is_owned, const Time& end);
    void touch(const CellCoordinates& cell);
    [[nodiscard]] double radius_of(std::uint32_t i) const {
        return bodies_.radius.is_one() ? bodies_.radius.of(0) : radius_[i];
    }
    /// The place of a cell given in ball i's frame; -1 outside the region.
    [[nodiscard]] std::int32_t place_of(std::uint32_t i, const CellCoordinates& c) const {
        return region_.place({c.x + locals_[i].frame.x, c.y + locals_[i].frame.y});
    }

    /// When ball i's entry in the queue comes up, since the start of the epoch.
    [[nodiscard]] double key_of(std::uint32_t i) const {
        const double key =
            std::min(clock_.since_epoch(records_[i].next.time, epoch_), records_[i].crossing_time);
        return key <= locals_[i].end ? key : std::numeric_limits<double>::infinity();
    }
    void schedule(std::uint32_t i) {
        const double key = key_of(i);
        queue_.set(i, key);
        if (simultaneous_ && key == now_) [[unlikely]]
            enter_tie(i);
    }
    /// Whether that entry is for leaving its cell, and not for its next event.
    [[nodiscard]] bool crosses_first(std::uint32_t i) const {
        return records_[i].crossing_time <= clock_.since_epoch(records_[i].next.time, epoch_);
    }

    /// A ball's entry of the present instant, where several events share it: they come by their bodies' ids.
    struct Tie {
        std::pair<std::uint32_t, std::uint32_t> bodies;  // in order; twice the ball where it leaves its cell
        std::uint32_t id;
        std::uint32_t local;
        friend auto operator<=>(const Tie&, const Tie&) = default;
    };
    [[nodiscard]] Tie tie_of(std::uint32_t i) const {
        const std::uint32_t id = records_[i].id();
        return {in_order(id, crosses_first(i) ? id : records_[i].next.partner), id, i};
    }
    [[gnu::noinline]] void enter_tie(std::uint32_t i);
    [[nodiscard]] bool is_stale(const Tie& tie) const {
        return queue_.key(tie.local) != now_ || tie != tie_of(tie.local);
    }

    const Bodies& bodies_;
    const Clock clock_;
    Region region_;
    CellLists cells_;
    EventQueue queue_;
    Sights sights_;
    bool filters_ = false;  // whether sights are used
    // The grid's axes as two balls side by side see them, x and y twice.
    struct Axes {
        Doubles low, high;  // where a place need not be wrapped
        Doubles min, inverse_width, count, width;
    };
    Axes axes_;
    std::vector<std::uint8_t> touched_at_start_;  // the domain's own cells and those beside them
    std::vector<std::uint8_t> is_inside_;  // one a place: whether the cells beside it lie beside it there too

    // One a ball, in the order of add(): what only this loop needs of it.
    struct Local {
        std::uint64_t history = 0;
        double end =
            std::numeric_limits<double>::infinity();  // when a copy is given up, since the epoch's start
        CellCoordinates frame;                        // from the anchor's frame to the region's
        std::uint32_t last_overwritten = kNowhere;
        std::uint8_t owned = 1;
    };
    std::vector<BallRecord> records_;
    std::vector<Local> locals_;
    std::vector<double> radius_;        // only where they differ
    std::vector<Vec2> acceleration_;    // only where it differs from ball to ball
    std::vector<Time> last_collision_;  // only where the contact time is not 0
    std::vector<std::uint32_t> large_;
    std::vector<std::uint32_t> free_;  // of no ball
    std::vector<Tie> ties_;            // a heap, the first on top; of simultaneous events, some stale

    std::int64_t epoch_ = 0;
    double now_ = 0;             // since the start of the epoch
    bool simultaneous_ = false;  // several events share the present instant
    bool failed_ = false;
    bool full_ = false;
    NotePart part_;            // that comes to `notes` or to `on_note` next
    std::uint64_t turns_ = 0;  // events of all balls
    std::uint64_t events_at_once_ = 0;
    std::uint64_t instants_ = 0;  // at which something happened since the window's start
};

/// The loop whose kernel suits the scene: no acceleration, the same for all balls, or each its own. `bodies`
/// must outlive it.
[[nodiscard]] std::unique_ptr<EventLoop> make_event_loop(const Bodies& bodies);

/// The way from an anchor on of a ball with this acceleration of its own, if accelerations differ.
[[nodiscard]] Motion<double> motion_since(const Bodies& bodies, const Anchor& anchor,
                                          const Vec2& acceleration);

/// The state at `t` >= its anchor of a ball with this acceleration of its own, if accelerations differ.
[[nodiscard]] BallState state_at(const Bodies& bodies, const Anchor& anchor, const Periods& periods,
                                 const Vec2& acceleration, const Time& t);

}  // namespace carom
