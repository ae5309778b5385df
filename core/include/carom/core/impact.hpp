// Is there a collision within a duration; when, where, along which normal, with which velocities after: the
// questions of one pair of bodies, for a caller who brings his own loop. Pure functions; the equations are in
// disc_time.hpp, wall_time.hpp and response.hpp.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include <carom/core/disc_time.hpp>
#include <carom/core/motion.hpp>
#include <carom/core/response.hpp>
#include <carom/core/wall_time.hpp>

namespace carom {

/// A ball at time 0 and its motion from there. radius > 0, mass > 0, restitution in [0, 1].
template <class T>
struct Disc {
    Motion<T> motion;
    T radius = T(1) / T(2);
    T mass = T(1);
    T restitution = T(1);
};

/// A collision. For a wall or a static ball, body b is the one that does not move and velocity_b is zero.
template <class T>
struct Impact {
    T time;                 ///< in [0, duration]
    Vector2<T> point;       ///< where the surfaces meet
    Vector2<T> normal;      ///< unit vector from b to a
    Vector2<T> velocity_a;  ///< after the collision
    Vector2<T> velocity_b;
};

namespace detail {

/// `v` as a unit vector; along x where it has no direction (centres in one place).
template <class T>
[[nodiscard]] inline Vector2<T> unit_or_x(const Vector2<T>& v) {
    using std::sqrt;
    const T length = sqrt(length_squared<T>(v));
    if (!(length > 0)) return {T(1), T(0)};
    return {T(v.x() / length), T(v.y() / length)};
}

/// The collision of two balls at a known time.
template <class T>
[[nodiscard]] inline Impact<T> ball_ball_at(const Disc<T>& a, const Disc<T>& b, const T& time,
                                            RestitutionRule rule) {
    const Vector2<T> centre_b = position_at<T>(b.motion, time);
    const Vector2<T> offset = position_at<T>(a.motion, time) - centre_b;
    const Vector2<T> normal = unit_or_x<T>(offset);
    const T restitution = pair_restitution<T>(rule, a.restitution, b.restitution);
    const PairVelocities<T> after = collide<T>(velocity_at<T>(a.motion, time), velocity_at<T>(b.motion, time),
                                               offset, a.mass, b.mass, restitution);
    return {time, centre_b + b.radius * normal, normal, after.a, after.b};
}

/// The collision of a ball with a static one at a known time.
template <class T>
[[nodiscard]] inline Impact<T> ball_static_at(const Disc<T>& ball, const Disc<T>& obstacle, const T& time,
                                              RestitutionRule rule) {
    const Vector2<T>& centre = obstacle.motion.position;
    const Vector2<T> offset = position_at<T>(ball.motion, time) - centre;
    const Vector2<T> normal = unit_or_x<T>(offset);
    const T restitution = pair_restitution<T>(rule, ball.restitution, obstacle.restitution);
    const Vector2<T> after = bounce<T>(velocity_at<T>(ball.motion, time), offset, restitution);
    return {time, centre + obstacle.radius * normal, normal, after, Vector2<T>::Zero()};
}

/// The collision of a ball with a part of a wall at a known time.
template <class T>
[[nodiscard]] inline Impact<T> ball_wall_at(const Disc<T>& ball, const Vector2<T>& from, const Vector2<T>& to,
                                            const T& wall_restitution, const WallHit<T>& hit,
                                            RestitutionRule rule) {
    const Vector2<T> centre = position_at<T>(ball.motion, hit.time);
    const Vector2<T> across = contact_normal<T>(centre, hit.feature, from, to);
    const Vector2<T> normal = unit_or_x<T>(across);
    const T restitution = pair_restitution<T>(rule, ball.restitution, wall_restitution);
    const Vector2<T> after = bounce<T>(velocity_at<T>(ball.motion, hit.time), across, restitution);
    Vector2<T> point = from;
    if (hit.feature == WallFeature::kTo) point = to;
    if (hit.feature == WallFeature::kFace)
        point = centre - dot<T>(normal, Vector2<T>(centre - from)) * normal;
    return {hit.time, point, normal, after, Vector2<T>::Zero()};
}

/// The motion of a body that stays where it is.
template <class T>
[[nodiscard]] inline Motion<T> at_rest(const Motion<T>& motion) {
    Motion<T> rest;
    rest.position = motion.position;
    return rest;
}

/// The time of impact of two motions within a duration; +infinity when there is none.
template <class T>
[[nodiscard]] inline T relative_time(const Motion<T>& a, const Motion<T>& b, const T& radius_sum,
                                     const T& duration) {
    return disc_time_of_impact<T>(Vector2<T>(a.position - b.position), Vector2<T>(a.velocity - b.velocity),
                                  Vector2<T>(a.acceleration - b.acceleration), radius_sum, duration);
}

}  // namespace detail

/// The first collision of two balls in [0, duration]; nullopt when there is none, also when they overlap and
/// do not approach. A quadratic where the accelerations are equal, else a quartic. Units, rule and errors:
/// disc_time_of_impact, collide.
template <class T>
[[nodiscard]] inline std::optional<Impact<T>> ball_ball_impact(const Disc<T>& a, const Disc<T>& b,
                                                               const T& duration,
                                                               RestitutionRule rule = RestitutionRule::kMin) {
    const T time = detail::relative_time<T>(a.motion, b.motion, T(a.radius + b.radius), duration);
    if (!(time <= duration)) return std::nullopt;
    return detail::ball_ball_at<T>(a, b, time, rule);
}

/// The first collision of a ball with a static one in [0, duration]; nullopt when there is none. Of the
/// obstacle only the position, radius and restitution count.
template <class T>
[[nodiscard]] inline std::optional<Impact<T>> ball_static_impact(
    const Disc<T>& ball, const Disc<T>& obstacle, const T& duration,
    RestitutionRule rule = RestitutionRule::kMin) {
    const Motion<T> rest = detail::at_rest<T>(obstacle.motion);
    const T time = detail::relative_time<T>(ball.motion, rest, T(ball.radius + obstacle.radius), duration);
    if (!(time <= duration)) return std::nullopt;
    return detail::ball_static_at<T>(ball, obstacle, time, rule);
}

/// The first collision of a ball with the segment from - to, seen from both sides and at both ends, in [0,
/// duration]; nullopt when there is none. Units, rule and errors: wall_time_of_impact, bounce.
template <class T>
[[nodiscard]] inline std::optional<Impact<T>> ball_wall_impact(const Disc<T>& ball, const Vector2<T>& from,
                                                               const Vector2<T>& to,
                                                               const T& wall_restitution, const T& duration,
                                                               RestitutionRule rule = RestitutionRule::kMin) {
    const WallHit<T> hit = wall_time_of_impact<T>(ball.motion, ball.radius, from, to);
    if (!(hit.time <= duration)) return std::nullopt;
    return detail::ball_wall_at<T>(ball, from, to, wall_restitution, hit, rule);
}

}  // namespace carom
