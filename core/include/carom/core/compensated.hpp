// Sums and products that keep what rounding would drop. Two numbers near contact differ by less than one
// rounding of their squares; these functions carry the lost half along. Methods: Dekker 1971 and Knuth
// (error-free transformations), Kahan (difference of products).
#pragma once

#include <cmath>
#include <type_traits>

#include <carom/core/vector.hpp>

namespace carom {

/// An unevaluated sum high + low with |low| at most about half an ulp of high.
template <class T>
struct Twofold {
    T high;
    T low;
};

/// a b + c in one rounding for the built-in types; a scalar of many digits rounds twice, and has the digits
/// for it.
template <class T>
[[nodiscard]] inline T fused_multiply_add(const T& a, const T& b, const T& c) {
    if constexpr (std::is_floating_point_v<T>) {
        return std::fma(a, b, c);
    } else {
        return a * b + c;
    }
}

/// a b exactly. For a scalar of many digits low is 0.
template <class T>
[[nodiscard]] inline Twofold<T> two_product(const T& a, const T& b) {
    const T product = a * b;
    if constexpr (std::is_floating_point_v<T>) {
        return {product, std::fma(a, b, -product)};
    } else {
        return {product, T(0)};
    }
}

/// a + b exactly. For a scalar of many digits low is 0.
template <class T>
[[nodiscard]] inline Twofold<T> two_sum(const T& a, const T& b) {
    const T sum = a + b;
    if constexpr (std::is_floating_point_v<T>) {
        const T b_rounded = sum - a;
        const T a_rounded = sum - b_rounded;
        return {sum, (a - a_rounded) + (b - b_rounded)};
    } else {
        return {sum, T(0)};
    }
}

/// a b of two twofold numbers, to a few eps^2.
template <class T>
[[nodiscard]] inline Twofold<T> twofold_product(const Twofold<T>& a, const Twofold<T>& b) {
    const Twofold<T> product = two_product<T>(a.high, b.high);
    return {product.high, product.low + (a.high * b.low + a.low * b.high)};
}

/// a / b of two twofold numbers, to a few eps^2.
template <class T>
[[nodiscard]] inline Twofold<T> twofold_quotient(const Twofold<T>& a, const Twofold<T>& b) {
    const T quotient = a.high / b.high;
    const T rest = fused_multiply_add<T>(-quotient, b.high, a.high) + (a.low - quotient * b.low);
    return {quotient, rest / b.high};
}

/// |r|^2 in twice the digits.
template <class T>
[[nodiscard]] inline Twofold<T> length_squared_twofold(const Vector2<T>& r) {
    const Twofold<T> xx = two_product<T>(r.x(), r.x());
    const Twofold<T> yy = two_product<T>(r.y(), r.y());
    const Twofold<T> sum = two_sum<T>(xx.high, yy.high);
    return {sum.high, sum.low + (xx.low + yy.low)};
}

/// a b - c d to within 1.5 ulp, whatever cancels (Jeannerod, Louvet and Muller 2013).
template <class T>
[[nodiscard]] inline T difference_of_products(const T& a, const T& b, const T& c, const T& d) {
    const T cd = c * d;
    const T error = fused_multiply_add<T>(-c, d, cd);
    return fused_multiply_add<T>(a, b, -cd) + error;
}

/// |r|^2 - s^2 for r = (x.high + x.low, y.high + y.low): the error is a few eps^2 s^2, besides one rounding
/// of the result.
template <class T>
[[nodiscard]] inline T gap_squared(const Twofold<T>& x, const Twofold<T>& y, const T& s) {
    const Twofold<T> xx = two_product<T>(x.high, x.high);
    const Twofold<T> yy = two_product<T>(y.high, y.high);
    const Twofold<T> ss = two_product<T>(s, s);
    const Twofold<T> sum = two_sum<T>(xx.high, yy.high);
    const Twofold<T> gap = two_sum<T>(sum.high, -ss.high);
    const T low = (gap.low + sum.low) + ((xx.low + yy.low) - ss.low);
    const T mixed = T(2) * (x.high * x.low + y.high * y.low);
    return gap.high + (low + mixed);
}

/// |r|^2 - s^2: negative where two bodies at offset r with radii's sum s overlap. The error is a few eps^2
/// s^2, besides one rounding of the result, so that its sign is right down to gaps of 1e-31 s.
template <class T>
[[nodiscard]] inline T gap_squared(const Vector2<T>& r, const T& s) {
    const Twofold<T> xx = two_product<T>(r.x(), r.x());
    const Twofold<T> yy = two_product<T>(r.y(), r.y());
    const Twofold<T> ss = two_product<T>(s, s);
    const Twofold<T> sum = two_sum<T>(xx.high, yy.high);
    const Twofold<T> gap = two_sum<T>(sum.high, -ss.high);
    return gap.high + ((gap.low + sum.low) + ((xx.low + yy.low) - ss.low));
}

}  // namespace carom
