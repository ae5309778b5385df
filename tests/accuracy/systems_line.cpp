// Equal elastic balls in a line exchange velocities, so that, each ball's diameter taken out, they are points
// that pass through each other: the k-th ball is where the k-th of the points is (order statistics of free
// flights; Jepsen 1965).
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <carom/parallel/world.hpp>

#include "accuracy/bouncing_point.hpp"
#include "accuracy/systems.hpp"
#include "core/random.hpp"

namespace carom::accuracy {
namespace {

constexpr int kLineBalls = 1000;

/// Two points pass each other; or, where i == j, one turns at a wall.
struct Crossing {
    long double time;
    int i, j;
    double rate;  ///< of approach
};

/// The points without size, in order at time 0, and what the surroundings make of them.
struct LineOfPoints {
    std::vector<double> place, speed;
    double gravity = 0;  ///< along the line, downwards
    double length = 0;   ///< of the room between walls or of the period, the diameters taken out
};

LineOfPoints random_line(std::uint64_t seed, double pitch) {
    test::Random random(seed);
    LineOfPoints line;
    double place = 0;
    for (int k = 0; k < kLineBalls; ++k) {
        line.place.push_back(place += dyadic(random.uniform(0.01, 2 * pitch)));
        line.speed.push_back(dyadic(random.uniform(-1, 1)));
    }
    line.length = place + 1;
    return line;
}

/// Upright, for gravity; the lowest ball touches y = 0 when its point is there.
Scene scene_of(const LineOfPoints& line) {
    Scene s;
    s.gravity = {0, -line.gravity};
    for (std::size_t k = 0; k < line.place.size(); ++k)
        s.balls.push_back(ball_at(0, line.place[k] + double(k) + 0.5, 0, line.speed[k]));
    return s;
}

/// `above`: room over the line's length.
Scene bounded(const LineOfPoints& line, Boundary boundary, double above = 0) {
    Scene s = scene_of(line);
    s.domain = Domain{{{-10, 0}, {10, line.length + kLineBalls + above}}, {Boundary::kOpen, boundary}, 1};
    return s;
}

/// The worst that one event can add: to a place, and to a speed.
struct EventError {
    double place, speed;
};

/// To predict, the earlier ball is moved (two roundings), the difference taken (one), the time found to two
/// units of what half an ulp in each input does to it (four), and the balls moved there (two): twelve
/// roundings of a place at most, and four of a time within an epoch, at the relative speed. An epoch is at
/// most 16 times what a ball at the mean square speed (1/3) needs for its diameter, or falls it in. The
/// exchange rounds the difference, the impulse (three times) and the sums; the motion under gravity two
/// products: eight roundings. Without gravity, dyadic speeds stay exact.
EventError event_error(double reach, double fastest, double gravity) {
    constexpr double kEpoch = 32;
    return {kRounding * (12 * reach + 4 * kEpoch * 2 * fastest), gravity > 0 ? 8 * kRounding * fastest : 0};
}

/// Balls k and k + 1 meet when the points that they carry pass: the times of each such pair of balls in
/// order. Balls -1 and the last stand for the walls.
using Meetings = std::map<int, std::vector<Crossing>>;

/// Carries the points along from crossing to crossing. `around`: the last ball meets the first.
Meetings meetings_of(std::vector<Crossing> crossings, bool around) {
    std::ranges::sort(crossings, {}, &Crossing::time);
    std::vector<int> ball(kLineBalls);
    std::iota(ball.begin(), ball.end(), 0);
    Meetings meetings;
    for (const Crossing& c : crossings) {
        int lower = std::min(ball[c.i], ball[c.j]);
        if (around && std::abs(ball[c.i] - ball[c.j]) == kLineBalls - 1) lower = kLineBalls - 1;
        if (c.i == c.j && lower == 0) lower = -1;
        meetings[lower].push_back(c);
        std::swap(ball[c.i], ball[c.j]);
    }
    return meetings;
}

/// Every meeting of every pair of balls in its place in their order, and the whole in the order of time.
void compare_meetings(Deviation& d, const Meetings& expected, const std::vector<Collision>& seen,
                      const std::vector<double>& bounds, double end) {
    std::map<int, std::size_t> next;
    double last = 0;
    for (const Collision& c : seen) {
        const bool is_wall = c.kind == CollisionKind::kWall;
        int lower = int(c.i);
        if (is_wall && c.i == 0) lower = -1;
        if (!is_wall && c.i == 0 && c.j == kLineBalls - 1) lower = kLineBalls - 1;
        const std::size_t k = next[lower]++;
        const auto found = expected.find(lower);
        if (c.time < last || found == expected.end() || k >= found->second.size() ||
            (!is_wall && lower < kLineBalls - 1 && c.j != c.i + 1)) {
            d.include(std::numeric_limits<double>::infinity(), 1);
            return;
        }
        last = c.time;
        const Crossing& e = found->second[k];
        d.include(static_cast<double>(std::abs(c.time - e.time)) * e.rate,
                  bounds[e.i] + bounds[e.j] + 2 * kRounding * end * e.rate);
    }
}

/// Runs the scene and compares all meetings, and the places at the end: `places` are those of the points by
/// ball, the diameters taken out, `period` their period or 0.
Deviation compare(const Scene& scene, double end, const std::vector<Crossing>& crossings, bool around,
                  const std::vector<long double>& places, const std::vector<double>& bounds, double period) {
    World world(scene, {.threads = 1});
    std::vector<Collision> seen;
    world.on_collision([&seen](const Collision& c) { seen.push_back(c); });
    world.advance_to(end);
    Deviation d;
    d.collisions = seen.size();
    d.expected = crossings.size();
    compare_meetings(d, meetings_of(crossings, around), seen, bounds, end);
    const PlaneVectors x = world.positions();
    const double worst = *std::ranges::max_element(bounds);
    for (int k = 0; k < kLineBalls; ++k) {
        long double error = x[k].y() - k - 0.5L - places[k];
        if (period > 0) error = std::remainder(error, static_cast<long double>(period));
        d.include(static_cast<double>(std::abs(error)), worst);
        if (x[k].x() != 0) d.include(std::numeric_limits<double>::infinity(), 1);
    }
    return d;
}

/// A bound for each point from the events that it takes part in.
std::vector<double> bounds_of(const std::vector<Crossing>& crossings, const EventError& each, double end) {
    std::vector<double> bounds(kLineBalls, each.place);
    for (const Crossing& c : crossings)
        for (const int k : {c.i, c.j}) bounds[k] += each.place + each.speed * end;
    return bounds;
}

/// Each pair of points passes once or never, and gravity takes no part in when.
Deviation open_line(double gravity, double end) {
    LineOfPoints line = random_line(61, 0.75);
    line.gravity = gravity;
    std::vector<Crossing> crossings;
    for (int i = 0; i < kLineBalls; ++i)
        for (int j = i + 1; j < kLineBalls; ++j) {
            const long double rate = line.speed[i] - line.speed[j];
            const long double gap = line.place[j] - line.place[i];
            if (rate * end > gap) crossings.push_back({gap / rate, i, j, double(rate)});
        }
    std::vector<long double> places;
    places.reserve(kLineBalls);
    for (int k = 0; k < kLineBalls; ++k)
        places.push_back(line.place[k] + static_cast<long double>(line.speed[k]) * end -
                         static_cast<long double>(gravity) * end * end / 2);
    std::ranges::sort(places);
    const double fallen = gravity * end * end / 2;
    const EventError each = event_error(line.length + kLineBalls + end + fallen, 1 + gravity * end, gravity);
    return compare(scene_of(line), end, crossings, false, places, bounds_of(crossings, each, end), 0);
}

/// The instants at which `place` + `speed` t is a multiple of `period`.
void add_multiples(std::vector<Crossing>& crossings, int i, int j, double place, double speed, double period,
                   double end) {
    if (speed == 0) return;
    const double low = std::min(place, place + speed * end);
    const double high = std::max(place, place + speed * end);
    for (double n = std::ceil(low / period); n * period <= high; ++n)
        crossings.push_back({(static_cast<long double>(n) * period - place) / speed, i, j, std::abs(speed)});
}

/// Between two walls: unfolded, a point goes straight on a circle of twice the length, and is seen where the
/// circle is pressed flat. Two meet where their angles or one's and the other's mirror image agree.
Deviation walled_line(double end) {
    const LineOfPoints line = random_line(62, 0.05);
    std::vector<Crossing> crossings;
    std::vector<long double> places;
    places.reserve(kLineBalls);
    for (int i = 0; i < kLineBalls; ++i) {
        add_multiples(crossings, i, i, line.place[i], line.speed[i], line.length, end);
        for (int j = i + 1; j < kLineBalls; ++j) {
            const double circle = 2 * line.length;
            add_multiples(crossings, i, j, line.place[i] - line.place[j], line.speed[i] - line.speed[j],
                          circle, end);
            add_multiples(crossings, i, j, line.place[i] + line.place[j], line.speed[i] + line.speed[j],
                          circle, end);
        }
        places.push_back(std::abs(std::remainder(line.place[i] + line.speed[i] * end, 2 * line.length)));
    }
    std::ranges::sort(places);
    const EventError each = event_error(line.length + kLineBalls, 1, 0);
    return compare(bounded(line, Boundary::kWall), end, crossings, false, places,
                   bounds_of(crossings, each, end), 0);
}

/// Round a circle. Which of the sorted points is ball 0's tells the sum of all ways, which no exchange
/// changes.
Deviation periodic_line(double end) {
    const LineOfPoints line = random_line(63, 0.05);
    std::vector<Crossing> crossings;
    std::vector<double> sorted;
    double ways = 0;
    for (int i = 0; i < kLineBalls; ++i) {
        for (int j = i + 1; j < kLineBalls; ++j)
            add_multiples(crossings, i, j, line.place[i] - line.place[j], line.speed[i] - line.speed[j],
                          line.length, end);
        const double place = line.place[i] + line.speed[i] * end;
        const double inside = place - std::floor(place / line.length) * line.length;
        sorted.push_back(inside);
        ways += place - inside;
    }
    std::ranges::sort(sorted);
    const auto turns = static_cast<long>(std::lround(ways / line.length));
    std::vector<long double> places;
    places.reserve(kLineBalls);
    for (int k = 0; k < kLineBalls; ++k) {
        const long of = ((k + turns) % kLineBalls + kLineBalls) % kLineBalls;
        const long laps = (k + turns - of) / kLineBalls;
        places.push_back(sorted[static_cast<std::size_t>(of)] + static_cast<long double>(laps) * line.length);
    }
    const double period = line.length + kLineBalls;
    const EventError each = event_error(2 * period, 1, 0);
    return compare(bounded(line, Boundary::kPeriodic), end, crossings, true, places,
                   bounds_of(crossings, each, end), period);
}

/// Between the bounces of either two bouncing points pass at most once, for there they share gravity.
void add_bouncing(std::vector<Crossing>& crossings, const std::vector<BouncingPoint>& points, int i, int j,
                  double end) {
    std::vector<long double> times = {0, end};
    for (const BouncingPoint& p : {points[i], points[j]})
        for (std::uint64_t n = 1; p.bounce_time(n) < end; ++n) times.push_back(p.bounce_time(n));
    std::ranges::sort(times);
    for (std::size_t k = 1; k < times.size(); ++k) {
        const long double low = points[i].height(times[k - 1]) - points[j].height(times[k - 1]);
        const long double high = points[i].height(times[k]) - points[j].height(times[k]);
        if ((low < 0) == (high < 0)) continue;
        const long double length = times[k] - times[k - 1];
        crossings.push_back({times[k - 1] + length * low / (low - high), i, j,
                             static_cast<double>(std::abs((high - low) / length))});
    }
}

/// A column on an elastic floor.
Deviation column(double end) {
    LineOfPoints line = random_line(64, 0.05);
    line.gravity = 0.5;
    std::vector<BouncingPoint> points;
    points.reserve(kLineBalls);
    for (int k = 0; k < kLineBalls; ++k) points.emplace_back(line.place[k], line.speed[k], line.gravity);
    std::vector<Crossing> crossings;
    std::vector<long double> places;
    places.reserve(kLineBalls);
    double fastest = 0;
    for (int i = 0; i < kLineBalls; ++i) {
        fastest = std::max(fastest, points[i].impact_speed());
        places.push_back(points[i].height(end));
        for (std::uint64_t n = 1; points[i].bounce_time(n) < end; ++n)
            crossings.push_back({points[i].bounce_time(n), i, i, points[i].impact_speed()});
        for (int j = i + 1; j < kLineBalls; ++j) add_bouncing(crossings, points, i, j, end);
    }
    std::ranges::sort(places);
    std::vector<std::uint64_t> events(kLineBalls);
    for (const Crossing& c : crossings)
        for (const int k : {c.i, c.j}) ++events[k];
    const EventError each = event_error(2 * line.length + kLineBalls, fastest, line.gravity);
    std::vector<double> bounds;
    bounds.reserve(kLineBalls);
    for (int k = 0; k < kLineBalls; ++k)
        bounds.push_back(points[k].bound(events[k] + 1, end, each.place, each.speed));
    const double high = 3 * (line.length + kLineBalls);  // above all bounces
    return compare(bounded(line, Boundary::kWall, high), end, crossings, false, places, bounds, 0);
}

}  // namespace

std::vector<System> line_systems() {
    return {
        {"1,000 equal balls in a line", "place", [] { return open_line(0, 256); }},
        {"1,000 equal balls in a line, in common gravity", "place", [] { return open_line(0x1p-5, 128); }},
        {"1,000 equal balls in a line between walls", "place", [] { return walled_line(64); }},
        {"1,000 equal balls in a periodic line", "place", [] { return periodic_line(64); }},
        {"column of 1,000 equal balls that bounce on a floor", "place", [] { return column(32); }}};
}

}  // namespace carom::accuracy
