#include "sensor_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace carom {
namespace {

/// The box around a sensor.
Box box_of(const Sensor& sensor) {
    Box box{sensor.corners.front(), sensor.corners.front()};
    for (const Vec2& corner : sensor.corners) {
        box.min = box.min.cwiseMin(corner);
        box.max = box.max.cwiseMax(corner);
    }
    const Vec2 reach(sensor.radius, sensor.radius);
    return {box.min - reach, box.max + reach};
}

/// The box around a ball's way from one time since the anchor to another, with what rounding may add.
Box box_of_way(const Motion<double>& m, double radius, double from, double to) {
    const Vec2 a = position_at(m, from);
    const Vec2 b = position_at(m, to);
    // A parabola is nowhere farther from its chord than in the middle.
    const double lapse = to - from;
    const Vec2 bulge = m.acceleration.cwiseAbs() * (lapse * lapse / 8);
    const double rounding = 1e-9 * (radius + a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
    const Vec2 margin = bulge + Vec2(radius + rounding, radius + rounding);
    return {a.cwiseMin(b) - margin, a.cwiseMax(b) + margin};
}

/// Whether the ball is in the sensor at a time, or just before it where that instant is not over.
bool holds(const std::vector<Stretch>& stretches, const Clock& clock, const Time& start, const Stop& at) {
    return std::ranges::any_of(stretches, [&](const Stretch& s) {
        const Time from = clock.after(start, s.from);
        const Time to = clock.after(start, s.to);
        return at.is_whole ? (s.from == 0 || from <= at.time) && to > at.time
                           : (s.from == 0 || from < at.time) && to >= at.time;
    });
}

}  // namespace

SensorWatch::SensorWatch(const Bodies& bodies, const std::vector<Sensor>& sensors, const Engine& engine,
                         const Time& now)
    : bodies_(&bodies), sensors_(sensors), inside_(bodies.count), seen_{now} {
    std::vector<Box> boxes;
    boxes.reserve(sensors.size());
    for (const Sensor& sensor : sensors) boxes.push_back(box_of(sensor));
    tree_ = BoxTree(boxes);
    const double far = std::numeric_limits<double>::infinity();
    all_ = {{far, far}, {-far, -far}};
    for (const Box& box : boxes) all_ = {all_.min.cwiseMin(box.min), all_.max.cwiseMax(box.max)};
    std::vector<Change> ignored;
    look(engine, {now}, ignored);
}

/// Adds what is near the way of a ball that is seen from an image of the sensors, `offset` away.
void SensorWatch::look_near(std::uint32_t ball, const Flight& flight, const Vec2& offset, const Box& way,
                            std::vector<Visit>& found) const {
    const double lapse =
        bodies_->physics.clock.difference(flight.end, flight.anchor.time) + bodies_->time_margin;
    const Motion<double> seen{flight.motion.position - offset, flight.motion.velocity,
                              flight.motion.acceleration};
    const CollisionFilter filter = bodies_->filters.empty() ? CollisionFilter{} : bodies_->filters[ball];
    tree_.for_each_near({way.min - offset, way.max - offset}, [&](std::uint32_t k) {
        if (!may_collide(filter, sensors_[k].filter)) return true;
        std::vector<Stretch> s = stretches_inside(seen, bodies_->radius.of(ball), sensors_[k], lapse);
        if (s.empty()) return true;
        const auto same = std::ranges::find(found, k, &Visit::sensor);
        if (same == found.end())
            found.push_back({k, std::move(s)});
        else
            same->stretches = united(std::move(same->stretches), s);
        return true;
    });
}

/// The sensors that a ball comes to between what was seen last and the flight's end, or is in.
std::vector<SensorWatch::Visit> SensorWatch::visits(std::uint32_t ball, const Flight& flight) const {
    const Clock& clock = bodies_->physics.clock;
    const Box way = box_of_way(flight.motion, bodies_->radius.of(ball),
                               clock.difference(std::max(seen_.time, flight.anchor.time), flight.anchor.time),
                               clock.difference(flight.end, flight.anchor.time));
    std::array<double, 2> first = {0, 0};
    std::array<double, 2> last = {0, 0};
    for (int axis = 0; axis < 2; ++axis) {
        if (bodies_->physics.domain.boundary[std::size_t(axis)] != Boundary::kPeriodic) {
            if (way.min[axis] > all_.max[axis] || way.max[axis] < all_.min[axis]) return {};
            continue;
        }
        const double period = (axis == 0 ? bodies_->grid.x : bodies_->grid.y).length();
        first[std::size_t(axis)] = std::ceil((way.min[axis] - all_.max[axis]) / period);
        last[std::size_t(axis)] = std::floor((way.max[axis] - all_.min[axis]) / period);
    }
    std::vector<Visit> found;
    for (double y = first[1]; y <= last[1]; ++y)
        for (double x = first[0]; x <= last[0]; ++x)
            look_near(ball, flight, {x * bodies_->grid.x.length(), y * bodies_->grid.y.length()}, way, found);
    return found;
}

/// Notes that a ball comes into a sensor or leaves it, `since` its anchor.
void SensorWatch::set(std::uint32_t ball, std::uint32_t sensor, bool enters, const Flight& flight,
                      double since, std::vector<Change>& changes) {
    std::vector<std::uint32_t>& in = inside_[ball];
    const auto at = std::ranges::lower_bound(in, sensor);
    if (!enters)
        in.erase(at);
    else
        in.insert(at, sensor);
    const Clock& clock = bodies_->physics.clock;
    const Time time = clock.after(flight.anchor.time, since);
    Periods ignored;
    changes.push_back({time,
                       static_cast<std::uint32_t>(changes.size()),
                       {clock.to_seconds(time), sensor, bodies_->ball_id(ball), enters,
                        bodies_->held_position(position_at(flight.motion, since), ignored),
                        bodies_->held_velocity(velocity_at(flight.motion, since))}});
}

/// What a ball is in at a time follows from the flight's anchor alone, so that it does not matter when it was
/// looked at last.
void SensorWatch::follow(std::uint32_t ball, const Flight& flight, const Stop& to,
                         std::vector<Change>& changes) {
    const Clock& clock = bodies_->physics.clock;
    const Time& start = flight.anchor.time;
    const Stop from = start < seen_.time ? seen_ : Stop{start};
    const std::vector<Visit> found = visits(ball, flight);
    const std::vector<std::uint32_t> before = inside_[ball];
    const double elapsed = clock.difference(from.time, start);
    for (const std::uint32_t k : before) {
        const auto at = std::ranges::find(found, k, &Visit::sensor);
        if (at == found.end() || !holds(at->stretches, clock, start, from))
            set(ball, k, false, flight, elapsed, changes);
    }
    // A flight that ends with an event is seen to its end.
    const bool to_the_end = flight.end < to.time || to.is_whole;
    for (const Visit& visit : found) {
        if (!std::ranges::binary_search(before, visit.sensor) && holds(visit.stretches, clock, start, from))
            set(ball, visit.sensor, true, flight, elapsed, changes);
        const auto passes = [&](double t) {
            const Time time = clock.after(start, t);
            return (from.is_whole ? time > from.time : time >= from.time) &&
                   (to_the_end ? time <= flight.end : time < flight.end);
        };
        for (const Stretch& s : visit.stretches) {
            if (s.from > 0 && passes(s.from)) set(ball, visit.sensor, true, flight, s.from, changes);
            if (passes(s.to)) set(ball, visit.sensor, false, flight, s.to, changes);
        }
    }
}

void SensorWatch::look(const Engine& engine, const Stop& to, std::vector<Change>& changes) {
    engine.visit_flights(seen_, to.time, [&](std::uint32_t ball, std::span<const Flight> flights) {
        std::vector<Change> of_ball;
        for (const Flight& flight : flights) follow(ball, flight, to, of_ball);
        if (of_ball.empty()) return;
        const std::lock_guard lock(mutex_);
        changes.insert(changes.end(), of_ball.begin(), of_ball.end());
    });
    seen_ = to;
}

void SensorWatch::take(const Engine& engine, const Stop& to,
                       const std::function<void(const Sensing&)>& tell) {
    std::vector<Change> changes;
    look(engine, to, changes);
    std::ranges::sort(changes, [](const Change& a, const Change& b) {
        if (!(a.time == b.time)) return a.time < b.time;
        return std::tuple(a.sensing.ball, a.rank) < std::tuple(b.sensing.ball, b.rank);
    });
    for (const Change& change : changes) tell(change.sensing);
}

void SensorWatch::go_on_with(const Bodies& bodies, const Engine& engine, const Time& now,
                             const std::vector<BallState>& before,
                             const std::function<void(const Sensing&)>& tell) {
    const Bodies& past = *bodies_;
    std::vector<std::vector<std::uint32_t>> then(bodies.count);
    std::vector<Sensing> left;
    std::uint32_t k = 0;
    for (std::uint32_t i = 0; i < past.count; ++i) {
        const std::uint32_t id = past.ball_id(i);
        while (k < bodies.count && bodies.ball_id(k) < id) ++k;
        if (k < bodies.count && bodies.ball_id(k) == id) {
            then[k] = std::move(inside_[i]);
            continue;
        }
        for (const std::uint32_t sensor : inside_[i])
            left.push_back({past.physics.clock.to_seconds(seen_.time), sensor, id, false, before[i].position,
                            before[i].velocity});
    }
    bodies_ = &bodies;
    inside_ = std::move(then);
    seen_ = {now};
    for (const Sensing& sensing : left) tell(sensing);
    take(engine, {now}, tell);
}

}  // namespace carom
