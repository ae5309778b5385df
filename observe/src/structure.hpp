// Where balls are relative to each other and to the box, averaged over samples.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <carom/observe/observer.hpp>

namespace carom::observe {

/// |mean of psi_6| and mean of |psi_6|. Precondition: some points; the cutoff is > 0.
[[nodiscard]] std::pair<double, double> hexatic_order(std::span<const Vec2> points, const Domain& domain,
                                                      double cutoff);

class RadialDistribution {
 public:
    /// Over distances up to `reach`, or as far as the domain allows; none in a domain with an open axis.
    RadialDistribution(const Domain& domain, double reach, double bin);
    void add(std::span<const Vec2> points);
    [[nodiscard]] Curve curve() const;
    template <class Words>
    void visit(Words& words) {
        words(pairs_, weight_);
    }

 private:
    [[nodiscard]] bool is_whole_around(const Vec2& point) const;

    Domain domain_;
    double bin_;
    std::vector<std::uint64_t> pairs_;  // by bin, each seen from one centre
    double weight_ = 0;                 // sum over centres of the density of others
};

class Profiles {
 public:
    Profiles(const Domain& domain, std::size_t bins);
    void add(std::span<const Vec2> points);
    /// Along x (0) or y (1).
    [[nodiscard]] Curve curve(int axis) const;
    template <class Words>
    void visit(Words& words) {
        words(counts_[0], counts_[1], samples_);
    }

 private:
    Box box_;
    std::array<std::vector<std::uint64_t>, 2> counts_;
    std::uint64_t samples_ = 0;
};

}  // namespace carom::observe
