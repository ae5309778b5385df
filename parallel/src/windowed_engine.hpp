// Domains side by side, exactly: each goes through a window of time on its own with copies of the balls
// around it, then what the copies did is compared with what their owners did. docs/domains.md has the
// argument why domains that agree have the serial run's trajectories.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "domain_state.hpp"
#include "engine.hpp"
#include "put_aside.hpp"

namespace carom {

class WindowedEngine final : public Engine {
 public:
    WindowedEngine(const Bodies& bodies, const EngineStart& start, const Executor& executor, int domains,
                   int halo);

    void advance_to(const Time& end, const Time& horizon) override;
    void renew_field(const Time& t) override;
    bool start_anew(const Time& t, std::span<NewStart> starts) override;
    void visit_states(const Time& t, const VisitState& visit) const override;
    void read_domains(std::span<std::uint32_t> domains) const override;
    void save(const Time& t, Snapshot& snapshot) const override;
    [[nodiscard]] std::uint32_t most_events() const override;
    void audit(std::vector<Violation>& found) const override;
    void visit_flights(const Stop& from, const Time& to, const VisitFlights& visit) const override;
    void follow(Follower follower) override { follower_ = std::move(follower); }
    void listen(std::function<void(const Collision&)> listener) override;
    [[nodiscard]] double working_seconds() const override {
        return std::chrono::duration<double>(std::chrono::steady_clock::duration(working_time_.load()))
            .count();
    }

 private:
    [[nodiscard]] std::unique_ptr<Workshop> make_workshop() const;
    class Lease;

    template <class F>
    void for_each_domain(F&& f) const {
        executor_.for_ranges(domains_.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t d = first; d < last; ++d) work(f, d);
        });
    }
    /// Does the work of a domain, and counts its time.
    template <class F>
    void work(F&& f, std::size_t domain) const {
        const auto start = std::chrono::steady_clock::now();
        f(domain);
        working_time_ += (std::chrono::steady_clock::now() - start).count();
    }
    void split(const std::vector<BallRecord>& records, const std::vector<BallExtra>& extras, Span x, Span y,
               int parts);
    struct BallInCell {
        CellCoordinates cell;
        std::uint32_t record;
        float load;
    };
    using MakeDomain = std::function<void(std::span<const BallInCell>, Span x, Span y)>;
    void cut(std::span<BallInCell> balls, Span x, Span y, int parts, const MakeDomain& make_domain) const;
    [[nodiscard]] bool knows_loads() const;
    void weigh_window();
    [[nodiscard]] bool is_uneven() const;
    [[nodiscard]] std::vector<float> loads() const;
    void cut_anew();
    void split_anew();
    void index(const DomainState& d, Roster& roster) const;
    class Index;
    void add_residents(std::uint32_t self, const Region& region, Workshop& w) const;
    template <class F>
    void pack(std::uint32_t from, const Region& region, std::int32_t halo, std::vector<BallMessage>& message,
              F&& deliver) const;
    [[nodiscard]] std::vector<Time> ends_of_copies(std::int32_t halo, const Time& window_end) const;
    void go_on(Workshop& w, std::size_t self, const Region& region, std::int32_t halo,
               const Time& window_end) const;
    void forget_loops();
    void load(Workshop& w, std::size_t self, const Region& region, std::int32_t halo, const Time& window_end,
              bool ends_early) const;
    static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
    static constexpr std::int32_t kEverything = std::numeric_limits<std::int32_t>::max();  // as a halo
    void run(DomainState& d, const Stop& window_end);
    void run(DomainState& d, const Stop& window_end, Workshop& w);
    /// The domain's own balls as they are in a loop, each of which is shown to look(index, place) as well: in
    /// one pass, for it is long, and written over, for it is as long as the time before.
    template <class F>
    void keep_own(DomainState& d, const Workshop& w, F&& look) const;
    void keep_outcome(DomainState& d, Workshop& w, const Time& window_end);
    [[nodiscard]] std::vector<OwnVisit> all_visits(const DomainState& d) const;
    void compare(DomainState& d) const;
    void forget_predictions(DomainState& d, const std::vector<std::uint8_t>& is_right) const;
    [[nodiscard]] bool are_beside(const CellCoordinates& a, const CellCoordinates& b) const;
    [[nodiscard]] bool is_blind(std::uint32_t d, const UnseenVisit& visit) const;
    [[nodiscard]] std::vector<std::uint8_t> disagreeing() const;
    [[nodiscard]] bool try_window(const Stop& window_end);
    [[nodiscard]] Stop run_together(const Stop& window_end, bool may_end_early);
    void predict_anew(bool renews_field);
    void next_window(const Time& wanted, const Time& horizon);
    void skip_quiet_epochs(const Time& until);
    void commit();
    void rewind_to_now();
    void tell_until(const Stop& end);
    struct Told {
        const CollisionNote* note;
        const Collision* collision;
    };
    /// A domain's balls as they were last advanced.
    [[nodiscard]] const Roster& held(const DomainState& d) const { return in_window_ ? d.end : d.start; }
    void order_simultaneous(std::span<Told> notes) const;
    /// A ball as it was left by its last event until some time.
    struct Past {
        Anchor anchor;
        Periods periods;
        bool is_of_window;  ///< whether that event lies within the window
    };
    [[nodiscard]] std::vector<std::uint32_t> latest_until(const DomainState& d, const Time& t) const;
    [[nodiscard]] Past past_of(const DomainState& d, std::size_t i,
                               const std::vector<std::uint32_t>& latest_of, const Time& t) const;
    [[nodiscard]] const BallRecord& record_at_start(const DomainState& d, std::size_t i) const;
    void tune(double length, bool agreed);
    [[nodiscard]] double shortened(double length);
    /// Collisions of all balls in a window that is neither too long nor too short.
    [[nodiscard]] double collisions_aimed_at() const { return target_ * double(bodies_.moving) / 2; }
    [[nodiscard]] double collisions_in_turn() const;
    /// A window with more collisions is too long, whatever else is wrong; chance may bring more where it aims
    /// at few.
    [[nodiscard]] double too_many() const { return 1000 + 1.5 * collisions_aimed_at(); }

    mutable std::atomic<std::chrono::steady_clock::rep> working_time_ = 0;
    const Executor& executor_;
    int wanted_domains_;
    // Where each thread has one domain its loop stays as it is from window to window. With more of them what
    // a thread goes through would be in no cache.
    bool loops_stay_;
    std::int32_t widest_kept_;  // copies of so many cells of a halo are simulated to the window's end
    std::int32_t halo_;
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<Workshop>> idle_;
    std::vector<DomainState> domains_;

    Follower follower_;
    Time now_;  // advanced to, as the world sees it
    Time window_start_;
    Stop window_end_;         // >= now_
    bool in_window_ = false;  // whether results are there
    // After an edit others are to be expected where the world stops next: there windows end.
    int cuts_left_ = 0;  // stops for which that holds
    bool cuts_windows_ = false;
    double window_length_;
    std::uint64_t disagreeing_ = 0;  // domains that had to go through the present window again
    double growth_;
    double target_ = 1;       // collisions a ball in a window
    int since_cut_ = 0;       // windows
    double patience_ = 1;     // with domains that are uneven, doubled by each cut in vain
    bool was_quiet_ = false;  // the last window had no event
};

/// Notes where the balls of one of a domain's rosters are, one after the other.
class WindowedEngine::Index {
 public:
    Index(const WindowedEngine& engine, const DomainState& d, Roster& roster)
        : grid_(engine.bodies_.grid), roster_(roster), halo_(engine.halo_), region_(grid_, d.x, d.y, halo_) {
        roster.cells.resize(roster.records.size());
        roster.near_border.resize(roster.records.size());
    }
    ~Index() {
        roster_.near_border.resize(near_);
        roster_.cells_x = x_;
        roster_.cells_y = y_;
    }
    Index(const Index&) = delete;
    Index& operator=(const Index&) = delete;

    /// Gives whether the ball is near the border.
    bool add(std::uint32_t k, const BallRecord& record) {
        const CellCoordinates c = fold_periodic(grid_, record.anchor.cell);
        roster_.cells[k] = c;
        roster_.near_border[near_] = k;
        const bool is_near = !region_.is_deep_inside(c, halo_);
        near_ += is_near ? 1 : 0;
        x_ = {std::min(x_.first, c.x), std::max(x_.last, c.x + 1)};
        y_ = {std::min(y_.first, c.y), std::max(y_.last, c.y + 1)};
        return is_near;
    }

 private:
    const Grid& grid_;
    Roster& roster_;
    std::int32_t halo_;  // as wide as all start with
    Region region_;
    std::size_t near_ = 0;
    Span x_{GridAxis::kFarthest, -GridAxis::kFarthest};
    Span y_ = x_;
};

template <class F>
void WindowedEngine::keep_own(DomainState& d, const Workshop& w, F&& look) const {
    Roster& end = d.end;
    const auto count = static_cast<std::uint32_t>(w.own.size());
    end.places = w.own;
    end.origins.resize(count);
    end.records.resize(count);
    end.extras.resize(bodies_.needs_extras() ? count : 0);
    end.unknown.clear();
    const std::span<const BallRecord> records = w.loop->records();
    Index index(*this, d, end);
    for (std::uint32_t k = 0; k < count; ++k) {
        if (k + kFetchedAhead < count) fetch(records[w.own[k + kFetchedAhead]]);
        const std::uint32_t i = w.own[k];
        end.origins[k] = w.origins[i];
        if (!end.extras.empty()) end.extras[k] = w.loop->extra(i);
        // What lies deep inside is read when the window is undone or looked into.
        if (index.add(k, records[i]))
            end.records[k] = records[i];
        else
            put_aside(end.records[k], records[i]);
        look(k, i);
    }
    finish_aside();
}

/// A workshop taken from the idle ones for a while.
class WindowedEngine::Lease {
 public:
    explicit Lease(const WindowedEngine& engine) : engine_(engine) {
        {
            const std::lock_guard lock(engine.mutex_);
            // The one that this thread used last, if it can be had: its cache still has it.
            auto found = std::ranges::find(engine.idle_, std::this_thread::get_id(),
                                           [](const auto& idle) { return idle->thread; });
            if (found == engine.idle_.end() && !engine.idle_.empty()) found = engine.idle_.begin();
            if (found != engine.idle_.end()) {
                workshop_ = std::move(*found);
                engine.idle_.erase(found);
            }
        }
        if (!workshop_) workshop_ = engine.make_workshop();
        workshop_->loop->listens = static_cast<bool>(engine.listener_);
        workshop_->thread = std::this_thread::get_id();
    }
    ~Lease() {
        const std::lock_guard lock(engine_.mutex_);
        engine_.idle_.push_back(std::move(workshop_));
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    Workshop& operator*() const { return *workshop_; }

 private:
    const WindowedEngine& engine_;
    std::unique_ptr<Workshop> workshop_;
};

}  // namespace carom
