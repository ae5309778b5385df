// Motion under constant acceleration, the only motion there is between two events.
#pragma once

#include <carom/core/vector.hpp>

namespace carom {

/// Where a body is at its time 0 and how it goes on: x(t) = x + v t + a t^2 / 2.
template <class T>
struct Motion {
    Vector2<T> position = Vector2<T>::Zero();
    Vector2<T> velocity = Vector2<T>::Zero();
    Vector2<T> acceleration = Vector2<T>::Zero();
};

/// One coordinate after `t`: (a t / 2 + v) t + x, so that a = 0 gives the bits of v t + x.
template <class T>
[[nodiscard]] inline T coordinate_at(const T& x, const T& v, const T& a, const T& t) {
    return x + t * (v + t * (a / 2));
}

template <class T>
[[nodiscard]] inline Vector2<T> position_at(const Motion<T>& m, const T& t) {
    return {coordinate_at<T>(m.position.x(), m.velocity.x(), m.acceleration.x(), t),
            coordinate_at<T>(m.position.y(), m.velocity.y(), m.acceleration.y(), t)};
}

template <class T>
[[nodiscard]] inline Vector2<T> velocity_at(const Motion<T>& m, const T& t) {
    return {m.velocity.x() + t * m.acceleration.x(), m.velocity.y() + t * m.acceleration.y()};
}

}  // namespace carom
