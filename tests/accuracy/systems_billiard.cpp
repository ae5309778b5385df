// Among walls: a triangle, whose mirror images tile the plane, and polygons, against a billiard in 100 digits
// that knows nothing of discs.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/systems.hpp"
#include "core/many_digits.hpp"

namespace carom::accuracy {
namespace {

using test::Big;
using test::BigVector;

/// Where the centre may go: a convex polygon's lines, moved inwards by the radius. `normal` points inwards
/// and has length 1.
struct InsetLine {
    BigVector normal;
    Big offset;

    InsetLine(const Wall& wall, double radius) {
        const BigVector along = test::big(wall.to) - test::big(wall.from);
        const Big length = sqrt(Big(along.x() * along.x() + along.y() * along.y()));
        normal = {Big(-along.y() / length), Big(along.x() / length)};
        offset = normal.x() * wall.from.x() + normal.y() * wall.from.y() + radius;
    }
    [[nodiscard]] Big height(const BigVector& x) const {
        return normal.x() * x.x() + normal.y() * x.y() - offset;
    }
    [[nodiscard]] Big rate(const BigVector& v) const { return normal.x() * v.x() + normal.y() * v.y(); }
};

/// Walls from corner to corner, counter-clockwise.
std::vector<Wall> closed(const std::vector<Vec2>& corners) {
    std::vector<Wall> walls;
    walls.reserve(corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k)
        walls.push_back({corners[k], corners[(k + 1) % corners.size()], 1});
    return walls;
}

std::vector<Wall> regular(int corners, double radius) {
    std::vector<Vec2> places;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners;
        places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return closed(places);
}

std::vector<InsetLine> lines_of(const std::vector<Wall>& walls, double radius) {
    std::vector<InsetLine> lines;
    lines.reserve(walls.size());
    for (const Wall& w : walls) lines.emplace_back(w, radius);
    return lines;
}

/// The path folded at one line after another.
std::uint64_t run_exactly(const std::vector<InsetLine>& lines, BigVector& x, BigVector v, Big time) {
    for (std::uint64_t hits = 0;; ++hits) {
        const InsetLine* next = nullptr;
        Big soonest = time;
        for (const InsetLine& line : lines) {
            const Big rate = line.rate(v);
            if (!(rate < 0)) continue;
            const Big t = line.height(x) / -rate;
            if (t < soonest) {
                soonest = t;
                next = &line;
            }
        }
        x += BigVector(v * soonest);
        time -= soonest;
        if (next == nullptr) return hits;
        const Big turn = 2 * next->rate(v);
        v -= BigVector(next->normal * turn);
    }
}

/// A hit turns the direction with eight roundings of the speed, and finds the place with twelve of the
/// largest coordinate; flat walls make nothing of either but distance. `doubt` is how far, in radians, a
/// wall's direction is from what the reference takes it for, times two for a reflection.
double path_bound(std::uint64_t hits, double reach, double speed, double time, double doubt) {
    const double each = 12 * kRounding * reach + (8 * kRounding + 2 * doubt) * speed * time;
    return static_cast<double>(hits + 1) * each;
}

/// Compares at every `step` of the time.
template <class Exact>
Deviation compare(const Scene& scene, double reach, double end, int steps, double doubt, Exact&& exact) {
    World world(scene, {.threads = 1});
    const double speed = scene.balls[0].velocity.norm();
    Deviation d;
    for (int k = 1; k <= steps; ++k) {
        const double time = end * k / steps;
        world.advance_to(time);
        BigVector x = test::big(scene.balls[0].position);
        d.expected = exact(x, test::big(scene.balls[0].velocity), Big(time));
        const BigVector error = test::big(world.positions()[0]) - x;
        d.include(static_cast<double>(sqrt(Big(error.x() * error.x() + error.y() * error.y()))),
                  path_bound(d.expected, reach, speed, time, doubt));
        // A reflection keeps the speed to a few roundings.
        d.include(std::abs(world.velocities()[0].norm() - speed),
                  speed * kRounding * 8 * double(d.expected + 1));
    }
    d.collisions = world.counts().wall_collisions;
    return d;
}

Deviation in_polygon(int corners, double end) {
    Scene s;
    s.walls = regular(corners, 8);
    s.balls = {ball_at(1.25, 0.5, 0.8125, 1.375)};
    const std::vector<InsetLine> lines = lines_of(s.walls, 0.5);
    return compare(s, 8, end, 8, 0, [&](BigVector& x, const BigVector& v, const Big& time) {
        return run_exactly(lines, x, v, time);
    });
}

/// Unfolded at the sides, the path through an equilateral triangle is straight. It ends in the image of the
/// triangle into which reflections fold it back; it hits as often as it crosses a line of the tiling, of
/// which each side's family has one in every height.
Deviation in_triangle(double end) {
    const double high = 8 * std::numbers::sqrt3;
    Scene s;
    s.walls = closed({{-8, 0}, {8, 0}, {0, high}});
    s.balls = {ball_at(0.25, 4.5, 0.8125, 1.375)};
    std::vector<InsetLine> lines;
    const Big root = sqrt(Big(3));
    for (const auto& [nx, ny, c] :
         {std::array<Big, 3>{0, 1, 0}, std::array<Big, 3>{-root / 2, Big(-0.5), -4 * root},
          std::array<Big, 3>{root / 2, Big(-0.5), -4 * root}}) {
        InsetLine line(s.walls[0], 0.5);
        line.normal = {nx, ny};
        line.offset = c + Big(0.5);
        lines.push_back(line);
    }
    const Big height = 8 * root - Big(1.5);  // of the triangle in which the centre stays
    // The upper corner is rounded to half an ulp of 14, and the sides are 16 long.
    constexpr double kDoubt = 0x1p-50 / 16;
    return compare(s, 16, end, 8, kDoubt, [&](BigVector& x, const BigVector& v, const Big& time) {
        const BigVector start = x;
        x += BigVector(v * time);
        std::uint64_t crossed = 0;
        for (const InsetLine& line : lines) {
            const Big from = floor(Big(line.height(start) / height));
            crossed += static_cast<std::uint64_t>(abs(Big(floor(Big(line.height(x) / height)) - from)));
        }
        for (bool outside = true; outside;) {
            outside = false;
            for (const InsetLine& line : lines) {
                const Big depth = line.height(x);
                if (!(depth < 0)) continue;
                x -= BigVector(line.normal * Big(2 * depth));
                outside = true;
            }
        }
        return crossed;
    });
}

}  // namespace

std::vector<System> billiard_systems() {
    std::vector<System> all = {
        {"ball in an equilateral triangle", "place", [] { return in_triangle(1000); }}};
    for (const int corners : {5, 96, 1000})
        all.push_back({fmt::format("ball in a regular polygon of {} walls", corners), "place",
                       [=] { return in_polygon(corners, 1000); }});
    return all;
}

}  // namespace carom::accuracy
