// A sum that does not depend on the order of its terms.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <carom/core/snapshot.hpp>

namespace carom {

/// Adds doubles as integers of 128 bits, so that any order and any split gives the same bits. A term is cut
/// at 2^-50 of the typical one; the sum holds 2^76 typical terms.
class OrderedSum {
 public:
    /// `typical` > 0: the size of a term; its power of two counts only.
    void set_scale(double typical) {
        exponent_ = 50 - std::ilogb(typical);
        const double scale = std::ldexp(1.0, exponent_);
        quick_scale_ = std::isnormal(scale) ? scale : std::numeric_limits<double>::infinity();
    }

    OrderedSum& operator+=(double term) {
        const double quick = term * quick_scale_;
        if (std::abs(quick) < 0x1p62) {
            sum_ += static_cast<std::int64_t>(quick);
            return *this;
        }
        const double scaled = std::ldexp(term, exponent_);
        if (std::abs(scaled) < 0x1p120)
            sum_ += static_cast<Integer>(scaled);
        else
            is_lost_ = true;
        return *this;
    }
    /// Precondition: both have one scale, or the other one no terms.
    OrderedSum& operator+=(const OrderedSum& other) {
        sum_ += other.sum_;
        is_lost_ = is_lost_ || other.is_lost_;
        return *this;
    }
    [[nodiscard]] double value() const {
        if (is_lost_) return std::numeric_limits<double>::quiet_NaN();
        return std::ldexp(static_cast<double>(sum_), -exponent_);
    }

    [[nodiscard]] SavedSum saved() const {
        return {static_cast<std::int64_t>(sum_ >> 64), static_cast<std::uint64_t>(sum_), is_lost_};
    }
    void restore(const SavedSum& saved) {
        sum_ = static_cast<Integer>(saved.high) * (Integer{1} << 64) + saved.low;
        is_lost_ = saved.is_lost;
    }

 private:
    __extension__ using Integer = __int128;
    Integer sum_ = 0;
    int exponent_ = 0;
    double quick_scale_ = 1;  // 2^exponent where that is a number
    bool is_lost_ = false;
};

}  // namespace carom
