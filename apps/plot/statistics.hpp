// What a plot of a scene measures at one moment: who is how far from whom, and how fast.
#pragma once

#include <vector>

#include <carom/core/scene.hpp>

#include "curves.hpp"

namespace carom::app {

/// The radial distribution function g(r), gathered over samples: the density of balls at distance r from a
/// ball over the mean density. Only balls that are at least the largest distance away from sides that are not
/// periodic are asked for their neighbours, so that nothing is missing around them.
class RadialDistribution {
 public:
    /// `bins` of equal width up to `reach`, which must not exceed half of a periodic side.
    RadialDistribution(const Domain& domain, double reach, std::size_t bins);

    void add(const std::vector<Ball>& balls);
    /// Empty where no ball was far enough from the sides.
    [[nodiscard]] std::vector<Vec2> points() const;

 private:
    [[nodiscard]] bool is_inside(const Vec2& place) const;
    [[nodiscard]] Vec2 offset(const Vec2& from, const Vec2& to) const;

    Domain domain_;
    double reach_;
    std::vector<double> pairs_;  // ordered ones, in each bin
    double expected_ = 0;        // balls asked times the mean density, over all samples
};

/// Speeds in units of sqrt(T / m) with the balls' own temperature, so that balls of any mass share one
/// distribution: the share of balls in each bin over its width. Static balls are left out; empty where
/// nothing moves.
class SpeedHistogram {
 public:
    explicit SpeedHistogram(std::size_t bins) : counts_(bins, 0) {}

    void add(const std::vector<Ball>& balls);
    [[nodiscard]] std::vector<Vec2> points() const;

    static constexpr double kReach = 4.5;  ///< beyond it Maxwell has 4e-5 of the balls

 private:
    std::vector<double> counts_;
    double balls_ = 0;
};

/// Maxwell's distribution of the speed in two dimensions, in those units: u exp(-u^2 / 2).
[[nodiscard]] double maxwell_speed_density(double speed);

}  // namespace carom::app
