// One domain in time order: every ball knows its next event, a queue hands out the earliest, and after a
// collision only its two balls are predicted anew.
//
// What the rest of the engine relies on:
// - A ball's anchor changes at its own events only; crossing a cell's border is not one.
// - A predicted time is a function of the two anchors and the periodic image alone, computed from the smaller
// id to the larger.
// - A ball's entry in the queue is never later than its true next event. It may be stale, when the partner
// has had another event
//   since; that is noticed when the entry comes up, and the ball is predicted anew. Of two balls that meet
//   next at least one has the event, or an earlier one, as its entry.
// - Events come in the order of (time, smaller id, larger id), walls numbered after the balls and the
// domain's sides after the walls.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <carom/broadphase/cell_lists.hpp>
#include <carom/broadphase/grid.hpp>
#include <carom/broadphase/obstacles.hpp>
#include <carom/core/event_queue.hpp>
#include <carom/parallel/world.hpp>

#include "executor.hpp"
#include "physics.hpp"

namespace carom {

/// A ball's state at its last event, and where the grid has it now. One cache line.
struct alignas(64) Anchor {
    double x, y, vx, vy;
    Time time;
    std::uint32_t stamp = 0;   ///< counts the ball's events
    std::int32_t storage = 0;  ///< the storage cell of `cell`
    CellCoordinates cell;      ///< in the frame of the anchor's position: unfolded
};

static_assert(sizeof(Anchor) == 64);

/// What a ball will meet next as far as is known.
struct NextEvent {
    Time time = kNever;
    std::uint32_t partner = 0;  ///< a ball, or ball count + wall, or ball count + wall count + side
    std::uint32_t stamp = 0;    ///< the partner's at prediction; for a wall the feature that is hit
    std::int32_t image_x =
        0;  ///< the partner is met this many periods from its own frame, seen from the ball's
    std::int32_t image_y = 0;
};

/// How many periods a ball has passed since time 0.
struct Periods {
    std::int64_t x = 0;
    std::int64_t y = 0;
};

/// When a ball leaves its cell, and to which side.
struct Crossing {
    double time = 0;  ///< since the start of the current epoch
    std::int8_t dx = 0;
    std::int8_t dy = 0;
};

class EventLoop {
 public:
    virtual ~EventLoop() = default;

    /// Resolves all events up to and including `end`.
    virtual void advance_to(const Time& end) = 0;
    /// Anchors every moving ball at `t`, no event being left before it, with a new acceleration: gravity, its
    /// own and the field's.
    virtual void update_field(const Time& t, std::span<const Attractor> attractors) = 0;
    /// The first broken rule of this file's head comment found for each ball.
    virtual void audit(std::vector<Violation>& found) const = 0;

    /// A ball's state at `t` >= its anchor, in the frame of the box.
    [[nodiscard]] virtual Ball ball_at(std::uint32_t id, const Time& t) const = 0;
    /// The same position before it is wrapped back over all the periods that the ball has passed.
    [[nodiscard]] virtual Vec2 unwrapped_position_at(std::uint32_t id, const Time& t) const = 0;

    [[nodiscard]] std::size_t ball_count() const { return anchors_.size(); }
    [[nodiscard]] const Counts& counts() const { return counts_; }
    [[nodiscard]] double virial() const { return virial_; }
    [[nodiscard]] const Grid& grid() const { return grid_; }
    std::function<void(const Collision&)> listener;

 protected:
    EventLoop(const Physics& physics, std::span<const Ball> balls, std::span<const Wall> walls,
              const Grid& grid, const Executor& executor);

    Physics physics_;
    Clock clock_;
    const Executor& executor_;
    Grid grid_;
    CellLists cells_;
    ObstacleMap obstacles_;
    ObstacleMap obstacles_of_large_;
    std::vector<std::uint32_t> large_;  // moving balls wider than a cell, few
    double largest_listed_radius_ = 0;  // of all other moving balls
    EventQueue queue_;

    std::vector<Anchor> anchors_;
    std::vector<NextEvent> next_;
    std::vector<Crossing> crossings_;
    std::vector<std::uint8_t> asleep_;  // whose next event is its partner's as well, and in the queue there
    std::vector<double> radius_;
    std::vector<double> mass_;
    std::vector<double> restitution_;
    std::vector<std::uint8_t> is_static_;
    std::vector<Vec2> own_acceleration_;
    std::vector<Vec2> acceleration_;    // the present one; only where it differs from ball to ball
    std::vector<Time> last_collision_;  // only where the contact time is not 0
    std::vector<Periods> periods_;      // how many periods the frame of the anchor is from that of time 0
    std::vector<Wall> walls_;

    void choose_margins();
    static constexpr double kDoubtfulShare = 0x1p-20;
    bool one_radius_ = false;  // of all moving balls
    bool filters_ = false;     // whether bound_times() is of use, with these margins:
    double margin_ = 0;        // relative, of squared lengths
    double farthest_ = 0;      // beyond such coordinates and flights the margin does not hold
    double time_margin_ = 0;   // of times since the start of the epoch

    std::int64_t epoch_ = 0;
    double now_ = 0;             // since the start of the epoch
    bool simultaneous_ = false;  // several events share the present instant
    std::uint64_t events_at_once_ = 0;
    Counts counts_;
    double virial_ = 0;
};

/// The loop whose kernel suits the scene: no acceleration, the same for all balls, or each its own.
/// `executor` must outlive it.
[[nodiscard]] std::unique_ptr<EventLoop> make_event_loop(const Physics& physics, std::span<const Ball> balls,
                                                         std::span<const Wall> walls,
                                                         std::span<const Attractor> attractors,
                                                         const Grid& grid, const Executor& executor);

}  // namespace carom
