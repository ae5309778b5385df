// The world behind a window: how it is moved on, what is known of it, which ball is looked at. Knows no
// window.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

#include "driver.hpp"
#include "event_log.hpp"
#include "next_meeting.hpp"

namespace carom::app {

/// All that is told of the ball that is looked at.
struct BallFacts {
    std::uint32_t id = 0;
    Ball ball;
    std::optional<SavedAnchor> anchor;  ///< none: static, or the method keeps none
    double anchor_age = 0;              ///< time since its last event
    std::uint32_t collisions = 0;
    std::optional<Meeting> next;
    std::vector<Collision> history;  ///< the last one first
};

/// Curves of a simulation's last stretch, by real time.
struct Curves {
    static constexpr std::size_t kLength = 240;
    std::vector<float> energy;
    std::vector<float> collision_rate;  ///< collisions a unit of simulated time
};

class Simulation {
 public:
    Simulation(Scene scene, const WorldOptions& options);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const World& world() const { return *world_; }
    [[nodiscard]] const EventLog& log() const { return *log_; }
    [[nodiscard]] const Curves& curves() const { return curves_; }
    [[nodiscard]] const std::vector<Ball>& balls() const { return balls_; }

    /// Moves on by `seconds` of real time at `speed`, but works no longer than `budget` real seconds: what is
    /// not reached by then is not made up for. Without a budget it is reached exactly.
    void play(double seconds, double speed, std::optional<double> budget);
    /// Moves on to the next collision's time and not beyond. False where there is none within the scene's
    /// reach.
    bool play_one_event();
    /// Begins anew; the seeds of the fills are shifted, 0 for the scene as it is.
    void restart(std::uint64_t seed_shift);

    /// The ball under a place, of several the one whose centre is nearest; or the one whose edge is within
    /// `slack`.
    [[nodiscard]] std::optional<std::uint32_t> ball_at(const Vec2& place, double slack) const;
    void look_at(std::optional<std::uint32_t> ball) { looked_at_ = ball; }
    [[nodiscard]] std::optional<std::uint32_t> looked_at() const { return looked_at_; }
    // Edits at the world's time. False, and refusal() says why, where that cannot be.
    bool throw_ball(std::uint32_t ball, const Vec2& velocity);
    /// At rest, otherwise like the ball that is looked at, or the first that moves.
    bool add_ball(const Vec2& place);
    /// A black hole that a ball at about the mean speed escapes from a tenth of the plane away.
    bool add_attractor(const Vec2& place);
    [[nodiscard]] const std::string& refusal() const { return refusal_; }

    /// Of the ball that is looked at.
    [[nodiscard]] std::optional<BallFacts> facts() const;

 private:
    void build();
    void advance_to(double time);
    void after_moving();
    void take_sample(double seconds);
    template <class Edit>
    bool edit(Edit&& edit);

    Scene scene_;
    std::vector<std::uint64_t> seeds_;
    WorldOptions options_;
    std::unique_ptr<EventLog> log_;
    std::unique_ptr<World> world_;
    bool listens_ = true;
    std::optional<double> seen_at_;  // time of the first collision since it was cleared
    std::vector<Ball> balls_;
    SlicePace pace_{1e-6};
    Curves curves_;
    double since_sample_ = 0;
    double sampled_at_ = 0;
    std::uint64_t sampled_collisions_ = 0;
    std::optional<std::uint32_t> looked_at_;
    std::map<std::uint32_t, double> thrown_at_;  // the time of a ball's last edit
    std::string refusal_;
};

}  // namespace carom::app
