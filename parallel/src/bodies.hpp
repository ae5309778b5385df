// What does not change while a world runs and all domains share: the bodies' properties, the grid, the
// obstacles, and the margins of the arithmetic.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <carom/broadphase/grid.hpp>
#include <carom/broadphase/obstacles.hpp>
#include <carom/core/response.hpp>
#include <carom/parallel/kernel.hpp>

#include "ball_record.hpp"
#include "fault.hpp"
#include "physics.hpp"

namespace carom {

/// A property that most scenes give to all balls alike: one value then, else one a ball.
class Property {
 public:
    Property() = default;
    Property(std::span<const Ball> balls, double Ball::* member);

    [[nodiscard]] double of(std::uint32_t id) const { return each_.empty() ? one_ : each_[id]; }
    [[nodiscard]] bool is_one() const { return each_.empty(); }

 private:
    double one_ = 0;
    std::vector<double> each_;
};

/// How many periods the second of two bodies is moved by to be met by the first.
struct Image {
    std::int32_t x = 0;
    std::int32_t y = 0;
    Image operator-() const { return {-x, -y}; }
    Image operator+(const Image& o) const { return {x + o.x, y + o.y}; }
    Image operator-(const Image& o) const { return {x - o.x, y - o.y}; }
};

/// A side of the domain, by its number: left, right, bottom, top.
struct Side {
    explicit Side(std::uint32_t number) : axis(static_cast<int>(number / 2)), upper(number % 2 == 1) {}
    int axis;
    bool upper;
};

struct Bodies {
    Bodies(const Physics& physics, std::span<const Ball> balls, std::span<const Wall> walls,
           std::span<const Attractor> attractors, const Grid& grid);

    Physics physics;
    Grid grid;
    std::vector<Wall> walls;
    std::vector<Attractor> attractors;
    std::uint32_t count = 0;  ///< of all balls, static ones included
    std::uint32_t moving = 0;
    // What the world calls them: rising numbers, of which those of removed bodies are left out. Within the
    // engine bodies go by their index, which orders them alike. Empty where the two are the same.
    std::vector<std::uint32_t> ball_ids;
    std::vector<std::uint32_t> wall_ids;
    Property radius, mass, restitution;
    std::vector<std::uint8_t> is_static;  ///< one a ball; empty where none is
    std::vector<CollisionFilter>
        filters;                         ///< of balls and walls by number; empty where all are the usual one
    std::vector<Vec2> own_acceleration;  ///< one a ball; empty where all are zero
    std::vector<Vec2> fixed;             ///< the places of static balls, one a ball; empty where none is

    ObstacleMap obstacles;
    ObstacleMap obstacles_of_large;
    std::vector<std::uint32_t> large;  ///< ids of moving balls wider than a cell, few
    double largest_listed_radius = 0;  ///< of all other moving balls

    double smallest_radius = 1;     ///< of the moving balls
    double time_margin = 0;         ///< of times since the start of the epoch
    bool has_obstacles = false;     ///< static balls, walls or walled sides
    bool has_clear_images = false;  ///< whether the image in the next cell is the nearest one

    [[nodiscard]] std::uint32_t ball_id(std::uint32_t index) const {
        return ball_ids.empty() ? index : ball_ids[index];
    }
    /// Of a wall, or of a side, which follow the last wall.
    [[nodiscard]] std::uint32_t wall_id(std::uint32_t index) const {
        if (wall_ids.empty() || index < wall_ids.size()) return wall_ids.empty() ? index : wall_ids[index];
        return wall_ids.back() + 1 + index - static_cast<std::uint32_t>(wall_ids.size());
    }
    /// As errors call it.
    [[nodiscard]] std::string ball_name(std::uint32_t index) const {
        return "balls[" + std::to_string(ball_id(index)) + "]";
    }
    /// Whether a ball collides with a body of any kind, by its number; with the domain's sides all do.
    [[nodiscard]] bool may_meet(std::uint32_t id, std::uint32_t partner) const {
        if (filters.empty() || partner >= first_side()) return true;
        if (is_active(Fault::kOneMask)) return (filters[id].category & filters[partner].mask) != 0;
        return may_collide(filters[id], filters[partner]);
    }
    [[nodiscard]] bool fixes(std::uint32_t id) const { return !is_static.empty() && is_static[id] != 0; }
    [[nodiscard]] Vec2 own_acceleration_of(std::uint32_t id) const {
        return own_acceleration.empty() ? Vec2(Vec2::Zero()) : own_acceleration[id];
    }
    [[nodiscard]] Vec2 offset_of(const Image& image) const {
        return {image.x * grid.x.length(), image.y * grid.y.length()};
    }
    /// The restitution of a ball with a body of any kind, by its number.
    [[nodiscard]] double restitution_between(std::uint32_t id, std::uint32_t partner) const {
        const double other = partner < count          ? restitution.of(partner)
                             : partner < first_side() ? walls[partner - count].restitution
                                                      : physics.domain.restitution;
        return pair_restitution(physics.restitution_rule, restitution.of(id), other);
    }
    /// Gravity, the ball's own acceleration and the attractors' at a place. Throws std::runtime_error where
    /// that is no number.
    [[nodiscard]] Vec2 acceleration_at(std::uint32_t id, const Vec2& place) const;
    /// Whether accelerations differ from ball to ball.
    [[nodiscard]] bool accelerates_each() const { return !own_acceleration.empty() || !attractors.empty(); }
    /// The event loop's kind.
    [[nodiscard]] Acceleration acceleration() const {
        if (accelerates_each()) return Acceleration::kPerBall;
        return physics.gravity.isZero(0) ? Acceleration::kNone : Acceleration::kUniform;
    }
    [[nodiscard]] Kernel kernel() const;
    /// Whether balls carry a BallExtra.
    [[nodiscard]] bool needs_extras() const { return accelerates_each() || physics.contact_time > 0; }
    /// A position as an anchor holds it: in the box, and rounded where states are held in float. Counts the
    /// periods that it was away.
    [[nodiscard]] Vec2 held_position(const Vec2& position, Periods& away) const {
        const Vec2 inside = {grid.x.wrapped(position.x(), away.x), grid.y.wrapped(position.y(), away.y)};
        return physics.in_float ? rounded_position(inside, away) : inside;
    }
    [[nodiscard]] Vec2 held_velocity(const Vec2& velocity) const {
        return physics.in_float ? rounded_to_float(velocity) : velocity;
    }
    /// Events are with partners numbered so: balls, then walls, then the domain's sides.
    [[nodiscard]] std::uint32_t first_side() const {
        return count + static_cast<std::uint32_t>(walls.size());
    }

 private:
    [[nodiscard]] Vec2 rounded_position(const Vec2& inside, Periods& away) const;
    void choose_margins();
};

}  // namespace carom
