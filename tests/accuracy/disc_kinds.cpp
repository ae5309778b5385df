#include "accuracy/disc_kinds.hpp"

#include <algorithm>
#include <cmath>

#include "accuracy/across.hpp"

namespace carom::accuracy {
namespace {

using test::Random;

/// From `distance` along a line that passes the centre at `parameter`, both in radii's sums s.
DiscQuery aimed(Random& random, double distance, double parameter, double s, double speed) {
    const Vec2 n = random.direction(1);
    const double along = std::sqrt(std::max(0.0, (distance - parameter) * (distance + parameter)));
    return {s * (parameter * across(n) - along * n), speed * n, {0, 0}, s};
}

/// The motion with acceleration a that is at x with velocity w at time t, up to the rounding of its start.
DiscQuery passing(const Vec2& x, const Vec2& w, const Vec2& a, double t, double s) {
    return {x - w * t + a * (t * t / 2), w - a * t, a, s};
}

DiscQuery with_acceleration(DiscQuery q, const Vec2& a) {
    q.a = a;
    return q;
}

DiscQuery generic(Random& random) {
    const Vec2 r = random.vector(10);
    return {r, random.vector(1) - r / random.uniform(1, 20), {0, 0}, random.uniform(0.5, 1.5)};
}

DiscQuery far(Random& random) {
    return aimed(random, random.decades(1, 8), random.uniform(-1.2, 1.2), random.uniform(0.5, 1.5),
                 random.uniform(0.1, 2));
}

DiscQuery small_gap(Random& random) {
    return aimed(random, 1 + random.decades(-15, 0), random.uniform(-1, 1), random.uniform(0.5, 1.5),
                 random.uniform(0.1, 2));
}

DiscQuery graze(Random& random) {
    return aimed(random, random.uniform(1.001, 20),
                 random.sign() * (1 + random.sign() * random.decades(-15, -1)), random.uniform(0.5, 1.5),
                 random.uniform(0.1, 2));
}

DiscQuery far_graze(Random& random) {
    return aimed(random, random.decades(1, 8), random.sign() * (1 + random.sign() * random.decades(-15, -1)),
                 random.uniform(0.5, 1.5), 1);
}

DiscQuery any_speed(Random& random) {
    return aimed(random, random.uniform(1.001, 20), random.uniform(-1.1, 1.1), random.uniform(0.5, 1.5),
                 random.decades(-12, 12));
}

/// Radii 1 and 1e-6 to 1e6, the gap in the smaller one's.
DiscQuery size_ratio(Random& random) {
    const double other = random.decades(-6, 6);
    const double s = 1 + other;
    const double gap = std::min(1.0, other) * random.decades(-3, 2);
    return aimed(random, 1 + gap / s, random.uniform(-1, 1), s, random.uniform(0.1, 2));
}

/// At a distance s to rounding, or exactly (a Pythagorean triple scaled by a power of two), radial speeds
/// from 1e-18 to 1 either way.
DiscQuery contact(Random& random) {
    Vec2 r = random.direction(1);
    double s = 1;
    if (random.sign() > 0) {
        const double m = std::floor(random.uniform(2, 4e3));
        const double n = std::floor(random.uniform(1, m));
        s = m * m + n * n;
        r = {random.sign() * (m * m - n * n), random.sign() * 2 * m * n};
    }
    const Vec2 out = r / s;
    return {
        r, out * (random.sign() * random.decades(-18, 0)) + across(out) * random.uniform(-1, 1), {0, 0}, s};
}

DiscQuery overlap(Random& random) {
    return {random.direction(1 - random.decades(-16, -0.01)), random.vector(1), {0, 0}, 1};
}

DiscQuery discs_of_any_unit(Random& random) {
    const double length = random.decades(-25, 25);
    const double time = random.decades(-12, 12);
    DiscQuery q = generic(random);
    return {q.r * length, q.v * (length / time), random.vector(0.3) * (length / time / time), q.s * length};
}

/// A tall arch over the disc that may graze it on the way up and again on the way down.
DiscQuery double_graze(Random& random) {
    const double depth = random.sign() * random.decades(-15, -1);
    return {{-3 + random.sign() * random.decades(-15, -2), -15.875 - depth}, {1, 12}, {0, -4}, 1};
}

/// Up through the disc and down again: four roots, at any angle and scale.
DiscQuery four_roots(Random& random) {
    const double scale = random.decades(-3, 3);
    const Vec2 up = random.direction(1);
    const double out = random.uniform(2, 30);  // the turning point, beyond the disc
    const double pull = random.decades(-1, 1);
    const double back = random.uniform(0, 10);
    const double fall = std::sqrt(2 * (out + 1 + back) / pull);
    const Vec2 x = up * out + across(up) * random.uniform(-0.3, 0.3);
    DiscQuery q = passing(x, across(up) * (random.uniform(-0.5, 0.5) / fall), up * -pull, fall, 1);
    return {q.r * scale, q.v * scale, q.a * scale, scale};
}

DiscQuery curved_graze(Random& random) {
    const Vec2 n = random.direction(1);
    const double depth = random.sign() * random.decades(-15, -1);
    return passing(n * (1 + depth), across(n) * (random.sign() * random.decades(-2, 1)),
                   random.direction(random.decades(-3, 1)), random.uniform(0.01, 5), 1);
}

/// Aimed so that the acceleration, which may move it far, still leads it to the disc.
DiscQuery curved_far(Random& random) {
    const Vec2 n = random.direction(1);
    const double distance = random.decades(1, 8);
    const double time = random.uniform(1, 10);
    const Vec2 a = random.direction(distance * random.decades(-9, -1));
    return passing(n * random.uniform(0, 1.2), across(n) * (distance / time) + random.vector(1), a, time, 1);
}

}  // namespace

DiscQuery straight_query(Random& random) {
    const Vec2 r = random.direction(random.uniform(1.001, 20));
    return {r, -r / random.uniform(1, 10) + random.vector(0.2), {0, 0}, 1};
}

std::vector<DiscKind> straight_kinds() {
    return {{"generic", generic},
            {"far: 10 to 1e8 s", far},
            {"gap 1e-15 to 1 s", small_gap},
            {"graze 1e-15 to 1e-1 s", graze},
            {"graze from up to 1e8 s", far_graze},
            {"speeds 1e-12 to 1e12", any_speed},
            {"radii 1 to 1e6, 1e-6", size_ratio},
            {"start in contact", contact},
            {"start in overlap", overlap}};
}

std::vector<DiscKind> curved_kinds() {
    const auto accelerate = [](DiscQuery (*make)(Random&), double low, double high) {
        return [=](Random& random) {
            const DiscQuery q = make(random);
            return with_acceleration(q, random.direction(q.s * random.decades(low, high)));
        };
    };
    const auto accelerate_by_speed = [](Random& random) {
        const DiscQuery q = any_speed(random);
        return with_acceleration(q, random.direction(q.v.squaredNorm() * random.decades(-6, 1)));
    };
    return {{"generic", accelerate(generic, -2, 1)},
            {"far: 10 to 1e8 s", curved_far},
            {"gap 1e-15 to 1 s", accelerate(small_gap, -3, 1)},
            {"graze 1e-15 to 1e-1 s", curved_graze},
            {"double graze 1e-15 to 1e-1 s", double_graze},
            {"four roots", four_roots},
            {"acceleration 1e-30 to 1e12", accelerate(straight_query, -30, 12)},
            {"speeds 1e-12 to 1e12", accelerate_by_speed},
            {"lengths 1e-25 to 1e25", discs_of_any_unit},
            {"radii 1 to 1e6, 1e-6", accelerate(size_ratio, -3, 1)},
            {"start in contact", accelerate(contact, -6, 2)},
            {"start in overlap", accelerate(overlap, -3, 1)}};
}

}  // namespace carom::accuracy
