// Fills and reads an event loop, and chooses the kernel.
#include "event_loop.hpp"

#include <algorithm>
#include <limits>

#include "event_loop_candidates.hpp"
#include "event_loop_events.hpp"
#include "event_loop_of.hpp"
#include "event_loop_search.hpp"

namespace carom {

namespace {

/// One a mark: the domain's own cells are touched, and those beside them.
std::vector<std::uint8_t> marks_touched_at_start(const Region& region) {
    std::vector<std::uint8_t> touched(static_cast<std::size_t>(region.mark_count()));
    const auto own_marks = [](const RegionAxis& axis) {
        std::vector<std::int32_t> marks;
        for (std::int32_t m = 0; m < axis.mark_count(); ++m)
            if (axis.depth(axis.marked(m)) <= 1) marks.push_back(m);
        return marks;
    };
    const std::vector<std::int32_t> columns = own_marks(region.x);
    const auto width = static_cast<std::size_t>(region.x.mark_count());
    for (const std::int32_t y : own_marks(region.y))
        for (const std::int32_t x : columns)
            touched[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = 1;
    return touched;
}

}  // namespace

EventLoop::EventLoop(const Bodies& bodies) : bodies_(bodies), clock_(bodies.physics.clock) {
    const auto of_axes = [&grid = bodies.grid](auto&& of) { return twice(of(grid.x), of(grid.y)); };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    axes_.low = of_axes([](const GridAxis& axis) { return axis.periodic() ? axis.min() : -kInfinity; });
    axes_.high = of_axes(
        [](const GridAxis& axis) { return axis.periodic() ? axis.min() + axis.length() : kInfinity; });
    axes_.min = of_axes([](const GridAxis& axis) { return axis.min(); });
    axes_.inverse_width = of_axes([](const GridAxis& axis) { return axis.inverse_width(); });
    axes_.count = of_axes([](const GridAxis& axis) { return double(axis.count()); });
    axes_.width = of_axes([](const GridAxis& axis) { return axis.width(); });
}

void EventLoop::clear(const Region& region, const Time& now) {
    region_ = region;
    cells_.reset(static_cast<std::size_t>(region.size()));
    sights_.clear(bodies_, region);
    is_inside_.assign(static_cast<std::size_t>(region.size()), 0);
    const std::ptrdiff_t row = region.x.size();
    for (std::ptrdiff_t y = 1; y < region.y.size() - 1; ++y)
        std::fill_n(is_inside_.begin() + y * row + 1, std::max<std::ptrdiff_t>(row - 2, 0), std::uint8_t{1});
    epoch_ = now.epoch;
    now_ = now.offset;
    empty(records_, locals_, radius_, acceleration_, last_collision_, large_, free_, touched_at_start_);
    forget_window();
}

void EventLoop::forget_window() {
    simultaneous_ = failed_ = full_ = false;
    turns_ = events_at_once_ = instants_ = 0;
    events = collisions_of_all = 0;
    part_.count = 0;
    empty(notes, collisions, overwritten, visits, meetings);
    if (!keeps_window) return;
    if (touched_at_start_.empty()) touched_at_start_ = marks_touched_at_start(region_);
    touched = touched_at_start_;
}

void EventLoop::add(const BallRecord& record, const BallExtra* extra, bool is_owned, const Time& end) {
    const auto i = size();
    records_.push_back(record);
    locals_.emplace_back();
    sights_.add(bodies_.radius.of(record.id()));
    if (!bodies_.radius.is_one()) radius_.emplace_back();
    if (bodies_.accelerates_each()) acceleration_.emplace_back();
    if (bodies_.physics.contact_time > 0) last_collision_.emplace_back();
    seat(i, extra, is_owned, end);
}

/// Makes place i the home of the ball whose record is there, which nothing names yet.
void EventLoop::seat(std::uint32_t i, const BallExtra* extra, bool is_owned, const Time& end) {
    BallRecord& r = records_[i];
    r.next.local = kNowhere;
    Local& local = locals_[i];
    local = {};
    local.owned = is_owned ? 1 : 0;
    local.frame = region_.frame_of(r.anchor.cell);
    local.end = clock_.since_epoch(end, epoch_);
    if (!radius_.empty()) radius_[i] = bodies_.radius.of(r.id());
    if (!acceleration_.empty()) acceleration_[i] = extra->acceleration;
    if (!last_collision_.empty()) last_collision_[i] = extra->last_collision;
    r.place = place_of(i, r.anchor.cell);
    if (!bodies_.large.empty() && std::ranges::binary_search(bodies_.large, r.id()))
        large_.push_back(i);
    else
        cells_.insert(r.place, i);
}

void EventLoop::forget_anchors() {
    overwritten.clear();
    for (Local& local : locals_) local.last_overwritten = kNowhere;
}

/// Enters all balls into the queue.
void EventLoop::begin() {
    queue_.reset(size());
    for (std::uint32_t i = 0; i < size(); ++i) queue_.put(i, key_of(i));
    queue_.rebuild();
    simultaneous_ = false;  // who shares the present instant is asked anew
}

void EventLoop::enter_tie(std::uint32_t i) {
    ties_.push_back(tie_of(i));
    std::ranges::push_heap(ties_, std::greater());
}

BallExtra EventLoop::extra(std::uint32_t i) const {
    BallExtra e;
    if (!last_collision_.empty()) e.last_collision = last_collision_[i];
    if (!acceleration_.empty()) e.acceleration = acceleration_[i];
    return e;
}

BallState EventLoop::state(std::uint32_t i, const Time& t) const {
    return state_at(bodies_, records_[i].anchor, records_[i].periods,
                    acceleration_.empty() ? Vec2(Vec2::Zero()) : acceleration_[i], t);
}

/// A ball of the domain's own has come here: it may meet what is in the cells around, so those must be known.
void EventLoop::touch(const CellCoordinates& cell) {
    region_.for_each_mark_beside(cell, [this](std::int32_t mark) {
        if (mark < 0)
            failed_ = true;
        else
            touched[static_cast<std::size_t>(mark)] = 1;
    });
}

template <Acceleration A>
void EventLoopOf<A>::start() {
    sight_all();
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (records_[i].next.time != kUnknown) continue;
        records_[i].next = search(i);
        predict_crossing(i);
    }
    begin();
}

template <Acceleration A>
std::uint32_t EventLoopOf<A>::enter(const BallRecord& record, const BallExtra& extra, bool is_owned,
                                    const Time& end) {
    std::uint32_t i = size();
    if (free_.empty()) {
        add(record, &extra, is_owned, end);
        queue_.append();
    } else {
        i = free_.back();
        free_.pop_back();
        sights_.replace(i, bodies_.radius.of(record.id()));
        records_[i] = record;
        seat(i, &extra, is_owned, end);
    }
    if (filters_) sight(i);
    schedule(i);
    return i;
}

template <Acceleration A>
void EventLoopOf<A>::remove(std::uint32_t i) {
    locals_[i].end = -std::numeric_limits<double>::infinity();
    reschedule(i);
    cells_.remove(records_[i].place, i);
    records_[i].anchor.id = kNowhere;
    free_.push_back(i);
}

template <Acceleration A>
void EventLoopOf<A>::look_again(std::span<const std::uint32_t> balls) {
    if (filters_ && sights_.are_worn(now_)) sight_all();
    for (const std::uint32_t i : balls) expect(i, search(i));
}

template <Acceleration A>
void EventLoopOf<A>::hand_over(std::uint32_t i, const Time& end) {
    locals_[i].owned = 0;
    locals_[i].end = clock_.since_epoch(end, epoch_);
    reschedule(i);
}

template <Acceleration A>
void EventLoopOf<A>::renew(std::uint32_t i, const BallRecord& record, const BallExtra& extra, bool is_owned,
                           const Time& end) {
    BallRecord& r = records_[i];
    const auto flight = [](const Anchor& a) {
        return std::tuple(a.time, a.stamp, a.x, a.y, a.vx, a.vy, a.cell);
    };
    const auto event = [](const NextEvent& e) {
        return std::tuple(e.time, e.partner, e.stamp, e.image_x, e.image_y);
    };
    if (flight(r.anchor) != flight(record.anchor)) {  // the copy went another way
        cells_.remove(r.place, i);
        r = record;
        seat(i, &extra, is_owned, end);
        if (filters_) sight(i);
        schedule(i);
        return;
    }
    locals_[i].owned = is_owned ? 1 : 0;
    locals_[i].end = clock_.since_epoch(end, epoch_);
    if (!last_collision_.empty()) last_collision_[i] = extra.last_collision;
    r.crossing_time = record.crossing_time;
    r.crossing_dx = record.crossing_dx;
    r.crossing_dy = record.crossing_dy;
    if (event(r.next) != event(record.next)) {
        r.next = record.next;
        r.next.local = kNowhere;
    }
    reschedule(i);
}

template <Acceleration A>
void EventLoopOf<A>::renew_field(const Time& t) {
    now_ = std::max(now_, clock_.since_epoch(t, epoch_));
    if constexpr (A == Acceleration::kPerBall) {
        for (std::uint32_t i = 0; i < size(); ++i) {
            advance(i, t);
            settle(i);
            events += locals_[i].owned;
            acceleration_[i] =
                bodies_.acceleration_at(records_[i].id(), {records_[i].anchor.x, records_[i].anchor.y});
        }
    }
}

template <Acceleration A>
void EventLoopOf<A>::start_anew(const Time& t, std::span<const NewStart> starts) {
    for (const NewStart& start : starts) {
        const std::uint32_t i = start.ball;
        BallRecord& r = records_[i];
        keep_anchor(i);
        carom::start_anew(bodies_, r.anchor, r.periods, acceleration_of(i), t, start);
        locals_[i].frame = region_.frame_of(r.anchor.cell);
        if constexpr (A == Acceleration::kPerBall)
            acceleration_[i] = bodies_.acceleration_at(r.id(), {r.anchor.x, r.anchor.y});
        settle(i);
        predict_crossing(i);
    }
    // All have their new ways before any looks around.
    for (const NewStart& start : starts) expect(start.ball, search(start.ball));
}

template <Acceleration A>
void EventLoopOf<A>::audit(std::vector<Violation>& found) const {
    std::vector<std::uint32_t> place_of_id(bodies_.count, kNowhere);
    for (std::uint32_t i = 0; i < size(); ++i) place_of_id[records_[i].id()] = i;
    for (std::uint32_t i = 0; i < size(); ++i) {
        const auto report_fault = [this, &found, i](const std::string& what) {
            found.push_back({bodies_.ball_name(records_[i].id()) + ": " + what});
        };
        const Anchor& a = records_[i].anchor;
        if (!std::isfinite(a.x + a.y + a.vx + a.vy)) report_fault("state is not finite");
        if (queue_.key(i) != key_of(i)) report_fault("the queue holds another time than its next event's");
        if (queue_.key(i) < now_) report_fault("next event lies in the past");
        bool listed = false;
        cells_.for_each(place_of(i, a.cell), [&](std::uint32_t j) { listed = listed || j == i; });
        if (listed == is_large(i) || records_[i].place != place_of(i, a.cell))
            report_fault("is not listed in its cell");
        const NextEvent& next = records_[i].next;
        const std::uint32_t j = next.partner < bodies_.count ? place_of_id[next.partner] : kNowhere;
        if (j != kNowhere && records_[j].anchor.stamp == next.stamp &&
            predict_pair(i, j, {next.image_x, next.image_y}, kNever) != next.time)
            report_fault("has an event at another time than its partner's way and its own give");
        const NextEvent best = search(i);
        const bool partner_knows = best.local != kNowhere && records_[best.local].next.time <= best.time;
        if (best.time < records_[i].next.time && !partner_knows)
            report_fault("has an event before the one in the queue");
    }
}

std::unique_ptr<EventLoop> make_event_loop(const Bodies& bodies) {
    switch (bodies.acceleration()) {
        case Acceleration::kPerBall:
            return std::make_unique<EventLoopOf<Acceleration::kPerBall>>(bodies);
        case Acceleration::kUniform:
            return std::make_unique<EventLoopOf<Acceleration::kUniform>>(bodies);
        case Acceleration::kNone:
            break;
    }
    return std::make_unique<EventLoopOf<Acceleration::kNone>>(bodies);
}

Collision collision_of(const Bodies& bodies, double seconds, std::uint32_t id, std::uint32_t partner,
                       const Vec2& centre, const Hit& hit) {
    const Vec2 point = centre - bodies.radius.of(id) * hit.normal;
    const bool is_wall = partner >= bodies.count;
    std::int32_t ignored = 0;
    return {seconds,
            is_wall ? CollisionKind::kWall : CollisionKind::kBall,
            bodies.ball_id(id),
            is_wall ? bodies.wall_id(partner - bodies.count) : bodies.ball_id(partner),
            {bodies.grid.x.wrapped(point.x(), ignored), bodies.grid.y.wrapped(point.y(), ignored)},
            hit.normal,
            hit.impulse,
            hit.approach_speed};
}

void start_anew(const Bodies& bodies, Anchor& anchor, Periods& periods, const Vec2& acceleration,
                const Time& t, const NewStart& start) {
    const Motion<double> way = motion_since(bodies, anchor, acceleration);
    const double since = bodies.physics.clock.difference(t, anchor.time);
    Vec2 place = bodies.held_position(position_at(way, since), periods);
    if (start.position) place = bodies.held_position(*start.position, periods);
    const Vec2 velocity = bodies.held_velocity(start.velocity ? *start.velocity : velocity_at(way, since));
    anchor = {place.x(), place.y(),    velocity.x(), velocity.y(),
              t,         anchor.stamp, anchor.id,    bodies.grid.coordinates(place)};
}

Motion<double> motion_since(const Bodies& bodies, const Anchor& anchor, const Vec2& acceleration) {
    return {{anchor.x, anchor.y},
            {anchor.vx, anchor.vy},
            bodies.accelerates_each() ? acceleration : bodies.physics.gravity};
}

BallState state_at(const Bodies& bodies, const Anchor& anchor, const Periods& periods,
                   const Vec2& acceleration, const Time& t) {
    const double since = bodies.physics.clock.difference(t, anchor.time);
    const Motion<double> m = motion_since(bodies, anchor, acceleration);
    const Vec2 x = position_at(m, since);
    Periods ignored;
    return {bodies.held_position(x, ignored),
            bodies.held_velocity(velocity_at(m, since)),
            {x.x() + double(periods.x) * bodies.grid.x.length(),
             x.y() + double(periods.y) * bodies.grid.y.length()}};
}

}  // namespace carom
