// An oracle for the time of impact that shares nothing with the code under test: the number of real roots in
// an interval by Sturm's theorem, on expanded coefficients in 100 digits.
#pragma once

#include <vector>

#include "core/many_digits.hpp"

namespace carom::test {

/// Coefficients from the constant up.
using Polynomial = std::vector<Big>;

inline Big value_at(const Polynomial& p, const Big& t) {
    Big value = 0;
    for (auto c = p.rbegin(); c != p.rend(); ++c) value = value * t + *c;
    return value;
}

inline Polynomial derivative(const Polynomial& p) {
    Polynomial d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(p[i] * i);
    return d;
}

/// Roots with sign changes between them, counted by Sturm's sequence p, p', -rem(p, p'), ...
class Sturm {
 public:
    explicit Sturm(Polynomial p) {
        trim(p);
        sequence_.push_back(p);
        Polynomial next = derivative(p);
        while (!next.empty()) {
            sequence_.push_back(next);
            next = negative_remainder(sequence_[sequence_.size() - 2], sequence_.back());
        }
    }

    /// Distinct real roots in (low, high]. Precondition: low is no root.
    [[nodiscard]] int roots(const Big& low, const Big& high) const {
        return changes_at(low) - changes_at(high);
    }
    /// Distinct real roots in (low, infinity).
    [[nodiscard]] int roots_beyond(const Big& low) const {
        std::vector<Big> leading;
        for (const Polynomial& p : sequence_) leading.push_back(p.back());
        return changes_at(low) - changes(leading);
    }

 private:
    static void trim(Polynomial& p) {
        while (!p.empty() && p.back() == 0) p.pop_back();
    }

    static Polynomial negative_remainder(Polynomial a, const Polynomial& b) {
        while (a.size() >= b.size()) {
            const Big factor = a.back() / b.back();
            const std::size_t shift = a.size() - b.size();
            for (std::size_t i = 0; i + 1 < b.size(); ++i) a[i + shift] -= factor * b[i];
            a.pop_back();
        }
        trim(a);
        for (Big& c : a) c = -c;
        return a;
    }

    static int changes(const std::vector<Big>& values) {
        int count = 0;
        int last = 0;
        for (const Big& value : values) {
            const int sign = value.sign();
            if (sign == 0) continue;
            count += last != 0 && sign != last ? 1 : 0;
            last = sign;
        }
        return count;
    }

    [[nodiscard]] int changes_at(const Big& t) const {
        std::vector<Big> values;
        for (const Polynomial& p : sequence_) values.push_back(value_at(p, t));
        return changes(values);
    }

    std::vector<Polynomial> sequence_;
};

/// |r + v t + a t^2 / 2|^2 - s^2
inline Polynomial gap_polynomial(const BigVector& r, const BigVector& v, const BigVector& a, const Big& s) {
    return {dot<Big>(r, r) - s * s, 2 * dot<Big>(r, v), dot<Big>(v, v) + dot<Big>(r, a), dot<Big>(v, a),
            dot<Big>(a, a) / 4};
}

}  // namespace carom::test
