// Unequal balls in a line: velocities composed of the one-dimensional formulas in 100 digits, event by event.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>

#include "accuracy/galperin.hpp"
#include "accuracy/systems.hpp"
#include "core/many_digits.hpp"
#include "core/random.hpp"

namespace carom::accuracy {
namespace {

using test::Big;

/// Balls of diameter 1 in a line, from left to right, in 100 digits. Of simultaneous meetings the one of the
/// smaller ids comes first.
class BigLine {
 public:
    explicit BigLine(const std::vector<Ball>& balls, bool ids_fall) : ids_fall_(ids_fall) {
        for (const Ball& b : balls) {
            place_.emplace_back(b.position.x());
            speed_.emplace_back(b.velocity.x());
            mass_.emplace_back(b.mass);
        }
    }

    /// Resolves the next meeting; false where there is none.
    bool next() {
        std::size_t first = place_.size();
        Big soonest = 0;
        for (std::size_t k = 0; k + 1 < place_.size(); ++k) {
            if (!(speed_[k] > speed_[k + 1])) continue;
            const Big time = (place_[k + 1] - place_[k] - 1) / (speed_[k] - speed_[k + 1]);
            if (first < place_.size() && (ids_fall_ ? time > soonest : time >= soonest)) continue;
            first = k;
            soonest = time;
        }
        if (first == place_.size()) return false;
        for (std::size_t k = 0; k < place_.size(); ++k) place_[k] += speed_[k] * soonest;
        exchange(first, first + 1);
        return true;
    }
    [[nodiscard]] const Big& speed(std::size_t k) const { return speed_[k]; }

 private:
    void exchange(std::size_t a, std::size_t b) {
        const Big sum = mass_[a] + mass_[b];
        const Big u = speed_[a];
        const Big v = speed_[b];
        speed_[a] = ((mass_[a] - mass_[b]) * u + 2 * mass_[b] * v) / sum;
        speed_[b] = ((mass_[b] - mass_[a]) * v + 2 * mass_[a] * u) / sum;
    }

    bool ids_fall_;
    std::vector<Big> place_, speed_, mass_;
};

/// A collision rounds, for either body, the difference of the speeds, the impulse (three times), its share
/// and the sum: at most 13 roundings of sqrt(2 E) in the speeds times the roots of the masses, 16 with some
/// to spare. In those coordinates a collision is a reflection (Galperin 2003), which keeps the length of
/// every error.
double speed_bound(std::uint64_t collisions, double energy, double mass) {
    return 16 * kRounding * static_cast<double>(collisions) * std::sqrt(2 * energy / mass);
}

/// `balls` from left to right, which is the order of the ids or the opposite.
Deviation compare_line(std::vector<Ball> balls, bool ids_fall = false) {
    BigLine exact(balls, ids_fall);
    Deviation d;
    while (exact.next()) ++d.expected;
    Scene s;
    if (ids_fall) std::ranges::reverse(balls);
    s.balls = balls;
    World world(s, {.threads = 1});
    const double energy = world.energy();
    world.advance_to(1e6);
    d.collisions = world.counts().ball_collisions;
    const PlaneVectors v = world.velocities();
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const std::size_t k = ids_fall ? balls.size() - 1 - i : i;
        d.include(static_cast<double>(abs(Big(v[i].x()) - exact.speed(k))),
                  speed_bound(d.expected, energy, balls[i].mass));
        if (v[i].y() != 0) d.include(std::numeric_limits<double>::infinity(), 1);
    }
    return d;
}

/// Each ball `ratio` times as heavy as the one before: n - 1 collisions, and ball k goes at
/// (2 / (1 + ratio))^k (1 - ratio) / (1 + ratio), the last at the power alone.
Deviation geometric_chain(double ratio) {
    constexpr std::size_t kBalls = 16;
    std::vector<Ball> balls;
    for (std::size_t k = 0; k < kBalls; ++k) {
        balls.push_back(ball_at(2.0 * double(k), 0, k == 0 ? 1 : 0, 0));
        balls.back().mass = std::pow(ratio, double(k));
    }
    Deviation d = compare_line(balls);
    const long double share = 2 / (1 + static_cast<long double>(ratio));
    Scene s;
    s.balls = balls;
    World world(s, {.threads = 1});
    world.advance_to(1e6);
    for (std::size_t k = 0; k < kBalls; ++k) {
        const long double speed = std::pow(share, static_cast<long double>(k)) *
                                  (k + 1 < kBalls ? (1 - static_cast<long double>(ratio)) / (1 + ratio) : 1);
        // The long double's own rounding, in its power, is far below.
        d.include(static_cast<double>(std::abs(world.velocities()[k].x() - speed)),
                  speed_bound(kBalls, 0.5, balls[k].mass));
    }
    if (d.expected != kBalls - 1) d.include(std::numeric_limits<double>::infinity(), 1);
    return d;
}

Deviation random_masses() {
    test::Random random(71);
    std::vector<Ball> balls;
    for (int k = 0; k < 24; ++k) {
        balls.push_back(ball_at(k * 2 + random.uniform(0, 0.9), 0, random.uniform(-1, 1), 0));
        balls.back().mass = random.decades(-3, 3);
    }
    return compare_line(balls);
}

/// A ball of mass 1 comes upon balls of mass 2, 3, ... that touch; or one comes from each side at once.
Deviation touching_masses(bool from_both_sides, bool ids_fall) {
    std::vector<Ball> balls = {ball_at(-3, 0, 1, 0), ball_at(0, 0, 0, 0), ball_at(1, 0, 0, 0)};
    if (from_both_sides) balls = {ball_at(-3, 0, 1, 0), ball_at(0, 0, 0, 0), ball_at(3, 0, -1, 0)};
    for (std::size_t k = 0; k < balls.size(); ++k) balls[k].mass = double(k + 1);
    return compare_line(balls, ids_fall);
}

System of_galperin(double ratio, bool heavy_first, bool mirrored) {
    const std::string name = fmt::format("a ball drives one 1/{:.0f} as heavy against a wall{}{}", ratio,
                                         heavy_first ? ", ids swapped" : "", mirrored ? ", mirrored" : "");
    return {name, "speed", [=] { return galperin(ratio, heavy_first, mirrored); }};
}

}  // namespace

std::uint64_t galperin_count(double ratio) {
    const long double turns =
        std::numbers::pi_v<long double> / std::atan(std::sqrt(1 / static_cast<long double>(ratio)));
    // The direction in the plane of the speeds errs by 16 roundings a collision; one that it decides is no
    // test. With equal masses the last two balls would go at exactly one speed, and they do.
    const long double doubt = 16 * kRounding * turns * turns;
    const long double nearest = std::round(turns);
    if (ratio != 1 && std::abs(turns - nearest) < doubt) return 0;
    return static_cast<std::uint64_t>(std::ceil(turns - doubt)) - 1;
}

Deviation galperin(double ratio, bool heavy_first, bool mirrored) {
    const double side = mirrored ? -1 : 1;
    Scene s;
    s.balls = {ball_at(2 * side, 0, 0, 0), ball_at(4 * side, 0, -side, 0)};
    s.balls[1].mass = ratio;
    if (heavy_first) std::swap(s.balls[0], s.balls[1]);
    s.walls = {{{0, -1}, {0, 1}, 1}};
    World world(s, {.threads = 1});
    const double energy = world.energy();
    world.advance_to(1000);
    Deviation d;
    d.expected = galperin_count(ratio);
    d.collisions = world.counts().ball_collisions + world.counts().wall_collisions;
    const Big m = ratio;
    Big light = 0;
    Big heavy = -side;
    for (std::uint64_t k = 0; k < d.expected; ++k) {
        if (k % 2 == 1) {
            light = -light;
            continue;
        }
        const Big before = light;
        light = ((1 - m) * light + 2 * m * heavy) / (1 + m);
        heavy = ((m - 1) * heavy + 2 * before) / (1 + m);
    }
    const PlaneVectors v = world.velocities();
    d.include(static_cast<double>(abs(Big(v[heavy_first ? 1 : 0].x()) - light)),
              speed_bound(d.expected, energy, 1));
    d.include(static_cast<double>(abs(Big(v[heavy_first ? 0 : 1].x()) - heavy)),
              speed_bound(d.expected, energy, ratio));
    return d;
}

std::vector<System> mass_systems() {
    std::vector<System> all;
    for (const double ratio : {100.0, 1e4, 1e6, 1e8}) all.push_back(of_galperin(ratio, false, false));
    for (const double ratio : {1.0, 16.0, 256.0, 4096.0, 65536.0, 1048576.0})
        all.push_back(of_galperin(ratio, true, true));
    for (const double ratio : {0.5, 2.0, 3.0})
        all.push_back({fmt::format("a ball hits a line of 15, each {} times as heavy as the last", ratio),
                       "speed", [=] { return geometric_chain(ratio); }});
    all.push_back({"24 balls of masses 1e-3 to 1e3 in a line", "speed", random_masses});
    for (const bool both : {false, true})
        for (const bool fall : {false, true})
            all.push_back(
                {fmt::format("three masses, {}, {}",
                             both ? "the middle one hit from both sides at once" : "two of them touching",
                             fall ? "ids falling" : "ids rising"),
                 "speed", [=] { return touching_masses(both, fall); }});
    return all;
}

}  // namespace carom::accuracy
