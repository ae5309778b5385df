// Time of impact of a disc on a line and on a segment seen from both sides, with its two ends.
//
// The rule is that of disc_time.hpp, with f the squared distance of the centre to the wall less the squared
// radius. On a segment f is made of three: the face where the foot of the perpendicular lies on the segment,
// an end's disc beyond either end. They join with one slope, so the search goes through the stretches of time
// between the foot's crossings of the ends, each with its own f.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <carom/core/compensated.hpp>
#include <carom/core/disc_time.hpp>
#include <carom/core/motion.hpp>
#include <carom/core/scene.hpp>
#include <carom/core/vector.hpp>

namespace carom {

/// The part of a wall that is hit.
enum class WallFeature : std::uint8_t { kFace, kFrom, kTo };

template <class T>
struct WallHit {
    T time;               ///< +infinity when there is none
    WallFeature feature;  ///< kFace when there is none
};

/// A unit vector across the segment, to the left of from -> to; exact for walls along the axes, zero for a
/// wall without a length.
template <class T>
[[nodiscard]] inline Vector2<T> face_normal(const Vector2<T>& from, const Vector2<T>& to) {
    using std::abs;
    using std::sqrt;
    const T dx = to.x() - from.x();
    const T dy = to.y() - from.y();
    if (dx == 0) return {T((dy < 0) - (dy > 0)), T(0)};
    if (dy == 0) return {T(0), T((dx > 0) - (dx < 0))};
    const T length = sqrt(T(dx * dx + dy * dy));
    return {T(-dy / length), T(dx / length)};
}

/// The direction from the wall to a disc's centre that touches it, for bounce(): the very vector that
/// wall_time_of_impact measures the approach along, so that a velocity that bounce() lets go is not hit again
/// at once. A unit vector for the face, the centre's offset from the end point for an end.
template <class T>
[[nodiscard]] inline Vector2<T> contact_normal(const Vector2<T>& centre, WallFeature feature,
                                               const Vector2<T>& from, const Vector2<T>& to) {
    if (feature == WallFeature::kFrom) return centre - from;
    if (feature == WallFeature::kTo) return centre - to;
    const Vector2<T> normal = face_normal<T>(from, to);
    const Vector2<T> offset = centre - from;
    return dot<T>(normal, offset) < 0 ? Vector2<T>(-normal) : normal;
}

namespace detail {

/// As side_time_of_impact, at or after `not_before` >= 0.
template <class T>
[[nodiscard]] inline T side_time_from(const T& gap, const T& speed, const T& acceleration,
                                      const T& not_before) {
    using std::sqrt;
    const T never = std::numeric_limits<T>::infinity();
    T hit(0);
    if (acceleration < 0) {
        const T discriminant = difference_of_products<T>(speed, speed, T(acceleration + acceleration), gap);
        if (!(discriminant > 0)) {
            hit = speed > 0 ? T(-speed / acceleration)
                            : T(0);  // below the line up to the turning point and beyond
        } else if (speed > 0) {
            hit = (speed + sqrt(discriminant)) / -acceleration;
        } else if (gap > 0) {
            hit = (gap + gap) / (sqrt(discriminant) - speed);
        }
        return hit < not_before ? not_before : hit;
    }
    if (!(speed + acceleration * not_before < 0)) return never;
    if (gap > 0) {
        const T discriminant = difference_of_products<T>(speed, speed, T(acceleration + acceleration), gap);
        if (!(discriminant > 0)) return never;
        hit = (gap + gap) / (sqrt(discriminant) - speed);
    }
    return hit < not_before ? not_before : hit;
}

/// The times at which the foot of the perpendicular passes an end, in order; where a root is none, +infinity.
template <class T>
class FootCrossings {
 public:
    FootCrossings(const T& place, const T& rate, const T& acceleration, const T& length_squared)
        : place_(place),
          rate_(rate),
          half_acceleration_(acceleration / T(2)),
          length_squared_(length_squared) {
        times_.fill(std::numeric_limits<T>::infinity());
        add_roots(place_);
        add_roots(T(place_ - length_squared_));
    }

    /// The first crossing after `t`.
    [[nodiscard]] T next(const T& t) const {
        for (int i = 0; i < count_; ++i) {
            if (times_[i] > t) return times_[i];
        }
        return std::numeric_limits<T>::infinity();
    }

    /// The feature below the centre between two crossings.
    [[nodiscard]] WallFeature feature_between(const T& from, const T& to) const {
        const T never = std::numeric_limits<T>::infinity();
        const T t = to < never ? T(from + (to - from) / T(2)) : T(from + from + unit_time());
        const T foot = place_ + t * (rate_ + t * half_acceleration_);
        if (foot < 0) return WallFeature::kFrom;
        return foot > length_squared_ ? WallFeature::kTo : WallFeature::kFace;
    }

 private:
    /// A time in which the foot goes some way, to look beyond the last crossing.
    [[nodiscard]] T unit_time() const {
        using std::abs;
        using std::sqrt;
        if (half_acceleration_ != 0)
            return abs(rate_ / half_acceleration_) + sqrt(T(length_squared_ / abs(half_acceleration_)));
        return rate_ != 0 ? T(length_squared_ / abs(rate_)) : T(0);
    }

    void add_roots(const T& c) {
        using std::sqrt;
        const T& a = half_acceleration_;
        if (a == 0) {
            if (rate_ != 0) add(T(-c / rate_));
            return;
        }
        const T discriminant = difference_of_products<T>(rate_, rate_, T(T(4) * a), c);
        if (!(discriminant > 0)) return;  // none, or a touch that does not leave the part
        const T half = rate_ < 0 ? T(rate_ - sqrt(discriminant)) : T(rate_ + sqrt(discriminant));
        add(T(half / (T(-2) * a)));
        add(T(T(-2) * c / half));
    }

    void add(const T& t) {
        if (!(t > 0)) return;
        int i = count_++;
        for (; i > 0 && times_[i - 1] > t; --i) times_[i] = times_[i - 1];
        times_[i] = t;
    }

    T place_, rate_, half_acceleration_, length_squared_;
    std::array<T, 4> times_;
    int count_ = 0;
};

/// The disc's edge above an endless line: gap + speed t + acceleration t^2 / 2.
template <class T>
struct LineApproach {
    T gap, speed, acceleration;

    /// Seen from the side that the centre is on at time `t`; on the line itself, from the side that it goes
    /// to.
    LineApproach(const Motion<T>& centre, const T& radius, const Vector2<T>& from, const Vector2<T>& to,
                 const T& t) {
        const Vector2<T> normal = face_normal<T>(from, to);
        const T height = dot<T>(normal, Vector2<T>(centre.position - from));
        speed = dot<T>(normal, centre.velocity);
        acceleration = dot<T>(normal, centre.acceleration);
        const T then = coordinate_at<T>(height, speed, acceleration, t);
        const T rate = speed + acceleration * t;
        const bool left = then != 0 ? then > 0 : (rate != 0 ? rate > 0 : acceleration > 0);
        gap = (left ? height : T(-height)) - radius;
        if (!left) {
            speed = -speed;
            acceleration = -acceleration;
        }
    }
};

/// The first hit of an end's f at or after `not_before`.
template <class T>
[[nodiscard]] inline T end_time_from(const Motion<T>& centre, const T& radius, const Vector2<T>& end,
                                     const T& not_before) {
    const Vector2<T> offset = centre.position - end;
    const Vector2<T>& a = centre.acceleration;
    if (a.x() == 0 && a.y() == 0) return disc_time_from<T>(offset, centre.velocity, radius, not_before);
    return disc_time_from<T>(offset, centre.velocity, a, radius, not_before);
}

/// The first hit of one feature's f at or after `not_before`, as if the feature were all there is (the face
/// an endless line).
template <class T>
[[nodiscard]] inline T feature_time_from(const Motion<T>& centre, const T& radius, const Vector2<T>& from,
                                         const Vector2<T>& to, WallFeature feature, const T& not_before) {
    if (feature == WallFeature::kFrom) return end_time_from<T>(centre, radius, from, not_before);
    if (feature == WallFeature::kTo) return end_time_from<T>(centre, radius, to, not_before);
    const LineApproach<T> line(centre, radius, from, to, not_before);
    return side_time_from<T>(line.gap, line.speed, line.acceleration, not_before);
}

}  // namespace detail

/// The first t >= 0 at which gap + speed t + acceleration t^2 / 2 is <= 0 and falls; +infinity when there is
/// none. For the domain's sides: `gap` from the disc's edge to the side, `speed` away from it.
///
/// Any one set of units; finite arguments. 0 when gap <= 0 and it falls now; a gap <= 0 that rises first
/// falls at its turning point or, where it is > 0 there, at its later root. Rest without acceleration never
/// falls. Relative error a few 1e-16 away from a graze. Pure.
template <class T>
[[nodiscard]] inline T side_time_of_impact(const T& gap, const T& speed, const T& acceleration) {
    return detail::side_time_from<T>(gap, speed, acceleration, T(0));
}

/// The first impact of a disc under constant acceleration on the segment from - to, at or after time 0, and
/// the part that is hit.
///
/// Any one set of units; finite arguments, radius >= 0. A wall without a length is a point. Time 0 when the
/// disc touches or overlaps the wall and approaches; a contact that opens or slides along the face is none.
/// Sides of the face: where the centre is; a centre on the line itself goes to the side it moves to. Pure.
template <class T>
[[nodiscard]] inline WallHit<T> wall_time_of_impact(const Motion<T>& centre, const T& radius,
                                                    const Vector2<T>& from, const Vector2<T>& to) {
    const T never = std::numeric_limits<T>::infinity();
    const Vector2<T> along = to - from;
    const Vector2<T> offset = centre.position - from;
    const T length_squared = dot<T>(along, along);
    if (!(length_squared > 0)) {
        const T t = detail::feature_time_from<T>(centre, radius, from, to, WallFeature::kFrom, T(0));
        return {t, t < never ? WallFeature::kFrom : WallFeature::kFace};
    }
    // Who stays clear of the endless line stays clear of the wall.
    const detail::LineApproach<T> line(centre, radius, from, to, T(0));
    if (line.gap > 0 && !(side_time_of_impact<T>(line.gap, line.speed, line.acceleration) < never))
        return {never, WallFeature::kFace};

    const detail::FootCrossings<T> crossings(dot<T>(along, offset), dot<T>(along, centre.velocity),
                                             dot<T>(along, centre.acceleration), length_squared);
    for (T begin(0); begin < never;) {
        const T end = crossings.next(begin);
        const WallFeature feature = crossings.feature_between(begin, end);
        const T t = detail::feature_time_from<T>(centre, radius, from, to, feature, begin);
        if (t < never && t <= end) return {t, feature};
        begin = end;
    }
    return {never, WallFeature::kFace};
}

/// The same on a scene's wall.
[[nodiscard]] inline WallHit<double> wall_time_of_impact(const Motion<double>& centre, double radius,
                                                         const Wall& wall) {
    return wall_time_of_impact<double>(centre, radius, wall.from, wall.to);
}

}  // namespace carom
