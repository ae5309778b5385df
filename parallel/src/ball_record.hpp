// What a ball carries from window to window and from domain to domain: plain data.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include <carom/broadphase/grid.hpp>
#include <carom/core/clock.hpp>

namespace carom {

/// A ball's state at its last event, and where the grid has it now: all of it that others' predictions read,
/// in one cache line.
struct alignas(64) Anchor {
    double x, y, vx, vy;
    Time time;
    std::uint32_t stamp = 0;  ///< counts the ball's events
    std::uint32_t id = 0;     ///< the ball's
    CellCoordinates cell;     ///< in the frame of the anchor's position: unfolded
};

static_assert(sizeof(Anchor) == 64);

inline constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// The numbers of an event's two bodies as events of one instant are ordered by them: the smaller first.
[[nodiscard]] inline std::pair<std::uint32_t, std::uint32_t> in_order(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

/// The time of a next event that has not been looked for.
inline constexpr Time kUnknown{-1, 0};

/// What a ball will meet next as far as is known.
struct NextEvent {
    Time time = kNever;
    std::uint32_t partner =
        kNowhere;             ///< a ball's id, or ball count + wall, or ball count + wall count + side
    std::uint32_t stamp = 0;  ///< the partner's at prediction; for a wall the feature that is hit
    std::int32_t image_x =
        0;  ///< the partner is met this many periods from its own frame, seen from the ball's
    std::int32_t image_y = 0;
    std::uint32_t local = kNowhere;  ///< a ball's index in the loop that predicted this, where known
};

/// When a ball leaves its cell, and to which side.
struct Crossing {
    double time = std::numeric_limits<double>::infinity();  ///< since the start of the current epoch
    std::int8_t dx = 0;
    std::int8_t dy = 0;
};

/// How many periods a ball has passed since time 0.
struct Periods {
    std::int32_t x = 0;
    std::int32_t y = 0;
};

/// All of a moving ball that is not the same for ever. Two cache lines.
struct BallRecord {
    Anchor anchor;
    NextEvent next;
    double crossing_time = 0;
    std::int32_t place = 0;  ///< of the anchor's cell in the region that holds the ball now
    std::int8_t crossing_dx = 0;
    std::int8_t crossing_dy = 0;
    Periods periods;

    [[nodiscard]] std::uint32_t id() const { return anchor.id; }
};

static_assert(sizeof(BallRecord) == 128);

/// Asks for the memory of a record ahead of its use.
inline void fetch(const BallRecord& record) {
    __builtin_prefetch(&record.anchor);
    __builtin_prefetch(&record.next);
}
/// What is gone through in no order of memory is asked for so many records ahead.
inline constexpr std::size_t kFetchedAhead = 8;

/// What only some scenes need beside it.
struct BallExtra {
    Time last_collision{std::numeric_limits<std::int64_t>::min(), 0};  ///< where the contact time is not 0
    Vec2 acceleration = Vec2::Zero();                                  ///< where it differs from ball to ball
};

/// A ball's state at some time.
struct BallState {
    Vec2 position = Vec2::Zero();  ///< in the box
    Vec2 velocity = Vec2::Zero();
    Vec2 unwrapped =
        Vec2::Zero();  ///< before it is wrapped back over all the periods that the ball has passed
};

}  // namespace carom
