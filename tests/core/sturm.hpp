// An oracle for the time of impact that shares nothing with the code under test: the number of real roots in
// an interval by Sturm's theorem, on expanded coefficients in 100 digits or in exact fractions.
#pragma once

#include <vector>

#include "core/many_digits.hpp"

namespace carom::test {

/// Coefficients from the constant up.
using Polynomial = std::vector<Big>;

template <class T>
inline T value_at(const std::vector<T>& p, const T& t) {
    T value = 0;
    for (auto c = p.rbegin(); c != p.rend(); ++c) value = value * t + *c;
    return value;
}

template <class T>
inline std::vector<T> derivative(const std::vector<T>& p) {
    std::vector<T> d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(p[i] * i);
    return d;
}

/// Roots with sign changes between them, counted by Sturm's sequence p, p', -rem(p, p'), ...
template <class T>
class Sturm {
 public:
    explicit Sturm(std::vector<T> p) {
        trim(p);
        sequence_.push_back(p);
        std::vector<T> next = derivative(p);
        while (!next.empty()) {
            sequence_.push_back(next);
            next = negative_remainder(sequence_[sequence_.size() - 2], sequence_.back());
        }
    }

    /// Distinct real roots in (low, high]. Precondition: low is no root.
    [[nodiscard]] int roots(const T& low, const T& high) const { return changes_at(low) - changes_at(high); }
    /// Distinct real roots in (low, infinity).
    [[nodiscard]] int roots_beyond(const T& low) const {
        std::vector<T> leading;
        for (const std::vector<T>& p : sequence_) leading.push_back(p.back());
        return changes_at(low) - changes(leading);
    }

 private:
    static void trim(std::vector<T>& p) {
        while (!p.empty() && p.back() == 0) p.pop_back();
    }

    static std::vector<T> negative_remainder(std::vector<T> a, const std::vector<T>& b) {
        while (a.size() >= b.size()) {
            const T factor = a.back() / b.back();
            const std::size_t shift = a.size() - b.size();
            for (std::size_t i = 0; i + 1 < b.size(); ++i) a[i + shift] -= factor * b[i];
            a.pop_back();
        }
        trim(a);
        for (T& c : a) c = -c;
        return a;
    }

    static int changes(const std::vector<T>& values) {
        int count = 0;
        int last = 0;
        for (const T& value : values) {
            const int sign = value.sign();
            if (sign == 0) continue;
            count += last != 0 && sign != last ? 1 : 0;
            last = sign;
        }
        return count;
    }

    [[nodiscard]] int changes_at(const T& t) const {
        std::vector<T> values;
        for (const std::vector<T>& p : sequence_) values.push_back(value_at(p, t));
        return changes(values);
    }

    std::vector<std::vector<T>> sequence_;
};

/// |r + v t + a t^2 / 2|^2 - s^2
inline Polynomial gap_polynomial(const BigVector& r, const BigVector& v, const BigVector& a, const Big& s) {
    return {dot<Big>(r, r) - s * s, 2 * dot<Big>(r, v), dot<Big>(v, v) + dot<Big>(r, a), dot<Big>(v, a),
            dot<Big>(a, a) / 4};
}

}  // namespace carom::test
