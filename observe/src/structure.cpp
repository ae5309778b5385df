#include "structure.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "near_pairs.hpp"

namespace carom::observe {
namespace {

constexpr double kWalledShare = 0.25;  // of a walled side that g(r) reaches to: half of the box is centres

double length_of(const Box& box, int axis) {
    return box.max[axis] - box.min[axis];
}

double reach_in(const Domain& domain, double wanted) {
    double reach = std::min(wanted, longest_reach(domain));
    for (int axis = 0; axis < 2; ++axis) {
        if (domain.boundary[axis] == Boundary::kOpen) return 0;
        if (domain.boundary[axis] == Boundary::kWall)
            reach = std::min(reach, kWalledShare * length_of(domain.box, axis));
    }
    return reach;
}

}  // namespace

std::pair<double, double> hexatic_order(std::span<const Vec2> points, const Domain& domain, double cutoff) {
    using Complex = std::complex<double>;
    std::vector<Complex> sums(points.size());
    std::vector<std::uint32_t> neighbours(points.size(), 0);
    const NearPairs pairs(points, domain, std::min(cutoff, longest_reach(domain)));
    pairs.for_each([&](std::uint32_t i, std::uint32_t j, const Vec2& offset, double distance_squared) {
        if (distance_squared == 0) return;  // no direction
        // The sixth power of the direction; the same from j to i.
        const Complex squared = Complex(offset.x(), offset.y()) * Complex(offset.x(), offset.y());
        const Complex sixth =
            squared / distance_squared * (squared / distance_squared) * (squared / distance_squared);
        for (const std::uint32_t k : {i, j}) {
            sums[k] += sixth;
            ++neighbours[k];
        }
    });
    Complex global = 0;
    double local = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (neighbours[k] == 0) continue;
        const Complex psi = sums[k] / double(neighbours[k]);
        global += psi;
        local += std::abs(psi);
    }
    const auto count = double(points.size());
    return {std::abs(global) / count, local / count};
}

RadialDistribution::RadialDistribution(const Domain& domain, double reach, double bin)
    : domain_(domain), bin_(bin) {
    // A last bin that ends at the reach but for rounding is whole.
    const double bins = std::floor(reach_in(domain, reach) / bin + 1e-9);
    pairs_.resize(bins > 0 ? static_cast<std::size_t>(bins) : 0);
}

bool RadialDistribution::is_whole_around(const Vec2& point) const {
    const double reach = bin_ * double(pairs_.size());
    for (int axis = 0; axis < 2; ++axis)
        if (domain_.boundary[axis] == Boundary::kWall &&
            (point[axis] - domain_.box.min[axis] < reach || domain_.box.max[axis] - point[axis] < reach))
            return false;
    return true;
}

void RadialDistribution::add(std::span<const Vec2> points) {
    if (pairs_.empty() || points.size() < 2) return;
    std::vector<std::uint8_t> is_centre(points.size());
    std::uint64_t centres = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        is_centre[i] = is_whole_around(points[i]) ? 1 : 0;
        centres += is_centre[i];
    }
    const double area = length_of(domain_.box, 0) * length_of(domain_.box, 1);
    weight_ += double(centres) * double(points.size() - 1) / area;
    const double reach = std::min(bin_ * double(pairs_.size()), longest_reach(domain_));
    const NearPairs near(points, domain_, reach);
    near.for_each([&](std::uint32_t i, std::uint32_t j, const Vec2&, double distance_squared) {
        const auto k = static_cast<std::size_t>(std::sqrt(distance_squared) / bin_);
        if (k < pairs_.size()) pairs_[k] += is_centre[i] + std::uint64_t{is_centre[j]};
    });
}

Curve RadialDistribution::curve() const {
    Curve g;
    if (!(weight_ > 0)) return g;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const double ring = std::numbers::pi * bin_ * bin_ * (2 * double(k) + 1);
        g.at.push_back((double(k) + 0.5) * bin_);
        g.value.push_back(double(pairs_[k]) / (weight_ * ring));
    }
    return g;
}

Profiles::Profiles(const Domain& domain, std::size_t bins) : box_(domain.box) {
    for (std::vector<std::uint64_t>& counts : counts_) counts.resize(bins);
}

void Profiles::add(std::span<const Vec2> points) {
    ++samples_;
    for (const Vec2& p : points) {
        // Out of the box of an open domain it is in no slice, whichever way it left.
        if ((p.array() < box_.min.array()).any() || (p.array() > box_.max.array()).any()) continue;
        for (int axis = 0; axis < 2; ++axis) {
            std::vector<std::uint64_t>& counts = counts_[axis];
            const double place = (p[axis] - box_.min[axis]) / length_of(box_, axis) * double(counts.size());
            ++counts[std::min(static_cast<std::size_t>(place), counts.size() - 1)];
        }
    }
}

Curve Profiles::curve(int axis) const {
    Curve density;
    const std::vector<std::uint64_t>& counts = counts_[axis];
    if (samples_ == 0) return density;
    const double width = length_of(box_, axis) / double(counts.size());
    const double slice = width * length_of(box_, 1 - axis);
    for (std::size_t k = 0; k < counts.size(); ++k) {
        density.at.push_back(box_.min[axis] + (double(k) + 0.5) * width);
        density.value.push_back(double(counts[k]) / (double(samples_) * slice));
    }
    return density;
}

}  // namespace carom::observe
