// What a collision does to the velocities.
//
// The impulse acts along the centre line, unnormalised: dv = -(1 + e) (dv . dr / dr . dr) dr. A normalised
// normal makes the energy of an elastic gas drift one way; so does a plain division by dr . dr where it
// rounds to 1 (discs of radius 1/2), by 4e-17 of the energy a collision. The factor of the line therefore
// carries twice the digits. With u the velocity components along the line, e the pair's one restitution, the
// article's formulas read, corrected (docs/errata.md):
//   u1' = ((1 + e) m2 u2 + (m1 - e m2) u1) / (m1 + m2)
//   u2' = ((1 + e) m1 u1 + (m2 - e m1) u2) / (m1 + m2)
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <carom/core/compensated.hpp>
#include <carom/core/scene.hpp>
#include <carom/core/vector.hpp>

namespace carom {

/// The one restitution of a pair, from each body's, both in [0, 1]. One number for both: two would break
/// momentum.
template <class T>
[[nodiscard]] inline T pair_restitution(RestitutionRule rule, const T& e_a, const T& e_b) {
    using std::sqrt;
    switch (rule) {
        case RestitutionRule::kMax:
            return e_a < e_b ? e_b : e_a;
        case RestitutionRule::kProduct:
            return e_a * e_b;
        case RestitutionRule::kMean:
            return (e_a + e_b) / T(2);
        case RestitutionRule::kGeometric:
            return e_a == e_b ? e_a : T(sqrt(T(e_a * e_b)));
        case RestitutionRule::kMin:
            break;
    }
    return e_b < e_a ? e_b : e_a;
}

/// The TC model (Luding and McNamara 1998): a collision of a body whose last one is less than `contact_time`
/// ago is elastic. Returns 1 then, else `restitution`.
template <class T>
[[nodiscard]] inline T tc_restitution(const T& restitution, const T& time_since_last_collision,
                                      const T& contact_time) {
    return time_since_last_collision < contact_time ? T(1) : restitution;
}

template <class T>
struct PairVelocities {
    Vector2<T> a, b;
};

namespace detail {

/// The same direction; along an axis the unit vector, which makes the response there exact.
template <class T>
[[nodiscard]] inline Vector2<T> exact_if_axial(const Vector2<T>& direction) {
    if (direction.x() == 0) return {T(0), T((direction.y() > 0) - (direction.y() < 0))};
    if (direction.y() == 0) return {T((direction.x() > 0) - (direction.x() < 0)), T(0)};
    return direction;
}

/// A multiple of the line, each component rounded once.
template <class T>
[[nodiscard]] inline Vector2<T> multiple(const Twofold<T>& factor, const Vector2<T>& line) {
    return {fused_multiply_add<T>(factor.high, line.x(), T(factor.low * line.x())),
            fused_multiply_add<T>(factor.high, line.y(), T(factor.low * line.y()))};
}

/// Velocities are kept as computed.
struct AsComputed {
    template <class T>
    [[nodiscard]] T operator()(const T& velocity) const {
        return velocity;
    }
};

/// Applies a multiple `factor` > 0 of the line by `apply`, which returns the rate of separation afterwards,
/// and raises it by doubling steps from one ulp until that rate is >= 0, and > 0 where `must_part`. Rounding
/// can leave it short by the velocities' ulp, some 2^106 times the ulp of a nearly tangential factor: hence
/// the bound on the loop.
template <class T, class Apply>
inline Twofold<T> apply_until_separating(Twofold<T> factor, bool must_part, Apply&& apply) {
    T extra = factor.high * std::numeric_limits<T>::epsilon();
    for (int i = 0; i < 4 * std::numeric_limits<T>::digits; ++i) {
        const T rate = apply(factor);
        if (rate > 0 || (rate == 0 && !must_part)) break;
        factor.high = factor.high + extra;
        extra = extra + extra;
    }
    return factor;
}

}  // namespace detail

/// The velocities after a collision of bodies a and b with `offset` = centre of a - centre of b (any length >
/// 0).
///
/// Any one set of units. Precondition: masses > 0, restitution in [0, 1], separation_speed >= 0, finite
/// velocities. The speed of separation afterwards is max(restitution * speed of approach, separation_speed);
/// tangential components stay. Returns the velocities unchanged where they part already, and at least at
/// separation_speed, or the offset is zero. One impulse serves both bodies with opposite signs, for mass
/// ratios of 1e-15 to 1e15 too. Afterwards dot(offset, va - vb), which the time of impact looks at, is >= 0
/// in the scalar's own arithmetic, and > 0 where the speed of separation asked for is. `impulse`, where
/// given, gets the length of the impulse (mass * speed). `keep` gives each velocity as the caller will hold
/// it, rounded perhaps; what is promised about afterwards holds for that. Pure.
template <class T, class Keep = detail::AsComputed>
[[nodiscard]] inline PairVelocities<T> collide(const Vector2<T>& va, const Vector2<T>& vb,
                                               const Vector2<T>& offset, const T& mass_a, const T& mass_b,
                                               const T& restitution, const T& separation_speed = T(0),
                                               T* impulse = nullptr, Keep&& keep = {}) {
    using std::sqrt;
    PairVelocities<T> after{va, vb};
    if (impulse != nullptr) *impulse = T(0);
    const Vector2<T> line = detail::exact_if_axial<T>(offset);
    const T rate = dot<T>(line, Vector2<T>(va - vb));
    const Twofold<T> line_squared = length_squared_twofold<T>(line);
    if (!(line_squared.high > 0)) return after;

    const T length = sqrt(line_squared.high);
    if (rate > 0 && rate >= separation_speed * length) return after;
    const T aimed = std::max<T>(T(-restitution * rate), T(separation_speed * length));
    const Twofold<T> reduced_mass =
        twofold_quotient<T>(two_product<T>(mass_a, mass_b), two_sum<T>(mass_a, mass_b));
    const Twofold<T> change = twofold_quotient<T>({T(aimed - rate), T(0)}, line_squared);
    const Twofold<T> start = twofold_product<T>(reduced_mass, change);
    const Twofold<T> factor = detail::apply_until_separating<T>(start, aimed > 0, [&](const Twofold<T>& f) {
        const Vector2<T> shared = detail::multiple<T>(f, line);
        after.a = keep(Vector2<T>(va + shared / mass_a));
        after.b = keep(Vector2<T>(vb - shared / mass_b));
        return dot<T>(offset, Vector2<T>(after.a - after.b));
    });
    if (impulse != nullptr) *impulse = factor.high * length;
    return after;
}

/// The velocity after a bounce off something that does not move: the limit of infinite mass. `normal` points
/// from it to the ball, of any length > 0; see contact_normal() for walls.
///
/// The rest as collide(). Along an axis the normal component is multiplied by -restitution and the other is
/// untouched, to the bit, but for what `keep` does to them.
template <class T, class Keep = detail::AsComputed>
[[nodiscard]] inline Vector2<T> bounce(const Vector2<T>& v, const Vector2<T>& normal, const T& restitution,
                                       const T& separation_speed = T(0), Keep&& keep = {}) {
    using std::sqrt;
    const Vector2<T> line = detail::exact_if_axial<T>(normal);
    const T rate = dot<T>(line, v);
    const Twofold<T> line_squared = length_squared_twofold<T>(line);
    if (!(line_squared.high > 0)) return keep(v);
    const T parting = separation_speed * sqrt(line_squared.high);
    if (rate > 0 && rate >= parting) return keep(v);
    const T aimed = std::max<T>(T(-restitution * rate), parting);
    if (line.x() == 0) return keep(Vector2<T>(v.x(), T(aimed * line.y())));
    if (line.y() == 0) return keep(Vector2<T>(T(aimed * line.x()), v.y()));
    Vector2<T> after = v;
    const Twofold<T> start = twofold_quotient<T>({T(aimed - rate), T(0)}, line_squared);
    detail::apply_until_separating<T>(start, aimed > 0, [&](const Twofold<T>& f) {
        after = keep(Vector2<T>(v + detail::multiple<T>(f, line)));
        return dot<T>(normal, after);
    });
    return after;
}

}  // namespace carom
