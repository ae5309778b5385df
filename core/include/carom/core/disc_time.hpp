// Time of impact of two discs: a quadratic where they move straight, a quartic where they accelerate
// differently.
//
// Both follow one rule (Bannerman, Strobl, Formella and Poeschel 2014). With f(t) = |x(t)|^2 - s^2, x the
// offset of the centres and s the sum of the radii, the impact is the first t >= 0 at which f <= 0 and f
// falls just after t. So a touch is no impact, a contact that opens is none either, and an overlap that
// rounding left behind ends in neither a locked nor a lost pair.
#pragma once

#include <limits>

#include <carom/core/compensated.hpp>
#include <carom/core/polynomial.hpp>
#include <carom/core/vector.hpp>

namespace carom {

namespace detail {

/// D = s^2 |v|^2 - (r x v)^2 in twice the digits, rounded once: a graze shows its true sign and size.
template <class T>
[[nodiscard]] inline T impact_discriminant(const Vector2<T>& r, const Vector2<T>& v, const T& s) {
    const Twofold<T> left = two_product<T>(r.x(), v.y());
    const Twofold<T> right = two_product<T>(r.y(), v.x());
    const Twofold<T> moment = two_sum<T>(left.high, -right.high);
    const T moment_low = moment.low + (left.low - right.low);
    const T d = gap_squared<T>(two_product<T>(s, v.x()), two_product<T>(s, v.y()), moment.high);
    return d - T(2) * (moment.high * moment_low);
}

}  // namespace detail

/// The first impact of two discs in relative motion r + v t, radii's sum s, at or after time 0; +infinity
/// when there is none.
///
/// Any one set of units. Finite arguments with s >= 0; squares and fourth powers of them must stay in range
/// (1e-70 to 1e70 in double). 0 when they touch or overlap and approach; +infinity when they touch or overlap
/// and do not. Never NaN, never negative. t = c / (-b + sqrt(D)) with c = |r|^2 - s^2 and D = s^2 |v|^2 - (r
/// x v)^2 in twice the digits: the relative error is a few 1e-16 far, near contact and in grazes down to
/// 1e-16 s deep (measured in tests/core/disc_time_test.cpp). The sign of b is that of dot(r, v), so that a
/// response that leaves dot(r, v) >= 0 is believed here. Pure.
template <class T>
[[nodiscard]] inline T disc_time_of_impact(const Vector2<T>& r, const Vector2<T>& v, const T& s) {
    using std::sqrt;
    const T never = std::numeric_limits<T>::infinity();
    const T b = dot<T>(r, v);
    if (!(b < 0)) return never;
    const T c = gap_squared<T>(r, s);
    if (!(c > 0)) return T(0);
    const T discriminant = detail::impact_discriminant<T>(r, v, s);
    if (!(discriminant > 0)) return never;
    return c / (sqrt(discriminant) - b);
}

namespace detail {

/// Offset, its rate and f = |x|^2 - s^2 at one time of an accelerated relative motion.
template <class T>
struct DiscState {
    T f;  ///< in twice the digits, rounded once
    T g;  ///< f' / 2 = x . x'
    T k;  ///< f'' / 2 = x' . x' + x . a
};

template <class T>
[[nodiscard]] inline Twofold<T> coordinate_twofold(const T& x, const T& v, const T& half_a, const T& t) {
    const Twofold<T> at = two_product<T>(t, half_a);
    const Twofold<T> rate = two_sum<T>(v, at.high);
    const Twofold<T> path = two_product<T>(t, rate.high);
    const Twofold<T> place = two_sum<T>(x, path.high);
    return {place.high, place.low + fused_multiply_add<T>(t, at.low + rate.low, path.low)};
}

/// A relative motion with acceleration, its critical polynomial, and the steps of the search for its impact.
template <class T>
class DiscQuartic {
 public:
    DiscQuartic(const Vector2<T>& r, const Vector2<T>& v, const Vector2<T>& a, const T& s)
        : r_(r), v_(v), a_(a), half_a_(a / T(2)), s_(s) {}

    /// f'/2 = x . x' as a cubic in t.
    [[nodiscard]] Cubic<T> slope() const {
        const T three_halves = T(3) / T(2);
        return {dot<T>(r_, v_), length_squared<T>(v_) + dot<T>(r_, a_), three_halves * dot<T>(v_, a_),
                length_squared<T>(a_) / T(2)};
    }

    /// True when the motion across the acceleration, which is straight, keeps the discs apart for ever.
    [[nodiscard]] bool passes_by() const {
        const T across = difference_of_products<T>(r_.x(), a_.y(), r_.y(), a_.x());
        const T drift = difference_of_products<T>(v_.x(), a_.y(), v_.y(), a_.x());
        const T safe = T(1) - T(32) * std::numeric_limits<T>::epsilon();
        return !(across * drift < 0) && across * across * safe > s_ * s_ * length_squared<T>(a_);
    }

    [[nodiscard]] T gap_at(const T& t) const {
        return gap_squared<T>(coordinate_twofold<T>(r_.x(), v_.x(), half_a_.x(), t),
                              coordinate_twofold<T>(r_.y(), v_.y(), half_a_.y(), t), s_);
    }

    [[nodiscard]] DiscState<T> state_at(const T& t) const {
        const Twofold<T> x = coordinate_twofold<T>(r_.x(), v_.x(), half_a_.x(), t);
        const Twofold<T> y = coordinate_twofold<T>(r_.y(), v_.y(), half_a_.y(), t);
        const Vector2<T> place(x.high, y.high);
        const Vector2<T> rate(v_.x() + t * a_.x(), v_.y() + t * a_.y());
        return {gap_squared<T>(x, y, s_), dot<T>(place, rate), length_squared<T>(rate) + dot<T>(place, a_)};
    }

    /// The root of f between `low`, where f > 0, and `high`, where f < 0; f falls in between. Steps along the
    /// parabola that f osculates (exact without acceleration, of third order with), bisects where that leaves
    /// the bracket.
    [[nodiscard]] T falling_root(T low, T high) const {
        using std::abs;
        using std::sqrt;
        const T unit = std::numeric_limits<T>::epsilon() / T(2);
        T t = low;
        for (int i = 0; i < kMaxSteps; ++i) {
            const DiscState<T> now = state_at(t);
            if (now.f == 0) return t;
            (now.f > 0 ? low : high) = t;
            const T discriminant = now.g * now.g - now.k * now.f;
            const T step = now.f / (discriminant > 0 ? T(sqrt(discriminant) - now.g) : T(T(-2) * now.g));
            T next = t + step;
            const bool slow = i > kFreeSteps && i % 2 == 1;
            if (slow || !(next > low && next < high)) {
                if (abs(step) <= unit * t) return t;
                next = low + (high - low) / T(2);
                if (!(next > low && next < high)) return high;
            }
            if (abs(next - t) <= unit * t) return next;
            t = next;
        }
        return t;
    }

 private:
    static constexpr int kFreeSteps = 8;
    static constexpr int kMaxSteps = 4 * std::numeric_limits<T>::digits;

    Vector2<T> r_, v_, a_, half_a_;
    T s_;
};

/// The first t >= not_before at which f <= 0 and falls, a == 0.
template <class T>
[[nodiscard]] inline T disc_time_from(const Vector2<T>& r, const Vector2<T>& v, const T& s,
                                      const T& not_before) {
    const T t = disc_time_of_impact<T>(r, v, s);
    if (!(t < not_before)) return t;
    const bool falling = dot<T>(r, v) + length_squared<T>(v) * not_before < 0;
    return falling ? not_before : std::numeric_limits<T>::infinity();
}

/// The first t >= not_before at which f <= 0 and falls.
template <class T>
[[nodiscard]] inline T disc_time_from(const Vector2<T>& r, const Vector2<T>& v, const Vector2<T>& a,
                                      const T& s, const T& not_before) {
    const DiscQuartic<T> quartic(r, v, a, s);
    const Cubic<T> slope = quartic.slope();
    // No acceleration, or one whose square underflows.
    if (!(slope.c3 > std::numeric_limits<T>::min() / std::numeric_limits<T>::epsilon())) {
        return disc_time_from<T>(r, v, s, not_before);
    }
    T impact = std::numeric_limits<T>::infinity();
    if (quartic.passes_by()) return impact;
    visit_negative_stretches<T>(slope, [&](const T& from, const T& to) {
        if (!(to > not_before)) return false;
        const T start = from < not_before ? not_before : from;
        if (quartic.gap_at(start) <= 0) {
            impact = start;
        } else if (quartic.gap_at(to) < 0) {
            impact = quartic.falling_root(start, to);
        } else {
            return false;
        }
        return true;
    });
    return impact;
}

}  // namespace detail

/// The first impact of two discs in relative motion r + v t + a t^2 / 2, radii's sum s, at or after time 0;
/// +infinity when there is none.
///
/// Units, preconditions and rule as without acceleration; a == 0 gives the same bits, and a small `a` joins
/// it to rounding. f has at most two falling stretches, between the roots of its cubic derivative; in each
/// the root is bracketed and refined on f itself, evaluated from r, v, a in twice the digits: an error of
/// about one ulp away from a graze, and no root lost that is deeper than 1e-20 s. An acceleration below about
/// 1e-146 (its square underflows) counts as none. Pure.
template <class T>
[[nodiscard]] inline T disc_time_of_impact(const Vector2<T>& r, const Vector2<T>& v, const Vector2<T>& a,
                                           const T& s) {
    if (a.x() == 0 && a.y() == 0) return disc_time_of_impact<T>(r, v, s);
    return detail::disc_time_from<T>(r, v, a, s, T(0));
}

/// The same, or +infinity when the impact comes after `duration`; cheap when the discs cannot reach each
/// other by then.
template <class T>
[[nodiscard]] inline T disc_time_of_impact(const Vector2<T>& r, const Vector2<T>& v, const Vector2<T>& a,
                                           const T& s, const T& duration) {
    using std::abs;
    const T half_square = duration * duration / T(2);
    const T safe = T(1) + T(16) * std::numeric_limits<T>::epsilon();
    const T reach_x = safe * (s + abs(v.x()) * duration + abs(a.x()) * half_square);
    const T reach_y = safe * (s + abs(v.y()) * duration + abs(a.y()) * half_square);
    if (abs(r.x()) > reach_x || abs(r.y()) > reach_y) return std::numeric_limits<T>::infinity();
    const T t = disc_time_of_impact<T>(r, v, a, s);
    return t <= duration ? t : std::numeric_limits<T>::infinity();
}

}  // namespace carom
