// The numbers of a scene that every event needs, and the scales derived from it.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <carom/core/clock.hpp>
#include <carom/core/scene.hpp>

namespace carom {

/// More renewals of the attractors' field than that no run survives.
inline constexpr double kMostFieldUpdates = 1e9;

/// What the empirical method goes by.
struct EmpiricalSteps {
    double longest = std::numeric_limits<double>::infinity();  ///< time
    double travel = std::numeric_limits<double>::infinity();   ///< length, of no moving ball more in a step
    double tolerance = 0;                                      ///< length
};

struct Physics {
    Domain domain;
    Vec2 gravity = Vec2::Zero();
    RestitutionRule restitution_rule = RestitutionRule::kMin;
    double contact_time = 0;  ///< of the TC model; 0 turns it off
    double rest_time = 0;     ///< a contact under pressure parts for at least so long, see scales.cpp
    double speed_factor = 1;
    bool in_float = false;      ///< balls' states are rounded to float at each event
    bool loses_energy = false;  ///< some restitution, or the speed factor, is below 1
    double typical_virial = 1;  ///< of a collision: mass * speed * diameter
    Clock clock;
    std::optional<EmpiricalSteps> empirical;  ///< where that is the method
};

/// The scene's numbers and scales. `balls` are all balls, fills included, at time 0.
[[nodiscard]] Physics derive_physics(const Scene& scene, std::span<const Ball> balls);

/// The speed at which a contact pressed together must part to stay open for `rest_time`; `line` is its centre
/// line or normal, of any length.
[[nodiscard]] inline double parting_speed(double pressure, const Vec2& line, double rest_time) {
    return pressure > 0 ? pressure / std::sqrt(length_squared(line)) * rest_time / 2 : 0.0;
}

/// The acceleration that the attractors give a ball at p.
[[nodiscard]] Vec2 field_at(std::span<const Attractor> attractors, const Vec2& p);

}  // namespace carom
