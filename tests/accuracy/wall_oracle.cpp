#include <algorithm>

#include "accuracy/wall_accuracy.hpp"

namespace carom::accuracy {
namespace {

struct QuadVector {
    Quad x, y;
};

/// First entries of several parts; one undecided spoils all that are not earlier, so all.
struct Earliest {
    WallTruth truth{Verdict::kMiss, 0};
    bool open = false;

    void add(const QuadRoot& root) {
        open |= root.verdict == Verdict::kUndecided;
        if (root.verdict != Verdict::kHit) return;
        if (truth.verdict == Verdict::kHit && !(root.time < truth.time)) return;
        truth = {Verdict::kHit, root.time};
    }
};

/// The one fall of a quadratic, from above or after a rise.
QuadRoot quadratic_fall(const QuadPolynomial& p) {
    const int start = p.sign_at(0);
    if (start > 0) return first_fall(p, 0);
    if (p.degree < 2 || !(p.c[2] < 0) || !(p.c[1] > 0)) return {Verdict::kMiss, 0};
    const auto top = static_cast<Wide>(-p.c[1] / (2 * p.c[2]));
    const int there = p.sign_at(top);
    if (there < 0) return {Verdict::kMiss, 0};
    return there == 0 ? QuadRoot{Verdict::kUndecided, 0} : first_fall(p, top);
}

/// A component of the motion along a direction, times the direction's length.
QuadPolynomial component(const QuadVector& offset, const Motion<double>& m, const QuadVector& direction) {
    QuadPolynomial p;
    const auto set = [&](std::size_t i, Quad x, Quad y, double factor) {
        Sum sum;
        sum.add(x, direction.x);
        sum.add(y, direction.y);
        p.c[i] = sum.value * Quad(factor);
        p.size[i] = sum.size * Wide(factor);
        if (sum.value != 0) p.degree = static_cast<int>(i);
    };
    set(0, offset.x, offset.y, 1);
    set(1, m.velocity.x(), m.velocity.y(), 1);
    set(2, m.acceleration.x(), m.acceleration.y(), 0.5);
    return p;
}

}  // namespace

WallTruth wall_truth(const WallQuery& q, Quad extra) {
    const auto less = [](const Vec2& a, const Vec2& b) {
        return QuadVector{Quad(a.x()) - Quad(b.x()), Quad(a.y()) - Quad(b.y())};
    };
    const Motion<double>& m = q.centre;
    const Quad radius = Quad(q.radius) + extra;
    Earliest first;
    for (const Vec2& end : {q.from, q.to}) {
        const QuadVector offset = less(m.position, end);
        first.add(first_fall(gap_polynomial(offset.x, offset.y, m.velocity, m.acceleration, radius), 0));
    }
    const QuadVector along = less(q.to, q.from);
    const QuadVector offset = less(m.position, q.from);
    const Quad length_squared = along.x * along.x + along.y * along.y;
    const Quad reach = radius * square_root(length_squared);
    const QuadPolynomial foot = component(offset, m, along);
    for (const int side : {1, -1}) {
        QuadPolynomial height = component(offset, m, {Quad(-side) * along.y, Quad(side) * along.x});
        height.c[0] -= reach;
        height.size[0] += static_cast<Wide>(reach);
        const QuadRoot root = quadratic_fall(height);
        // Where the foot is at an end, that end's disc is entered at the same time.
        const Quad place = root.verdict == Verdict::kHit ? foot.value(root.time) : Quad(0);
        if (place >= 0 && place <= length_squared) first.add(root);
    }
    if (first.open) first.truth.verdict = Verdict::kUndecided;
    return first.truth;
}

}  // namespace carom::accuracy
