// A simulation at one moment as plain data: all that its future and its summary depend on, and nothing that
// can be derived from the scene. parallel's World gives and takes it, io writes it to files and reads it.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <carom/core/clock.hpp>
#include <carom/core/vector.hpp>

namespace carom {

struct Counts {
    std::uint64_t ball_collisions = 0;
    std::uint64_t wall_collisions = 0;
    std::uint64_t events = 0;             ///< collisions, cell crossings, stale predictions and field updates
    std::uint64_t windows = 0;            ///< stretches of time through which a domain went on its own
    std::uint64_t window_retries = 0;     ///< of them those that a domain had to go through again
    std::uint64_t copied_collisions = 0;  ///< that a domain resolved for its halo, on top of all others
    std::optional<std::uint64_t> steps;   ///< of the empirical method
    /// Pairs of bodies, ball or wall, that met on their way through a step of the empirical method, ended it
    /// apart and were not resolved in it; none where not counted.
    std::optional<std::uint64_t> missed_collisions;
};

/// A moving ball at its last event.
struct SavedAnchor {
    Vec2 position = Vec2::Zero();  ///< in the box
    Vec2 velocity = Vec2::Zero();
    Time time;
    std::int32_t periods_x = 0;  ///< passed since time 0
    std::int32_t periods_y = 0;
};

/// A sum of doubles kept as an integer of 128 bits, whose scale the scene gives.
struct SavedSum {
    std::int64_t high = 0;
    std::uint64_t low = 0;
    bool is_lost = false;  ///< it has become too large to be told
};

/// Two bodies that a step of the empirical method has left overlapping, numbered as an engine numbers them.
struct SavedContact {
    std::uint32_t ball = 0;     ///< a moving one; of two the smaller number
    std::uint32_t partner = 0;  ///< a ball, a wall or a side of the domain
    std::int32_t image_x = 0;   ///< periods from the partner's place to where it is touched
    std::int32_t image_y = 0;

    friend auto operator<=>(const SavedContact&, const SavedContact&) = default;
};

struct Cast;  // of parallel: who takes part in a world

/// Predicted events are no part of it: they are functions of the anchors, and are found anew.
struct Snapshot {
    std::string method = "event";  ///< how balls are moved; at most 16 characters
    std::uint64_t scene_hash = 0;  ///< of the scene as simulated
    double time = 0;
    std::uint64_t field_updates = 0;  ///< of the attractors, up to and including `time`
    Counts counts;
    SavedSum virial;
    // One a moving ball, in the order of the ids.
    std::vector<SavedAnchor> anchors;
    std::vector<Time>
        last_collisions;  ///< of the least epoch where there was none; empty where the contact time is 0
    std::vector<Vec2> accelerations;  ///< whole ones; empty where they do not differ from ball to ball
    /// At the end of the empirical method's last step, which the anchors show; none where who overlaps is to
    /// be looked for.
    std::optional<std::vector<SavedContact>> contacts;
    /// Where edits have made the bodies others than the scene's: these, shared with the world; no file holds
    /// them.
    std::shared_ptr<const Cast> edited;
};

/// A snapshot that cannot be gone on from: of another scene or method, or not a state at all.
class SnapshotError : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

}  // namespace carom
