// Properties of the quartic on thousands of random and adversarial motions. Sturm's theorem in 100 digits
// says how many roots lie before the time found; the time itself must be a root, or a turning point in
// overlap, to rounding.
#include <carom/core/disc_time.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "core/limits.hpp"
#include "core/random.hpp"
#include "core/sturm.hpp"

namespace carom {
namespace {

using test::Big;
using test::kEpsilon;
using test::kInfinity;
using test::Random;

struct Motion2 {
    Vec2 r, v, a;
    double s;
};

/// One motion, its exact polynomials, and what rounding may do to them.
class Check {
 public:
    explicit Check(const Motion2& m)
        : m_(m),
          gap_(test::gap_polynomial(test::big(m.r), test::big(m.v), test::big(m.a), Big(m.s))),
          rate_(test::derivative(gap_)) {}

    /// Empty when `t` is the impact by the rule, else what is wrong.
    [[nodiscard]] std::string fault(double t) const {
        if (!(t >= 0)) return "negative or NaN";
        if (gap_[0] > 0) return t < kInfinity ? fault_of_hit(t, 0) : fault_of_miss();
        return fault_from_overlap(t);
    }

 private:
    /// Error of f in twice the digits at t: some tens of eps^2 of the largest term.
    [[nodiscard]] Big gap_error(const Big& t) const {
        const Big reach = Big(m_.r.norm()) + m_.v.norm() * t + m_.a.norm() * t * t + m_.s;
        return 32 * Big(kEpsilon) * kEpsilon * reach * reach;
    }

    /// Error of the cubic f' at t from coefficients of one rounding each.
    [[nodiscard]] Big rate_error(const Big& t) const {
        const Big reach = Big(m_.r.norm()) + m_.v.norm() * t + m_.a.norm() * t * t;
        return 8 * kEpsilon * reach * (m_.v.norm() + m_.a.norm() * t);
    }

    /// How far t may lie from the root: some ulp, and what the error of f shifts it by.
    [[nodiscard]] Big time_error(const Big& t) const {
        return 2 * kEpsilon * t + 2 * gap_error(t) / abs(test::value_at(rate_, t));
    }

    [[nodiscard]] std::string fault_of_hit(double found, int roots_before) const {
        const Big t(found);
        const Big rate = test::value_at(rate_, t);
        const Big gap = test::value_at(gap_, t);
        const Big slack = time_error(t);
        if (abs(gap) > 2 * abs(rate) * slack) return "f is not 0 at the time found";
        if (rate > rate_error(t)) return "f rises at the time found";
        const Big before = t - slack;
        if (before > 0 && test::Sturm(gap_).roots(Big(0), before) != roots_before)
            return "there is an earlier root";
        return "";
    }

    /// f > 0 at first and no time found: there is no root, or the dip below 0 is less than rounding.
    [[nodiscard]] std::string fault_of_miss() const {
        const test::Sturm roots(gap_);
        if (roots.roots_beyond(Big(0)) == 0) return "";
        Big low = 0;
        Big high = 1;
        while (roots.roots(Big(0), high) == 0) high *= 2;
        for (int i = 0; i < 250; ++i) {
            const Big middle = (low + high) / 2;
            (roots.roots(Big(0), middle) == 0 ? low : high) = middle;
        }
        test::Polynomial lifted = gap_;
        lifted[0] += gap_error(high);
        return test::Sturm(lifted).roots_beyond(Big(0)) == 0 ? "" : "missed";
    }

    [[nodiscard]] std::string fault_from_overlap(double found) const {
        if (abs(rate_[0]) <= 2 * rate_error(Big(0)) && rate_[0] != 0)
            return "";  // the sign of b is rounding's
        const Big first = rate_[0] != 0 ? rate_[0] : rate_[1];
        if (first < 0) return found == 0 ? "" : "falls from an overlap, must be 0";
        if (!(found < kInfinity)) return fault_of_endless_overlap();
        const Big t(found);
        // At the turning point where f <= 0 still, else at the root after it.
        const Big curvature = test::value_at(test::derivative(rate_), t);
        if (abs(test::value_at(rate_, t)) <= 2 * rate_error(t) + abs(curvature) * 2 * kEpsilon * t) {
            if (test::value_at(gap_, t) > gap_error(t)) return "turns above 0";
            const Big before = t - 2 * kEpsilon * t - 2 * rate_error(t) / abs(curvature);
            return test::Sturm(rate_).roots(Big(0), before) == 0 ? "" : "f turned before";
        }
        return fault_of_hit(found, gap_[0] == 0 ? 0 : 1);
    }

    [[nodiscard]] std::string fault_of_endless_overlap() const {
        return test::Sturm(gap_).roots_beyond(Big(0)) <= 1 ? "" : "missed after the overlap";
    }

    Motion2 m_;
    test::Polynomial gap_;
    test::Polynomial rate_;
};

/// Checks `count` motions of a family; returns how many of them hit.
int check_family(std::uint64_t seed, int count, const std::function<Motion2(Random&)>& make) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    int hits = 0;
    int faults = 0;
    for (int i = 0; i < count && faults < 5; ++i) {
        const Motion2 m = make(random);
        const double t = disc_time_of_impact<double>(m.r, m.v, m.a, m.s);
        const std::string fault = Check(m).fault(t);
        hits += t < kInfinity ? 1 : 0;
        faults += fault.empty() ? 0 : 1;
        EXPECT_EQ(fault, "") << "case " << i << ", t = " << t << std::hexfloat << "\nr " << m.r.transpose()
                             << " v " << m.v.transpose() << " a " << m.a.transpose() << " s " << m.s;
    }
    return hits;
}

/// A motion that passes the place `x` with velocity `w` at time `t`.
Motion2 passing(const Vec2& x, const Vec2& w, const Vec2& a, double t, double s) {
    return {x - w * t + a * (t * t / 2), w - a * t, a, s};
}

TEST(DiscQuarticProperty, AnyMotion) {
    const int hits = check_family(21, 20000, [](Random& random) {
        return Motion2{random.vector(4), random.vector(2), random.vector(2), random.uniform(0.1, 2)};
    });
    EXPECT_GT(hits, 2000);
}

TEST(DiscQuarticProperty, AccelerationsFromTinyToHuge) {
    const int hits = check_family(22, 20000, [](Random& random) {
        const Vec2 r = random.direction(random.uniform(1.001, 10));
        return Motion2{r, random.vector(0.3) - r, random.direction(random.decades(-30, 12)), 1};
    });
    EXPECT_GT(hits, 8000);
}

TEST(DiscQuarticProperty, Grazes) {
    const int hits = check_family(23, 20000, [](Random& random) {
        const Vec2 n = random.direction(1);
        const double depth = random.sign() * random.decades(-15, -2);
        const Vec2 w = Vec2(-n.y(), n.x()) * (random.sign() * random.decades(-2, 1));
        return passing(n * (1 + depth), w, random.direction(random.decades(-3, 1)), random.uniform(0.01, 5),
                       1);
    });
    EXPECT_GT(hits, 8000);
}

TEST(DiscQuarticProperty, FirstDipsOfTwo) {
    // A tall arch over the disc grazes it on the way up and again on the way down.
    const int hits = check_family(24, 20000, [](Random& random) {
        const double depth = random.sign() * random.decades(-14, -1);
        const Vec2 r(-3 + random.sign() * random.decades(-14, -2), -15.875 - depth);
        return Motion2{r, {1, 12}, {0, -4}, 1};
    });
    EXPECT_GT(hits, 8000);
}

TEST(DiscQuarticProperty, StartsInContact) {
    const int hits = check_family(25, 20000, [](Random& random) {
        const Vec2 r = random.direction(1);
        const Vec2 along(-r.y(), r.x());
        const Vec2 v = r * (random.sign() * random.decades(-18, 0)) + along * random.uniform(-1, 1);
        return Motion2{r, v, random.direction(random.decades(-6, 2)), 1};
    });
    EXPECT_GT(hits, 8000);
}

TEST(DiscQuarticProperty, StartsOverlapping) {
    const int hits = check_family(26, 20000, [](Random& random) {
        return Motion2{random.direction(1 - random.decades(-16, -0.01)), random.vector(1), random.vector(2),
                       1};
    });
    EXPECT_GT(hits, 8000);
}

TEST(DiscQuarticProperty, UnitsDoNotMatter) {
    const int hits = check_family(27, 10000, [](Random& random) {
        const double length = random.decades(-25, 25);
        const double time = random.decades(-12, 12);
        const Vec2 r = random.vector(4);
        return Motion2{r * length, (random.vector(1) - r / 2) * (length / time),
                       random.vector(1) * (length / time / time), length};
    });
    EXPECT_GT(hits, 4000);
}

}  // namespace
}  // namespace carom
