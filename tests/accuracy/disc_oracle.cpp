#include "accuracy/disc_oracle.hpp"

#include <algorithm>
#include <limits>

#include <carom/core/disc_time.hpp>

#include "accuracy/exact.hpp"

namespace carom::accuracy {
namespace {

Sum gap_at_start(const DiscQuery& q) {
    Sum sum = product_sum(q.r, q.r);
    sum.add(q.s, -Quad(q.s));
    return sum;
}

QuadPolynomial gap_polynomial(const DiscQuery& q) {
    QuadPolynomial p = accuracy::gap_polynomial(q.r.x(), q.r.y(), q.v, q.a, q.s);
    // Contact is common, and an exact 0 leaves the sign just after to the next term.
    if (p.sign_at(0) == 0 && exact_sign_of_gap(q) == 0) p.c[0] = p.size[0] = 0;
    return p;
}

int sign_of_gap_at_start(const DiscQuery& q) {
    const Sum gap = gap_at_start(q);
    if (gap.surely_positive(4)) return 1;
    if (gap.surely_negative(4)) return -1;
    return exact_sign_of_gap(q);
}

/// The closed form; products of two inputs are exact in Quad.
Truth straight_truth(const DiscQuery& q) {
    const Sum b = product_sum(q.r, q.v);
    if (b.value == 0 && b.size == 0) return {Verdict::kMiss};
    if (b.surely_positive(4)) return {Verdict::kMiss};
    if (!b.surely_negative(4)) return {};
    const Sum c = gap_at_start(q);
    if (sign_of_gap_at_start(q) <= 0) return {Verdict::kHit, 0};
    Sum moment;
    moment.add(q.r.x(), q.v.y());
    moment.add(-Quad(q.r.y()), q.v.x());
    const Quad speed_squared = product_sum(q.v, q.v).value;
    const Quad reach = Quad(q.s) * Quad(q.s) * speed_squared;
    const Quad discriminant = reach - moment.value * moment.value;
    const Wide error = kQuadUnit * (8 * static_cast<Wide>(reach) +
                                    8 * moment.size * std::abs(static_cast<Wide>(moment.value)));
    if (static_cast<Wide>(discriminant) < -error) return {Verdict::kMiss};
    if (!(static_cast<Wide>(discriminant) > error)) return {};
    return {Verdict::kHit, c.value / (square_root(discriminant) - b.value)};
}

Truth curved_truth(const DiscQuery& q) {
    const QuadPolynomial gap = gap_polynomial(q);
    if (sign_of_gap_at_start(q) > 0) {
        if (gap.sign_at(0) == 0) return {};
        const QuadRoot root = first_fall(gap, 0);
        return {root.verdict, root.time};
    }
    const QuadPolynomial rate = derivative(gap);
    if (rate.sign_at(0) == 0) return {};
    if (rate.sign_at(0) < 0) return {Verdict::kHit, 0};
    const QuadRoot turn = first_fall(rate, 0);
    if (turn.verdict != Verdict::kHit) return {turn.verdict};
    const auto then = static_cast<Wide>(turn.time);
    const int there = gap.sign_at(then);
    if (there == 0) return {};
    if (there < 0) return {Verdict::kHit, turn.time, true};
    const QuadRoot root = first_fall(gap, then);
    return {root.verdict, root.time};
}

Wide absolute(Quad x) {
    return static_cast<Wide>(magnitude(x));
}

struct Coordinate {
    Quad place, rate;
    Wide place_change, rate_change, curve;
};

Coordinate coordinate(double r, double v, double a, Quad t) {
    const auto w = static_cast<Wide>(t);
    return {Quad(r) + t * (Quad(v) + t * Quad(a) / 2), Quad(v) + t * Quad(a),
            half_ulp(r) + w * (half_ulp(v) + w * half_ulp(a) / 2), half_ulp(v) + w * half_ulp(a), a};
}

/// f = |x|^2 - s^2 at one time, and what half an ulp in every input does to it.
struct State {
    Wide f, g, k;
    Wide f_change, g_change;
};

State state_at(const DiscQuery& q, Quad t) {
    const Coordinate x = coordinate(q.r.x(), q.v.x(), q.a.x(), t);
    const Coordinate y = coordinate(q.r.y(), q.v.y(), q.a.y(), t);
    State s{};
    s.f = static_cast<Wide>(x.place * x.place + y.place * y.place - Quad(q.s) * Quad(q.s));
    s.g = static_cast<Wide>(x.place * x.rate + y.place * y.rate);
    s.k = static_cast<Wide>(x.rate * x.rate + y.rate * y.rate) + static_cast<Wide>(x.place) * x.curve +
          static_cast<Wide>(y.place) * y.curve;
    s.f_change = 2 * (absolute(x.place) * x.place_change + absolute(y.place) * y.place_change +
                      Wide(q.s) * half_ulp(q.s));
    s.g_change = absolute(x.place) * x.rate_change + absolute(x.rate) * x.place_change +
                 absolute(y.place) * y.rate_change + absolute(y.rate) * y.place_change;
    return s;
}

}  // namespace

Truth quad_truth(const DiscQuery& q) {
    Truth truth = q.straight() ? straight_truth(q) : curved_truth(q);
    if (truth.verdict != Verdict::kHit || truth.time == 0) return truth;
    // Undecided, too, where the error of Quad is more than 1e-4 of a unit.
    const State there = state_at(q, truth.time);
    const QuadPolynomial gap = gap_polynomial(q);
    const auto t = static_cast<Wide>(truth.time);
    Wide error = gap.error(t) / (2 * std::abs(there.g));
    if (truth.turning) error = derivative(gap).error(t) / (2 * std::abs(there.k));
    // Of the closed form only c can have lost digits that the unit does not forgive.
    if (q.straight()) error = 64 * kQuadUnit * t * gap.size[0] / absolute(gap.c[0]);
    if (!(error <= Wide(1e-4) * condition(q, truth).time)) truth.verdict = Verdict::kUndecided;
    return truth;
}

Condition condition(const DiscQuery& q, const Truth& truth) {
    const State there = state_at(q, truth.time);
    Condition c{there.f_change, there.g_change, 0};
    c.time = truth.turning ? there.g_change / std::abs(there.k) : there.f_change / (2 * std::abs(there.g));
    c.time += half_ulp(static_cast<double>(truth.time));
    return c;
}

bool in_band(const DiscQuery& q, const Truth& truth) {
    const State start = state_at(q, 0);
    if (start.f <= start.f_change && std::abs(start.g) <= start.g_change) return true;
    const Wide until = truth.verdict == Verdict::kHit ? static_cast<Wide>(truth.time)
                                                      : std::numeric_limits<Wide>::infinity();
    const auto dip_at = [&](Wide t) {
        const State low = state_at(q, t);
        return std::abs(low.f) <= low.f_change;
    };
    if (truth.verdict == Verdict::kHit) {
        // The dip that follows: f + 2 g dt + k dt^2 reaches -g^2 / k.
        const State there = state_at(q, truth.time);
        if (there.k > 0 && there.g * there.g <= there.k * there.f_change) return true;
        if (truth.turning && std::abs(there.f) <= there.f_change) return true;
    }
    if (q.straight()) {
        const Wide speed_squared = Wide(q.v.x()) * Wide(q.v.x()) + Wide(q.v.y()) * Wide(q.v.y());
        const Wide nearest = -start.g / speed_squared;
        return nearest > 0 && nearest < until && dip_at(nearest);
    }
    bool touched = false;
    visit_negative_stretches<double>(
        carom::detail::DiscQuartic<double>(q.r, q.v, q.a, q.s).slope(), [&](double from, double to) {
            touched |= (to < until && dip_at(to)) || (from < until && dip_at(from));
            return touched;
        });
    return touched;
}

}  // namespace carom::accuracy
