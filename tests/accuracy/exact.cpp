#include "accuracy/exact.hpp"

namespace carom::accuracy {
namespace {

using test::Sturm;
using test::value_at;

constexpr int kBits = 115;

Quad quad_of(Rational x) {
    Quad sum = 0;
    for (int i = 0; i < 4; ++i) {
        const auto part = x.convert_to<double>();
        sum += part;
        x -= Rational(part);
    }
    return sum;
}

Rational rational_of(Quad x) {
    const auto high = static_cast<double>(x);
    const auto middle = static_cast<double>(x - Quad(high));
    return Rational(high) + Rational(middle) + Rational(static_cast<double>(x - Quad(high) - Quad(middle)));
}

/// The times before and after the first fall of p beyond `from`, where p > 0 just after `from`.
struct Bracket {
    bool found;
    Rational low, high;
};

Bracket exact_first_fall(RationalPolynomial p, const Rational& from) {
    while (from == 0 && !p.empty() && p[0] == 0) p.erase(p.begin());
    if (p.size() < 2) return {false, 0, 0};
    const Sturm<Rational> sturm(p);
    const int total = sturm.roots_beyond(from);
    for (int k = 1; k <= total; ++k) {
        Rational low = from;
        Rational high = from + 1;
        while (sturm.roots(from, high) < k) high = from + (high - from) * 2;
        bool alone = false;  // the k-th root, a change of sign: no more need to count
        while (low == from || (high - low) * Rational(boost::multiprecision::cpp_int(1) << kBits) >= high) {
            // Halve the exponent first, then the interval: a root may be 1e-300.
            const Rational middle = from + (low + high - 2 * from) / (low == from ? 65536 : 2);
            const bool before =
                alone ? value_at(p, middle).sign() == value_at(p, low).sign() : sturm.roots(from, middle) < k;
            (before ? low : high) = middle;
            alone = alone || (low != from && value_at(p, low).sign() * value_at(p, high).sign() < 0 &&
                              sturm.roots(low, high) == 1);
        }
        // A root may be the very end of its bracket: look a little beyond.
        const Rational after = high + (high - low);
        if (value_at(p, after) < 0) return {true, low, high};
    }
    return {false, 0, 0};
}

/// The sign of p just after 0.
int first_sign(const RationalPolynomial& p) {
    for (const Rational& c : p) {
        if (c != 0) return c.sign();
    }
    return 0;
}

}  // namespace

RationalPolynomial exact_gap(const DiscQuery& q) {
    const Rational rx(q.r.x()), ry(q.r.y()), vx(q.v.x()), vy(q.v.y()), ax(q.a.x()), ay(q.a.y()), s(q.s);
    RationalPolynomial p = {rx * rx + ry * ry - s * s, 2 * (rx * vx + ry * vy),
                            vx * vx + vy * vy + rx * ax + ry * ay, vx * ax + vy * ay,
                            (ax * ax + ay * ay) / 4};
    while (!p.empty() && p.back() == 0) p.pop_back();
    return p;
}

int exact_sign_of_gap(const DiscQuery& q) {
    const Rational x(q.r.x()), y(q.r.y()), s(q.s);
    return Rational(x * x + y * y - s * s).sign();
}

Truth exact_truth(const DiscQuery& q) {
    const RationalPolynomial gap = exact_gap(q);
    if (gap.empty()) return {Verdict::kMiss};
    const auto hit_in = [](const Bracket& b, bool turning) {
        return b.found ? Truth{Verdict::kHit, quad_of(b.high), turning} : Truth{Verdict::kMiss};
    };
    if (gap[0] > 0) return hit_in(exact_first_fall(gap, 0), false);
    const RationalPolynomial rate = test::derivative(gap);
    const int sign = first_sign(rate);
    if (sign == 0) return {Verdict::kMiss};
    if (sign < 0) return {Verdict::kHit, 0};
    const Bracket turn = exact_first_fall(rate, 0);
    if (!turn.found) return {Verdict::kMiss};
    if (value_at(gap, turn.high) <= 0) return hit_in(turn, true);
    return hit_in(exact_first_fall(gap, turn.high), false);
}

bool confirms(const DiscQuery& q, const Truth& truth, Wide slack) {
    const RationalPolynomial gap = exact_gap(q);
    if (gap.size() < 2) return truth.verdict == Verdict::kMiss;
    if (gap[0] <= 0) {
        const Truth exact = exact_truth(q);
        return exact.verdict == truth.verdict && exact.turning == truth.turning &&
               magnitude(exact.time - truth.time) <= Quad(slack);
    }
    const Sturm<Rational> sturm(gap);
    if (truth.verdict == Verdict::kMiss) return sturm.roots_beyond(0) == 0;
    const Rational low = rational_of(truth.time - Quad(slack));
    const Rational high = rational_of(truth.time + Quad(slack));
    return low > 0 && sturm.roots(0, low) == 0 && sturm.roots(0, high) == 1 && value_at(gap, high) < 0;
}

}  // namespace carom::accuracy
