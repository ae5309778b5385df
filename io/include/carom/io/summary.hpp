// What a run came to, as one JSON object.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <carom/core/vector.hpp>

namespace carom {

struct Summary {
    std::string scene;
    std::string method = "event";      ///< or "empirical"
    std::string precision = "double";  ///< or "float"
    int threads = 1;
    std::uint64_t balls = 0;
    std::uint64_t walls = 0;
    double time = 0;  ///< simulated, at the end
    std::uint64_t ball_collisions = 0;
    std::uint64_t wall_collisions = 0;
    std::uint64_t events = 0;
    double wall_seconds = 0;  ///< by the clock on the wall
    double collisions_per_second = 0;
    double energy_initial = 0;  ///< kinetic plus potential
    double energy_final = 0;
    double energy_relative_change = 0;
    Vec2 momentum_initial = Vec2::Zero();
    Vec2 momentum_final = Vec2::Zero();
    double max_overlap = 0;  ///< in units of the radii's sum
    std::optional<double> compressibility_factor;
    std::uint64_t windows = 0;
    std::uint64_t window_retries = 0;
    std::optional<std::uint64_t> steps;              ///< of the empirical method
    std::optional<std::uint64_t> missed_collisions;  ///< by the empirical method, where counted
    std::uint64_t peak_memory_bytes = 0;
    std::uint64_t state_hash = 0;
};

/// One JSON object, keys in the order above. Numbers read back with the same bits; what is not finite becomes
/// null; the hash is a string of 16 hexadecimal digits.
[[nodiscard]] std::string to_json(const Summary& summary);

}  // namespace carom
