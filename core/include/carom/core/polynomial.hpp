// Where a cubic is negative: the stretches in which a squared distance falls. Serves the time of impact under
// acceleration.
#pragma once

#include <cmath>
#include <limits>

#include <carom/core/compensated.hpp>

namespace carom {

/// c0 + c1 t + c2 t^2 + c3 t^3
template <class T>
struct Cubic {
    T c0, c1, c2, c3;

    [[nodiscard]] T operator()(const T& t) const { return ((c3 * t + c2) * t + c1) * t + c0; }
    [[nodiscard]] T slope(const T& t) const { return (T(3) * c3 * t + T(2) * c2) * t + c1; }
};

namespace detail {

/// The root in [low, high], where `g` is monotone, by Newton's steps from `t`; a step that leaves the bracket
/// is replaced by a bisection.
template <class T>
[[nodiscard]] inline T monotone_root(const Cubic<T>& g, T low, T high, bool rising, T t) {
    using std::abs;
    const T unit = std::numeric_limits<T>::epsilon();
    const int max_steps = 2 * std::numeric_limits<T>::digits;
    for (int i = 0; i < max_steps; ++i) {
        const T value = g(t);
        if (value == 0) return t;
        ((value < 0) == rising ? low : high) = t;
        T next = t - value / g.slope(t);
        if (!(next >= low && next <= high)) next = low + (high - low) / T(2);
        if (abs(next - t) <= unit * abs(next)) return next;
        t = next;
    }
    return t;
}

/// A power of two above the cube root of x > 0, at most twice that root.
template <class T>
[[nodiscard]] inline T above_cube_root(const T& x) {
    using std::frexp;
    using std::ldexp;
    int exponent = 0;
    (void)frexp(x, &exponent);
    return ldexp(T(1), exponent > 0 ? (exponent + 2) / 3 : exponent / 3);
}

/// The root beyond `start` of a `g` that rises and is convex from there on; g(start) < 0. Each term of the
/// expansion at `start` alone bounds the root from above, and from above Newton's steps descend to it.
template <class T>
[[nodiscard]] inline T last_root(const Cubic<T>& g, const T& start) {
    using std::sqrt;
    const T depth = -g(start);
    if (!(depth > 0)) return start;
    const T first = g.slope(start);
    const T second = g.c2 + T(3) * g.c3 * start;
    T reach = above_cube_root<T>(T(depth / g.c3));
    if (first > 0 && depth < first * reach) reach = depth / first;
    if (second > 0 && depth < second * reach * reach) reach = sqrt(T(depth / second));
    const T high = start + reach;
    return monotone_root<T>(g, start, high, true, high);
}

/// As visit_negative_stretches, for a `g` that rises for all t >= 0.
template <class T, class Visitor>
inline void visit_rising(const Cubic<T>& g, Visitor&& visit) {
    if (!(g.c0 < 0)) return;
    const T inflection = -g.c2 / (T(3) * g.c3);
    if (!(inflection > 0)) {
        visit(T(0), last_root<T>(g, T(0)));
    } else if (g(inflection) < 0) {
        visit(T(0), last_root<T>(g, inflection));
    } else {
        visit(T(0), monotone_root<T>(g, T(0), inflection, true, T(0)));
    }
}

}  // namespace detail

/// Calls visit(from, to) for each stretch of t >= 0 in which `g` is negative, in order, until it returns
/// true; at most two. Stretches are open, g < 0 inside. Precondition: g.c3 > 0. Each end has the error of a
/// root of a cubic with rounded coefficients.
template <class T, class Visitor>
inline void visit_negative_stretches(const Cubic<T>& g, Visitor&& visit) {
    using std::sqrt;
    if (g.c0 >= 0 && g.c1 >= 0 && g.c2 >= 0) return;
    const T three_c3 = T(3) * g.c3;
    const T discriminant = difference_of_products<T>(g.c2, g.c2, three_c3, g.c1);
    if (!(discriminant > 0)) return detail::visit_rising<T>(g, visit);

    // The turning points: g rises to `top`, falls to `bottom`, rises from there.
    const T half = g.c2 < 0 ? T(sqrt(discriminant) - g.c2) : T(-sqrt(discriminant) - g.c2);
    const T one = half / three_c3;
    const T other = g.c1 / half;
    const T top = one < other ? one : other;
    const T bottom = one < other ? other : one;
    if (!(bottom > 0)) return detail::visit_rising<T>(g, visit);

    const bool starts_negative = g.c0 < 0 || (g.c0 == 0 && !(top > 0));
    if (starts_negative && (!(top > 0) || g(top) <= 0)) {
        visit(T(0), detail::last_root<T>(g, bottom));
        return;
    }
    if (starts_negative && visit(T(0), detail::monotone_root<T>(g, T(0), top, true, T(0)))) return;
    if (!(g(bottom) < 0)) return;
    const T high = top > 0 ? top : T(0);
    const T fall = detail::monotone_root<T>(g, high, bottom, false, T(high + (bottom - high) / T(2)));
    visit(fall, detail::last_root<T>(g, bottom));
}

}  // namespace carom
