// The windows: how far they go, who has to go again, and what becomes of the results.
#include "windowed_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace carom {
namespace {

// Cells. What a window costs beside its events is less where loops stay, so that windows may be shorter.
constexpr std::int32_t kHalo = 6;
constexpr std::int32_t kHaloWhereLoopsStay = 5;
// So often the domains that disagree go through a window again before it is given up.
constexpr int kMostRepairs = 2;
// The first window's share of an epoch; the next ones follow the collisions that it had.
constexpr double kFirstWindow = 1.0 / 256;
// The least window's share of an epoch: what cannot be cut finer, a row of touching balls that is hit at one
// end, goes through one loop, and time goes on.
constexpr double kLeastWindow = 0x1p-30;
// How the collisions a ball aimed at in a window grow while all agrees, and shrink when it does not.
constexpr double kFirstGrowth = 1.05;  // until the first disagreement
constexpr double kGrowth = 1.002;
constexpr double kShrinkage = 0.8;  // where all had to run again; the power of the share that had to
constexpr double kLeastTarget = 0.05;
constexpr double kMostTarget = 4;
// All balls in one loop end a window after so many collisions a ball.
constexpr std::uint64_t kMostCollisionsTogether = 8;
// So much of its first length is the least that a window is made before it goes through one loop.
constexpr double kMostShortened = 1.0 / 64;

/// The halo of a domain that runs again.
constexpr std::int32_t widened(std::int32_t halo) {
    return halo + halo / 2 + 1;
}

}  // namespace

WindowedEngine::WindowedEngine(const Bodies& bodies, const EngineStart& start, const Executor& executor,
                               int domains, int halo)
    : Engine(bodies, start),
      executor_(executor),
      wanted_domains_(domains),
      loops_stay_(domains <= executor.threads()),
      widest_kept_((loops_stay_ ? kHaloWhereLoopsStay : kHalo) - 1),
      halo_(halo > 0 ? halo : widest_kept_ + 1),
      now_(start.now),
      window_start_(start.now),
      window_length_(bodies.physics.clock.epoch_length() * kFirstWindow),
      growth_(kFirstGrowth) {
    split(start.records, start.extras, whole(bodies.grid.x), whole(bodies.grid.y), domains);
    predict_anew(bodies.accelerates_each() && !start.has_field);
}

/// Runs every domain to `window_end` and repairs those that disagree with their neighbours: again, with a
/// wider halo. Gives up after a few rounds, and at once where too much happens for a window.
bool WindowedEngine::try_window(const Stop& window_end) {
    std::vector<std::uint8_t> runs(domains_.size(), 1);
    for (DomainState& d : domains_) d.halo = halo_;
    disagreeing_ = 0;
    for (int round = 0;; ++round) {
        const auto run_again = [&](std::size_t d) {
            if (runs[d]) run(domains_[d], window_end);
        };
        const auto compare_all = [&](std::size_t d) { compare(domains_[d]); };
        executor_.for_each_in_steps(domains_.size(), std::array<Executor::Step, 2>{
                                                         [&](std::size_t d) { work(run_again, d); },
                                                         [&](std::size_t d) { work(compare_all, d); },
                                                     });
        runs = disagreeing();
        const auto count = static_cast<std::uint64_t>(std::ranges::count(runs, 1));
        if (count == 0) return true;
        counts_.window_retries += count;
        disagreeing_ += count;
        const bool gives_up = round == kMostRepairs || 4 * count > 3 * domains_.size() + 4 ||
                              std::ranges::any_of(domains_, &DomainState::is_full) ||
                              collisions_in_turn() > too_many();
        if (gives_up) {
            forget_loops();
            return false;
        }
        for (std::size_t d = 0; d < domains_.size(); ++d) {
            if (!runs[d]) continue;
            domains_[d].halo = widened(domains_[d].halo);
            domains_[d].can_go_on = false;
        }
    }
}

/// All balls in one loop: what remains when the domains cannot agree. Gives how far they went.
Stop WindowedEngine::run_together(const Stop& window_end, bool may_end_early) {
    const Lease lease(*this);
    Workshop& w = *lease;
    w.loop->keeps_window = false;  // nobody compares
    w.loop->keeps_anchors = Keeps::kAll;
    w.loop->is_patient = true;
    load(w, kAll, {bodies_.grid, whole(bodies_.grid.x), whole(bodies_.grid.y), 0}, 0, window_end.time, false);
    EventLoop& loop = *w.loop;
    loop.most_collisions = EventLoop::kEndless;
    loop.room = may_end_early ? loop.room_for(kMostCollisionsTogether) : EventLoop::kEndless;
    loop.start();
    loop.advance_to(window_end.time, window_end.is_whole);
    forget_loops();
    for (DomainState& d : domains_) {
        d.clear_outcome();
        d.end.clear();
        d.is_full = false;
        d.in_turn = 0;
    }
    for (std::uint32_t i = 0; i < loop.size(); ++i) {
        DomainState& d = domains_[w.origins[i].domain];
        d.end.records.push_back(loop.records()[i]);
        if (bodies_.needs_extras()) d.end.extras.push_back(loop.extra(i));
        // The chain of overwritten anchors, the oldest first.
        std::vector<std::uint32_t> chain;
        for (std::uint32_t k = loop.last_overwritten(i); k != kNowhere; k = loop.overwritten[k].previous)
            chain.push_back(k);
        std::uint32_t last = kNowhere;
        for (; !chain.empty(); chain.pop_back()) {
            OverwrittenAnchor o = loop.overwritten[chain.back()];
            o.previous = last;
            o.ball = static_cast<std::uint32_t>(d.end.records.size() - 1);  // which is its place as well
            last = static_cast<std::uint32_t>(d.overwritten.size());
            d.overwritten.push_back(o);
        }
        d.last_overwritten.push_back(last);
        d.end.places.push_back(static_cast<std::uint32_t>(d.end.places.size()));
    }
    for (DomainState& d : domains_) index(d, d.end);
    domains_.front().swap_notes(loop);
    domains_.front().events = loop.events;
    return loop.is_full() ? Stop{loop.time_now()} : window_end;
}

/// What has become of the balls since, the domains' loops do not know.
void WindowedEngine::forget_loops() {
    for (DomainState& d : domains_) d.can_go_on = false;
}

std::unique_ptr<Workshop> WindowedEngine::make_workshop() const {
    auto workshop = std::make_unique<Workshop>();
    workshop->loop = make_event_loop(bodies_);
    workshop->loop->keeps_notes = true;
    return workshop;
}

/// Finds every ball's next event from nothing, after a renewal of the field where asked.
void WindowedEngine::predict_anew(bool renews_field) {
    constexpr std::int32_t kSight = 2;  // cells
    forget_loops();
    for_each_domain([&](std::size_t k) {
        DomainState& d = domains_[k];
        const Lease lease(*this);
        Workshop& w = *lease;
        w.loop->keeps_window = false;
        w.loop->keeps_anchors = Keeps::kNone;
        load(w, k, {bodies_.grid, d.x, d.y, kSight}, kSight, kNever, false);
        if (renews_field) w.loop->renew_field(window_start_);
        w.loop->predict_all(nullptr);
        d.clear_outcome();
        d.events = w.loop->events;
        keep_own(d, w, [](std::uint32_t, std::uint32_t) {});
    });
    in_window_ = true;
    window_end_ = {window_start_};
    commit();
}

/// The end of the window becomes the start of the next one.
void WindowedEngine::commit() {
    if (!in_window_) return;
    was_quiet_ = std::ranges::all_of(domains_, [](const DomainState& d) { return d.events == 0; });
    for (DomainState& d : domains_) {
        std::swap(d.start, d.end);
        d.outcomes.resize(d.start.records.size());
        counts_.events += d.events;
        counts_.copied_collisions += d.copied_collisions;
    }
    window_start_ = window_end_.time;
    in_window_ = false;
    weigh_window();
    if (is_uneven()) cut_anew();
}

/// Between windows, epochs in which nothing happens are left out.
void WindowedEngine::skip_quiet_epochs(const Time& until) {
    const Clock& clock = bodies_.physics.clock;
    Time first = until;
    for (const DomainState& d : domains_)
        for (const BallRecord& r : d.start.records)
            first = std::min({first, r.next.time, clock.after({window_start_.epoch, 0}, r.crossing_time)});
    if (first.epoch <= window_start_.epoch) return;
    const double passed = clock.epoch_length() * (double(first.epoch) - double(window_start_.epoch));
    for (DomainState& d : domains_)
        for (BallRecord& r : d.start.records) r.crossing_time -= passed;
    window_start_ = {first.epoch, 0};
}

/// One window more, on the way to `wanted` or beyond it.
void WindowedEngine::next_window(const Time& wanted, const Time& horizon) {
    const Clock& clock = bodies_.physics.clock;
    commit();
    if (was_quiet_) skip_quiet_epochs(std::min(wanted, horizon));
    const double least = std::max(clock.epoch_length() * kLeastWindow, window_length_ * kMostShortened);
    for (bool again = false;; again = true) {
        const bool gives_up = again && window_length_ <= least;
        Stop end{clock.after(window_start_, std::min(window_length_, clock.epoch_length())), false};
        const Time& last = cuts_windows_ ? std::min(wanted, horizon) : horizon;
        if (end.time >= last) end = {last};
        const double length = clock.difference(end.time, window_start_);
        const bool agreed = !gives_up && try_window(end);
        try {
            if (gives_up) end = run_together(end, true);
        } catch (const std::runtime_error&) {
            if (end.time <= wanted) throw;
            // What cannot go on lies ahead of the time that is asked for, and is no fault yet.
            end = run_together({wanted}, true);
        }
        counts_.windows += domains_.size();
        tune(length, agreed);
        window_length_ = std::max(least, window_length_);
        if (!agreed && !gives_up) continue;
        window_end_ = end;
        in_window_ = true;
        return;
    }
}

double WindowedEngine::collisions_in_turn() const {
    double collisions = 0;
    for (const DomainState& d : domains_) collisions += double(d.in_turn);
    return collisions;
}

/// Aims the next window at a number of collisions a ball that the halo stands.
void WindowedEngine::tune(double length, bool agreed) {
    if (!agreed) {
        window_length_ = shortened(length);
        return;
    }
    // One that has been cut short, as by the field's renewal, tells little.
    if (length < window_length_ / 2) return;
    const double retried = double(disagreeing_) / double(domains_.size());
    if (retried > 0) growth_ = kGrowth;
    target_ = std::min(kMostTarget, target_ * growth_ * std::pow(kShrinkage, retried));
    double collisions = 0;
    for (const DomainState& d : domains_) collisions += double(d.note_count());
    const double wanted = collisions > 0 ? length * collisions_aimed_at() / collisions : 2 * length;
    window_length_ = std::clamp(wanted, length / 2, std::max(2 * length, window_length_));
}

/// The length of a window in place of one that is given up: half, or so much that it has as many collisions
/// as it should.
double WindowedEngine::shortened(double length) {
    double wanted = length / 2;
    for (const DomainState& d : domains_) {
        if (!d.is_full) continue;
        const double came = bodies_.physics.clock.difference(d.full_at, window_start_);
        wanted = std::min(wanted, came * collisions_aimed_at() / double(d.in_turn + 1));
    }
    const double collisions = collisions_in_turn();
    if (collisions > too_many()) return std::min(wanted, length * collisions_aimed_at() / collisions);
    if (std::ranges::none_of(domains_, &DomainState::is_full)) {
        target_ = std::max(kLeastTarget, target_ * kShrinkage);
        growth_ = kGrowth;
    }
    return wanted;
}

std::unique_ptr<Engine> make_windowed_engine(const Bodies& bodies, const EngineStart& start,
                                             const Executor& executor, int domains, int halo) {
    return std::make_unique<WindowedEngine>(bodies, start, executor, domains, halo);
}

}  // namespace carom
