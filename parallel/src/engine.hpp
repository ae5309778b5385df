// What moves a world's balls: one loop over all of them, or domains side by side. The two give the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <carom/core/motion.hpp>

#include "ball_record.hpp"
#include "bodies.hpp"
#include "engine_state.hpp"
#include "event_loop.hpp"
#include "executor.hpp"
#include "ordered_sum.hpp"

namespace carom {

/// A ball's way from one event to the next, or to the end of what is asked for.
struct Flight {
    Anchor anchor;
    Motion<double> motion;  ///< since the anchor
    Time end;
};

/// How far a look has gone: to a time, with or without what happens at that very instant. A flight that ends
/// there is seen again where it is without.
struct Stop {
    Time time;
    bool is_whole = true;
    [[nodiscard]] bool covers(const Time& t) const { return t < time || (t == time && is_whole); }
};

class Engine {
 public:
    virtual ~Engine() = default;

    /// Resolves all events up to and including `end`. What lies beyond `horizon` >= end must not be looked at
    /// yet: the field changes there.
    virtual void advance_to(const Time& end, const Time& horizon) = 0;
    /// Anchors every ball at `t`, up to which all has been advanced, with the field's new acceleration.
    virtual void renew_field(const Time& t) = 0;
    /// Starts balls anew at `t`, the time advanced to last, none twice. False where the engine has no such
    /// way, and nothing is done.
    [[nodiscard]] virtual bool start_anew(const Time& t, std::span<NewStart> starts) = 0;
    /// Calls visit(id, state) for every moving ball with its state at `t`, the time advanced to last: side by
    /// side for the balls.
    using VisitState = std::function<void(std::uint32_t, const BallState&)>;
    virtual void visit_states(const Time& t, const VisitState& visit) const = 0;
    /// The numbers of the domains that own the moving balls: domains[id]. Left alone where there is one loop.
    virtual void read_domains(std::span<std::uint32_t> domains) const { (void)domains; }
    /// The same balls as they were left by their last events until `t`.
    virtual void save(const Time& t, Snapshot& snapshot) const = 0;
    /// Events of the ball that has had most of them since the engine was made; 0 where the method is steps.
    [[nodiscard]] virtual std::uint32_t most_events() const { return 0; }
    /// Every broken rule of the loops.
    virtual void audit(std::vector<Violation>& found) const = 0;
    /// Calls visit(id, flights) for every moving ball with its flights that end after `from`, in their order,
    /// the last one cut off at `to`, up to which all has been advanced: side by side for the balls. `from`
    /// is `to`, or not before the stop that the follower was told last.
    using VisitFlights = std::function<void(std::uint32_t, std::span<const Flight>)>;
    virtual void visit_flights(const Stop& from, const Time& to, const VisitFlights& visit) const = 0;
    /// From the time advanced to last on `follower` is told up to where flights can be visited, before what
    /// lies further back is forgotten; an empty function turns it off.
    using Follower = std::function<void(const Stop&)>;
    virtual void follow(Follower follower) = 0;
    /// Collisions are told from the time advanced to last on; an empty function turns it off.
    virtual void listen(std::function<void(const Collision&)> listener) = 0;

    /// Seconds that the threads have worked on domains, all together; 0 where there is one loop.
    [[nodiscard]] virtual double working_seconds() const { return 0; }
    [[nodiscard]] Counts counts() const {
        Counts all = counts_;
        all.ball_collisions = tally_.ball_collisions;
        all.wall_collisions = tally_.wall_collisions;
        return all;
    }
    [[nodiscard]] double virial() const { return tally_.virial.value(); }
    [[nodiscard]] SavedSum saved_virial() const { return tally_.virial.saved(); }

 protected:
    Engine(const Bodies& bodies, const EngineStart& start);
    [[nodiscard]] static std::uint32_t most_events(std::span<const BallRecord> records);

    const Bodies& bodies_;
    std::function<void(const Collision&)> listener_;
    Counts counts_;  // but for the collisions
    Tally tally_;
};

/// Puts a ball's flights together, from its anchor and those that it has overwritten.
class FlightList {
 public:
    explicit FlightList(const Bodies& bodies) : bodies_(bodies) {}
    /// A ball's anchor, the one that it has overwritten last, and the one that kAtStart stands for.
    struct Way {
        const Anchor& last;
        std::uint32_t previous;
        const Anchor* at_start;
    };
    /// Those that end after `from`, and the last one, cut off at `to`. Until the next call.
    std::span<const Flight> of(const Way& way, const Vec2& acceleration,
                               std::span<const OverwrittenAnchor> overwritten, const Stop& from,
                               const Time& to);

 private:
    void add(const Anchor& anchor, const Vec2& acceleration, const Time& to);

    const Bodies& bodies_;
    std::vector<Flight> flights_;
};

/// `bodies` and `executor` must outlive the engine. `domains` 0 lets the engine choose.
[[nodiscard]] std::unique_ptr<Engine> make_engine(const Bodies& bodies, const EngineStart& start,
                                                  const Executor& executor, const WorldOptions& options);

[[nodiscard]] std::unique_ptr<Engine> make_windowed_engine(const Bodies& bodies, const EngineStart& start,
                                                           const Executor& executor, int domains, int halo);

[[nodiscard]] std::unique_ptr<Engine> make_empirical_engine(const Bodies& bodies, const EngineStart& start,
                                                            const Executor& executor, bool count_missed);

}  // namespace carom
