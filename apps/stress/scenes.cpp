// The order of the draws matters: walls and large bodies first, the many balls into what they leave, and then
// what only changes numbers. Lengths are in units of the usual ball's diameter until the last step.
#include "scenes.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <set>

#include <carom/broadphase/overlap.hpp>
#include <carom/broadphase/placement.hpp>

#include "draw.hpp"

// Every scene that is drawn has a domain from the first on.
// NOLINTBEGIN(bugprone-unchecked-optional-access)

namespace carom::stress {
namespace {

Vec2 extent(const Scene& s) {
    return s.domain->box.max - s.domain->box.min;
}

bool is(const Scene& s, int axis, Boundary boundary) {
    return s.domain->boundary[std::size_t(axis)] == boundary;
}

void draw_domain(Draw& draw, Scene& s, std::size_t count) {
    constexpr Boundary kBoundaries[] = {Boundary::kPeriodic, Boundary::kWall, Boundary::kOpen};
    const double packing = draw.one_in(3) ? draw.decades(-2.5, -1) : draw.uniform(0.05, 0.7);
    const double area = double(count) * std::numbers::pi / 4 / packing;
    const double aspect = draw.one_in(2) ? 1 : draw.decades(-0.7, 0.7);
    // Wide enough for a large ball and a wall, whatever the shape.
    const Vec2 side = {std::max(4.0, std::sqrt(area * aspect)), std::max(4.0, std::sqrt(area / aspect))};
    s.domain = Domain{{{0, 0}, side}, {kBoundaries[draw.below(3)], kBoundaries[draw.below(3)]}, 1};
}

/// Walls of any slant; or a chain or a star of them, that meet at their ends.
void draw_walls(Draw& draw, Scene& s) {
    const Vec2 side = extent(s);
    const std::size_t kind = draw.below(3);
    const std::size_t count = 1 + draw.below(6);
    const Vec2 centre = draw.in_box(0.2 * side, 0.8 * side);
    Vec2 last = centre;
    for (std::size_t k = 0; k < count; ++k) {
        const Vec2 from = kind == 0 ? draw.in_box(Vec2::Zero(), side) : last;
        const Vec2 step = draw.direction(std::min(side.x(), side.y()) * draw.uniform(0.05, 0.6));
        const Vec2 to = (from + step).cwiseMax(Vec2::Zero()).cwiseMin(side);
        if (length_squared<double>(to - from) < 1e-4) continue;
        s.walls.push_back({from, to, 1});
        last = kind == 1 ? to : centre;
    }
}

void add_bodies(Draw& draw, Scene& s, std::size_t count, double largest, bool is_static) {
    const Vec2 side = extent(s);
    for (std::size_t k = 0; k < count; ++k) {
        Ball b;
        b.radius = draw.uniform(0.1, largest);
        b.position = draw.in_box(Vec2::Zero(), side);
        for (int axis = 0; axis < 2; ++axis)
            if (is(s, axis, Boundary::kWall))
                b.position[axis] = draw.uniform(b.radius, side[axis] - b.radius);
        b.is_static = is_static;
        s.balls.push_back(b);
    }
}

/// Takes out what overlaps something before it.
void drop_overlapping(Scene& s) {
    std::set<std::size_t> dropped;
    for (const Overlap& o : find_overlaps(s.balls, s)) dropped.insert(std::max(o.i, o.j));
    for (const Overlap& o : find_wall_overlaps(s.balls, s)) dropped.insert(o.i);
    std::vector<Ball> kept;
    for (std::size_t i = 0; i < s.balls.size(); ++i)
        if (!dropped.contains(i)) kept.push_back(s.balls[i]);
    s.balls = std::move(kept);
}

/// Balls wherever there is room, in all of the box or in one of its corners.
void add_gas(Draw& draw, Scene& s, std::size_t count) {
    Fill fill;
    fill.count = count;
    fill.seed = draw.bits() >> 40;
    if (draw.one_in(2)) {
        fill.radius_max = 0.5;
        fill.radius_min = 0.5 * draw.decades(-1.5, 0);
    }
    const Vec2 side = extent(s);
    if (draw.one_in(4)) {
        const double share = draw.uniform(0.3, 0.8);
        const Vec2 corner = draw.one_in(2) ? Vec2(0, 0) : Vec2((1 - share) * side);
        fill.region = Box{corner, corner + share * side};
    }
    // Walls take room that nobody has counted: fewer balls until they fit.
    for (; *fill.count > 0; *fill.count = *fill.count * 3 / 4) {
        s.fills = {fill};
        try {
            s.balls = place_balls(s);
            break;
        } catch (const SceneError&) {
            if (*fill.count == 1) break;
        }
    }
    s.fills.clear();
}

/// Rows of balls that touch: a square or a triangular lattice from the lower left corner.
void add_lattice(Draw& draw, Scene& s, std::size_t count, double pitch) {
    const Vec2 side = extent(s);
    const bool is_square = draw.one_in(2);
    const double rise = is_square ? pitch : pitch * std::sqrt(0.75) * (1 + 1e-15);
    std::size_t placed = 0;
    for (std::size_t row = 0; placed < count; ++row) {
        const double y = 0.5 + double(row) * rise;
        if (y + 0.5 > side.y()) break;
        for (double x = is_square || row % 2 == 0 ? 0.5 : 0.5 + pitch / 2;
             x + 0.5 <= side.x() && placed < count; x += pitch, ++placed) {
            Ball b;
            b.position = {x, y};
            s.balls.push_back(b);
        }
    }
    drop_overlapping(s);
}

/// Balls at places where nobody has looked what is there.
void add_overlapping(Draw& draw, Scene& s, std::size_t count) {
    s.allows_overlap = true;
    add_bodies(draw, s, count, 0.6, false);
}

void draw_balls(Draw& draw, Scene& s, std::size_t count) {
    if (draw.one_in(2)) draw_walls(draw, s);
    const double least_side = std::min(extent(s).x(), extent(s).y());
    if (draw.one_in(3)) add_bodies(draw, s, 1 + draw.below(8), std::min(1.5, 0.2 * least_side), true);
    if (draw.one_in(4)) add_bodies(draw, s, 1 + draw.below(5), 0.24 * least_side, false);
    drop_overlapping(s);
    switch (draw.below(6)) {
        case 0:
            add_lattice(draw, s, count, draw.one_in(2) ? 1 : draw.uniform(1, 1.3));
            break;
        case 1:
            add_overlapping(draw, s, std::min<std::size_t>(count, 200));
            break;
        default:
            add_gas(draw, s, count);
    }
}

/// Three kinds, of which some meet only some; and balls wherever those that they pass through leave room.
void draw_filters(Draw& draw, Scene& s, std::size_t count) {
    if (!draw.one_in(5)) return;
    std::array<CollisionFilter, 3> kinds;
    for (CollisionFilter& kind : kinds) kind = draw.filter();
    const auto share = [&](auto& body) { body.filter = kinds[draw.below(kinds.size())]; };
    if (draw.one_in(2)) add_bodies(draw, s, 1 + count / 2, 0.6, false);
    std::ranges::for_each(s.balls, share);
    if (draw.one_in(2)) std::ranges::for_each(s.walls, share);
    if (!s.allows_overlap) drop_overlapping(s);
}

void draw_velocities(Draw& draw, Scene& s) {
    const double at_rest = draw.one_in(3) ? draw.uniform(0, 1) : 0;
    const Vec2 drift = draw.one_in(5) ? draw.direction(draw.decades(-1, 2)) : Vec2(Vec2::Zero());
    const bool along_axis = draw.one_in(8);
    for (Ball& b : s.balls) {
        if (b.is_static) continue;
        b.velocity = draw.direction(draw.uniform(0, 2));
        if (along_axis) b.velocity = {b.velocity.x() > 0 ? 1.0 : -1.0, 0};
        if (draw.uniform(0, 1) < at_rest) b.velocity.setZero();
        b.velocity += drift;
    }
    if (!draw.one_in(4)) return;
    const double faster = draw.decades(0.5, 3);
    const std::size_t every = 5 + draw.below(100);
    for (std::size_t i = draw.below(every); i < s.balls.size(); i += every) s.balls[i].velocity *= faster;
}

void draw_masses(Draw& draw, Scene& s) {
    const std::size_t kind = draw.below(4);
    const double heavy = draw.decades(1, 6);
    for (Ball& b : s.balls) {
        if (kind == 1) b.mass = 4 * b.radius * b.radius;
        if (kind == 2) b.mass = draw.decades(-3, 3);
        if (kind == 3 && draw.one_in(6)) b.mass = heavy;
    }
}

void draw_losses(Draw& draw, Scene& s) {
    constexpr RestitutionRule kRules[] = {RestitutionRule::kMin, RestitutionRule::kMax,
                                          RestitutionRule::kProduct, RestitutionRule::kMean,
                                          RestitutionRule::kGeometric};
    s.restitution_rule = kRules[draw.below(5)];
    const std::size_t kind = draw.below(5);  // 0, 1: elastic
    const double common = draw.one_in(6) ? 0 : draw.uniform(0, 1);
    const auto restitution = [&] {
        if (kind <= 1) return 1.0;
        return kind == 2 ? common : std::clamp(draw.uniform(-0.2, 1.2), 0.0, 1.0);
    };
    for (Ball& b : s.balls) b.restitution = restitution();
    for (Wall& w : s.walls) w.restitution = restitution();
    s.domain->restitution = restitution();
    if (draw.one_in(6)) s.speed_factor = draw.uniform(0.5, 1);
    if (draw.one_in(6)) s.contact_time = draw.decades(-6, -2);
}

void draw_forces(Draw& draw, Scene& s) {
    if (draw.one_in(3)) s.gravity = draw.one_in(2) ? Vec2(0, -draw.decades(-1, 1)) : draw.direction(1);
    if (draw.one_in(5))
        for (Ball& b : s.balls)
            if (!b.is_static && draw.one_in(2)) b.acceleration = draw.direction(draw.decades(-2, 0.5));
    if (!draw.one_in(7)) return;
    const std::size_t count = 1 + draw.below(3);
    for (std::size_t k = 0; k < count; ++k)
        s.attractors.push_back({draw.in_box(Vec2::Zero(), extent(s)), draw.uniform(-5, 20),
                                draw.one_in(4) ? 0.1 : draw.uniform(0.3, 2)});
    s.field_interval = draw.decades(-2, -0.5);
}

/// Steps of time, of travel, or both. The end comes early where balls are fast: the way of all steps is
/// bounded.
void draw_method(Draw& draw, Scene& s) {
    if (!draw.one_in(6)) return;
    s.method = Method::kEmpirical;
    const std::size_t kind = draw.below(3);
    if (kind != 0) s.step = draw.decades(-2.5, -0.5);
    if (kind != 1) s.max_travel = draw.decades(-2, -0.3);
    constexpr double kSteps = 500;
    double fastest = 1;
    double smallest = 1;
    for (const Ball& b : s.balls) {
        fastest = std::max(fastest, std::sqrt(length_squared<double>(b.velocity)));
        smallest = std::min(smallest, b.radius);
    }
    // A step looks along the whole way that a ball has gone in it.
    if (s.step) s.step = std::min(*s.step, 10 * smallest / fastest);
    if (draw.one_in(2)) s.tolerance = smallest * draw.decades(-10, -2);
    if (s.max_travel) s.until = std::min(s.until, kSteps * *s.max_travel * smallest / fastest);
    if (s.step) s.until = std::min(s.until, kSteps * *s.step);
}

/// Far from the origin, in other units, in float.
void draw_units(Draw& draw, Scene& s) {
    const bool in_float = draw.one_in(6);
    const Vec2 origin = draw.one_in(5) ? draw.direction(draw.decades(1, in_float ? 2 : 4)) : Vec2(0, 0);
    const bool rescales = draw.one_in(4);
    const double reach = in_float ? 5 : 25;
    const double length = rescales ? std::exp2(std::round(draw.uniform(-reach, reach))) : 1;
    const double time = rescales ? std::exp2(std::round(draw.uniform(-reach, reach))) : 1;
    const double mass = rescales ? draw.decades(-reach, reach) : 1;
    const auto place = [&](Vec2& x) { x = length * (x + origin); };
    place(s.domain->box.min);
    place(s.domain->box.max);
    for (Wall& w : s.walls) place(w.from), place(w.to);
    for (Attractor& a : s.attractors) {
        place(a.position);
        a.strength *= length * length * length / (time * time);
        a.softening *= length;
    }
    s.gravity *= length / (time * time);
    s.field_interval *= time;
    if (s.contact_time) *s.contact_time *= time;
    for (Ball& b : s.balls) {
        place(b.position);
        b.radius *= length;
        b.velocity *= length / time;
        b.acceleration *= length / (time * time);
        b.mass *= mass;
    }
    s.until *= time;
    if (s.step) *s.step *= time;
    if (s.tolerance) *s.tolerance *= length;
    if (in_float) s.precision = Precision::kFloat;
}

/// Rounding of places, to float or far from the origin, may have pushed balls that touched into each other or
/// out of the box.
void mend(Scene& s) {
    const bool in_float = s.precision == Precision::kFloat;
    std::erase_if(s.balls, [&](Ball& b) {
        if (in_float) {
            b.position = rounded_to_float(b.position);
            b.velocity = rounded_to_float(b.velocity);
        }
        for (int axis = 0; axis < 2; ++axis) {
            const double low = s.domain->box.min[axis];
            const double high = s.domain->box.max[axis];
            const double x = b.position[axis];
            if (is(s, axis, Boundary::kPeriodic) && !(x >= low && x < high)) return true;
            if (is(s, axis, Boundary::kWall) && !(x - b.radius >= low && x + b.radius <= high)) return true;
        }
        return false;
    });
    if (!s.allows_overlap) drop_overlapping(s);
    const auto is_moving = [](const Ball& b) { return !b.is_static; };
    if (std::ranges::any_of(s.balls, is_moving)) return;
    Ball lone;  // no scene without a ball
    lone.radius = 0.01 * std::min(extent(s).x(), extent(s).y());
    lone.position = s.domain->box.min + extent(s) / 3;
    lone.velocity = extent(s) / s.until;
    s.allows_overlap = true;
    s.balls.push_back(lone);
    if (in_float) s.balls.back().position = rounded_to_float(lone.position);
    if (in_float) s.balls.back().velocity = rounded_to_float(lone.velocity);
}

/// Points, gates and triangles of some ball's size and place, across a periodic side at times.
void draw_sensors(Draw& draw, Scene& s) {
    if (s.method != Method::kEvent || !draw.one_in(3)) return;
    const std::size_t count = 1 + draw.below(4);
    for (std::size_t k = 0; k < count; ++k) {
        const Ball& ball = s.balls[draw.below(s.balls.size())];
        const double size = ball.radius * draw.decades(-1, 2);
        Sensor sensor;
        const Vec2 out = draw.direction(size);
        const std::size_t corners = 1 + draw.below(3);
        sensor.corners.push_back(ball.position + out);
        if (corners > 1) sensor.corners.push_back(ball.position - out);
        if (corners > 2) sensor.corners.emplace_back(ball.position + Vec2(-out.y(), out.x()));
        if (draw.one_in(2)) sensor.radius = size * draw.uniform(0, 1);
        if (draw.one_in(4)) sensor.filter = draw.filter();
        s.sensors.push_back(sensor);
    }
}

}  // namespace

Scene draw_scene(std::uint64_t seed, std::size_t most_balls) {
    Draw draw(seed);
    Scene s;
    const auto count = static_cast<std::size_t>(draw.decades(0.3, std::log10(double(most_balls))));
    draw_domain(draw, s, std::max<std::size_t>(count, 1));
    draw_balls(draw, s, std::max<std::size_t>(count, 1));
    draw_filters(draw, s, count);
    draw_velocities(draw, s);
    draw_masses(draw, s);
    draw_losses(draw, s);
    draw_forces(draw, s);
    s.until = draw.decades(-0.5, 1.2);
    draw_method(draw, s);
    draw_units(draw, s);
    mend(s);
    draw_sensors(draw, s);
    return s;
}

}  // namespace carom::stress

// NOLINTEND(bugprone-unchecked-optional-access)
