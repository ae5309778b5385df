// Both forms of an operator, sign or constant in one program, and which of them counts chosen when it starts.
//
// weave() of mutants.py puts a switch with the mutant's number beside each place that it may change:
//   a + b    becomes    a + ::carom_mutation::Plus{17} + b
// The switch binds as the operator does, so that nobody has to know where the operands begin and end. `a +
// switch` keeps a; what is kept `+ b` is a + b, or a - b in the run whose environment says CAROM_MUTANT=17.
#pragma once

#include <array>
#include <cstdlib>
#include <type_traits>
#include <utility>

namespace carom_mutation {

inline constexpr int kMost = 8192;
/// Of each mutant: 0 not reached yet, 1 reached, 2 reached where its changed form does not compile.
inline std::array<char, kMost> reached{};

inline const int active =
    std::getenv("CAROM_MUTANT") != nullptr ? std::atoi(std::getenv("CAROM_MUTANT")) : -1;

/// Whether mutant `n` is the one to be run. Nothing here is constexpr: a switch that the compiler turned
/// would stay there.
inline bool on(int n, bool compiles = true) {
    reached[static_cast<std::size_t>(n)] = compiles ? 1 : 2;
    return n == active;
}

/// The value that an expression stands for, the same type for both forms: Eigen's sums and differences differ
/// in type.
template <class E>
auto value(E&& e) {
    if constexpr (requires { e.eval(); }) {
        return e.eval();
    } else {
        return std::decay_t<E>(std::forward<E>(e));
    }
}

#define CAROM_SWITCH(Name, kept, changed)                                                            \
    struct Name {                                                                                    \
        int n;                                                                                       \
    };                                                                                               \
    template <class L>                                                                               \
    struct Name##After {                                                                             \
        L&& left;                                                                                    \
        int n;                                                                                       \
    };                                                                                               \
    template <class L>                                                                               \
    Name##After<L> operator kept(L && left, Name it) {                                               \
        return {std::forward<L>(left), it.n};                                                        \
    }                                                                                                \
    template <class L, class R>                                                                      \
    auto operator kept(Name##After<L>&& l, R&& right) {                                              \
        using Result = decltype(value(l.left kept right));                                           \
        if constexpr (requires { Result(value(l.left changed right)); }) {                           \
            return on(l.n) ? Result(value(l.left changed right)) : Result(value(l.left kept right)); \
        } else {                                                                                     \
            (void)on(l.n, false);                                                                    \
            return Result(value(l.left kept right));                                                 \
        }                                                                                            \
    }

CAROM_SWITCH(Less, <, <=)
CAROM_SWITCH(LessEqual, <=, <)
CAROM_SWITCH(Greater, >, >=)
CAROM_SWITCH(GreaterEqual, >=, >)
CAROM_SWITCH(Equal, ==, !=)
CAROM_SWITCH(NotEqual, !=, ==)
CAROM_SWITCH(Plus, +, -)
CAROM_SWITCH(Minus, -, +)
CAROM_SWITCH(Times, *, /)
CAROM_SWITCH(Over, /, *)
#undef CAROM_SWITCH

/// a && switch && [&] { return b; }: b is looked at only where it decides.
#define CAROM_LAZY_SWITCH(Name, kept, changed)                             \
    struct Name {                                                          \
        int n;                                                             \
    };                                                                     \
    struct Name##After {                                                   \
        bool left;                                                         \
        int n;                                                             \
    };                                                                     \
    template <class L>                                                     \
    Name##After operator kept(L&& left, Name it) {                         \
        return {static_cast<bool>(left), it.n};                            \
    }                                                                      \
    template <class F>                                                     \
    inline bool operator kept(Name##After l, F&& right) {                  \
        return on(l.n) ? (l.left changed right()) : (l.left kept right()); \
    }

CAROM_LAZY_SWITCH(And, &&, ||)
CAROM_LAZY_SWITCH(Or, ||, &&)
#undef CAROM_LAZY_SWITCH

/// left += switch += right, which goes from right to left.
#define CAROM_ASSIGNMENT_SWITCH(Name, kept, changed)        \
    struct Name {                                           \
        int n;                                              \
    };                                                      \
    template <class R>                                      \
    struct Name##Before {                                   \
        R&& right;                                          \
        int n;                                              \
    };                                                      \
    template <class R>                                      \
    Name##Before<R> operator kept(Name it, R && right) {    \
        return {std::forward<R>(right), it.n};              \
    }                                                       \
    template <class L, class R>                             \
    L& operator kept(L & left, Name##Before<R>&& r) {       \
        if constexpr (requires { left changed r.right; }) { \
            if (on(r.n)) return left changed r.right;       \
        } else {                                            \
            (void)on(r.n, false);                           \
        }                                                   \
        return left kept r.right;                           \
    }

CAROM_ASSIGNMENT_SWITCH(PlusAssign, +=, -=)
CAROM_ASSIGNMENT_SWITCH(MinusAssign, -=, +=)
#undef CAROM_ASSIGNMENT_SWITCH

/// switch->*a in place of !a or -a: of all operators with two operands the one that binds closest.
struct Not {
    int n;
};
template <class A>
bool operator->*(Not it, A&& a) {
    return on(it.n) ? static_cast<bool>(a) : !a;
}
struct Negative {
    int n;
};
template <class A>
auto operator->*(Negative it, A&& a) {
    using Result = decltype(value(-a));
    return on(it.n) ? Result(value(a)) : Result(value(-a));
}

/// std::max or std::min, and the other one.
struct Extreme {
    int n;
    bool is_max;
    template <class T>
    [[nodiscard]] T of(const T& a, const T& b) const {
        return on(n) != is_max ? (a < b ? b : a) : (b < a ? b : a);
    }
};

}  // namespace carom_mutation
