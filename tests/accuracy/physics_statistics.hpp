// Means and their standard errors from series whose neighbours depend on each other.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace carom::accuracy {

struct Estimate {
    double value = 0;
    double error = 0;        ///< standard error of `value`
    bool is_settled = true;  ///< the longest blocks do not give an error that is larger beyond doubt
};

/// Mean of a series in order of time, its error by blocking (Flyvbjerg and Petersen 1989): neighbours are
/// joined in pairs again and again, and the error is that of the first level which no coarser one exceeds by
/// more than the coarser one's own uncertainty. That is a few per cent too much for independent values, and
/// so much too little for some that depend on each other. Levels of fewer than 32 blocks, whose errors are
/// known to 13 %, are not asked. At least 64 values, else the error is that of independent ones.
Estimate mean_of(std::vector<double> series);

/// Sum of a over sum of b, its error from the blocks of a - (ratio) b.
Estimate ratio_of(const std::vector<double>& a, const std::vector<double>& b);

/// Counts values in classes that are equally probable.
class EqualClasses {
 public:
    /// `ends`: rising, between one class and the next.
    explicit EqualClasses(std::vector<double> ends) : ends_(std::move(ends)), counts_(ends_.size() + 1) {}
    void count(double x);
    [[nodiscard]] std::size_t size() const { return counts_.size(); }
    [[nodiscard]] double total() const;
    [[nodiscard]] double chi_square() const;

 private:
    std::vector<double> ends_, counts_;
};

/// Both value and error, times a factor known exactly.
Estimate scaled(const Estimate& estimate, double factor);

}  // namespace carom::accuracy
