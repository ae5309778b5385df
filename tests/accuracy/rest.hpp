// What resting and collapsing scenes cost, and whether a pile keeps its energy and its height.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::accuracy {

/// Balls under gravity in a box. Times are in contact times, which the scene gives.
struct RestCase {
    std::string name;
    Scene scene;
    double settling = 0;  ///< before anything is measured
    double length = 0;    ///< of the measurement
    bool settles = true;  ///< whether it is at rest by then; else it still cools
};

/// With m the mean mass and g the gravity: energies are a ball's, in m (g t_c)^2, the energy of a fall for
/// one contact time t_c twice over; heights in g t_c^2.
struct Rest {
    std::uint64_t balls = 0;
    double contact_time = 0;
    double collisions = 0;  ///< in one contact time, half of each ball's a ball
    double most = 0;        ///< the same in the busiest of ten parts of the measurement
    double kinetic_0 = 0, kinetic_1 = 0;
    double energy_change = 0;  ///< kinetic plus potential
    double height_change = 0;  ///< of the centre of mass
    double overlap = 0;        ///< at the end, in units of the radii's sum
};

/// More a ball and contact time no scene may have, see docs/accuracy.md.
inline constexpr double kMostInContactTime = 30;

/// Eight layers that come to rest: the pile that others compare with.
[[nodiscard]] RestCase resting_pile();
/// Small ones, and with `all` those whose measurement takes minutes.
[[nodiscard]] std::vector<RestCase> rest_cases(bool all);
[[nodiscard]] Rest measure(const RestCase& rest);
[[nodiscard]] std::string rest_header();
[[nodiscard]] std::string rest_line(const RestCase& rest, const Rest& measured);

}  // namespace carom::accuracy
