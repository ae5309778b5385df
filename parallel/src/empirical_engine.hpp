// The empirical method: move all balls by a step, look who overlaps, trace each pair back to the contact,
// respond, go on to the end of the step.
//
// What the rest relies on:
// - Where steps begin and end follows from the scene alone, and the state at a step's end from the one at its
//   start. Between two steps a ball is read in free flight. So frames, threads and cells change no bit.
// - The contacts of a step are resolved in the order of (time, smaller number, larger number), numbered as
//   the event loop numbers bodies. After a response both balls are looked at again for the rest of the step.
// - A ball has at most kMostResponses responses in a step. What still overlaps at the end of a step is kept
//   in `lasting_`, and responds at the start of the next where it approaches then; it loses no more.
// - Positions are never corrected, only velocities: an elastic response cannot add energy. Scenes with losses
//   pay for that with speeds of parting, see parting_speed_of() and recovery().
//
// Balls stand at slots, in the order of the cells every now and then; their ids decide every order that
// shows. empirical_search.cpp finds the contacts, empirical_respond.cpp resolves them, empirical_missed.cpp
// counts what was missed, empirical_engine.cpp keeps the steps and reads.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <carom/core/motion.hpp>
#include <carom/core/wall_time.hpp>

#include "empirical_grid.hpp"
#include "engine.hpp"

namespace carom {

class EmpiricalEngine final : public Engine {
 public:
    EmpiricalEngine(const Bodies& bodies, const EngineStart& start, const Executor& executor,
                    bool count_missed);

    void advance_to(const Time& end, const Time& horizon) override;
    void renew_field(const Time& t) override;
    bool start_anew(const Time&, std::span<NewStart>) override { return false; }
    void visit_states(const Time& t, const VisitState& visit) const override;
    /// The balls as the last step has left them, and who overlapped then.
    void save(const Time& t, Snapshot& snapshot) const override;
    void audit(std::vector<Violation>& found) const override;
    void visit_flights(const Stop&, const Time&, const VisitFlights&) const override;
    void follow(Follower follower) override;
    void listen(std::function<void(const Collision&)> listener) override { listener_ = std::move(listener); }

 private:
    // Of a ball in a step; beyond the first number with obstacles alone, so that in a pile the floor has the
    // last word.
    static constexpr std::uint32_t kMostAmongBalls = 32;
    static constexpr std::uint32_t kMostResponses = 64;

    /// A ball and what it meets: another ball at slot `other`, or an obstacle. Of two balls the first has the
    /// smaller id.
    struct Pair {
        std::uint32_t slot = 0;
        std::uint32_t other = kNowhere;
        std::uint32_t partner = 0;  ///< the number of the second body
        Image image;
    };
    /// Two bodies that overlap at the end of the step. Stamps tell whether they still do.
    struct Meeting {
        double time = 0;  ///< of the contact, since the start of the step
        std::uint32_t lower = 0, higher = 0;
        Pair pair;
        std::uint32_t stamp = 0, other_stamp = 0;

        friend bool operator<(const Meeting& a, const Meeting& b) {
            const auto key = [](const Meeting& m) {
                return std::tuple(m.time, m.lower, m.higher, m.pair.image.x, m.pair.image.y);
            };
            return key(a) < key(b);
        }
    };
    /// How a ball touches a body.
    struct Touch {
        double gap;  ///< between the surfaces
        Vec2 line;   ///< from the body to the ball, of any length
        bool is_round;
        WallFeature feature = WallFeature::kFace;
    };
    /// A stretch of a ball's way through a step, straight or a parabola.
    struct Leg {
        double start;  ///< since the start of the step
        double x, y, vx, vy;
        std::uint32_t previous;
    };
    /// A ball that has responded in this step.
    struct Touched {
        std::uint32_t slot = 0;
        std::uint32_t responses = 0;
        double start = 0;  ///< of its last leg
        std::uint32_t previous = kNowhere;
        std::uint32_t next_in_cell = kNowhere;
        std::int32_t cell = -1;
    };
    /// What a part of a loop found.
    struct Part {
        std::vector<Meeting> contacts;
        std::vector<Meeting> lasting;
        std::vector<Pair> obstacles;
        std::uint64_t missed = 0;
        double shortest = 0;
    };

    [[nodiscard]] std::size_t size() const { return id_.size(); }
    [[nodiscard]] double radius_of(std::uint32_t slot) const {
        return radius_.empty() ? bodies_.radius.of(id_[slot]) : radius_[slot];
    }
    [[nodiscard]] Vec2 acceleration_of(std::uint32_t slot) const {
        return acceleration_.empty() ? bodies_.physics.gravity : acceleration_[slot];
    }
    [[nodiscard]] bool is_touched(std::uint32_t slot) const { return touched_index_[slot] != kNowhere; }
    [[nodiscard]] double start_of(std::uint32_t slot) const {
        return is_touched(slot) ? touched_[touched_index_[slot]].start : 0;
    }
    [[nodiscard]] std::uint32_t stamp_of(std::uint32_t slot) const {
        if (slot == kNowhere || !is_touched(slot)) return 0;
        return touched_[touched_index_[slot]].responses;
    }
    [[nodiscard]] Vec2 offset_of(const Image& image) const { return bodies_.offset_of(image); }
    [[nodiscard]] Image turns_of(std::uint32_t slot) const {
        return turns_.empty() ? Image{} : Image{turns_[slot].x, turns_[slot].y};
    }
    [[nodiscard]] Vec2 wrapped_end(std::uint32_t slot) const { return {wrapped_x_[slot], wrapped_y_[slot]}; }
    /// The last leg's motion from `time` >= its start on.
    [[nodiscard]] Motion<double> motion_from(std::uint32_t slot, double time) const;
    [[nodiscard]] Pair pair_of(std::uint32_t a, std::uint32_t b, const Image& image) const;
    /// Runs body(part, first, last) over [0, count), cut the same way whatever the number of threads.
    template <class Body>
    void for_parts(std::size_t count, std::size_t grain, Body&& body);

    // empirical_engine.cpp
    void schedule();
    [[nodiscard]] double travel_time();
    void step_to(const Time& end);
    void move_all();
    void place_end(std::uint32_t slot, const Vec2& end);
    void settle_all();
    void reorder();
    void keep_lasting();

    // empirical_search.cpp
    void search();
    void search_cell(std::int32_t cell, Part& part) const;
    void search_large(Part& part) const;
    void search_obstacles(std::uint32_t slot, Part& part) const;
    void look_around(std::uint32_t slot, Part& part) const;
    void examine(const Pair& pair, Part& part) const;
    void examine_start(const Meeting& lasting, Part& part) const;
    [[nodiscard]] bool overlap_at_end(std::uint32_t a, std::uint32_t b, const Vec2& shift) const;
    [[nodiscard]] Touch touch(const Pair& pair, const Vec2& centre, const Vec2& other) const;
    [[nodiscard]] Meeting meeting_of(const Pair& pair, double time) const;
    [[nodiscard]] Meeting meeting_of(const SavedContact& contact) const;
    [[nodiscard]] bool is_close(const Pair& pair) const;
    /// Of a way through more periods than a few, and of what is further beside a way, nothing is looked at.
    [[nodiscard]] static double within_periods(const GridAxis& axis, double length) {
        constexpr double kMostPeriods = 8;
        return axis.periodic() ? std::min(length, kMostPeriods * axis.length()) : length;
    }
    /// All images of a moving point, known in boxes, that may come within `reach` of another.
    template <class Visit>
    void for_each_image(const Vec2& offset, double reach, Visit&& visit) const;
    /// The obstacles that a ball with its centre somewhere in the box may touch, each once; images as seen
    /// from the box.
    void collect_obstacles(std::uint32_t slot, const Vec2& low, const Vec2& high,
                           std::vector<Pair>& found) const;

    // empirical_respond.cpp
    void resolve_all();
    void resolve(const Meeting& meeting);
    void advance(std::uint32_t slot, double time);
    void relist(std::uint32_t slot);
    void respond_ball(const Meeting& meeting);
    void respond_obstacle(const Meeting& meeting);
    void tell(const Meeting& meeting, const Hit& hit);
    [[nodiscard]] double restitution_at(double restitution, const Pair& pair, double gap,
                                        const Time& t) const;
    [[nodiscard]] double recovery(double gap, std::uint32_t slot) const;
    [[nodiscard]] double parting_speed_of(double pressure, const Vec2& line) const;

    // empirical_missed.cpp
    void count_missed();
    void count_missed_of(std::uint32_t slot, Part& part) const;
    void count_missed_obstacles(std::uint32_t slot, const Vec2& low, const Vec2& high, Part& part) const;
    [[nodiscard]] double travel_of(std::uint32_t slot, Vec2& low, Vec2& high) const;
    [[nodiscard]] bool is_resolved(std::uint32_t slot, std::uint32_t partner) const;
    [[nodiscard]] bool misses(const Pair& pair) const;
    [[nodiscard]] bool meet_straight(const Pair& pair) const;
    struct Way {
        std::array<Leg, kMostResponses + 2> legs;
        std::size_t count = 0;
    };
    [[nodiscard]] Way way_of(std::uint32_t slot) const;
    [[nodiscard]] double impact_time(const Pair& pair, const Motion<double>& a,
                                     const Motion<double>& b) const;

    const Executor& executor_;
    const EmpiricalSteps steps_;
    const Clock clock_;
    const bool counts_missed_;
    EmpiricalGrid grid_;

    // One a ball, at its slot: the start of its last leg.
    std::vector<double> x_, y_, vx_, vy_;
    std::vector<std::uint32_t> id_;
    std::vector<std::uint32_t> slot_of_;  // by id
    std::vector<Periods> periods_;
    std::vector<Vec2> acceleration_;      // only where it differs from ball to ball
    std::vector<double> radius_;          // only where they differ
    std::vector<Time> last_collision_;    // only where the contact time is not 0
    std::vector<std::uint8_t> is_large_;  // only where some are
    std::vector<std::uint32_t> large_;    // slots
    // The end of the step: in the box, and the periods that wrapping took away.
    std::vector<double> wrapped_x_, wrapped_y_;
    std::vector<Periods> turns_;  // only where an axis has a period
    std::vector<double> travel_;  // only where what is missed is counted: of each axis at most

    std::vector<std::uint32_t> touched_index_;
    std::vector<Touched> touched_;
    std::vector<std::uint32_t> first_touched_;  // of each cell: index into touched_
    std::vector<Leg> legs_;                     // that came before the last ones
    std::vector<std::pair<std::uint32_t, std::uint32_t>> resolved_;

    std::vector<Part> parts_;
    Part serial_;
    std::vector<Meeting> contacts_;  // of the search, in order
    std::vector<Meeting> later_;     // found after a response: a heap, the first on top
    std::vector<Meeting> lasting_;   // overlapping at `now_`; slots of the present order

    Time now_;            // the end of the last step
    Time next_ = kNever;  // and of the next, but for the horizon
    double step_index_ = 0;
    double duration_ = 0;  // of the present step
};

template <class Body>
void EmpiricalEngine::for_parts(std::size_t count, std::size_t grain, Body&& body) {
    const std::size_t parts = (count + grain - 1) / grain;
    if (parts_.size() < parts) parts_.resize(parts);
    for (std::size_t p = 0; p < parts; ++p) {
        parts_[p].contacts.clear();
        parts_[p].lasting.clear();
        parts_[p].missed = 0;
    }
    executor_.for_ranges(parts, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t p = first; p < last; ++p)
            body(parts_[p], p * grain, std::min(count, (p + 1) * grain));
    });
}

template <class Visit>
void EmpiricalEngine::for_each_image(const Vec2& offset, double reach, Visit&& visit) const {
    const auto range = [reach](const GridAxis& axis, double d) {
        if (!axis.periodic()) return std::pair(0, 0);
        const double within = within_periods(axis, reach);
        return std::pair(static_cast<std::int32_t>(std::ceil((d - within) / axis.length())),
                         static_cast<std::int32_t>(std::floor((d + within) / axis.length())));
    };
    const auto [first_x, last_x] = range(bodies_.grid.x, offset.x());
    const auto [first_y, last_y] = range(bodies_.grid.y, offset.y());
    for (std::int32_t x = first_x; x <= last_x; ++x)
        for (std::int32_t y = first_y; y <= last_y; ++y) visit(Image{x, y});
}

}  // namespace carom
