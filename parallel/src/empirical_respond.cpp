// The contacts of a step in time order: what they do to the balls, and what that leads to in the rest of the
// step.
#include <algorithm>
#include <cmath>

#include <carom/core/response.hpp>

#include "empirical_engine.hpp"

namespace carom {
namespace {

// Of an overlap in a step.
constexpr double kRecovered = 0.5;
// A ball that has responded so often in a step lies in contact, and loses no more in it: the TC model told by
// a count, for the contact time may be far shorter than the step.
constexpr std::uint32_t kLossyResponses = 4;

}  // namespace

void EmpiricalEngine::resolve_all() {
    later_.clear();
    const auto sooner_on_top = [](const Meeting& a, const Meeting& b) { return b < a; };
    std::size_t next = 0;
    while (next < contacts_.size() || !later_.empty()) {
        Meeting meeting;
        if (later_.empty() || (next < contacts_.size() && contacts_[next] < later_.front())) {
            meeting = contacts_[next++];
        } else {
            std::ranges::pop_heap(later_, sooner_on_top);
            meeting = later_.back();
            later_.pop_back();
        }
        const auto has_responded = [&](std::uint32_t slot, std::uint32_t stamp) {
            return stamp_of(slot) != stamp;
        };
        const Pair& pair = meeting.pair;
        if (has_responded(pair.slot, meeting.stamp) || has_responded(pair.other, meeting.other_stamp))
            continue;  // it was looked at again then
        const std::uint32_t most = pair.other == kNowhere ? kMostResponses : kMostAmongBalls;
        if (std::max(meeting.stamp, meeting.other_stamp) >= most) {
            lasting_.push_back(meeting);
            continue;
        }
        resolve(meeting);
        for (const Meeting& m : serial_.contacts) {
            later_.push_back(m);
            std::ranges::push_heap(later_, sooner_on_top);
        }
        lasting_.insert(lasting_.end(), serial_.lasting.begin(), serial_.lasting.end());
    }
}

/// Responds, and finds into `serial_` what the balls meet from there.
void EmpiricalEngine::resolve(const Meeting& meeting) {
    const Pair& pair = meeting.pair;
    advance(pair.slot, meeting.time);
    if (pair.other != kNowhere) {
        advance(pair.other, meeting.time);
        respond_ball(meeting);
    } else {
        respond_obstacle(meeting);
    }
    if (counts_missed_) resolved_.emplace_back(meeting.lower, meeting.higher);
    serial_.contacts.clear();
    serial_.lasting.clear();
    relist(pair.slot);
    if (pair.other != kNowhere) relist(pair.other);
    look_around(pair.slot, serial_);
    if (pair.other != kNowhere) look_around(pair.other, serial_);
}

/// Begins a new leg.
void EmpiricalEngine::advance(std::uint32_t slot, double time) {
    if (!is_touched(slot)) {
        touched_index_[slot] = static_cast<std::uint32_t>(touched_.size());
        touched_.push_back({slot});
    }
    Touched& t = touched_[touched_index_[slot]];
    const Motion<double> m = motion_from(slot, time);
    if (counts_missed_ && time > t.start) {
        legs_.push_back({t.start, x_[slot], y_[slot], vx_[slot], vy_[slot], t.previous});
        t.previous = static_cast<std::uint32_t>(legs_.size() - 1);
    }
    const Vec2 v = bodies_.held_velocity(m.velocity);
    x_[slot] = m.position.x();
    y_[slot] = m.position.y();
    vx_[slot] = v.x();
    vy_[slot] = v.y();
    t.start = time;
    ++t.responses;
}

/// Puts a ball with a new leg where that ends.
void EmpiricalEngine::relist(std::uint32_t slot) {
    const std::uint32_t index = touched_index_[slot];
    Touched& t = touched_[index];
    place_end(slot, position_at(motion_from(slot, t.start), duration_ - t.start));
    if (!is_large_.empty() && is_large_[slot] != 0) return;
    const std::int32_t cell = grid_.cell(wrapped_x_[slot], wrapped_y_[slot]);
    if (cell == t.cell) return;
    if (t.cell >= 0) {
        std::uint32_t* link = &first_touched_[static_cast<std::size_t>(t.cell)];
        while (*link != index) link = &touched_[*link].next_in_cell;
        *link = t.next_in_cell;
    }
    t.cell = cell;
    t.next_in_cell = first_touched_[static_cast<std::size_t>(cell)];
    first_touched_[static_cast<std::size_t>(cell)] = index;
}

/// The TC model: a body that has collided a moment ago loses nothing. Nor does a contact that has lasted
/// since the step before: it has paid already, and would sink a little in every step.
double EmpiricalEngine::restitution_at(double restitution, const Pair& pair, double gap,
                                       const Time& t) const {
    if (gap < -steps_.tolerance) return 1;
    if (std::max(stamp_of(pair.slot), stamp_of(pair.other)) > kLossyResponses) return 1;
    const double contact_time = bodies_.physics.contact_time;
    if (contact_time == 0) return restitution;
    const Time& last = pair.other == kNowhere
                           ? last_collision_[pair.slot]
                           : std::max(last_collision_[pair.slot], last_collision_[pair.other]);
    return tc_restitution(restitution, clock_.difference(t, last), contact_time);
}

/// The speed at which a contact pressed together must part to stay open for the rest time; in a scene with
/// losses for a step at least, lest what lies at rest falls into its floor in the rest of each step.
double EmpiricalEngine::parting_speed_of(double pressure, const Vec2& line) const {
    const Physics& physics = bodies_.physics;
    const double rest = physics.loses_energy ? std::max(physics.rest_time, duration_) : physics.rest_time;
    return parting_speed(pressure, line, rest);
}

/// The speed at which two bodies that a step has left overlapping part at least, in a scene with losses: half
/// of the overlap in a step, but no faster than what is at rest parts from its floor. So a pile, pressed
/// together from step to step, opens again. 0 in an elastic scene, where it would add energy.
double EmpiricalEngine::recovery(double gap, std::uint32_t slot) const {
    if (!bodies_.physics.loses_energy || !(gap < -steps_.tolerance) || !(duration_ > 0)) return 0;
    const double pull = std::sqrt(length_squared(acceleration_of(slot)));
    return std::min(kRecovered * -gap / duration_, pull * duration_ / 2);
}

void EmpiricalEngine::respond_ball(const Meeting& meeting) {
    const std::uint32_t i = meeting.pair.slot;
    const std::uint32_t j = meeting.pair.other;
    const Time time = clock_.after(now_, meeting.time);
    const Vec2 va = {vx_[i], vy_[i]};
    const Vec2 vb = {vx_[j], vy_[j]};
    const Touch contact = touch(meeting.pair, {x_[i], y_[i]}, {x_[j], y_[j]});
    const Vec2& line = contact.line;
    const double restitution =
        restitution_at(bodies_.restitution_between(id_[i], id_[j]), meeting.pair, contact.gap, time);
    double pressure = 0;
    if (!acceleration_.empty())
        pressure =
            -(length_squared<double>(va - vb) + dot<double>(line, acceleration_[i] - acceleration_[j]));
    double impulse = 0;
    const PairVelocities<double> after =
        collide(va, vb, line, bodies_.mass.of(id_[i]), bodies_.mass.of(id_[j]), restitution,
                std::max(parting_speed_of(pressure, line), recovery(contact.gap, i)), &impulse,
                [this](const Vec2& v) { return bodies_.held_velocity(v); });
    vx_[i] = after.a.x();
    vy_[i] = after.a.y();
    vx_[j] = after.b.x();
    vy_[j] = after.b.y();
    if (bodies_.physics.contact_time > 0) last_collision_[i] = last_collision_[j] = time;
    const double distance = std::sqrt(length_squared(line));
    const Vec2 normal = distance > 0 ? Vec2(line / distance) : Vec2(1, 0);
    tell(meeting, {normal, impulse, -dot<double>(va - vb, normal), impulse * distance});
}

void EmpiricalEngine::respond_obstacle(const Meeting& meeting) {
    const std::uint32_t i = meeting.pair.slot;
    const std::uint32_t partner = meeting.pair.partner;
    const Time time = clock_.after(now_, meeting.time);
    const Vec2 before = {vx_[i], vy_[i]};
    const Vec2 centre = {x_[i], y_[i]};
    const Touch contact = touch(meeting.pair, centre, centre);
    const Vec2& line = contact.line;
    const bool is_ball = partner < bodies_.count;
    const double restitution = bodies_.restitution_between(id_[i], partner);
    const bool lasts = restitution_at(0, meeting.pair, contact.gap, time) == 1;
    const double lasting = lasts ? 1 : restitution;
    const Vec2 acceleration = acceleration_of(i);
    double pressure = 0;
    if (!acceleration.isZero(0))
        pressure = -(dot(line, acceleration) + (contact.is_round ? length_squared(before) : 0.0));
    const bool is_paid = lasts || contact.gap < -steps_.tolerance;
    const double factor = is_paid ? 1 : bodies_.physics.speed_factor;
    const Vec2 after = bounce<double>(
        before, line, lasting, std::max(parting_speed_of(pressure, line), recovery(contact.gap, i)) / factor,
        [&](const Vec2& v) { return bodies_.held_velocity(v * factor); });
    vx_[i] = after.x();
    vy_[i] = after.y();
    if (bodies_.physics.contact_time > 0) last_collision_[i] = time;
    const double length = std::sqrt(length_squared(line));
    const Vec2 normal = length > 0 ? Vec2(line / length) : Vec2(1, 0);
    const double impulse = bodies_.mass.of(id_[i]) * dot<double>(after - before, normal);
    tell(meeting, {normal, impulse, -dot(before, normal), is_ball ? impulse * length : 0.0});
}

/// Counts the collision, and tells whoever listens.
void EmpiricalEngine::tell(const Meeting& meeting, const Hit& hit) {
    const std::uint32_t i = meeting.pair.slot;
    const std::uint32_t partner = meeting.pair.partner;
    CollisionNote note;
    note.is_wall = partner >= bodies_.count;
    note.virial = hit.virial;
    tally_.count(note);
    ++counts_.events;
    if (!listener_) return;
    listener_(collision_of(bodies_, clock_.to_seconds(clock_.after(now_, meeting.time)), id_[i], partner,
                           {x_[i], y_[i]}, hit));
}

}  // namespace carom
