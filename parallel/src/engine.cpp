// The choice between the engines, and the one that is a single loop.
#include "engine.hpp"

#include <algorithm>
#include <cmath>

namespace carom {
namespace {

// A domain of about so many balls, with its halo, fits a core's second-level cache.
constexpr double kBallsOfDomain = 12000;
// A follower is told after so many collisions a ball at the latest.
constexpr std::uint64_t kCollisionsOfBall = 8;
// With fewer balls a thread the halo costs more than another thread gives.
constexpr double kFewestOfThread = 2000;

int choose_domains(const Bodies& bodies, const Executor& executor, int wanted) {
    if (!bodies.large.empty()) return 1;  // a large ball's surroundings may be the whole plane
    const double balls = bodies.moving;
    if (wanted > 0) return static_cast<int>(std::min<double>(wanted, std::max(1.0, balls)));
    const double by_cache = std::floor(balls / kBallsOfDomain);
    const double by_threads = std::min<double>(executor.threads(), std::floor(balls / kFewestOfThread));
    if (by_threads < 2) return by_cache < 4 ? 1 : static_cast<int>(by_cache);
    // A whole number of rounds, so that no thread waits for the last domain.
    return static_cast<int>(by_threads * std::max(1.0, std::round(by_cache / by_threads)));
}

/// All balls in one loop.
class SerialEngine final : public Engine {
 public:
    SerialEngine(const Bodies& bodies, const EngineStart& start, const Executor& executor)
        : Engine(bodies, start), executor_(executor), loop_(make_event_loop(bodies)) {
        loop_->on_note = [this](const CollisionNote& note, const Collision* collision) {
            tally_.count(note);
            if (listener_ && collision != nullptr) listener_(*collision);
        };
        loop_->clear({bodies.grid, whole(bodies.grid.x), whole(bodies.grid.y), 0}, start.now);
        for (std::size_t k = 0; k < start.records.size(); ++k)
            loop_->add(start.records[k], start.extras.empty() ? nullptr : &start.extras[k], true);
        loop_->events = counts_.events;
        if (bodies.accelerates_each() && !start.has_field) loop_->renew_field(start.now);
        loop_->predict_all(&executor_);
    }

    void advance_to(const Time& end, const Time&) override {
        loop_->advance_to(end, true);
        counts_.events = loop_->events;
        if (follower_) tell_follower({end});
    }
    void renew_field(const Time& t) override {
        loop_->renew_field(t);
        loop_->predict_all(&executor_);
        counts_.events = loop_->events;
    }
    bool start_anew(const Time& t, std::span<NewStart> starts) override {
        // The loop has the balls in the order of their ids.
        std::vector<NewStart> here(starts.begin(), starts.end());
        for (NewStart& start : here) {
            const auto at = std::ranges::lower_bound(loop_->records(), start.ball, {}, &BallRecord::id);
            start.ball = static_cast<std::uint32_t>(at - loop_->records().begin());
        }
        loop_->start_anew(t, here);
        for (std::size_t k = 0; k < starts.size(); ++k) starts[k].state = loop_->state(here[k].ball, t);
        return true;
    }
    void visit_states(const Time& t, const VisitState& visit) const override {
        executor_.for_ranges(loop_->size(), 4096, [&](std::size_t first, std::size_t last) {
            for (auto i = static_cast<std::uint32_t>(first); i < last; ++i)
                visit(loop_->id(i), loop_->state(i, t));
        });
    }
    void save(const Time&, Snapshot& snapshot) const override {
        BallSaver saver(bodies_, snapshot);
        executor_.for_ranges(loop_->size(), 4096, [&](std::size_t first, std::size_t last) {
            for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
                const BallRecord& r = loop_->records()[i];
                saver.save(r.id(), r.anchor, r.periods, loop_->extra(i));
            }
        });
    }
    std::uint32_t most_events() const override { return Engine::most_events(loop_->records()); }
    void audit(std::vector<Violation>& found) const override { loop_->audit(found); }
    void visit_flights(const Stop& from, const Time& to, const VisitFlights& visit) const override {
        executor_.for_ranges(loop_->size(), 4096, [&](std::size_t first, std::size_t last) {
            FlightList flights(bodies_);
            for (auto i = static_cast<std::uint32_t>(first); i < last; ++i)
                visit(loop_->id(i),
                      flights.of({loop_->records()[i].anchor, loop_->last_overwritten(i), nullptr},
                                 loop_->extra(i).acceleration, loop_->overwritten, from, to));
        });
    }
    void follow(Follower follower) override {
        follower_ = std::move(follower);
        loop_->keeps_anchors = follower_ ? Keeps::kAll : Keeps::kNone;
        loop_->on_part = nullptr;
        if (follower_) loop_->on_part = [this](const Time& t) { tell_follower({t, false}); };
        forget_anchors();
    }
    void listen(std::function<void(const Collision&)> listener) override {
        listener_ = std::move(listener);
        loop_->listens = static_cast<bool>(listener_);
    }

 private:
    void tell_follower(const Stop& stop) {
        follower_(stop);
        forget_anchors();
    }
    void forget_anchors() {
        loop_->forget_anchors();
        loop_->room = follower_ ? loop_->room_for(kCollisionsOfBall) : EventLoop::kEndless;
    }

    const Executor& executor_;
    std::unique_ptr<EventLoop> loop_;
    Follower follower_;
};

}  // namespace

Engine::Engine(const Bodies& bodies, const EngineStart& start) : bodies_(bodies), counts_(start.counts) {
    tally_.ball_collisions = start.counts.ball_collisions;
    tally_.wall_collisions = start.counts.wall_collisions;
    tally_.virial.set_scale(bodies.physics.typical_virial);
    tally_.virial.restore(start.virial);
}

std::span<const Flight> FlightList::of(const Way& way, const Vec2& acceleration,
                                       std::span<const OverwrittenAnchor> overwritten, const Stop& from,
                                       const Time& to) {
    flights_.clear();
    add(way.last, acceleration, to);
    for (std::uint32_t k = way.previous; k != kNowhere;) {
        const bool is_seen = !flights_.empty() && (from.is_whole ? flights_.back().anchor.time <= from.time
                                                                 : flights_.back().anchor.time < from.time);
        if (is_seen) break;
        add(k == kAtStart ? *way.at_start : anchor_of(overwritten[k]), acceleration, to);
        k = k == kAtStart ? kNowhere : overwritten[k].previous;
    }
    std::ranges::reverse(flights_);
    return flights_;
}

/// Adds a flight before those that are there.
void FlightList::add(const Anchor& anchor, const Vec2& acceleration, const Time& to) {
    if (anchor.time > to) return;
    const Time end = flights_.empty() ? to : flights_.back().anchor.time;
    flights_.push_back({anchor, motion_since(bodies_, anchor, acceleration), end});
}

std::uint32_t Engine::most_events(std::span<const BallRecord> records) {
    std::uint32_t most = 0;
    for (const BallRecord& r : records) most = std::max(most, r.anchor.stamp);
    return most;
}

std::unique_ptr<Engine> make_engine(const Bodies& bodies, const EngineStart& start, const Executor& executor,
                                    const WorldOptions& options) {
    if (bodies.physics.empirical) return make_empirical_engine(bodies, start, executor, options.count_missed);
    const int domains = choose_domains(bodies, executor, options.domains);
    if (domains <= 1) return std::make_unique<SerialEngine>(bodies, start, executor);
    // A halo as wide as the plane holds all there is.
    const int halo = std::min(options.halo, std::max(bodies.grid.x.count(), bodies.grid.y.count()));
    return make_windowed_engine(bodies, start, executor, domains, halo);
}

}  // namespace carom
