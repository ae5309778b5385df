// What a user asks for: balls, walls, forces and the rules between them. Units are the user's own, but one
// set throughout (lengths, times and masses; speeds, accelerations and energies follow). io reads and writes
// it, broadphase turns its fills into balls, parallel's World runs it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <carom/core/precision.hpp>
#include <carom/core/vector.hpp>

namespace carom {

/// How two restitutions, one of each body, become the one of the pair.
enum class RestitutionRule : std::uint8_t { kMin, kMax, kProduct, kMean, kGeometric };

/// What happens at a pair of opposite sides of the domain.
enum class Boundary : std::uint8_t { kWall, kPeriodic, kOpen };

/// How collisions are found. kEvent: each at its true time. kEmpirical: at the end of a step, by the overlap
/// that it left, and traced back from there; faster or slower, as accurate as the step is short.
enum class Method : std::uint8_t { kEvent, kEmpirical };

/// Who collides with whom: two bodies do where each one's category has a bit in the other's mask.
struct CollisionFilter {
    std::uint32_t category = 1;
    std::uint32_t mask = 0xffffffff;
    friend bool operator==(const CollisionFilter&, const CollisionFilter&) = default;
};

[[nodiscard]] constexpr bool may_collide(const CollisionFilter& a, const CollisionFilter& b) {
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

/// A disc. `acceleration` is its own, added to the scene's gravity. A static ball never moves and has, in
/// effect, infinite mass.
struct Ball {
    Vec2 position = Vec2::Zero();
    Vec2 velocity = Vec2::Zero();
    Vec2 acceleration = Vec2::Zero();
    double radius = 0.5;
    double mass = 1;
    double restitution = 1;
    bool is_static = false;
    CollisionFilter filter = {};
};

/// A segment that balls hit from both sides and at both ends.
struct Wall {
    Vec2 from = Vec2::Zero();
    Vec2 to = Vec2::Zero();
    double restitution = 1;
    CollisionFilter filter = {};
};

/// Pulls a ball at distance d with acceleration k d / (d^2 + s^2)^(3/2) along the line of centres; k < 0
/// pushes.
struct Attractor {
    Vec2 position = Vec2::Zero();
    double strength = 0;
    double softening = 0;
};

/// A place that tells which balls are there and changes no course: all that is nearer than `radius` to the
/// point, the segment or the convex polygon of its corners (either way around). A moving ball is
/// there while its disc overlaps that, where the filters let the two collide.
struct Sensor {
    std::vector<Vec2> corners;  ///< one, two, or those of a convex polygon
    double radius = 0;
    CollisionFilter filter = {};
};

/// A rectangle with sides along the axes.
struct Box {
    Vec2 min = Vec2::Zero();
    Vec2 max = Vec2::Zero();
};

/// The simulated rectangle and what its sides do: boundary[0] for the sides x = min, max; boundary[1] for y.
struct Domain {
    Box box;
    std::array<Boundary, 2> boundary = {Boundary::kOpen, Boundary::kOpen};
    double restitution = 1;
};

/// Balls to be placed at random without overlap. At least one of count and packing_fraction is given; with
/// both the radius follows (the radii are scaled in common). Packing is the discs' area over the region's
/// area.
struct Fill {
    std::optional<std::uint64_t> count;
    std::optional<double> packing_fraction;
    double radius_min = 0.5;  ///< radii are uniform between the two
    double radius_max = 0.5;
    std::optional<double> mass;     ///< every ball's mass; at most one of mass and density
    std::optional<double> density;  ///< mass = density * pi * radius^2
    double restitution = 1;
    double temperature =
        0;  ///< variance of a velocity component times the mass; the total momentum is removed
    std::uint64_t seed = 1;
    std::optional<Box> region;    ///< the domain's box where absent
    CollisionFilter filter = {};  ///< every ball's; placed without overlap all the same
};

struct Scene {
    std::string name;
    std::optional<Domain> domain;  ///< where absent: open, around everything that is there
    Vec2 gravity = Vec2::Zero();
    RestitutionRule restitution_rule = RestitutionRule::kMin;
    std::optional<double>
        contact_time;         ///< of the TC model; where absent it is derived, see default_contact_time
    double speed_factor = 1;  ///< whole velocity after a hit on a wall or a static ball, times this
    Precision precision = Precision::kDouble;  ///< in which balls' states are held
    Method method = Method::kEvent;
    // Of the empirical method alone; where neither step nor max_travel is given, max_travel is kUsualTravel.
    std::optional<double> step;  ///< time; with max_travel the longest step
    std::optional<double>
        max_travel;                   ///< of any ball in a step, in units of the smallest radius; 0: no limit
    std::optional<double> tolerance;  ///< length; where absent, kUsualTolerance times the smallest radius
    static constexpr double kUsualTravel = 0.2;
    static constexpr double kUsualTolerance = 1e-6;
    bool allows_overlap = false;  ///< whether balls may start inside each other and inside walls
    std::vector<Ball> balls;
    std::vector<Fill> fills;
    std::vector<Wall> walls;
    std::vector<Attractor> attractors;
    std::vector<Sensor> sensors;
    double field_interval = 0.02;  ///< attractors' accelerations are held constant for so long
    double until = 0;              ///< end of the simulation, from time 0
};

/// A scene that cannot be simulated: where it is wrong (`balls[17].radius`) and what must hold there (`must
/// be > 0, is -1`).
class SceneError : public std::runtime_error {
 public:
    SceneError(std::string place, const std::string& rule)
        : std::runtime_error(place.empty() ? rule : place + ": " + rule), place_(std::move(place)) {}
    [[nodiscard]] const std::string& place() const { return place_; }

 private:
    std::string place_;
};

/// Checks every rule that needs no search among the balls: finite numbers, positive radii and masses,
/// restitutions in [0, 1], walls with a length, a domain with an area, balls inside walled and periodic sides
/// (centre at least a radius inside a walled side, centre inside a periodic one), fills that say how many.
/// Throws SceneError at the first fault.
void check(const Scene& scene);

/// The same of one body, with the place `balls[index]`, `walls[index]` and so on; of `scene` the domain and
/// the precision count.
void check(const Ball& ball, const Scene& scene, std::size_t index);
void check(const Wall& wall, const Scene& scene, std::size_t index);
void check(const Attractor& attractor, std::size_t index);
void check(const Sensor& sensor, std::size_t index);
void check_gravity(const Vec2& gravity);

}  // namespace carom
