// The empirical way to find a collision: move both bodies by the step, test for overlap there, and bisect
// back to the contact. Cheap and simple, for who trades accuracy for speed. The exact way is impact.hpp.
//
// What it misses, by construction: every collision that is over at the end of the step. A fast ball passes
// another or a wall (tunnelling), a parabola dips into a body and leaves it again, a graze comes and goes.
// Where several contacts lie inside one step it may find a later one. Shorter steps make all of that rarer,
// never impossible.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <carom/core/impact.hpp>

namespace carom {

namespace detail {

/// Distance of a point to a segment, and the part that is nearest.
template <class T>
struct WallDistance {
    T distance;
    WallFeature feature;
};

template <class T>
[[nodiscard]] inline WallDistance<T> distance_to_wall(const Vector2<T>& point, const Vector2<T>& from,
                                                      const Vector2<T>& to) {
    using std::abs;
    using std::sqrt;
    const Vector2<T> along = to - from;
    const Vector2<T> offset = point - from;
    const T foot = dot<T>(along, offset);
    if (!(foot > 0)) return {T(sqrt(length_squared<T>(offset))), WallFeature::kFrom};
    if (foot > dot<T>(along, along))
        return {T(sqrt(length_squared<T>(Vector2<T>(point - to)))), WallFeature::kTo};
    return {T(abs(dot<T>(face_normal<T>(from, to), offset))), WallFeature::kFace};
}

/// A time in [0, duration] with 0 <= gap <= tolerance just before an overlap, by bisection; nullopt when
/// gap(duration) >= 0. With gap(0) < 0 it is time 0. Ends also when the times meet, where the tolerance is
/// below what the scalar resolves.
template <class T, class Gap>
[[nodiscard]] inline std::optional<T> bisect_contact(const T& duration, const T& tolerance, Gap&& gap) {
    if (!(gap(duration) < 0)) return std::nullopt;
    T free(0);
    T overlapping = duration;
    T free_gap = gap(free);
    while (free_gap > tolerance) {
        const T middle = free + (overlapping - free) / T(2);
        if (!(middle > free && middle < overlapping)) break;
        const T middle_gap = gap(middle);
        if (middle_gap < 0) {
            overlapping = middle;
        } else {
            free = middle;
            free_gap = middle_gap;
        }
    }
    return free;
}

template <class T>
[[nodiscard]] inline bool approaching(const Vector2<T>& offset, const Vector2<T>& rate) {
    return dot<T>(offset, rate) < 0;
}

template <class T>
[[nodiscard]] inline std::optional<T> bisect_discs(const Motion<T>& a, const Motion<T>& b,
                                                   const T& radius_sum, const T& duration,
                                                   const T& tolerance) {
    using std::sqrt;
    const auto offset = [&](const T& t) { return Vector2<T>(position_at<T>(a, t) - position_at<T>(b, t)); };
    const std::optional<T> time = bisect_contact<T>(
        duration, tolerance, [&](const T& t) { return T(sqrt(length_squared<T>(offset(t))) - radius_sum); });
    if (!time ||
        !approaching<T>(offset(*time), Vector2<T>(velocity_at<T>(a, *time) - velocity_at<T>(b, *time))))
        return std::nullopt;
    return time;
}

}  // namespace detail

/// A collision of two balls found at the end of the step: nullopt unless they overlap after `duration` and
/// approach at the contact.
///
/// `tolerance` > 0 is a length: the impact returned has the surfaces apart by at most that much, not
/// overlapping (time 0 when they overlap at the start). Units, rule and the rest of the result as
/// ball_ball_impact. What it misses is said at the head of this file.
template <class T>
[[nodiscard]] inline std::optional<Impact<T>> bisect_ball_ball(const Disc<T>& a, const Disc<T>& b,
                                                               const T& duration, const T& tolerance,
                                                               RestitutionRule rule = RestitutionRule::kMin) {
    const auto time =
        detail::bisect_discs<T>(a.motion, b.motion, T(a.radius + b.radius), duration, tolerance);
    if (!time) return std::nullopt;
    return detail::ball_ball_at<T>(a, b, *time, rule);
}

/// A collision of a ball with a static one, as bisect_ball_ball.
template <class T>
[[nodiscard]] inline std::optional<Impact<T>> bisect_ball_static(
    const Disc<T>& ball, const Disc<T>& obstacle, const T& duration, const T& tolerance,
    RestitutionRule rule = RestitutionRule::kMin) {
    const Motion<T> rest = detail::at_rest<T>(obstacle.motion);
    const auto time =
        detail::bisect_discs<T>(ball.motion, rest, T(ball.radius + obstacle.radius), duration, tolerance);
    if (!time) return std::nullopt;
    return detail::ball_static_at<T>(ball, obstacle, *time, rule);
}

/// A collision of a ball with a wall, as bisect_ball_ball; the wall has two sides and two ends.
template <class T>
[[nodiscard]] inline std::optional<Impact<T>> bisect_ball_wall(const Disc<T>& ball, const Vector2<T>& from,
                                                               const Vector2<T>& to,
                                                               const T& wall_restitution, const T& duration,
                                                               const T& tolerance,
                                                               RestitutionRule rule = RestitutionRule::kMin) {
    const auto distance = [&](const T& t) {
        return detail::distance_to_wall<T>(position_at<T>(ball.motion, t), from, to);
    };
    const std::optional<T> time = detail::bisect_contact<T>(
        duration, tolerance, [&](const T& t) { return T(distance(t).distance - ball.radius); });
    if (!time) return std::nullopt;
    const WallHit<T> hit{*time, distance(*time).feature};
    const Vector2<T> across = contact_normal<T>(position_at<T>(ball.motion, *time), hit.feature, from, to);
    if (!detail::approaching<T>(across, velocity_at<T>(ball.motion, *time))) return std::nullopt;
    return detail::ball_wall_at<T>(ball, from, to, wall_restitution, hit, rule);
}

}  // namespace carom
