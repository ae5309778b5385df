// Vectors of the plane. Products are written out by component, so that no build fuses or reorders them.
#pragma once

#include <Eigen/Core>

namespace carom {

/// A vector of the plane over any scalar; the tests instantiate it in 100 digits.
template <class T>
using Vector2 = Eigen::Matrix<T, 2, 1>;

using Vec2 = Vector2<double>;

template <class T>
[[nodiscard]] inline T dot(const Vector2<T>& a, const Vector2<T>& b) {
    return a.x() * b.x() + a.y() * b.y();
}

/// The third component of the cross product: positive where b lies counter-clockwise of a.
template <class T>
[[nodiscard]] inline T cross(const Vector2<T>& a, const Vector2<T>& b) {
    return a.x() * b.y() - a.y() * b.x();
}

template <class T>
[[nodiscard]] inline T length_squared(const Vector2<T>& a) {
    return dot(a, a);
}

}  // namespace carom
