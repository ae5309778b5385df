// What happens at an event, and the loop that takes them in order.
#pragma once

#include <algorithm>
#include <bit>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <carom/core/response.hpp>
#include <carom/core/wall_time.hpp>

#include "event_loop_of.hpp"
#include "event_loop_pair.hpp"
#include "fault.hpp"
#include "hash.hpp"

namespace carom {

template <Acceleration A>
void EventLoopOf<A>::advance_to(const Time& end, bool inclusive) {
    while (!full_ && epoch_ < end.epoch) {
        run_in_parts(clock_.epoch_length(), false);
        if (full_) break;
        const double epochs = std::floor(queue_.first_key() / clock_.epoch_length());
        start_next_epoch(epochs < double(end.epoch - epoch_)
                             ? epoch_ + std::max(std::int64_t{1}, static_cast<std::int64_t>(epochs))
                             : end.epoch);
    }
    if (!full_) run_in_parts(end.offset, inclusive);
    if (!full_) now_ = std::max(now_, end.offset);
    pass_on_notes();
}

/// Where anchors are kept for a follower, it is told often enough that they stay few. Where there may be too
/// many collisions, that shows early.
template <Acceleration A>
void EventLoopOf<A>::run_in_parts(double end, bool inclusive) {
    constexpr double kParts = 64;
    if (on_part) {
        const double part = clock_.epoch_length() / kParts;
        for (double k = std::floor(now_ / part) + 1; k * part < end && !failed_; ++k) {
            if (!(queue_.first_key() < k * part)) continue;
            run_until(k * part, false);
            pass_on_notes();
            on_part({epoch_, k * part});
        }
    }
    constexpr int kLooks = 8;
    const double start = now_;
    for (int look = 1; look < kLooks && most_collisions != kEndless; ++look) {
        run_until(start + (end - start) * look / kLooks, false);
        full_ = full_ || in_turn(collisions_of_all) > most_collisions;
        if (full_) return;
    }
    run_until(end, inclusive);
}

template <Acceleration A>
void EventLoopOf<A>::run_until(double end, bool inclusive) {
    while (!failed_) {
        const EventQueue::Front first = queue_.front();
        std::uint32_t i = first.id;
        const double key = first.key;
        if (!(key < end || (inclusive && key == end))) return;
        if (key > now_) {
            if (load() >= room) {
                make_room(key);
                if (full_) return;
            }
            now_ = key;
            if (filters_ && sights_.are_worn(now_)) sight_all();
            events_at_once_ = 0;
            ++instants_;
            simultaneous_ = false;
        } else if (++events_at_once_ > most_events_at_once()) {
            if (!is_patient) {
                failed_ = true;
                return;
            }
            refuse_wedged(i);
        }
        if (!are_plainly_first(first)) [[unlikely]]
            i = first_of_ties();
        queue_.take(i);
        fetch_own(queue_.coming_later());
        fetch_pair(queue_.coming());
        ++turns_;
        events += locals_[i].owned;
        if (crosses_first(i))
            cross(i);
        else
            collide_first(i);
    }
}

/// Stops the loop, or tells the follower what has happened before `end`.
template <Acceleration A>
void EventLoopOf<A>::make_room(double end) {
    full_ = !on_part;
    if (full_) return;
    pass_on_notes();
    on_part({epoch_, end});
}

/// Whether the queue's front is one event: of one ball, or of two that meet each other, and in no later tie.
template <Acceleration A>
bool EventLoopOf<A>::are_plainly_first(const EventQueue::Front& first) const {
    const auto meets = [this, key = first.key](std::uint32_t i, std::uint32_t j) {
        const BallRecord& r = records_[i];
        return static_cast<unsigned>(r.next.local == j) & static_cast<unsigned>(r.next.time.offset == key) &
               static_cast<unsigned>(r.next.time.epoch == epoch_) &
               static_cast<unsigned>(r.crossing_time > key);
    };
    // Whether two balls know of their event or one cannot be foreseen, so nothing branches on it.
    const unsigned is_one = first.id == first.other;
    const unsigned is_pair = meets(first.id, first.other) & meets(first.other, first.id);
    return (is_one | is_pair) > static_cast<unsigned>(first.may_be_more);
}

/// Several events share this instant: lets the smaller id of each pair know of its event, so that who holds
/// the event of the smallest ids holds the first one. A static ball holds none, and may have the smallest.
template <Acceleration A>
std::uint32_t EventLoopOf<A>::first_of_ties() {
    if (!simultaneous_) {
        std::vector<Tie> tied;
        queue_.for_each_first([&](std::uint32_t i) { tied.push_back(tie_of(i)); });
        const auto is_one_pair = [&] {
            const NextEvent& a = records_[tied[0].local].next;
            const NextEvent& b = records_[tied[1].local].next;
            return a.partner == tied[1].id && b.partner == tied[0].id && a.time == b.time;
        };
        if (tied.size() == 1 || (tied.size() == 2 && is_one_pair())) return std::ranges::min(tied).local;
        simultaneous_ = true;
        ties_ = tied;
        std::ranges::make_heap(ties_, std::greater());
        for (const Tie& tie : tied) tell_lower(tie.local);
    }
    while (is_stale(ties_.front())) {
        std::ranges::pop_heap(ties_, std::greater());
        ties_.pop_back();
    }
    return ties_.front().local;
}

/// Hands the notes on, a part at a time.
template <Acceleration A>
void EventLoopOf<A>::pass_on_notes() {
    if (part_.count == 0) return;
    const std::uint32_t count = part_.count;
    if (keeps_notes) {
        part_.tally = {};
        part_.tally.virial.set_scale(bodies_.physics.typical_virial);
        for (std::uint32_t k = 0; k < count; ++k) part_.tally.count(part_.notes[k]);
        part_.end = part_.notes[count - 1].time;
        notes.push_aside(part_);
        part_.count = 0;
        return;
    }
    part_.count = 0;
    // Taken out first: whoever is told may ask for an end of it.
    std::vector<Collision> in_full = std::exchange(collisions, {});
    const bool is_full = in_full.size() == count;
    for (std::uint32_t k = 0; k < count; ++k) on_note(part_.notes[k], is_full ? &in_full[k] : nullptr);
    in_full.clear();
    collisions = std::move(in_full);
}

/// Many balls may meet at one instant, in a row of touching balls (N / 2)^2 times; what goes on has no end.
template <Acceleration A>
void EventLoopOf<A>::refuse_wedged(std::uint32_t i) const {
    std::ostringstream what;
    what << bodies_.ball_name(records_[i].id()) << ": is wedged: more than " << most_events_at_once()
         << " events at time " << clock_.to_seconds(time_now())
         << " (it has no room to move, or loses energy without a contact_time)";
    throw std::runtime_error(what.str());
}

template <Acceleration A>
void EventLoopOf<A>::start_next_epoch(std::int64_t epoch) {
    const double passed = clock_.epoch_length() * (double(epoch) - double(epoch_));
    epoch_ = epoch;
    now_ = 0;
    simultaneous_ = false;
    for (std::uint32_t i = 0; i < size(); ++i) {
        records_[i].crossing_time -= passed;
        locals_[i].end -= passed;
        queue_.put(i, key_of(i));
    }
    queue_.rebuild();
    sight_all();
}

template <Acceleration A>
void EventLoopOf<A>::cross(std::uint32_t i) {
    const Anchor& a = records_[i].anchor;
    const Crossing crossing{records_[i].crossing_time, records_[i].crossing_dx, records_[i].crossing_dy};
    relist(i, {a.cell.x + crossing.dx, a.cell.y + crossing.dy});
    if (std::max(std::abs(a.cell.x), std::abs(a.cell.y)) >= GridAxis::kFarthest)
        throw std::runtime_error(bodies_.ball_name(records_[i].id()) +
                                 ": flies more than a thousand million cells without an event");
    NextEvent best = records_[i].next;
    const CellCoordinates side{crossing.dx, crossing.dy};  // from where others come into view
    Candidates found;
    if (look_beside(i, side, found))
        choose(i, found, best);
    else
        scan_beside(i, side, best);
    scan_large(i, best);
    scan_obstacles(i, best);
    predict_crossing(i);
    expect(i, best);
}

template <Acceleration A>
void EventLoopOf<A>::collide_first(std::uint32_t i) {
    const NextEvent event = records_[i].next;
    if (event.partner >= bodies_.count || bodies_.fixes(event.partner)) {
        collide_obstacle(i, event);
        return;
    }
    std::uint32_t j = event.local;
    if (j == kNowhere) {  // predicted before the balls came here
        bool is_inside = true;
        j = find_beside(i, event.partner, is_inside);
        if (j == kNowhere && !is_inside) return lose(i);
        records_[i].next.local = j;
    }
    if (j == kNowhere || (!is_current(records_[i].next) && !is_active(Fault::kStalePartner)))
        expect(i, search(i));  // the partner has gone another way
    else if (now_ > locals_[j].end)
        lose(i);  // perhaps it has, perhaps not
    else
        collide_pair(i, j, {event.image_x, event.image_y}, event.time);
}

/// The ball of an id in the cells around ball i, where a partner in contact is. `is_inside` tells whether all
/// of those cells are in the region.
template <Acceleration A>
std::uint32_t EventLoopOf<A>::find_beside(std::uint32_t i, std::uint32_t id, bool& is_inside) const {
    const CellCoordinates c = records_[i].anchor.cell;
    std::uint32_t found = kNowhere;
    int cells = 0;
    for_each_place(i, {c.x - 1, c.y - 1}, {c.x + 1, c.y + 1}, [&](std::int32_t place, CellCoordinates) {
        ++cells;
        cells_.for_each(place, [&](std::uint32_t j) {
            if (records_[j].id() == id) found = j;
        });
    });
    is_inside = cells == 9;
    return found;
}

/// Notes a ball's anchor, that is about to be overwritten.
template <Acceleration A>
void EventLoopOf<A>::keep_anchor(std::uint32_t i) {
    if (keeps_anchors == Keeps::kNone || !is_owned(i)) return;
    std::uint32_t& last = locals_[i].last_overwritten;
    if (keeps_anchors == Keeps::kAllButFirst && last == kNowhere) {
        last = kAtStart;
        return;
    }
    const Anchor& a = records_[i].anchor;
    const OverwrittenAnchor o{a.x, a.y, a.vx, a.vy, a.time, records_[i].periods, last, i};
    if (keeps_anchors == Keeps::kAllButFirst)
        overwritten.push_aside(o);  // read where somebody looks into the window
    else
        overwritten.push_back(o);
    last = static_cast<std::uint32_t>(overwritten.size() - 1);
}

/// Anchors a ball at `t`, wrapped into the box. Gives the periods that the wrapping took away.
template <Acceleration A>
auto EventLoopOf<A>::advance(std::uint32_t i, const Time& t) -> Image {
    Anchor& a = records_[i].anchor;
    const double since = clock_.difference(t, a.time);
    const Motion<double> m = motion_of(i);
    const Vec2 v = bodies_.held_velocity(velocity_at(m, since));
    keep_anchor(i);
    const Grid& grid = bodies_.grid;
    Periods wrapped;
    const Vec2 inside = bodies_.held_position(position_at(m, since), wrapped);
    a.x = inside.x();
    a.y = inside.y();
    a.vx = v.x();
    a.vy = v.y();
    a.time = t;
    records_[i].periods.x += wrapped.x;
    records_[i].periods.y += wrapped.y;
    locals_[i].frame.x = region_.x.frame_after(locals_[i].frame.x, wrapped.x * grid.x.count());
    locals_[i].frame.y = region_.y.frame_after(locals_[i].frame.y, wrapped.y * grid.y.count());
    return {wrapped.x, wrapped.y};
}

/// After an event: finds the ball's cell anew and marks every prediction about the ball as stale.
template <Acceleration A>
void EventLoopOf<A>::settle(std::uint32_t i) {
    Anchor& a = records_[i].anchor;
    ++a.stamp;
    relist(i, bodies_.grid.coordinates({a.x, a.y}));
    if (filters_) sight(i);
}

/// Puts a ball into another cell's list; a large ball is in none.
template <Acceleration A>
void EventLoopOf<A>::relist(std::uint32_t i, CellCoordinates cell) {
    Anchor& a = records_[i].anchor;
    const std::int32_t place = place_of(i, cell);
    if (place < 0) return lose(i);
    a.cell = cell;
    if (place == records_[i].place) return;
    if (!is_large(i)) {
        cells_.remove(records_[i].place, i);
        cells_.insert(place, i);
    }
    records_[i].place = place;
    if (!keeps_window) return;
    const CellCoordinates here{cell.x + locals_[i].frame.x, cell.y + locals_[i].frame.y};
    if (!is_owned(i)) return;
    visits.push_back({i, here});
    if (region_.depth(here) > 0) touch(here);
}

/// The TC model: a body that has collided a moment ago loses nothing. `j` == i where the other body has no
/// past.
template <Acceleration A>
double EventLoopOf<A>::restitution_at(double restitution, std::uint32_t i, std::uint32_t j,
                                      const Time& t) const {
    if (bodies_.physics.contact_time == 0) return restitution;
    const double since = clock_.difference(t, std::max(last_collision_[i], last_collision_[j]));
    return tc_restitution(restitution, since, bodies_.physics.contact_time);
}

template <Acceleration A>
void EventLoopOf<A>::collide_pair(std::uint32_t i, std::uint32_t j, Image image, const Time& t) {
    put_in_order(i, j, image);
    if (keeps_window && is_owned(i) != is_owned(j)) [[unlikely]]
        keep_meeting(i, j, image, t);
    Pair pair = pair_at(i, j, t);
    const bool plain = A != Acceleration::kPerBall && is_plain(pair);
    if (plain) {
        keep_anchor(i);
        keep_anchor(j);
    } else {
        const Image wrapped_i = advance(i, t);
        const Image wrapped_j = advance(j, t);
        image = {image.x - wrapped_i.x + wrapped_j.x, image.y - wrapped_i.y + wrapped_j.y};
        const Anchor& a = records_[i].anchor;
        const Anchor& b = records_[j].anchor;
        pair = {Doubles{a.x, a.y, b.x, b.y}, Doubles{a.vx, a.vy, b.vx, b.vy}};
    }
    const Vec2 va = {pair.velocity[0], pair.velocity[1]};
    const Vec2 vb = {pair.velocity[2], pair.velocity[3]};
    // Centre i less centre j's image, the same bits as the prediction's.
    const Vec2 r = Vec2(pair.place[0], pair.place[1]) - Vec2(pair.place[2], pair.place[3]) - offset_of(image);
    const double restitution =
        restitution_at(bodies_.restitution_between(records_[i].id(), records_[j].id()), i, j, t) *
        (is_active(Fault::kEnergyGain) ? 1 + 1e-6 : 1);
    const bool swaps = is_active(Fault::kSwappedMasses);
    const double mass_i = bodies_.mass.of(records_[swaps ? j : i].id());
    const double mass_j = bodies_.mass.of(records_[swaps ? i : j].id());
    // NOLINTNEXTLINE(misc-const-correctness): not where there is an acceleration
    double pressure = 0;  // -f'' / 2 of the squared distance f: positive where the pair is pressed together
    if constexpr (A == Acceleration::kPerBall)
        pressure = -(length_squared<double>(va - vb) + dot<double>(r, acceleration_[i] - acceleration_[j]));
    const double separation = parting_speed(pressure, r, bodies_.physics.rest_time);
    double impulse = 0;  // along the unit normal
    const PairVelocities<double> after = collide(va, vb, r, mass_i, mass_j, restitution, separation, &impulse,
                                                 [this](const Vec2& v) { return bodies_.held_velocity(v); });
    pair.velocity = Doubles{after.a.x(), after.a.y(), after.b.x(), after.b.y()};
    anchor_pair(i, j, pair, t);
    remember(i, t, records_[j].id());
    remember(j, t, records_[i].id());
    const double distance = std::sqrt(length_squared(r));
    ++collisions_of_all;
    if (is_owned(i)) {
        const double approach = -dot<double>(va - vb, r) / distance;
        note(t, i, records_[j].id(), records_[j].anchor.stamp,
             {r / distance, impulse, approach, impulse * distance});
    }
    if (bodies_.physics.contact_time > 0) last_collision_[i] = last_collision_[j] = t;
    settle_pair(i, j, pair, t);
    // Both look before one chooses: neither waits for the other's arithmetic.
    Candidates around_i, around_j;
    const bool has_looked_i = look_beside(i, {0, 0}, around_i);
    const bool has_looked_j = look_beside(j, {0, 0}, around_j);
    expect(i, search_among(i, around_i, has_looked_i));
    expect(j, search_among(j, around_j, has_looked_j));
}

/// Notes that one of the domain's own balls and a copy will collide, for the copy's owner to have that as
/// well. By id i < j. What comes of it follows from the balls' ways to it.
template <Acceleration A>
void EventLoopOf<A>::keep_meeting(std::uint32_t i, std::uint32_t j, Image image, const Time& t) {
    Hash hash;
    hash << t << std::uint64_t{records_[i].id()} << std::uint64_t{records_[j].id()};
    hash << static_cast<std::uint64_t>(image.x) << static_cast<std::uint64_t>(image.y);
    for (const std::uint32_t k : {i, j}) {
        const Anchor& a = records_[k].anchor;
        hash << a.x << a.y << a.vx << a.vy << a.time;
    }
    meetings.push_back({is_owned(i) ? j : i, hash.value});
}

template <Acceleration A>
void EventLoopOf<A>::collide_obstacle(std::uint32_t i, const NextEvent& event) {
    const Image wrapped = advance(i, event.time);
    const Image image = {event.image_x - wrapped.x, event.image_y - wrapped.y};
    Anchor& a = records_[i].anchor;
    const bool is_ball = event.partner < bodies_.count;
    Vec2 normal;  // from the obstacle to the ball, of any length
    if (is_ball) {
        const Vec2 centre = {a.x, a.y};
        const Vec2& fixed = bodies_.fixed[event.partner];
        if (event.partner < records_[i].id())
            normal = -(fixed - centre - offset_of(-image));
        else
            normal = centre - fixed - offset_of(image);
    } else if (event.partner < bodies_.first_side()) {
        const Wall& wall = bodies_.walls[event.partner - bodies_.count];
        const Vec2 centre = Vec2(a.x, a.y) - offset_of(image);
        normal = contact_normal<double>(centre, static_cast<WallFeature>(event.stamp), wall.from, wall.to);
    } else {
        const Side side(event.partner - bodies_.first_side());
        normal = Vec2::Zero();
        normal[side.axis] = side.upper ? -1 : 1;
    }
    const double restitution = bodies_.restitution_between(records_[i].id(), event.partner);
    const bool lasts = restitution_at(0, i, i, event.time) == 1;  // then nothing is lost, by no rule
    const double lasting = lasts ? 1 : restitution;
    const Vec2 before = {a.vx, a.vy};
    const double length = std::sqrt(length_squared(normal));
    // NOLINTNEXTLINE(misc-const-correctness): not where there is an acceleration
    double pressure = 0;
    if constexpr (A != Acceleration::kNone) {
        const bool is_round = is_ball || (event.partner < bodies_.first_side() &&
                                          static_cast<WallFeature>(event.stamp) != WallFeature::kFace);
        pressure = -(dot(normal, acceleration_of(i)) + (is_round ? length_squared(before) : 0.0));
    }
    const double separation = parting_speed(pressure, normal, bodies_.physics.rest_time);
    const double factor = lasts ? 1 : bodies_.physics.speed_factor;
    const Vec2 after = bounce<double>(before, normal, lasting, separation / factor,
                                      [&](const Vec2& v) { return bodies_.held_velocity(v * factor); });
    a.vx = after.x();
    a.vy = after.y();
    remember(i, event.time, event.partner);
    const double impulse = bodies_.mass.of(records_[i].id()) * dot<double>(after - before, normal) / length;
    ++collisions_of_all;
    if (is_owned(i)) {
        const double approach = -dot(before, normal) / length;
        note(event.time, i, event.partner, 0,
             {normal / length, impulse, approach, is_ball ? impulse * length : 0.0});
    }
    if (bodies_.physics.contact_time > 0) last_collision_[i] = event.time;
    settle(i);
    predict_crossing(i);
    expect(i, search(i));
}

/// Adds an event to a ball's history: two balls with equal histories since one state have done the same. The
/// velocity after it belongs there: balls that touch meet at a time that does not tell how fast they were.
template <Acceleration A>
void EventLoopOf<A>::remember(std::uint32_t i, const Time& t, std::uint32_t partner) {
    if (!keeps_window) return;
    std::uint64_t h = locals_[i].history;
    const auto fold = [&h](std::uint64_t bits, std::uint64_t more) {
        h ^= bits;
        h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL + more;
    };
    fold(std::bit_cast<std::uint64_t>(t.offset), partner);
    fold(std::bit_cast<std::uint64_t>(records_[i].anchor.vx), static_cast<std::uint64_t>(t.epoch));
    fold(std::bit_cast<std::uint64_t>(records_[i].anchor.vy), 0);
    locals_[i].history = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
}

template <Acceleration A>
void EventLoopOf<A>::note(const Time& t, std::uint32_t i, std::uint32_t partner, std::uint32_t partner_stamp,
                          const Hit& hit) {
    CollisionNote& n = part_.notes[part_.count];
    n.time = t;
    n.lower = records_[i].id();
    n.higher = partner;
    n.lower_stamp = records_[i].anchor.stamp;
    n.higher_stamp = partner_stamp;
    n.is_wall = partner >= bodies_.count;
    n.virial = hit.virial;
    if (listens) {
        collisions.push_back(collision_of(bodies_, clock_.to_seconds(t), records_[i].id(), partner,
                                          {records_[i].anchor.x, records_[i].anchor.y}, hit));
    }
    if (++part_.count == NotePart::kMost) pass_on_notes();
}

}  // namespace carom
