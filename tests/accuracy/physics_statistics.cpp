#include "accuracy/physics_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace carom::accuracy {
namespace {

constexpr std::size_t kFewestBlocks = 32;

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Standard error of the mean of independent values.
double plain_error(const std::vector<double>& values, double mean) {
    double sum = 0;
    for (const double x : values) sum += (x - mean) * (x - mean);
    const auto n = static_cast<double>(values.size());
    return std::sqrt(sum / n / (n - 1));
}

void join_pairs(std::vector<double>& values) {
    for (std::size_t i = 0; 2 * i + 1 < values.size(); ++i)
        values[i] = (values[2 * i] + values[2 * i + 1]) / 2;
    values.resize(values.size() / 2);
}

struct Level {
    double error, uncertainty;
};

/// The first that no coarser one exceeds by more than so many of the coarser one's uncertainties.
std::size_t first_level(const std::vector<Level>& levels, double uncertainties) {
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const auto exceeds = [&](const Level& l) {
            return l.error - uncertainties * l.uncertainty > levels[k].error;
        };
        if (std::none_of(levels.begin() + static_cast<std::ptrdiff_t>(k) + 1, levels.end(), exceeds))
            return k;
    }
    return levels.size() - 1;
}

}  // namespace

Estimate mean_of(std::vector<double> series) {
    const double value = mean(series);
    std::vector<Level> levels;
    do {
        const double error = plain_error(series, value);
        levels.push_back({error, error / std::sqrt(2 * (static_cast<double>(series.size()) - 1))});
        join_pairs(series);
    } while (series.size() >= kFewestBlocks);
    const std::size_t chosen = first_level(levels, 1);
    return {value, levels[chosen].error, levels.size() == 1 || first_level(levels, 2) + 1 < levels.size()};
}

Estimate ratio_of(const std::vector<double>& a, const std::vector<double>& b) {
    const double ratio = mean(a) / mean(b);
    std::vector<double> residuals(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) residuals[i] = a[i] - ratio * b[i];
    Estimate estimate = scaled(mean_of(residuals), 1 / mean(b));
    estimate.value = ratio;
    return estimate;
}

void EqualClasses::count(double x) {
    ++counts_[static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), x) - ends_.begin())];
}

double EqualClasses::total() const {
    return std::accumulate(counts_.begin(), counts_.end(), 0.0);
}

double EqualClasses::chi_square() const {
    const double expected = total() / static_cast<double>(size());
    double sum = 0;
    for (const double n : counts_) sum += (n - expected) * (n - expected) / expected;
    return sum;
}

Estimate scaled(const Estimate& estimate, double factor) {
    return {estimate.value * factor, estimate.error * std::abs(factor), estimate.is_settled};
}

}  // namespace carom::accuracy
