#include "windowed_engine.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <queue>
#include <stdexcept>
#include <tuple>

namespace carom {
namespace {

constexpr std::int32_t kHalo = 6;  // cells
// So many cells of it are simulated to the window's end; the domain's own balls come there.
constexpr std::int32_t kKept = 4;
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
constexpr int kMostRepairs = 2;
constexpr int kMostShortenings = 5;
// A domain may have so many times the mean of balls before the plane is cut anew.
constexpr double kUneven = 1.5;
constexpr int kWindowsBetweenSplits = 16;

/// The halo of a domain that runs again.
constexpr std::int32_t widened(std::int32_t halo) {
    return halo + halo / 2 + 1;
}
/// The widest that a domain may come to.
constexpr std::int32_t widest(std::int32_t halo) {
    for (int repair = 0; repair < kMostRepairs; ++repair) halo = widened(halo);
    return halo;
}

CellCoordinates fold_periodic(const Grid& grid, const CellCoordinates& c) {
    return {grid.x.periodic() ? grid.x.fold(c.x) : c.x, grid.y.periodic() ? grid.y.fold(c.y) : c.y};
}

}  // namespace

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
        if (!workshop_) {
            workshop_ = std::make_unique<Workshop>();
            workshop_->loop = make_event_loop(engine.bodies_);
            workshop_->loop->keeps_notes = true;
        }
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

WindowedEngine::WindowedEngine(const Bodies& bodies, std::span<const Ball> balls, const Executor& executor,
                               int domains, int halo)
    : Engine(bodies),
      executor_(executor),
      wanted_domains_(domains),
      halo_(halo > 0 ? halo : kHalo),
      window_length_(bodies.physics.clock.epoch_length() * kFirstWindow),
      growth_(kFirstGrowth) {
    std::vector<BallRecord> records = records_at_start(bodies, balls);
    std::vector<BallExtra> extras(bodies.needs_extras() ? records.size() : 0);
    split(std::move(records), std::move(extras), whole(bodies.grid.x), whole(bodies.grid.y), domains);
    predict_anew(bodies.accelerates_each());
}

template <class F>
void WindowedEngine::for_each_domain(F&& f) const {
    executor_.for_ranges(domains_.size(), 1, [&](std::size_t first, std::size_t last) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t d = first; d < last; ++d) f(d);
        working_time_ += (std::chrono::steady_clock::now() - start).count();
    });
}

// ---- Cutting the plane

/// Cuts a rectangle of cells that holds the records into `parts` domains with about as many balls each, at
/// right angles to the longer side of what is occupied.
void WindowedEngine::split(std::vector<BallRecord> records, std::vector<BallExtra> extras, Span x, Span y,
                           int parts) {
    std::vector<CellCoordinates> cells;
    cells.reserve(records.size());
    for (const BallRecord& r : records) cells.push_back(fold_periodic(bodies_.grid, r.anchor.cell));
    const auto extent = [&cells](std::int32_t CellCoordinates::* axis) {
        const auto [low, high] = std::ranges::minmax(cells, {}, axis);
        return Span{low.*axis, high.*axis + 1};
    };
    const int left_parts = parts / 2;
    for (int attempt = 0; parts > 1 && !cells.empty() && attempt < 2; ++attempt) {
        const Span extent_x = extent(&CellCoordinates::x);
        const Span extent_y = extent(&CellCoordinates::y);
        const bool across = (extent_x.size() >= extent_y.size()) == (attempt == 0);
        const auto axis = across ? &CellCoordinates::x : &CellCoordinates::y;
        const Span occupied = across ? extent_x : extent_y;
        std::vector<std::size_t> balls(static_cast<std::size_t>(occupied.size()), 0);
        if (balls.size() < 2 || balls.size() > 64 * records.size() + 1024) continue;
        for (const CellCoordinates& c : cells) ++balls[static_cast<std::size_t>(c.*axis - occupied.first)];
        const double share = double(records.size()) * left_parts / parts;
        std::int32_t cut = occupied.first + 1;
        std::size_t before = balls[0];
        while (cut < occupied.last - 1 &&
               double(before) + double(balls[static_cast<std::size_t>(cut - occupied.first)]) / 2 < share)
            before += balls[static_cast<std::size_t>(cut++ - occupied.first)];

        std::vector<BallRecord> halves[2];
        std::vector<BallExtra> half_extras[2];
        for (std::size_t k = 0; k < records.size(); ++k) {
            const int half = cells[k].*axis < cut ? 0 : 1;
            halves[half].push_back(records[k]);
            if (!extras.empty()) half_extras[half].push_back(extras[k]);
        }
        records = {};
        Span& side = across ? x : y;
        const Span lower{side.first, cut};
        const Span upper{cut, side.last};
        side = lower;
        split(std::move(halves[0]), std::move(half_extras[0]), x, y, left_parts);
        side = upper;
        split(std::move(halves[1]), std::move(half_extras[1]), x, y, parts - left_parts);
        return;
    }
    DomainState& d = domains_.emplace_back();
    d.x = x;
    d.y = y;
    d.records = std::move(records);
    d.extras = std::move(extras);
    index_records(d);
}

void WindowedEngine::split_anew() {
    std::vector<BallRecord> records;
    std::vector<BallExtra> extras;
    records.reserve(bodies_.moving);
    for (DomainState& d : domains_) {
        records.insert(records.end(), d.records.begin(), d.records.end());
        extras.insert(extras.end(), d.extras.begin(), d.extras.end());
        d.records = {};
    }
    domains_.clear();
    split(std::move(records), std::move(extras), whole(bodies_.grid.x), whole(bodies_.grid.y),
          wanted_domains_);
    since_split_ = 0;
}

void WindowedEngine::index_records(DomainState& d) const {
    d.cells.clear();
    d.cells_x = d.cells_y = {GridAxis::kFarthest, -GridAxis::kFarthest};
    for (const BallRecord& r : d.records) {
        const CellCoordinates c = fold_periodic(bodies_.grid, r.anchor.cell);
        d.cells.push_back(c);
        d.cells_x = {std::min(d.cells_x.first, c.x), std::max(d.cells_x.last, c.x + 1)};
        d.cells_y = {std::min(d.cells_y.first, c.y), std::max(d.cells_y.last, c.y + 1)};
    }
    d.histories.assign(d.records.size(), 0);
}

// ---- One domain through a window

/// Appends to a message what a domain holds for a region: plain data, all that the receiver needs.
void WindowedEngine::pack(std::uint32_t from, const Region& region, std::vector<BallMessage>& message) const {
    const DomainState& source = domains_[from];
    if (!region.x.meets(source.cells_x) || !region.y.meets(source.cells_y)) return;
    for (std::uint32_t k = 0; k < source.records.size(); ++k) {
        CellCoordinates c = source.cells[k];
        if (!region.x.covers(c.x) || !region.y.covers(c.y)) continue;
        c.x += region.x.frame_of(c.x);
        c.y += region.y.frame_of(c.y);
        BallMessage& ball = message.emplace_back();
        ball.record = source.records[k];
        if (!source.extras.empty()) ball.extra = source.extras[k];
        ball.origin = {from, k};
        ball.depth = region.depth(c);
    }
}

/// Fills a loop from a message: the domain's own balls first, then copies of the others. With `ends_early` a
/// copy is given up the sooner the deeper in the halo it starts: what it does later cannot reach the domain
/// before the window ends.
void WindowedEngine::unpack(const std::vector<BallMessage>& message, const Region& region, std::int32_t halo,
                            const Time& window_end, bool ends_early, Workshop& w) const {
    const Clock& clock = bodies_.physics.clock;
    std::vector<Time> ends;  // of copies, by depth
    const double length = clock.difference(window_end, window_start_);
    for (std::int32_t depth = 0; depth <= halo; ++depth) {
        const double share =
            depth <= kKept ? 1.0 : double(halo - depth + 1) / double(std::max(1, halo - kKept + 1));
        ends.push_back(share < 1 && ends_early ? clock.after(window_start_, share * length) : kNever);
    }
    w.loop->clear(region, window_start_);
    w.loop->reserve(message.size());
    w.origins.clear();
    for (const bool own : {true, false}) {
        for (const BallMessage& ball : message) {
            if ((ball.depth == 0) != own) continue;
            w.loop->add(ball.record, &ball.extra, own,
                        ends[std::min(static_cast<std::size_t>(ball.depth), ends.size() - 1)]);
            w.origins.push_back(ball.origin);
        }
        if (own) w.own = w.loop->size();
    }
}

void WindowedEngine::load(Workshop& w, const Region& region, std::int32_t halo, const Time& window_end,
                          bool ends_early) const {
    w.message.clear();
    for (std::uint32_t d = 0; d < domains_.size(); ++d) pack(d, region, w.message);
    unpack(w.message, region, halo, window_end, ends_early, w);
}

void WindowedEngine::run(DomainState& d, const Time& window_end, bool inclusive) {
    const Lease lease(*this);
    Workshop& w = *lease;
    w.loop->keeps_window = true;
    w.loop->is_patient = false;  // all balls together will tell
    d.region = {bodies_.grid, d.x, d.y, d.halo};
    load(w, d.region, d.halo, window_end, true);
    w.loop->start();
    try {
        w.loop->advance_to(window_end, inclusive);
        d.failed = w.loop->has_failed();
    } catch (const std::runtime_error&) {
        d.failed = true;  // perhaps only because a copy went astray: all balls together will tell
    }
    keep_outcome(d, w, window_end);
}

void WindowedEngine::keep_outcome(DomainState& d, Workshop& w, const Time& window_end) {
    EventLoop& loop = *w.loop;
    d.results.clear();
    d.result_extras.clear();
    d.last_overwritten.clear();
    d.copies.clear();
    d.copy_visits.clear();
    d.visits.clear();
    d.told = 0;
    std::swap(d.overwritten, loop.overwritten);
    std::swap(d.notes, loop.notes);
    std::swap(d.collisions, loop.collisions);
    std::swap(d.touched, loop.touched);
    d.events = loop.events;
    d.copied_collisions =
        loop.collisions_of_all - std::min<std::uint64_t>(loop.collisions_of_all, d.notes.size());
    d.results.assign(loop.records().begin(), loop.records().begin() + w.own);
    for (std::uint32_t i = 0; i < w.own; ++i) {
        if (bodies_.needs_extras()) d.result_extras.push_back(loop.extra(i));
        d.last_overwritten.push_back(loop.last_overwritten(i));
        domains_[w.origins[i].domain].histories[w.origins[i].index] = loop.history(i);
    }
    d.copies.reserve(loop.size() - w.own);
    for (std::uint32_t i = w.own; i < loop.size(); ++i) {
        const CellCoordinates c = domains_[w.origins[i].domain].cells[w.origins[i].index];
        const CellCoordinates frame = d.region.frame_of(c);
        d.copies.push_back({w.origins[i], loop.history(i), d.region.mark({c.x + frame.x, c.y + frame.y}),
                            loop.is_lost(i, window_end)});
    }
    for (const Visit& v : loop.visits_of_copies)
        d.copy_visits.push_back({v.ball - w.own, d.region.mark(v.cell)});
    // Other domains reach no further into this one than their halo, be it widened after this run.
    const std::int32_t reach = widest(halo_);
    for (const Visit& v : loop.visits)
        if (!d.region.x.is_deep_inside(v.cell.x, reach) || !d.region.y.is_deep_inside(v.cell.y, reach))
            d.visits.push_back({w.origins[v.ball], fold_periodic(bodies_.grid, v.cell)});
}

/// Whether every foreign ball that could have met one of the domain's own did there what it did at its owner.
bool WindowedEngine::agrees(const DomainState& d) const {
    if (d.failed) return false;
    std::vector<std::uint8_t> is_right(d.copies.size());
    for (std::size_t k = 0; k < d.copies.size(); ++k) {
        const CopyOutcome& copy = d.copies[k];
        is_right[k] =
            !copy.is_lost && copy.history == domains_[copy.origin.domain].histories[copy.origin.index];
        if (!is_right[k] && d.touched[static_cast<std::size_t>(copy.mark)]) return false;
    }
    for (const CopyVisit& v : d.copy_visits)
        if (!is_right[v.copy] && d.touched[static_cast<std::size_t>(v.mark)]) return false;
    for (const DomainState& other : domains_) {
        if (&other == &d || !d.region.meets(other.region)) continue;
        for (const OwnVisit& v : other.visits) {
            const CellCoordinates frame = d.region.frame_of(v.cell);
            const std::int32_t mark = d.region.mark({v.cell.x + frame.x, v.cell.y + frame.y});
            if (mark < 0 || !d.touched[static_cast<std::size_t>(mark)]) continue;
            const auto copy = std::ranges::lower_bound(d.copies, v.origin, {}, &CopyOutcome::origin);
            if (copy == d.copies.end() || copy->origin != v.origin ||
                !is_right[static_cast<std::size_t>(copy - d.copies.begin())])
                return false;
        }
    }
    return true;
}

// ---- All domains through a window

/// Runs every domain to `window_end` and repairs those that disagree with their neighbours: again, with a
/// wider halo. Gives up after a few rounds.
bool WindowedEngine::try_window(const Time& window_end, bool inclusive) {
    std::vector<std::uint8_t> runs(domains_.size(), 1);
    for (DomainState& d : domains_) d.halo = halo_;
    disagreeing_ = 0;
    for (int round = 0;; ++round) {
        for_each_domain([&](std::size_t d) {
            if (runs[d]) run(domains_[d], window_end, inclusive);
        });
        for_each_domain([&](std::size_t d) { runs[d] = agrees(domains_[d]) ? 0 : 1; });
        const auto disagreeing = static_cast<std::uint64_t>(std::ranges::count(runs, 1));
        if (disagreeing == 0) return true;
        counts_.window_retries += disagreeing;
        disagreeing_ += disagreeing;
        if (round == kMostRepairs || 4 * disagreeing > 3 * domains_.size() + 4) return false;
        for (std::size_t d = 0; d < domains_.size(); ++d)
            if (runs[d]) domains_[d].halo = widened(domains_[d].halo);
    }
}

/// All balls in one loop: what remains when the domains cannot agree.
void WindowedEngine::run_together(const Time& window_end, bool inclusive) {
    const Lease lease(*this);
    Workshop& w = *lease;
    w.loop->keeps_window = w.loop->is_patient = true;
    load(w, {bodies_.grid, whole(bodies_.grid.x), whole(bodies_.grid.y), 0}, 0, window_end, false);
    w.loop->start();
    w.loop->advance_to(window_end, inclusive);
    EventLoop& loop = *w.loop;
    for (DomainState& d : domains_) {
        d.results.clear();
        d.result_extras.clear();
        d.last_overwritten.clear();
        d.overwritten.clear();
        d.notes.clear();
        d.collisions.clear();
        d.told = 0;
        d.events = d.copied_collisions = 0;
    }
    for (std::uint32_t i = 0; i < loop.size(); ++i) {
        DomainState& d = domains_[w.origins[i].domain];
        d.results.push_back(loop.records()[i]);
        if (bodies_.needs_extras()) d.result_extras.push_back(loop.extra(i));
        // The chain of overwritten anchors, the oldest first.
        std::vector<std::uint32_t> chain;
        for (std::uint32_t k = loop.last_overwritten(i); k != kNowhere; k = loop.overwritten[k].previous)
            chain.push_back(k);
        std::uint32_t last = kNowhere;
        for (; !chain.empty(); chain.pop_back()) {
            OverwrittenAnchor o = loop.overwritten[chain.back()];
            o.previous = last;
            last = static_cast<std::uint32_t>(d.overwritten.size());
            d.overwritten.push_back(o);
        }
        d.last_overwritten.push_back(last);
    }
    std::swap(domains_.front().notes, loop.notes);
    std::swap(domains_.front().collisions, loop.collisions);
    domains_.front().events = loop.events;
}

/// Finds every ball's next event from nothing, after a renewal of the field where asked.
void WindowedEngine::predict_anew(bool renews_field) {
    constexpr std::int32_t kSight = 2;  // cells
    for_each_domain([&](std::size_t k) {
        DomainState& d = domains_[k];
        const Lease lease(*this);
        Workshop& w = *lease;
        w.loop->keeps_window = false;
        load(w, {bodies_.grid, d.x, d.y, kSight}, kSight, kNever, false);
        if (renews_field) w.loop->renew_field(window_start_);
        w.loop->predict_all(nullptr);
        d.events = w.loop->events;
        d.results.clear();
        d.result_extras.clear();
        d.results.assign(w.loop->records().begin(), w.loop->records().begin() + w.own);
        for (std::uint32_t i = 0; bodies_.needs_extras() && i < w.own; ++i)
            d.result_extras.push_back(w.loop->extra(i));
        d.notes.clear();
        d.told = 0;
        d.copied_collisions = 0;
    });
    in_window_ = true;
    window_end_ = window_start_;
    commit();
}

/// The results become the records.
void WindowedEngine::commit() {
    if (!in_window_) return;
    for_each_domain([&](std::size_t k) {
        DomainState& d = domains_[k];
        std::swap(d.records, d.results);
        std::swap(d.extras, d.result_extras);
        index_records(d);
    });
    std::size_t most = 0;
    for (const DomainState& d : domains_) {
        counts_.events += d.events;
        counts_.copied_collisions += d.copied_collisions;
        most = std::max(most, d.records.size());
    }
    window_start_ = window_end_;
    in_window_ = window_is_closed_ = false;
    if (++since_split_ >= kWindowsBetweenSplits &&
        double(most) * double(domains_.size()) > kUneven * double(bodies_.moving))
        split_anew();
}

/// One window more, on the way to `wanted` or beyond it.
void WindowedEngine::next_window(const Time& wanted, const Time& horizon) {
    const Clock& clock = bodies_.physics.clock;
    commit();
    const double least = clock.epoch_length() * kLeastWindow;
    for (int shortenings = 0;; ++shortenings) {
        const bool gives_up = shortenings > kMostShortenings || (shortenings > 0 && window_length_ <= least);
        Time end = clock.after(window_start_, window_length_);
        if (end.epoch > window_start_.epoch) end = {window_start_.epoch + 1, 0};
        window_is_closed_ = end >= horizon;
        if (window_is_closed_) end = horizon;
        const double length = clock.difference(end, window_start_);
        const bool agreed = !gives_up && try_window(end, window_is_closed_);
        try {
            if (gives_up) run_together(end, window_is_closed_);
        } catch (const std::runtime_error&) {
            if (end <= wanted) throw;
            // What cannot go on lies ahead of the time that is asked for, and is no fault yet.
            end = wanted;
            window_is_closed_ = true;
            run_together(end, window_is_closed_);
        }
        counts_.windows += domains_.size();
        tune(length, agreed);
        if (!agreed && !gives_up) continue;
        window_end_ = end;
        in_window_ = true;
        return;
    }
}

/// Aims the next window at a number of collisions a ball that the halo stands.
void WindowedEngine::tune(double length, bool agreed) {
    const double least = bodies_.physics.clock.epoch_length() * kLeastWindow;
    if (!agreed) {
        target_ = std::max(kLeastTarget, target_ * kShrinkage);
        growth_ = kGrowth;
        window_length_ = std::max(length / 2, least);
        return;
    }
    // One that an epoch's end or the field has cut short tells little.
    if (length < window_length_ / 2) return;
    const double retried = double(disagreeing_) / double(domains_.size());
    if (retried > 0) growth_ = kGrowth;
    target_ = std::min(kMostTarget, target_ * growth_ * std::pow(kShrinkage, retried));
    double collisions = 0;
    for (const DomainState& d : domains_) collisions += double(d.notes.size());
    const double a_ball = 2 * collisions / std::max(1.0, double(bodies_.moving));
    const double wanted = a_ball > 0 ? length * target_ / a_ball : 2 * length;
    window_length_ = std::max(least, std::clamp(wanted, length / 2, std::max(2 * length, window_length_)));
}

// ---- As the world sees it

void WindowedEngine::advance_to(const Time& end, const Time& horizon) {
    while (!in_window_ || window_end_ < end || (window_end_ == end && !window_is_closed_)) {
        if (in_window_) tell_until(window_end_);
        next_window(end, horizon);
    }
    tell_until(end);
    now_ = end;
}

void WindowedEngine::tell_until(const Time& end) {
    std::vector<Told> told;
    for (DomainState& d : domains_) {
        for (; d.told < d.notes.size() && d.notes[d.told].time <= end; ++d.told) {
            count(d.notes[d.told]);
            if (listener_) told.push_back({&d.notes[d.told], &d.collisions[d.told]});
        }
    }
    std::ranges::stable_sort(told, {}, [](const Told& t) { return t.note->time; });
    for (auto first = told.begin(); first != told.end();) {
        const auto last = std::find_if(first, told.end(),
                                       [first](const Told& t) { return t.note->time != first->note->time; });
        if (last - first > 1) order_simultaneous({first, last});
        first = last;
    }
    for (const Told& t : told) listener_(*t.collision);
}

/// Collisions at one instant in the order in which a single loop has them: always the smallest ids whose
/// balls have had all that came to them before. One collision may bring about the next, so that the ids alone
/// do not tell.
void WindowedEngine::order_simultaneous(std::span<Told> notes) const {
    struct Use {
        std::uint32_t ball, stamp;
        std::size_t note;
    };
    std::vector<Use> uses;
    for (std::size_t k = 0; k < notes.size(); ++k) {
        const CollisionNote& n = *notes[k].note;
        uses.push_back({n.lower, n.lower_stamp, k});
        if (!n.is_wall && !bodies_.fixes(n.higher)) uses.push_back({n.higher, n.higher_stamp, k});
    }
    std::ranges::sort(uses, {}, [](const Use& u) { return std::tuple(u.ball, u.stamp); });
    std::vector<int> waits_for(notes.size(), 0);
    std::vector<std::vector<std::size_t>> lets_go(notes.size());
    for (std::size_t u = 1; u < uses.size(); ++u) {
        if (uses[u].ball != uses[u - 1].ball) continue;
        lets_go[uses[u - 1].note].push_back(uses[u].note);
        ++waits_for[uses[u].note];
    }
    const auto comes_later = [&notes](std::size_t a, std::size_t b) {
        return std::tuple(notes[a].note->lower, notes[a].note->higher) >
               std::tuple(notes[b].note->lower, notes[b].note->higher);
    };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(comes_later)> ready(comes_later);
    for (std::size_t k = 0; k < notes.size(); ++k)
        if (waits_for[k] == 0) ready.push(k);
    std::vector<Told> ordered;
    while (!ready.empty()) {
        const std::size_t k = ready.top();
        ready.pop();
        ordered.push_back(notes[k]);
        for (const std::size_t next : lets_go[k])
            if (--waits_for[next] == 0) ready.push(next);
    }
    std::ranges::copy(ordered, notes.begin());
}

void WindowedEngine::renew_field(const Time& t) {
    commit();
    window_start_ = t;
    predict_anew(true);
}

void WindowedEngine::read(const Time& t, std::span<BallState> states) const {
    for_each_domain([&](std::size_t k) {
        const DomainState& d = domains_[k];
        const std::vector<BallRecord>& records = in_window_ ? d.results : d.records;
        const std::vector<BallExtra>& extras = in_window_ ? d.result_extras : d.extras;
        for (std::size_t i = 0; i < records.size(); ++i) {
            Anchor anchor = records[i].anchor;
            Periods periods = records[i].periods;
            if (in_window_) {
                for (std::uint32_t o = d.last_overwritten[i]; anchor.time > t && o != kNowhere;
                     o = d.overwritten[o].previous) {
                    const OverwrittenAnchor& before = d.overwritten[o];
                    anchor = {before.x, before.y, before.vx, before.vy, before.time, 0, 0, {}};
                    periods = before.periods;
                }
            }
            states[records[i].id] = state_at(bodies_, anchor, periods,
                                             extras.empty() ? Vec2(Vec2::Zero()) : extras[i].acceleration, t);
        }
    });
}

void WindowedEngine::audit(std::vector<Violation>& found) const {
    const std::unique_ptr<EventLoop> loop = make_event_loop(bodies_);
    loop->clear({bodies_.grid, whole(bodies_.grid.x), whole(bodies_.grid.y), 0},
                in_window_ ? window_end_ : window_start_);
    for (const DomainState& d : domains_) {
        const std::vector<BallRecord>& records = in_window_ ? d.results : d.records;
        const std::vector<BallExtra>& extras = in_window_ ? d.result_extras : d.extras;
        for (std::size_t i = 0; i < records.size(); ++i)
            loop->add(records[i], extras.empty() ? nullptr : &extras[i], true);
    }
    loop->start();
    loop->audit(found);
}

/// Back to the time that the world sees: what lies ahead of it is forgotten.
void WindowedEngine::rewind_to_now() {
    if (!in_window_) return;
    // The window again, up to now only; its events are counted and told already.
    run_together(now_, true);
    for (DomainState& d : domains_) {
        d.notes.clear();
        d.collisions.clear();
    }
    window_end_ = now_;
    window_is_closed_ = true;
}

void WindowedEngine::listen(std::function<void(const Collision&)> listener) {
    rewind_to_now();
    listener_ = std::move(listener);
}

std::unique_ptr<Engine> make_windowed_engine(const Bodies& bodies, std::span<const Ball> balls,
                                             const Executor& executor, int domains, int halo) {
    return std::make_unique<WindowedEngine>(bodies, balls, executor, domains, halo);
}

}  // namespace carom
