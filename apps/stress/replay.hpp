// The list of collisions taken at its word: velocities and energy follow from the start, the forces and the
// impulses alone. What follows must be what the world shows, and each collision must obey the law of impact.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>
#include <carom/parallel/world.hpp>

#include "physics.hpp"

namespace carom::stress {

class Replay {
 public:
    /// At the start of a world of `scene`, whose fills are placed.
    Replay(const Scene& scene, const World& world);

    /// After edits, from what the world is now. `scene` is what it has become.
    void start_anew(const Scene& scene, const World& world);
    /// Every collision, in the order in which the world tells them; `steps` is how many the empirical method
    /// has made by then.
    void take(const Collision& c, std::uint64_t steps);
    /// The world at a time up to which all collisions have been taken.
    void compare(const World& world);

    /// What was wrong first; empty while all is well.
    [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
    /// A ball's velocity, and by how much rounding may have put it wrong.
    struct Course {
        Vec2 velocity;
        Vec2 acceleration;
        double time = 0;
        std::uint64_t steps = 0;
        double doubt = 0;
        double reach = 0;  ///< no place of the ball is farther from the origin
        double fastest = 0;
    };

    /// The one body or the two of a collision, seen along its normal.
    struct Bodies {
        Course* first = nullptr;
        Course* second = nullptr;  ///< none where it does not move
        double inverse_mass_first = 0;
        double inverse_mass_second = 0;
    };

    [[nodiscard]] std::size_t index_of(std::uint32_t id) const;
    [[nodiscard]] bool has_partner(const Collision& c) const;
    void blame(const Collision& c, const std::string& what, double found, double bound);
    [[nodiscard]] bool is_well_formed(const Collision& c);
    [[nodiscard]] double restitution_of(const Collision& c) const;
    [[nodiscard]] double hop_of(const Bodies& bodies) const;
    void move_to(Course& course, double time) const;
    void check_response(const Collision& c, const Bodies& bodies);
    void push(Course& course, const Vec2& change);
    void compare_energy(const World& world, double time);

    Scene scene_;
    std::vector<std::uint32_t> ids_;  ///< of the scene's balls, rising
    std::vector<std::uint32_t> wall_ids_;
    std::vector<Course> courses_;
    bool follows_velocities_ = true;  ///< neither the field nor a speed factor changes them unseen
    double rounding_ = 0;             ///< half an ulp of 1, in what states are held
    double rest_time_ = 0;            ///< at most: edits leave it or derive it anew
    std::optional<EmpiricalSteps> empirical_;
    std::uint64_t steps_ = 0;
    double corner_ = 0;  ///< the box's farthest point from the origin
    double last_time_ = 0;
    double energy_ = 0;  ///< at the start
    double energy_gained_ =
        0;                     ///< since then, as it follows; apart, lest small gains are lost in a large sum
    double energy_doubt_ = 0;  ///< rounding, summed
    std::uint64_t collisions_ = 0;
    std::string fault_;
};

}  // namespace carom::stress
