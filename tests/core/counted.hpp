// A double that counts the absolute values and the square roots taken of it: so a test sees how many steps a
// search takes, and whether it was begun at all.
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace carom::test {

struct Counted {
    double value = 0;
    inline static int absolutes = 0;
    inline static int roots = 0;

    Counted() = default;
    Counted(double x) : value(x) {}  // NOLINT: as the built-in types convert
    Counted& operator+=(Counted b) { return *this = *this + b; }

    friend Counted operator+(Counted a, Counted b) { return a.value + b.value; }
    friend Counted operator-(Counted a, Counted b) { return a.value - b.value; }
    friend Counted operator*(Counted a, Counted b) { return a.value * b.value; }
    friend Counted operator/(Counted a, Counted b) { return a.value / b.value; }
    friend Counted operator-(Counted a) { return -a.value; }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
    friend auto operator<=>(Counted a, Counted b) { return a.value <=> b.value; }
    friend Counted abs(Counted a) {
        ++absolutes;
        return std::abs(a.value);
    }
    friend Counted sqrt(Counted a) {
        ++roots;
        return std::sqrt(a.value);
    }
    friend Counted frexp(Counted a, int* exponent) { return std::frexp(a.value, exponent); }
    friend Counted ldexp(Counted a, int exponent) { return std::ldexp(a.value, exponent); }
};

}  // namespace carom::test

template <>
struct std::numeric_limits<carom::test::Counted> : std::numeric_limits<double> {};

template <>
struct Eigen::NumTraits<carom::test::Counted> : Eigen::NumTraits<double> {
    using Real = carom::test::Counted;
    using NonInteger = carom::test::Counted;
    using Nested = carom::test::Counted;
    using Literal = carom::test::Counted;
};
