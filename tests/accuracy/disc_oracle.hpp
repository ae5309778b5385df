// The true time of impact of two discs for millions of queries: decided in Quad where the bound of its error
// allows, else in exact fractions. And how well conditioned a query is.
#pragma once

#include <limits>

#include <carom/core/vector.hpp>

#include "accuracy/quad_polynomial.hpp"

namespace carom::accuracy {

/// The time of an impact that never comes.
inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct DiscQuery {
    Vec2 r, v, a;
    double s;

    [[nodiscard]] bool straight() const { return a.x() == 0 && a.y() == 0; }
};

struct Truth {
    Verdict verdict = Verdict::kUndecided;
    Quad time = 0;
    /// At a turning point in overlap, not at a root of the gap.
    bool turning = false;
};

/// In Quad only; kUndecided where its rounding could matter.
Truth quad_truth(const DiscQuery& q);

/// What half an ulp in every input at once, all against us, does to first order.
struct Condition {
    /// To the gap |x|^2 - s^2 at that time, and to its rate x . x'.
    Wide gap = 0, rate = 0;
    /// To the time, and half an ulp of the time.
    Wide time = 0;
};
Condition condition(const DiscQuery& q, const Truth& truth);

/// Is whether there is an impact, or which, up to the inputs' own rounding: a contact, or a dip of the gap,
/// or an approach out of overlap that half an ulp in every input can undo?
bool in_band(const DiscQuery& q, const Truth& truth);

}  // namespace carom::accuracy
