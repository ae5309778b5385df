// Systems whose course is known, run through the whole engine: each gives its worst error and the bound that
// reasoning allows. exact_systems_test holds them to it; carom_accuracy prints them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::accuracy {

/// The largest relative error of one rounding.
inline constexpr double kRounding = 0x1p-53;

/// What a run came to.
struct Deviation {
    std::uint64_t collisions = 0;  ///< that the engine resolved
    std::uint64_t expected = 0;    ///< counted without the engine
    double error = 0;              ///< the worst, as a part of its bound
    double bound = 0;              ///< of that one

    void include(double new_error, double new_bound) {
        if (std::isnan(new_error)) new_error = std::numeric_limits<double>::infinity();
        if (new_error == 0 && bound > 0) return;
        if (new_error * bound < error * new_bound) return;
        error = new_error;
        bound = new_bound;
    }
};

struct System {
    std::string name;
    std::string figure;  ///< what the error is of
    std::function<Deviation()> measure;
};

std::vector<System> line_systems();      ///< equal balls in a line, which are points that pass each other
std::vector<System> mass_systems();      ///< unequal balls in a line
std::vector<System> bounce_systems();    ///< bounces under gravity
std::vector<System> billiard_systems();  ///< among walls
std::vector<System> reversal_systems();  ///< there and back
std::vector<System> long_systems();      ///< some ten million collisions

std::string systems_header();
std::string system_line(const System& system, const Deviation& deviation);

/// A ball of radius 1/2 and mass 1.
inline Ball ball_at(double x, double y, double vx, double vy) {
    Ball b;
    b.position = {x, y};
    b.velocity = {vx, vy};
    return b;
}

/// Multiples of 2^-20: sums and products of a few of them are exact in double.
inline double dyadic(double x) {
    return std::nearbyint(std::ldexp(x, 20)) * 0x1p-20;
}

}  // namespace carom::accuracy
