#include "accuracy/quad_polynomial.hpp"

#include <algorithm>
#include <vector>

namespace carom::accuracy {
namespace {

constexpr int kMaxIntervals = 400;
constexpr std::array<std::array<int, 5>, 5> kChoose = {
    {{1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}}};

using Bernstein = std::array<Quad, 5>;

Wide wide(Quad x) {
    return static_cast<Wide>(x);
}

/// The coefficients on [low, high]: shifted to low, scaled to the length, and summed.
Bernstein bernstein(const QuadPolynomial& p, Wide low, Wide high) {
    Bernstein shifted = p.c;
    const auto n = static_cast<std::size_t>(p.degree);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = n; j > i; --j) shifted[j - 1] += shifted[j] * Quad(low);
    }
    Quad power = 1;
    for (std::size_t j = 1; j <= n; ++j) {
        power *= Quad(high) - Quad(low);
        shifted[j] *= power;
    }
    Bernstein b{};
    for (std::size_t i = 0; i <= n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) b[i] += shifted[j] * Quad(kChoose[i][j]) / Quad(kChoose[n][j]);
    }
    return b;
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
    for (std::size_t i = 0; i < n; ++i)
        high = std::max(high, std::pow(size(i) / size(n), Wide(1) / Wide(n - i)));
    for (std::size_t i = 1; i <= n; ++i) low = std::max(low, std::pow(size(i) / size(0), Wide(1) / Wide(i)));
    return {low > 0 ? Wide(0.499) / low : Wide(0), Wide(2.001) * high};
}

/// Changes of sign, or -1 where a sign is open.
int changes(const Bernstein& b, int degree, Wide error) {
    int count = 0;
    for (int i = 0; i <= degree; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!(std::abs(wide(b[k])) > error)) return -1;
        if (i > 0 && (b[k] > 0) != (b[k - 1] > 0)) ++count;
    }
    return count;
}

bool surely_convex(const Bernstein& b, int degree, Wide error) {
    for (std::size_t i = 0; i + 2 <= static_cast<std::size_t>(degree); ++i) {
        if (!(wide(b[i] - 2 * b[i + 1] + b[i + 2]) > 4 * error)) return false;
    }
    return true;
}

/// Where p' goes through 0 in [low, high], p convex there: Newton's steps inside a bracket.
Quad lowest(const QuadPolynomial& slope, Wide low, Wide high) {
    Quad a = low;
    Quad b = high;
    Quad t = (a + b) / 2;
    for (int i = 0; i < 200; ++i) {
        const Quad value = slope.value(t);
        (value < 0 ? a : b) = t;
        Quad next = t - value / slope.slope(t);
        if (!(next > a && next < b)) next = (a + b) / 2;
        if (magnitude(next - t) <= Quad(0x1p-100L) * t) return next;
        t = next;
    }
    return t;
}

/// The one root in [low, high], p > 0 at low and < 0 at high.
Quad refine(const QuadPolynomial& p, Wide low, Wide high) {
    Quad a = low;
    Quad b = high;
    Quad t = (a + b) / 2;
    for (int i = 0; i < 400; ++i) {
        const Quad value = p.value(t);
        if (value == 0) return t;
        (value > 0 ? a : b) = t;
        Quad next = t - value / p.slope(t);
        if (!(next > a && next < b) || i % 16 == 15) next = (a + b) / 2;
        if (magnitude(next - t) <= Quad(0x1p-112L) * t) return next;
        t = next;
    }
    return t;
}

struct Interval {
    Wide low, high;
};

}  // namespace

Quad QuadPolynomial::value(Quad t) const {
    Quad sum = 0;
    for (int i = degree; i >= 0; --i) sum = sum * t + c[static_cast<std::size_t>(i)];
    return sum;
}

Quad QuadPolynomial::slope(Quad t) const {
    Quad sum = 0;
    for (int i = degree; i > 0; --i) sum = sum * t + Quad(i) * c[static_cast<std::size_t>(i)];
    return sum;
}

// 8 units from the coefficients; at most 4 shifts, 8 products and 4 sums after. Doubled once more for the
// roundings of this bound.
Wide QuadPolynomial::error(Wide t) const {
    Wide sum = 0;
    for (int i = degree; i >= 0; --i) sum = sum * t + size[static_cast<std::size_t>(i)];
    return 48 * kQuadUnit * sum;
}

int QuadPolynomial::sign_at(Wide t) const {
    const Wide found = wide(value(t));
    if (std::abs(found) > error(t)) return found > 0 ? 1 : -1;
    return 0;
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
    std::vector<Interval> open;
    const Wide start = std::max(from, bounds.low);
    if (start < bounds.high) open.push_back({start, bounds.high});
    for (int i = 0; !open.empty(); ++i) {
        if (i > kMaxIntervals) return {Verdict::kUndecided, 0};
        const auto [low, high] = open.back();
        open.pop_back();
        const Bernstein b = bernstein(p, low, high);
        const Wide error = p.error(high);
        const int roots = changes(b, p.degree, error);
        if (roots == 0) continue;
        if (roots == 1) return {Verdict::kHit, refine(p, low, high)};
        Wide middle = high > 4 * low ? std::sqrt(low * high) : low + (high - low) / 2;
        const auto last = static_cast<std::size_t>(p.degree);
        if (wide(b[0]) > 16 * error && wide(b[last]) > 16 * error && surely_convex(b, p.degree, error)) {
            if (wide(b[1]) >= wide(b[0]) || wide(b[last - 1]) >= wide(b[last])) continue;  // lowest at an end
            const Wide bottom = wide(lowest(slope, low, high));
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
