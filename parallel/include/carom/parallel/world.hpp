// World: a scene in motion. Every collision is found at its true time and resolved in time order; by the
// empirical method, where the scene asks for that, within a tolerance and as far as a step shows it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>
#include <carom/core/snapshot.hpp>
#include <carom/parallel/edits.hpp>
#include <carom/parallel/kernel.hpp>
#include <carom/parallel/queries.hpp>

namespace carom {

/// One resolved collision. `j` is a ball's id for kBall (i < j, or j is static), a wall's for kWall; the
/// domain's sides are numbered after the last wall: left, right, bottom, top.
struct Collision {
    double time;
    CollisionKind kind;
    std::uint32_t i;
    std::uint32_t j;
    Vec2 point;             ///< where the two surfaces meet
    Vec2 normal;            ///< unit vector towards ball i
    double impulse;         ///< given to ball i along the normal, mass * length / time
    double approach_speed;  ///< relative speed along the normal just before
};

/// A ball that comes into a sensor or leaves it.
struct Sensing {
    double time;
    std::uint32_t sensor;  ///< its index in World::sensors()
    std::uint32_t ball;    ///< id
    bool enters;
    Vec2 position;  ///< of the ball then
    Vec2 velocity;
};

struct WorldOptions {
    int threads = 0;  ///< 0: as many as the machine offers
    double cell_size =
        0;            ///< of the grid; 0: chosen from the scene. Changes speed, never a bit of the result
    int domains = 0;  ///< that the plane is cut in, to be simulated side by side; 0: chosen. Speed only
    int halo = 0;     ///< cells around a domain that it simulates as well; 0: chosen. Speed only
    bool count_missed = true;  ///< whether the empirical method counts what it misses. Speed only
};

/// Something that must not be: what, where, by how much.
struct Violation {
    std::string what;
};

/// One vector a ball, in the order of the ids: N pairs of doubles without gaps. A std::vector rather than a
/// matrix of Eigen's, whose way of allocating changes with the instruction set that the library was built
/// for; to have the N x 2 matrix, Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2,
/// Eigen::RowMajor>>(p[0].data(), p.size(), 2).
using PlaneVectors = std::vector<Vec2>;

class World {
 public:
    /// Checks the scene, places its fills, finds every ball's first event. Throws SceneError on a scene that
    /// cannot be simulated.
    explicit World(const Scene& scene, const WorldOptions& options = {});
    /// The same scene as a snapshot has it, to go on from there. Throws SnapshotError as restore() does.
    World(const Scene& scene, const WorldOptions& options, const Snapshot& snapshot);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Resolves all events up to and including the given time, which must not lie in the past
    /// (std::invalid_argument). The empirical method goes through all steps that end by then; from the last
    /// one on, balls are read in free flight.
    void advance_to(double time);
    /// advance_to(time() + dt)
    void step(double dt);

    [[nodiscard]] double time() const;
    [[nodiscard]] std::size_t ball_count() const;
    [[nodiscard]] std::size_t wall_count() const;
    [[nodiscard]] int threads() const;
    [[nodiscard]] double cell_size() const;
    [[nodiscard]] double contact_time() const;
    /// The box that is simulated; where the scene has none, the one around what was there at the start.
    [[nodiscard]] const Domain& domain() const;
    /// What of the engine the scene makes run; fixed when the world is built.
    [[nodiscard]] Kernel kernel() const;

    /// State at time(); reading anchors nothing. Periodic positions lie inside the box. One entry a ball, in
    /// the order of the ids; as long as no ball has been removed, a ball's id is its index.
    [[nodiscard]] PlaneVectors positions() const;
    [[nodiscard]] PlaneVectors velocities() const;
    /// Where balls would be had periodic sides not taken them back, from their positions at time 0 on.
    [[nodiscard]] PlaneVectors unwrapped_positions() const;
    /// The same rounded to float, for what draws or needs no more: 8 bytes a ball.
    [[nodiscard]] std::vector<Vector2<float>> positions_in_float() const;
    [[nodiscard]] std::vector<Vector2<float>> velocities_in_float() const;
    /// Every ball at time(), in the order of the ids: positions, velocities and what does not change.
    [[nodiscard]] std::vector<Ball> balls() const;

    /// The number of the domain that owns each ball at present, in the order of the ids: how the work is cut,
    /// for who wants to look at it. Of no consequence; 0 for static balls and where there is one domain.
    [[nodiscard]] std::vector<std::uint32_t> domains_of_balls() const;

    [[nodiscard]] Counts counts() const;
    /// Seconds that the threads have worked on domains, all together, for benchmarks; 0 where there is one
    /// domain.
    [[nodiscard]] double working_seconds() const;
    [[nodiscard]] double kinetic_energy() const;
    /// Kinetic plus potential in the scene's gravity and the balls' own accelerations.
    [[nodiscard]] double energy() const;
    [[nodiscard]] Vec2 momentum() const;
    /// Sum over the ball collisions of r_ij . impulse, with r_ij the centres' offset: mass * length^2 /
    /// time^2 * time.
    [[nodiscard]] double virial() const;
    /// PA / NkT from the virial; none unless the box is periodic on both axes,
    /// time has passed, and neither losses nor forces change the temperature.
    [[nodiscard]] std::optional<double> compressibility_factor() const;
    /// The deepest penetration of two balls, or a ball and a wall, at time(), in units of the radii's sum; 0
    /// where none overlaps.
    [[nodiscard]] double max_overlap() const;
    /// Equal exactly when all positions and velocities at time() are bit-identical.
    [[nodiscard]] std::uint64_t state_hash() const;
    /// Every broken invariant; empty in a sound world. That bodies overlap is none where the method is
    /// empirical. Costs a pass over all pairs of neighbours.
    [[nodiscard]] std::vector<Violation> validate() const;

    /// Equal for scenes with the same course: of all but the name and the end.
    [[nodiscard]] std::uint64_t scene_hash() const;
    /// All that the future depends on, at time(). What is gone on from it is what would have been, to the
    /// bit, for any options on either side: states, collisions and all that follows from them. Counts of the
    /// work alone (events, windows, retries, copies) go on from here but depend on how the work is done.
    [[nodiscard]] Snapshot snapshot() const;
    /// Puts the world where the snapshot has it, earlier or later. Throws SnapshotError where that is of
    /// another scene or method or holds what cannot be; the world stays as it was. Not to be called from a
    /// listener.
    void restore(const Snapshot& snapshot);

    // ---- Who takes part. A ball keeps its id while it is there; in a scene that is its index.

    /// One a ball, in the order of positions() and balls().
    [[nodiscard]] std::vector<std::uint32_t> ball_ids() const;
    [[nodiscard]] bool has_ball(std::uint32_t id) const;
    /// Throws std::out_of_range where there is none of that id, as all below do.
    [[nodiscard]] Ball ball(std::uint32_t id) const;
    /// The walls that are there, and their ids in the same order.
    [[nodiscard]] const std::vector<Wall>& walls() const;
    [[nodiscard]] std::vector<std::uint32_t> wall_ids() const;
    [[nodiscard]] const std::vector<Attractor>& attractors() const;
    [[nodiscard]] const Vec2& gravity() const;
    /// A number of the user's own; 0 until it is set, and again when the ball is removed.
    [[nodiscard]] std::uint64_t user_data(std::uint32_t id) const;
    void set_user_data(std::uint32_t id, std::uint64_t data);

    // ---- Edits. Each takes place at time() and is an event of the balls that it names: they start anew from
    // there. Walls and static balls that come, and changes of forces, are events of all balls. What is not
    // edited keeps its bits; the same edits at the same time give the same bits however the world is stepped
    // and cut up. The empirical method ends a step there, for all balls. Nothing is changed where one throws:
    // SceneError on values that no scene may have, and on what would overlap (unless the scene allows that);
    // std::out_of_range on ids that are not there. Not to be called from a listener.

    /// All at once. Where moving balls get other velocities and nothing else changes, the cost is theirs in a
    /// world of one domain; other positions cost a pass over all balls, anything else that of setting up a
    /// world of so many balls: one call with many is far cheaper than many with one.
    Added apply(const Edits& edits);
    std::uint32_t add_ball(const Ball& ball);
    void remove_ball(std::uint32_t id);
    void set_position(std::uint32_t id, const Vec2& position);
    void set_velocity(std::uint32_t id, const Vec2& velocity);
    void set_acceleration(std::uint32_t id, const Vec2& acceleration);
    void set_radius(std::uint32_t id, double radius);
    void set_mass(std::uint32_t id, double mass);
    void set_restitution(std::uint32_t id, double restitution);
    /// Adds impulse / mass to the velocity.
    void apply_impulse(std::uint32_t id, const Vec2& impulse);
    std::uint32_t add_wall(const Wall& wall);
    void remove_wall(std::uint32_t id);
    void set_attractors(const std::vector<Attractor>& attractors);
    void set_gravity(const Vec2& gravity);

    // ---- What is where at time(), static balls included. Ids rise. The first question at a time sorts all
    // balls by place, further ones are answered in logarithmic time. Periodic axes are gone round.

    /// Balls whose discs touch the box, and those that touch a disc (a point, where its radius is 0).
    [[nodiscard]] std::vector<std::uint32_t> balls_in(const Box& box) const;
    [[nodiscard]] std::vector<std::uint32_t> balls_at(const Vec2& centre, double radius = 0) const;
    /// None where there is no ball. `except` leaves one out: who asks from its own place.
    [[nodiscard]] std::optional<NearestBall> nearest_ball(const Vec2& point,
                                                          std::optional<std::uint32_t> except = {}) const;
    /// The first ball, wall or walled side along a ray of that length. Throws std::invalid_argument where
    /// the direction is zero, or the way longer than a million periods of a periodic box.
    [[nodiscard]] std::optional<RayHit> cast_ray(const Vec2& from, const Vec2& direction,
                                                 double length) const;

    // ---- Sensors. They look on: with or without them the balls' course has the same bits. The event method
    // alone knows them (std::logic_error).

    [[nodiscard]] const std::vector<Sensor>& sensors() const;
    /// Others from now on. Throws SceneError on what no scene may have.
    void set_sensors(std::vector<Sensor> sensors);
    /// The moving balls that are in a sensor at time(). Ids rise.
    [[nodiscard]] std::vector<std::uint32_t> balls_in_sensor(std::uint32_t sensor) const;
    /// Called for every moving ball that comes into a sensor or leaves it from time() on, at its true time,
    /// in the order of time: after the collisions of the same stretch of time. A ball that is in one already
    /// does not come, one that an edit puts there or takes away does so at the edit's time. A sensor that
    /// ends where balls bounce off tells what rounding makes of it. An empty function turns it off.
    void on_sensing(std::function<void(const Sensing&)> listener);

    /// Called for every collision in the order of events, while the world moves: a listener must not look at
    /// its balls nor change it (std::logic_error), what it is told is what holds. An empty function turns it
    /// off.
    void on_collision(std::function<void(const Collision&)> listener);

 private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace carom
