// The first fall through zero of a polynomial in Quad, with proof: its coefficients in Bernstein's basis on
// an interval bound it there, and one change of their signs means one root (Descartes; Lane and Riesenfeld
// 1981). What rounding leaves open is said to be open, and goes to exact fractions.
#pragma once

#include <array>

#include <carom/core/vector.hpp>

#include "accuracy/quad.hpp"

namespace carom::accuracy {

/// A sum of products with the size of what it was summed from.
struct Sum {
    Quad value = 0;
    Wide size = 0;

    void add(Quad a, Quad b) {
        value += a * b;
        size += std::abs(static_cast<Wide>(a) * static_cast<Wide>(b));
    }
    [[nodiscard]] bool surely_positive(Wide units) const {
        return static_cast<Wide>(value) > units * kQuadUnit * size;
    }
    [[nodiscard]] bool surely_negative(Wide units) const {
        return static_cast<Wide>(value) < -units * kQuadUnit * size;
    }
};

inline Sum product_sum(const Vec2& a, const Vec2& b) {
    Sum sum;
    sum.add(a.x(), b.x());
    sum.add(a.y(), b.y());
    return sum;
}

/// Up to degree 4, from the constant up, in the digits of T.
template <class T>
struct Polynomial {
    int degree = 0;
    std::array<T, 5> c{};

    [[nodiscard]] T value(T t) const {
        T sum = 0;
        for (int i = degree; i >= 0; --i) sum = sum * t + c[static_cast<std::size_t>(i)];
        return sum;
    }
    [[nodiscard]] T slope(T t) const {
        T sum = 0;
        for (int i = degree; i > 0; --i) sum = sum * t + T(i) * c[static_cast<std::size_t>(i)];
        return sum;
    }
};

/// `size` bounds the terms that each coefficient is the sum of, at most six of them, each of a few roundings:
/// a coefficient errs by less than 8 kQuadUnit of its size.
struct QuadPolynomial : Polynomial<Quad> {
    std::array<Wide, 5> size{};

    /// Bound of the error of a value, or of a coefficient in Bernstein's basis, within [0, t]; computed in
    /// numbers of which half an ulp of 1 is `unit`.
    [[nodiscard]] Wide error(Wide t, Wide unit = kQuadUnit) const;
    /// 1, -1, or 0 where rounding hides it.
    [[nodiscard]] int sign_at(Wide t) const;
    /// The same coefficients with 64 bits.
    [[nodiscard]] Polynomial<Wide> rounded() const;
};

/// |r + v t + a t^2 / 2|^2 - s^2
QuadPolynomial gap_polynomial(Quad rx, Quad ry, const Vec2& v, const Vec2& a, Quad s);

QuadPolynomial derivative(const QuadPolynomial& p);

enum class Verdict { kMiss, kHit, kUndecided };

struct QuadRoot {
    Verdict verdict;
    Quad time;
};

/// The first t > from at which p goes from above 0 to below. Precondition: p > 0 just after `from`, surely.
QuadRoot first_fall(const QuadPolynomial& p, Wide from);

}  // namespace carom::accuracy
