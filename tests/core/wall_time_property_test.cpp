// Properties of the time of impact on a segment. The oracle sees the wall as a shape, everything within a
// radius of the segment: two discs by Sturm's theorem, two lines by their quadratics, in 100 digits. A box of
// walls tests what follows a hit.
#include <carom/core/wall_time.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <carom/core/response.hpp>

#include "core/limits.hpp"
#include "core/random.hpp"
#include "core/sturm.hpp"

namespace carom {
namespace {

using test::Big;
using test::BigVector;
using test::kInfinity;
using test::Random;

/// Hits are checked up to here; the families keep places below 1e3 until then.
constexpr double kHorizon = 20;
/// Rounding of places below 1e3 and of distances from them.
constexpr double kSlack = 1e-12;

struct WallMotion {
    Motion<double> centre;
    double radius;
    Vec2 from, to;
};

BigVector place_at(const Motion<double>& m, const Big& t) {
    return test::big(m.position) + test::big(m.velocity) * t + test::big(m.acceleration) * Big(t * t / 2);
}

/// Distance of a point to the segment.
template <class T>
T distance(const Vector2<T>& point, const Vector2<T>& from, const Vector2<T>& to) {
    using std::sqrt;
    const Vector2<T> along = to - from;
    T foot = dot<T>(along, Vector2<T>(point - from)) / dot<T>(along, along);
    foot = foot < 0 ? T(0) : (foot > 1 ? T(1) : foot);
    const Vector2<T> offset = point - from - along * foot;
    return sqrt(dot<T>(offset, offset));
}

/// Does the centre come nearer than `radius` to the segment in (0, until)? Precondition: not at time 0.
bool enters(const WallMotion& m, const Big& radius, const Big& until) {
    const BigVector from = test::big(m.from);
    const BigVector to = test::big(m.to);
    const BigVector p = test::big(m.centre.position);
    const BigVector v = test::big(m.centre.velocity);
    const BigVector a = test::big(m.centre.acceleration);
    for (const BigVector& end : {from, to}) {
        if (test::Sturm(test::gap_polynomial(BigVector(p - end), v, a, radius)).roots(Big(0), until) > 0)
            return true;
    }
    const BigVector along = to - from;
    const Big length = sqrt(dot<Big>(along, along));
    const BigVector normal(-along.y() / length, along.x() / length);
    const Big height = dot<Big>(normal, BigVector(p - from));
    const Big speed = dot<Big>(normal, v);
    const Big half = dot<Big>(normal, a) / 2;
    const auto on_face = [&](const Big& t) {
        const Big foot = dot<Big>(along, BigVector(place_at(m.centre, t) - from));
        return t > 0 && t < until && foot > 0 && foot < length * length;
    };
    for (const Big& line : {radius, Big(-radius)}) {
        const Big c = height - line;
        if (half == 0) {
            if (speed != 0 && on_face(Big(-c / speed))) return true;
            continue;
        }
        const Big discriminant = speed * speed - 4 * half * c;
        if (discriminant <= 0) continue;
        if (on_face(Big((-speed + sqrt(discriminant)) / (2 * half)))) return true;
        if (on_face(Big((-speed - sqrt(discriminant)) / (2 * half)))) return true;
    }
    return false;
}

/// What is wrong with a hit of a disc that starts clear of the wall; empty when nothing is.
std::string fault_from_outside(const WallMotion& m, const WallHit<double>& hit) {
    if (!(hit.time >= 0)) return "negative or NaN";
    const double until = hit.time < kHorizon ? hit.time : kHorizon;
    if (until > 0 && enters(m, Big(m.radius) - kSlack, Big(until))) return "too late or missed";
    if (!(hit.time < kHorizon)) return "";
    const BigVector from = test::big(m.from);
    const BigVector to = test::big(m.to);
    const BigVector place = place_at(m.centre, Big(hit.time));
    if (abs(distance<Big>(place, from, to) - m.radius) > kSlack) return "not in contact at the time found";
    const BigVector end = hit.feature == WallFeature::kFrom ? from : to;
    if (hit.feature != WallFeature::kFace &&
        abs(distance<Big>(place, end, BigVector(end + BigVector(Big(1e-60), Big(0)))) - m.radius) > kSlack) {
        return "not the part that is hit";
    }
    const Vec2 centre = position_at<double>(m.centre, hit.time);
    const Vec2 normal = contact_normal<double>(centre, hit.feature, m.from, m.to);
    const double rate = dot<double>(normal, velocity_at<double>(m.centre, hit.time));
    return rate > 1e-6 ? "recedes at the time found" : "";
}

int check_family(std::uint64_t seed, int count, const std::function<WallMotion(Random&)>& make) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    int hits = 0;
    int faults = 0;
    for (int i = 0; i < count && faults < 5; ++i) {
        const WallMotion m = make(random);
        if (distance<Big>(test::big(m.centre.position), test::big(m.from), test::big(m.to)) <=
            Big(m.radius) + kSlack)
            continue;
        const WallHit<double> hit = wall_time_of_impact<double>(m.centre, m.radius, m.from, m.to);
        const std::string fault = fault_from_outside(m, hit);
        hits += hit.time < kInfinity ? 1 : 0;
        faults += fault.empty() ? 0 : 1;
        EXPECT_EQ(fault, "") << "case " << i << ", t = " << hit.time << ", part "
                             << static_cast<int>(hit.feature) << std::hexfloat << "\np "
                             << m.centre.position.transpose() << " v " << m.centre.velocity.transpose()
                             << " a " << m.centre.acceleration.transpose() << " radius " << m.radius
                             << " wall " << m.from.transpose() << " - " << m.to.transpose();
    }
    return hits;
}

TEST(WallTimeProperty, StraightMotion) {
    const int hits = check_family(31, 10000, [](Random& random) {
        const Vec2 p = random.vector(4);
        const Vec2 v = random.vector(1) - p / 4;
        return WallMotion{{p, v, {0, 0}}, random.uniform(0.01, 1), random.vector(2), random.vector(2)};
    });
    EXPECT_GT(hits, 1000);
}

TEST(WallTimeProperty, AcceleratedMotion) {
    const int hits = check_family(32, 10000, [](Random& random) {
        const Vec2 p = random.vector(4);
        const Vec2 v = random.vector(2) - p / 4;
        return WallMotion{{p, v, random.direction(random.decades(-12, 0.3))},
                          random.uniform(0.01, 1),
                          random.vector(2),
                          random.vector(2)};
    });
    EXPECT_GT(hits, 1000);
}

// Walls along the axes, whole numbers: feet that pass an end just as the face is met, touches, turning points
// on the line.
TEST(WallTimeProperty, WholeNumbers) {
    const int hits = check_family(33, 10000, [](Random& random) {
        const auto whole = [&](double reach) { return std::floor(random.uniform(-reach, reach + 1)); };
        const Vec2 from(whole(3), whole(3));
        const double length = 1 + std::floor(random.uniform(0, 4));
        const Vec2 to =
            random.sign() > 0 ? Vec2(from.x() + length, from.y()) : Vec2(from.x(), from.y() - length);
        const double x = whole(6);
        const double vx = whole(3);
        return WallMotion{{{x, whole(6)}, {vx, whole(3)}, {0, whole(2)}}, 1, from, to};
    });
    EXPECT_GT(hits, 1000);
}

// The parabola passes an end's disc, or the face, at a distance of a radius and a little.
TEST(WallTimeProperty, Grazes) {
    const int hits = check_family(34, 10000, [](Random& random) {
        const Vec2 from(random.uniform(-2, -1), 0);
        const Vec2 to(random.uniform(1, 2), random.uniform(-0.5, 0.5));
        const double angle = random.uniform(-1.8, 1.8);
        const Vec2 n(std::sin(angle), std::cos(angle));
        const Vec2 foot = random.sign() > 0 ? from : Vec2(from + (to - from) * random.uniform(-0.1, 1.1));
        const double away = 0.5 * (1 + random.sign() * random.decades(-13, -2));
        const Vec2 w = Vec2(n.y(), -n.x()) * random.uniform(-2, 2);
        const Vec2 a = random.vector(1);
        const double t = random.uniform(0.1, 3);
        const Vec2 x = foot + n * away;
        return WallMotion{{x - w * t + a * (t * t / 2), w - a * t, a}, 0.5, from, to};
    });
    EXPECT_GT(hits, 1000);
}

// In contact and moving in: now. Moving out: not now, and what comes is a fall from a radius away.
TEST(WallTimeProperty, StartsInContact) {
    SCOPED_TRACE("seed 35");
    Random random(35);
    for (int i = 0; i < 20000; ++i) {
        const Vec2 from = random.vector(2);
        const Vec2 to = random.vector(2);
        const Vec2 along = (to - from).normalized();
        const Vec2 across(-along.y(), along.x());
        const double choice = random.uniform(0, 3);
        const double turn = random.uniform(-1.5707963, 1.5707963);
        Vec2 n = across;  // beside the face, around `from`, around `to`
        Vec2 foot = from + (to - from) * random.uniform(0.01, 0.99);
        if (choice < 1) n = across * std::sin(turn) - along * std::cos(turn);
        if (choice < 1) foot = from;
        if (choice > 2) n = across * std::sin(turn) + along * std::cos(turn);
        if (choice > 2) foot = to;
        const double out = random.sign() * random.decades(-9, 0);
        const Vec2 tangent(-n.y(), n.x());
        const Motion<double> m{foot + 0.5 * n, n * out + tangent * random.uniform(-1, 1), random.vector(1)};
        const WallHit<double> hit = wall_time_of_impact<double>(m, 0.5, from, to);
        if (out < 0) {
            // The place is rounded: a gap of 1e-15 is closed in 1e-15 / |out|, or not at all when tangential
            // motion opens it before.
            ASSERT_TRUE(out > -1e-6 || hit.time <= 4e-15 / -out) << "case " << i << ": passed through";
            continue;
        }
        ASSERT_TRUE(out < 1e-6 || hit.time > out * 0.05) << "case " << i << ": hit again at once";
        if (!(hit.time < kHorizon)) continue;
        const Big gap = distance<Big>(place_at(m, Big(hit.time)), test::big(from), test::big(to)) - Big(0.5);
        ASSERT_LE(gap, Big(kSlack)) << i;
        ASSERT_FALSE(out > 1e-6 && gap < -kSlack) << i;
    }
}

// A disc in a slanted box of six walls under gravity, elastic and not: it stays in, and no instant locks.
TEST(WallTimeProperty, StaysInABox) {
    const std::array<Vec2, 6> corners = {Vec2(-2, 0),  Vec2(0, -0.7), Vec2(2, 0.3),
                                         Vec2(2.5, 3), Vec2(0, 2),    Vec2(-3, 3.1)};
    const auto wall_end = [&](std::size_t k) { return corners[k % corners.size()]; };
    for (const double e : {1.0, 0.9}) {
        SCOPED_TRACE("restitution " + std::to_string(e) + ", seed 36");
        Random random(36);
        for (int run = 0; run < 60; ++run) {
            Motion<double> m{{random.uniform(-1, 1), 1}, random.vector(5), {0, -1}};
            for (int event = 0; event < 300; ++event) {
                WallHit<double> first{kInfinity, WallFeature::kFace};
                std::size_t wall = 0;
                for (std::size_t k = 0; k < corners.size(); ++k) {
                    const WallHit<double> hit =
                        wall_time_of_impact<double>(m, 0.2, wall_end(k), wall_end(k + 1));
                    if (hit.time < first.time) wall = k;
                    if (hit.time < first.time) first = hit;
                }
                ASSERT_LT(first.time, 20) << "run " << run << ", event " << event << ": out of the box";
                m = {position_at<double>(m, first.time), velocity_at<double>(m, first.time), m.acceleration};
                const Vec2 normal =
                    contact_normal<double>(m.position, first.feature, wall_end(wall), wall_end(wall + 1));
                // A speed of 1e-3 at least parts them, as the contact model of a scene would.
                m.velocity = bounce<double>(m.velocity, normal, e, 1e-3);
                for (std::size_t k = 0; k < corners.size(); ++k) {
                    const double away = distance<double>(m.position, wall_end(k), wall_end(k + 1));
                    ASSERT_GT(away, 0.2 - 1e-10) << "run " << run << ", event " << event;
                }
            }
        }
    }
}

}  // namespace
}  // namespace carom
