#include <carom/parallel/kernel.hpp>

#include <initializer_list>
#include <utility>

#include "bodies.hpp"
#include "sights.hpp"

namespace carom {
namespace {

std::string acceleration_text(const Kernel& k) {
    if (k.acceleration == Acceleration::kNone) return "no acceleration";
    if (k.acceleration == Acceleration::kUniform) return "uniform acceleration (gravity)";
    if (!k.has_field) return "acceleration per ball (the balls' own)";
    return k.has_own_accelerations ? "acceleration per ball (the balls' own and attractors)"
                                   : "acceleration per ball (attractors)";
}

std::string boundary_text(const std::array<Boundary, 2>& boundary) {
    constexpr std::array<const char*, 3> kNames = {"walled", "periodic", "open"};
    const auto name = [&](std::size_t axis) {
        return std::string(kNames[static_cast<std::size_t>(boundary[axis])]);
    };
    return boundary[0] == boundary[1] ? name(0) : "x " + name(0) + ", y " + name(1);
}

std::string bounds_text(const Kernel& k) {
    if (k.bounds_on_vectors) return "yes";
    return k.acceleration == Acceleration::kPerBall ? "no (accelerations differ from ball to ball)"
                                                    : "no (too few cells, or balls too small in them)";
}

}  // namespace

Kernel Bodies::kernel() const {
    Kernel k;
    k.acceleration = acceleration();
    k.has_own_accelerations = !own_acceleration.empty();
    k.has_field = !attractors.empty();
    k.has_equal_radii = radius.is_one();
    k.has_equal_masses = mass.is_one();
    k.loses_energy = physics.loses_energy;
    k.keeps_contacts = physics.contact_time > 0;
    k.rounds_to_float = physics.in_float;
    k.has_walls = !walls.empty();
    k.has_static_balls = !is_static.empty();
    k.large_balls = large.size();
    k.boundary = physics.domain.boundary;
    Sights sights;
    sights.clear(*this, {grid, whole(grid.x), whole(grid.y), 0});
    k.bounds_on_vectors = sights.are_of_use() && k.acceleration != Acceleration::kPerBall;
    return k;
}

std::string describe(const Kernel& k) {
    std::string text = acceleration_text(k);
    const std::initializer_list<std::pair<bool, std::string>> parts = {
        {true, k.has_equal_radii ? "equal radii" : "mixed radii"},
        {k.large_balls > 0, std::to_string(k.large_balls) + " wider than a cell (one domain)"},
        {true, k.has_equal_masses ? "equal masses" : "mixed masses"},
        {true, k.loses_energy ? "losses" : "elastic"},
        {k.keeps_contacts, "contact time"},
        {true, boundary_text(k.boundary)},
        {k.has_walls, "walls"},
        {k.has_static_balls, "static balls"},
        {k.rounds_to_float, "rounds to float"}};
    for (const auto& [is_said, part] : parts)
        if (is_said) text += ", " + part;
    return text + "; bounds on vectors: " + bounds_text(k);
}

}  // namespace carom
