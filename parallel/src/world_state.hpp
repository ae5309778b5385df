// What a World holds: the bodies that take part, the engine that moves them, the time, and the states as they
// were read last.
#pragma once

#include <carom/parallel/world.hpp>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <carom/broadphase/overlap.hpp>

#include "bodies.hpp"
#include "engine.hpp"
#include "executor.hpp"
#include "place_index.hpp"
#include "sensor_watch.hpp"

namespace carom {

/// Who takes part, and by which rules. Never changed: an edit of either makes another.
struct Cast {
    Cast(Scene rules, const Physics& physics, const std::vector<Ball>& balls, double cell_size);

    Scene rules;  ///< without balls and fills
    Bodies bodies;
    std::uint64_t scene_hash = 0;  ///< of the scene with which it all began
    /// Neither losses nor forces, so that one temperature holds until there are edits.
    bool in_equilibrium = false;
    double deepest_overlap = 0;  ///< at the beginning or after edits, where overlaps are allowed
    std::vector<std::pair<std::uint32_t, BallState>> fixed_states;
};

/// A sum that carries what its terms lose (Neumaier 1974).
struct CompensatedSum {
    double sum = 0;
    double lost = 0;
    CompensatedSum& operator+=(double x) {
        const double next = sum + x;
        lost += std::abs(sum) >= std::abs(x) ? (sum - next) + x : (x - next) + sum;
        sum = next;
        return *this;
    }
    CompensatedSum& operator+=(const CompensatedSum& other) {
        *this += other.sum;
        lost += other.lost;
        return *this;
    }
    [[nodiscard]] double value() const { return sum + lost; }
};

/// As a ball's state is held where that is in float.
void round_to_float(Ball& ball);

/// A number as errors show it.
[[nodiscard]] std::string shown(double number);

class World::State {
 public:
    /// From the scene's beginning where `snapshot` is null.
    State(const Scene& scene, const WorldOptions& options, const Snapshot* snapshot);

    [[nodiscard]] Snapshot snapshot() const {
        require_rest();
        return snapshot_of(*engine);
    }
    /// Throws std::logic_error while the balls are on their way to the next time.
    void require_rest() const;
    void restore(const Snapshot& s);
    void advance_to(double time);
    [[nodiscard]] Added apply(const Edits& edits);

    [[nodiscard]] const Bodies& bodies() const { return cast->bodies; }
    [[nodiscard]] std::size_t size() const { return bodies().count; }
    /// Every ball's state now, by index; read once for each time.
    [[nodiscard]] const std::vector<BallState>& states() const;
    [[nodiscard]] PlaneVectors vectors(Vec2 BallState::* part) const;
    [[nodiscard]] Ball ball(std::uint32_t index, const BallState& s) const;
    [[nodiscard]] std::vector<Ball> balls() const;
    /// The index of a ball by its id. Throws std::out_of_range where it is not there.
    [[nodiscard]] std::uint32_t index_of_ball(std::uint32_t id) const;
    /// Ids instead of indices.
    [[nodiscard]] std::vector<std::uint32_t> named(std::vector<std::uint32_t> indices) const;
    [[nodiscard]] std::vector<Vector2<float>> in_float(Vec2 BallState::* part) const;
    [[nodiscard]] double max_overlap() const { return carom::max_overlap(balls(), cast->rules); }
    /// How deep rounding alone may let two bodies overlap, in units of their radii's sum.
    [[nodiscard]] double rounding_of_overlaps() const;
    /// Of the balls now; made once for each time.
    [[nodiscard]] const PlaceIndex& places() const;

    /// Sum of quantity(index, state) over all moving balls, compensated.
    template <class Quantity>
    [[nodiscard]] double sum(Quantity&& quantity) const {
        const std::vector<BallState>& all = states();
        return executor
            .sum(size(), CompensatedSum{},
                 [&](std::size_t first, std::size_t last) {
                     CompensatedSum s;
                     for (std::size_t i = first; i < last; ++i) {
                         const auto index = static_cast<std::uint32_t>(i);
                         if (!bodies().fixes(index)) s += quantity(index, all[i]);
                     }
                     return s;
                 })
            .value();
    }

    WorldOptions wanted;
    Executor executor;
    std::shared_ptr<const Cast> scene_cast;  // the scene's
    std::shared_ptr<const Cast> cast;        // the same until edits make another
    std::uint64_t hash = 0;                  // of the scene; of what edits have made of it
    bool is_edited = false;
    std::function<void(const Collision&)> listener;
    std::unique_ptr<Engine> engine;
    std::uint64_t field_updates = 0;
    Time now;
    double seconds = 0;
    double inherited_overlap = 0;  // deepest when the engine was made, where states are rounded to float
    std::vector<std::uint64_t> user_data;  // by id
    std::vector<Sensor> sensors;
    std::function<void(const Sensing&)> sensing;

    /// Holds while listeners may be told, who must not change the world, nor, while it moves, look at its
    /// balls. Throws std::logic_error where it is held already.
    class Telling {
     public:
        explicit Telling(State& state, bool moves = false);
        ~Telling() { state_.is_telling_ = state_.is_moving_ = false; }
        Telling(const Telling&) = delete;
        Telling& operator=(const Telling&) = delete;

     private:
        State& state_;
    };

    /// To be called where sensors, who listens, or the time have changed otherwise than by going on.
    void watch_anew();

 private:
    void check(const Snapshot& s) const;
    /// Does edits that change no more than where balls are and how they move, in place; false where they
    /// change more, or the engine has no such way.
    bool start_anew(const Edits& edits);
    /// Lets the watch, which is there, see what the engine does.
    void follow_flights();
    /// What has been read is of the past.
    void forget();
    [[nodiscard]] Snapshot snapshot_of(const Engine& e) const;
    void read(const Engine& e, std::vector<BallState>& all) const;
    void visit_states(const Engine& e, const Engine::VisitState& visit) const;
    [[nodiscard]] std::unique_ptr<Engine> make_from(const Cast& of, const Snapshot& s) const {
        return make_engine(of.bodies, start_from(of.bodies, s, executor), executor, wanted);
    }
    /// Goes on with these bodies and an engine made from a snapshot of theirs.
    void continue_with(std::shared_ptr<const Cast> next, std::unique_ptr<Engine> made, const Snapshot& s);

    bool is_telling_ = false;
    bool is_moving_ = false;
    bool has_stopped_midway_ = false;     // a listener's exception, or a wedged ball, has ended an advance
    std::unique_ptr<SensorWatch> watch_;  // where somebody listens
    mutable std::mutex reading_;
    mutable bool is_read_ = false;
    mutable std::atomic<bool> was_asked_ = false;  // for states at the present time
    mutable std::vector<BallState> states_;
    mutable std::unique_ptr<PlaceIndex> places_;
};

}  // namespace carom
