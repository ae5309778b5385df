#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace carom::app {
namespace {

/// Balls by cells of a grid over the domain, each at least `reach` wide: neighbours within the reach are in
/// the nine cells around.
class Neighbourhood {
 public:
    Neighbourhood(const Domain& domain, double reach, const std::vector<Vec2>& places) : box_(domain.box) {
        constexpr double kMostAcross = 512;
        const Vec2 extent = box_.max - box_.min;
        for (Eigen::Index axis = 0; axis < 2; ++axis)
            across_[axis] = int(std::clamp(std::floor(extent[axis] / reach), 1.0, kMostAcross));
        cells_.resize(std::size_t(across_[0]) * std::size_t(across_[1]));
        for (std::size_t i = 0; i < places.size(); ++i)
            cells_[index(cell(places[i], 0), cell(places[i], 1))].push_back(std::uint32_t(i));
    }

    /// Calls `visit` once for each ball in the cells around a place, across the sides too.
    template <class Visit>
    void around(const Vec2& place, Visit visit) const {
        const int x = cell(place, 0);
        const int y = cell(place, 1);
        // With fewer than three cells across a wrapped cell would come twice.
        for (int i = 0; i < std::min(3, across_[0]); ++i)
            for (int j = 0; j < std::min(3, across_[1]); ++j)
                for (const std::uint32_t ball : cells_[index((x + i - 1 + across_[0]) % across_[0],
                                                             (y + j - 1 + across_[1]) % across_[1])])
                    visit(ball);
    }

 private:
    [[nodiscard]] int cell(const Vec2& place, Eigen::Index axis) const {
        const double share = (place[axis] - box_.min[axis]) / (box_.max[axis] - box_.min[axis]);
        return int(std::clamp(share * across_[axis], 0.0, across_[axis] - 1.0));
    }
    [[nodiscard]] std::size_t index(int x, int y) const {
        return std::size_t(y) * std::size_t(across_[0]) + std::size_t(x);
    }

    Box box_;
    int across_[2] = {1, 1};
    std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace

RadialDistribution::RadialDistribution(const Domain& domain, double reach, std::size_t bins)
    : domain_(domain), reach_(reach), pairs_(bins, 0) {}

bool RadialDistribution::is_inside(const Vec2& place) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto i = Eigen::Index(axis);
        if (domain_.boundary[axis] == Boundary::kPeriodic) continue;
        if (!(place[i] - reach_ >= domain_.box.min[i] && place[i] + reach_ <= domain_.box.max[i]))
            return false;
    }
    return true;
}

Vec2 RadialDistribution::offset(const Vec2& from, const Vec2& to) const {
    Vec2 d = to - from;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto i = Eigen::Index(axis);
        const double extent = domain_.box.max[i] - domain_.box.min[i];
        if (domain_.boundary[axis] == Boundary::kPeriodic) d[i] -= extent * std::round(d[i] / extent);
    }
    return d;
}

void RadialDistribution::add(const std::vector<Ball>& balls) {
    std::vector<Vec2> places;
    for (const Ball& ball : balls)
        if (!ball.is_static) places.push_back(ball.position);
    const Neighbourhood neighbourhood(domain_, reach_, places);
    const double area = (domain_.box.max - domain_.box.min).prod();
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        if (!is_inside(places[i])) continue;
        expected_ += (double(places.size()) - 1) / area;
        neighbourhood.around(places[i], [&](std::uint32_t j) {
            const double distance = offset(places[i], places[j]).norm();
            if (i != j && distance < reach_)
                pairs_[std::min(std::size_t(distance / reach_ * double(pairs_.size())), pairs_.size() - 1)] +=
                    1;
        });
    }
}

std::vector<Vec2> RadialDistribution::points() const {
    std::vector<Vec2> points;
    const double width = reach_ / double(pairs_.size());
    for (std::size_t bin = 0; expected_ > 0 && bin < pairs_.size(); ++bin) {
        const double middle = (double(bin) + 0.5) * width;
        points.emplace_back(middle, pairs_[bin] / (expected_ * 2 * std::numbers::pi * middle * width));
    }
    return points;
}

void SpeedHistogram::add(const std::vector<Ball>& balls) {
    double twice_energy = 0;
    double moving = 0;
    for (const Ball& ball : balls) {
        if (ball.is_static) continue;
        twice_energy += ball.mass * ball.velocity.squaredNorm();
        moving += 1;
    }
    const double temperature = twice_energy / (2 * moving);
    if (!(temperature > 0)) return;
    for (const Ball& ball : balls) {
        if (ball.is_static) continue;
        const double speed = ball.velocity.norm() * std::sqrt(ball.mass / temperature);
        const auto bin = std::size_t(speed / kReach * double(counts_.size()));
        if (bin < counts_.size()) counts_[bin] += 1;
        balls_ += 1;
    }
}

std::vector<Vec2> SpeedHistogram::points() const {
    std::vector<Vec2> points;
    const double width = kReach / double(counts_.size());
    for (std::size_t bin = 0; balls_ > 0 && bin < counts_.size(); ++bin)
        points.emplace_back((double(bin) + 0.5) * width, counts_[bin] / (balls_ * width));
    return points;
}

double maxwell_speed_density(double speed) {
    return speed * std::exp(-speed * speed / 2);
}

}  // namespace carom::app
