// What of the engine a scene makes run. A scene pays for what it uses; this says what that is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <carom/core/scene.hpp>

namespace carom {

/// How accelerations differ from ball to ball. Pairs under one common acceleration move straight relative to
/// each other.
enum class Acceleration : std::uint8_t { kNone, kUniform, kPerBall };

/// The parts of the event loop that a world runs, and what in its scene asks for them. Chosen once, when the
/// world is built.
struct Kernel {
    Acceleration acceleration = Acceleration::kNone;
    bool has_own_accelerations = false;  ///< of balls: accelerations differ from ball to ball
    bool has_field = false;              ///< of attractors: the same
    bool has_equal_radii = true;         ///< of all balls, static ones included; else one is read a ball
    bool has_equal_masses = true;        ///< the same
    bool loses_energy = false;           ///< some restitution, or the speed factor, is below 1
    bool keeps_contacts = false;         ///< every ball's last collision, for the contact time
    bool rounds_to_float = false;        ///< a ball's state at each of its events
    bool has_walls = false;              ///< segments, beside the domain's sides
    bool has_static_balls = false;
    std::size_t large_balls = 0;  ///< wider than a cell: each looks at many cells, all at each; one domain
    std::array<Boundary, 2> boundary = {Boundary::kOpen, Boundary::kOpen};
    /// Whether vectors bound the times of impact of all candidates at once, so that few need the exact one.
    /// Not where accelerations differ from ball to ball, nor where rounding could outgrow the bounds' margin:
    /// in a periodic box of fewer than six cells, or one too wide for its smallest ball.
    bool bounds_on_vectors = false;
};

/// One line of plain text: `uniform acceleration (gravity), equal radii, equal masses, elastic, periodic;
/// bounds on vectors: yes`.
[[nodiscard]] std::string describe(const Kernel& kernel);

}  // namespace carom
