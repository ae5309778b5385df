// A point that bounces on an elastic floor under gravity, in closed form: it repeats itself.
#pragma once

#include <cmath>
#include <cstdint>

#include "accuracy/systems.hpp"

namespace carom::accuracy {

class BouncingPoint {
 public:
    /// From `height` >= 0 at `speed` upwards; gravity > 0.
    BouncingPoint(long double height, long double speed, long double gravity)
        : gravity_(gravity),
          impact_speed_(std::sqrt(speed * speed + 2 * gravity * height)),
          since_floor_((impact_speed_ - speed) / gravity) {}

    [[nodiscard]] long double height(long double time) const {
        const long double s = std::fmod(since_floor_ + time, period());
        return s * (impact_speed_ - s * gravity_ / 2);
    }
    [[nodiscard]] std::uint64_t bounces(long double time) const {
        return static_cast<std::uint64_t>(std::floor((since_floor_ + time) / period()));
    }
    /// Of the bounce number n = 1, 2, ...
    [[nodiscard]] long double bounce_time(std::uint64_t n) const {
        return static_cast<long double>(n) * period() - since_floor_;
    }
    [[nodiscard]] double impact_speed() const { return static_cast<double>(impact_speed_); }

    /// What `events` events, each with an error `place` of the height and `speed` of the speed, can do to the
    /// height at `time`. With w the impact speed, w dw = g dz + v dv, and the period is 2 w / g: an event
    /// changes w by at most g dz / w + dv, hence the height there and then by (2 w / g) dw, the phase by
    /// (dw + dv) / g and, in each of n bounces to come, by another 2 dw / g; the phase moves the height at
    /// w.
    [[nodiscard]] double bound(std::uint64_t events, long double time, double place, double speed) const {
        const auto n = static_cast<double>(bounces(time));
        const double w = impact_speed();
        const auto g = static_cast<double>(gravity_);
        const double change = g * place / w + speed;
        return static_cast<double>(events) * (w / g * ((3 + 2 * n) * change + speed)) + place;
    }

 private:
    [[nodiscard]] long double period() const { return 2 * impact_speed_ / gravity_; }

    long double gravity_;
    long double impact_speed_;
    long double since_floor_;
};

}  // namespace carom::accuracy
