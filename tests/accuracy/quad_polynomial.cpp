#include "accuracy/quad_polynomial.hpp"

#include <algorithm>
#include <vector>

namespace carom::accuracy {
namespace {

constexpr int kMaxIntervals = 400;
constexpr std::array<std::array<int, 5>, 5> kChoose = {
    {{1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}}};

template <class T>
using Bernstein = std::array<T, 5>;

Wide wide(Quad x) {
    return static_cast<Wide>(x);
}

/// The coefficients on [low, high]: shifted to low, scaled to the length, and summed.
template <class T>
Bernstein<T> bernstein(const Polynomial<T>& p, Wide low, Wide high) {
    Bernstein<T> shifted = p.c;
    const auto n = static_cast<std::size_t>(p.degree);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = n; j > i; --j) shifted[j - 1] += shifted[j] * T(low);
    }
    T power = 1;
    for (std::size_t j = 1; j <= n; ++j) {
        power *= T(high) - T(low);
        shifted[j] *= power / T(kChoose[n][j]);
    }
    Bernstein<T> b{};
    for (std::size_t i = 0; i <= n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) b[i] += shifted[j] * T(kChoose[i][j]);
    }
    return b;
}

/// A power of two that is at least the k-th root of x >= 0, and at most four times that.
Wide root_above(Wide x, std::size_t k) {
    if (x == 0 || !std::isfinite(x)) return x;
    const int over = std::ilogb(x) + 1;
    const int n = static_cast<int>(k);
    return std::ldexp(Wide(1), over / n + (over % n > 0 ? 1 : 0));
}

/// All positive roots lie in (low, high), by Fujiwara's bound on p and on p reversed.
struct RootBounds {
    Wide low, high;
};

RootBounds root_bounds(const QuadPolynomial& p) {
    const auto n = static_cast<std::size_t>(p.degree);
    const auto size = [&](std::size_t i) { return std::abs(wide(p.c[i])) + 8 * kQuadUnit * p.size[i]; };
    Wide high = 0;
    Wide low = 0;
    for (std::size_t i = 0; i < n; ++i) high = std::max(high, root_above(size(i) / size(n), n - i));
    for (std::size_t i = 1; i <= n; ++i) low = std::max(low, root_above(size(i) / size(0), i));
    return {low > 0 ? Wide(0.499) / low : Wide(0), Wide(2.001) * high};
}

/// Changes of sign, or -1 where a sign is open.
template <class T>
int changes(const Bernstein<T>& b, int degree, Wide error) {
    int count = 0;
    for (int i = 0; i <= degree; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!(std::abs(static_cast<Wide>(b[k])) > error)) return -1;
        if (i > 0 && (b[k] > 0) != (b[k - 1] > 0)) ++count;
    }
    return count;
}

bool surely_convex(const Bernstein<Quad>& b, int degree, Wide error) {
    for (std::size_t i = 0; i + 2 <= static_cast<std::size_t>(degree); ++i) {
        if (!(wide(b[i] - 2 * b[i + 1] + b[i + 2]) > 4 * error)) return false;
    }
    return true;
}

struct Interval {
    Wide low, high;
};

/// The one root in an interval of a polynomial that falls there, or rises: Newton's steps inside a bracket,
/// in 64 bits as far as those go.
template <class T>
T refine(const Polynomial<T>& p, bool falls, T a, T b, T t, Wide tolerance) {
    for (int i = 0; i < 400; ++i) {
        const T value = p.value(t);
        if (value == 0) return t;
        ((value > 0) == falls ? a : b) = t;
        T next = t - value / p.slope(t);
        if (!(next > a && next < b) || i % 16 == 15) next = (a + b) / 2;
        if (std::abs(static_cast<Wide>(next - t)) <= tolerance * static_cast<Wide>(t)) return next;
        t = next;
    }
    return t;
}

Quad refine(const Polynomial<Quad>& p, const Polynomial<Wide>& rounded, bool falls, const Interval& in) {
    const Wide middle = in.low + (in.high - in.low) / 2;
    const Wide near = refine<Wide>(rounded, falls, in.low, in.high, middle, Wide(0x1p-58));
    return refine<Quad>(p, falls, in.low, in.high, near, Wide(0x1p-112));
}

}  // namespace

// 8 units from the coefficients; at most 4 shifts, 8 products and 4 sums after. Doubled once more for the
// roundings of this bound.
Wide QuadPolynomial::error(Wide t, Wide unit) const {
    Wide sum = 0;
    for (int i = degree; i >= 0; --i) sum = sum * t + size[static_cast<std::size_t>(i)];
    return 48 * unit * sum;
}

int QuadPolynomial::sign_at(Wide t) const {
    const Wide found = wide(value(t));
    if (std::abs(found) > error(t)) return found > 0 ? 1 : -1;
    return 0;
}

Polynomial<Wide> QuadPolynomial::rounded() const {
    Polynomial<Wide> p;
    p.degree = degree;
    std::ranges::transform(c, p.c.begin(), wide);
    return p;
}

QuadPolynomial gap_polynomial(Quad rx, Quad ry, const Vec2& v, const Vec2& a, Quad s) {
    QuadPolynomial p;
    const auto set = [&](std::size_t i, const Sum& sum, double factor) {
        p.c[i] = sum.value * Quad(factor);
        p.size[i] = sum.size * Wide(factor);
        if (sum.value != 0) p.degree = static_cast<int>(i);
    };
    Sum gap;
    gap.add(rx, rx);
    gap.add(ry, ry);
    gap.add(s, -s);
    Sum first;
    first.add(rx, v.x());
    first.add(ry, v.y());
    Sum second = product_sum(v, v);
    second.add(rx, a.x());
    second.add(ry, a.y());
    set(0, gap, 1);
    set(1, first, 2);
    set(2, second, 1);
    set(3, product_sum(v, a), 1);
    set(4, product_sum(a, a), 0.25);
    return p;
}

QuadPolynomial derivative(const QuadPolynomial& p) {
    QuadPolynomial d;
    d.degree = p.degree > 0 ? p.degree - 1 : 0;
    for (int i = 1; i <= p.degree; ++i) {
        const auto k = static_cast<std::size_t>(i);
        d.c[k - 1] = Quad(i) * p.c[k];
        d.size[k - 1] = Wide(i) * p.size[k];
    }
    return d;
}

QuadRoot first_fall(const QuadPolynomial& p, Wide from) {
    if (p.degree == 0) return {Verdict::kMiss, 0};
    const RootBounds bounds = root_bounds(p);
    const QuadPolynomial slope = derivative(p);
    const Polynomial<Wide> rounded = p.rounded();
    std::vector<Interval> open;
    const Wide start = std::max(from, bounds.low);
    if (start < bounds.high) open.push_back({start, bounds.high});
    for (int i = 0; !open.empty(); ++i) {
        if (i > kMaxIntervals) return {Verdict::kUndecided, 0};
        const auto [low, high] = open.back();
        open.pop_back();
        const Wide error = p.error(high);
        Bernstein<Quad> b{};
        int roots = changes(bernstein(rounded, low, high), p.degree, p.error(high, kWideUnit));
        if (roots != 0 && roots != 1) {  // 64 bits do not tell, or there is more to see
            b = bernstein<Quad>(p, low, high);
            roots = changes(b, p.degree, error);
        }
        if (roots == 0) continue;
        if (roots == 1) return {Verdict::kHit, refine(p, rounded, true, {low, high})};
        Wide middle = high > 4 * low ? std::sqrt(low * high) : low + (high - low) / 2;
        const auto last = static_cast<std::size_t>(p.degree);
        if (wide(b[0]) > 16 * error && wide(b[last]) > 16 * error && surely_convex(b, p.degree, error)) {
            if (wide(b[1]) >= wide(b[0]) || wide(b[last - 1]) >= wide(b[last])) continue;  // lowest at an end
            const Wide bottom = wide(refine(slope, slope.rounded(), false, {low, high}));
            const Wide least = wide(p.value(bottom));
            const Wide tilt = std::abs(wide(slope.value(bottom))) + slope.error(bottom);
            if (least > p.error(bottom) + tilt * (high - low)) continue;
            if (least < -p.error(bottom)) {
                middle = bottom;
            } else {
                // The tilt of the tangent is rounding's, and leads below 0 far away: look nearby.
                const Wide near = bottom * Wide(0x1p-12);
                if (!(bottom - near > low && bottom + near < high)) return {Verdict::kUndecided, 0};
                open.push_back({bottom + near, high});
                open.push_back({bottom - near, bottom + near});
                open.push_back({low, bottom - near});
                continue;
            }
        }
        if (!(middle > low && middle < high)) return {Verdict::kUndecided, 0};
        open.push_back({middle, high});
        open.push_back({low, middle});
    }
    return {Verdict::kMiss, 0};
}

}  // namespace carom::accuracy
