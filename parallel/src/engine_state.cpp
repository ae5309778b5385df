#include "engine_state.hpp"

#include <atomic>
#include <cmath>
#include <string>

#include <carom/core/motion.hpp>

#include "fault.hpp"

namespace carom {
namespace {

bool is_finite(const Vec2& v) {
    return std::isfinite(v.x()) && std::isfinite(v.y());
}

/// Where the grid has a ball at `now`, in the frame of its anchor.
CellCoordinates cell_at(const Bodies& bodies, const SavedAnchor& a, const Vec2& acceleration,
                        const Time& now) {
    const double since = bodies.physics.clock.difference(now, a.time);
    return bodies.grid.coordinates(position_at(Motion<double>{a.position, a.velocity, acceleration}, since));
}

bool is_sound(const Bodies& bodies, const SavedAnchor& a, const Time& now) {
    const double epoch = bodies.physics.clock.epoch_length();
    return is_finite(a.position) && is_finite(a.velocity) && a.time.epoch >= 0 && a.time.offset >= 0 &&
           a.time.offset < epoch && a.time <= now;
}

bool is_sound(const CellCoordinates& c) {
    const auto is_near = [](std::int32_t k) { return k < GridAxis::kFarthest && k > -GridAxis::kFarthest; };
    return is_near(c.x) && is_near(c.y);
}

void check_sizes(const Bodies& bodies, const Snapshot& s) {
    const std::size_t moving = bodies.moving;
    if (s.anchors.size() != moving)
        throw SnapshotError("holds " + std::to_string(s.anchors.size()) + " moving balls, the scene has " +
                            std::to_string(moving));
    if (s.last_collisions.size() != (bodies.physics.contact_time > 0 ? moving : 0) ||
        s.accelerations.size() != (bodies.accelerates_each() ? moving : 0))
        throw SnapshotError("does not hold for each ball what this scene needs");
}

}  // namespace

EngineStart start_at_zero(const Bodies& bodies, std::span<const Ball> balls) {
    EngineStart start;
    start.records.reserve(bodies.moving);
    for (std::uint32_t i = 0; i < bodies.count; ++i) {
        if (bodies.fixes(i)) continue;
        const Ball& b = balls[i];
        BallRecord& r = start.records.emplace_back();
        const Vec2 x = bodies.held_position(b.position, r.periods);
        const Vec2 v = bodies.held_velocity(b.velocity);
        r.anchor = {x.x(), x.y(), v.x(), v.y(), {}, 0, i, bodies.grid.coordinates(x)};
    }
    if (bodies.needs_extras()) start.extras.resize(start.records.size());
    return start;
}

EngineStart start_from(const Bodies& bodies, const Snapshot& s, const Executor& executor) {
    check_sizes(bodies, s);
    EngineStart start;
    start.now = bodies.physics.clock.from_seconds(s.time);
    start.has_field = true;
    start.counts = s.counts;
    start.virial = s.virial;
    start.contacts = s.contacts;
    start.records.resize(s.anchors.size());
    if (bodies.needs_extras()) start.extras.resize(s.anchors.size());
    std::size_t rank = 0;
    for (std::uint32_t i = 0; i < bodies.count; ++i)
        if (!bodies.fixes(i)) start.records[rank++].anchor.id = i;

    std::atomic<bool> is_whole = true;
    executor.for_ranges(start.records.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            const SavedAnchor& a = s.anchors[k];
            const Vec2 acceleration = s.accelerations.empty() ? bodies.physics.gravity : s.accelerations[k];
            if (!is_sound(bodies, a, start.now) || !is_finite(acceleration)) {
                is_whole = false;
                continue;
            }
            BallRecord& r = start.records[k];
            const CellCoordinates cell = cell_at(bodies, a, acceleration, start.now);
            if (!is_sound(cell)) is_whole = false;
            r.anchor = {
                a.position.x(), a.position.y(), a.velocity.x(), a.velocity.y(), a.time, 0, r.id(), cell};
            r.periods = {a.periods_x, a.periods_y};
            if (!s.accelerations.empty()) start.extras[k].acceleration = acceleration;
            if (s.last_collisions.empty() || is_active(Fault::kForgottenHit)) continue;
            if (!(s.last_collisions[k] <= start.now)) is_whole = false;
            start.extras[k].last_collision = s.last_collisions[k];
        }
    });
    if (!is_whole) throw SnapshotError("holds a ball in a state that cannot be");
    return start;
}

BallSaver::BallSaver(const Bodies& bodies, Snapshot& snapshot) : snapshot_(snapshot) {
    snapshot.anchors.resize(bodies.moving);
    if (bodies.physics.contact_time > 0) snapshot.last_collisions.resize(bodies.moving);
    if (bodies.accelerates_each()) snapshot.accelerations.resize(bodies.moving);
    if (bodies.is_static.empty()) return;
    std::uint32_t rank = 0;
    for (std::uint32_t i = 0; i < bodies.count; ++i) ranks_.push_back(bodies.fixes(i) ? rank : rank++);
}

void BallSaver::save(std::uint32_t id, const Anchor& a, const Periods& periods, const BallExtra& extra) {
    const std::size_t k = ranks_.empty() ? id : ranks_[id];
    snapshot_.anchors[k] = {{a.x, a.y}, {a.vx, a.vy}, a.time, periods.x, periods.y};
    if (!snapshot_.last_collisions.empty()) snapshot_.last_collisions[k] = extra.last_collision;
    if (!snapshot_.accelerations.empty()) snapshot_.accelerations[k] = extra.acceleration;
}

}  // namespace carom
