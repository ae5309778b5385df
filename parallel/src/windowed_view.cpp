// The windows as the world sees them: a time inside one, what has happened until then, and the state there.
#include <algorithm>
#include <queue>
#include <tuple>

#include "windowed_engine.hpp"

namespace carom {

void WindowedEngine::advance_to(const Time& end, const Time& horizon) {
    cuts_windows_ = cuts_left_ > 0;
    if (cuts_windows_) --cuts_left_;
    while (!in_window_ || !window_end_.covers(end)) {
        if (in_window_) tell_until(window_end_);
        next_window(end, horizon);
    }
    tell_until({end});
    now_ = end;
}

void WindowedEngine::tell_until(const Stop& end) {
    std::vector<Told> told;
    for (DomainState& d : domains_) {
        const std::size_t first = d.told;
        d.tell(end.time, tally_);
        for (std::size_t k = first; listener_ && k < d.told; ++k)
            told.push_back({&d.note(k), &d.collisions[k]});
    }
    std::ranges::sort(told, {}, [](const Told& t) { return t.note->time; });
    for (auto first = told.begin(); first != told.end();) {
        const auto last = std::find_if(first, told.end(),
                                       [first](const Told& t) { return t.note->time != first->note->time; });
        if (last - first > 1) order_simultaneous({first, last});
        first = last;
    }
    for (const Told& t : told) listener_(*t.collision);
    if (follower_) follower_(end);
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
    const auto ids = [&notes](std::size_t k) {  // a static ball is the note's second, whatever its id
        return in_order(notes[k].note->lower, notes[k].note->higher);
    };
    const auto comes_later = [&ids](std::size_t a, std::size_t b) { return ids(a) > ids(b); };
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

bool WindowedEngine::start_anew(const Time& t, std::span<NewStart> starts) {
    constexpr int kStopsAfterEdit = 4;
    rewind_to_now();
    commit();
    forget_loops();
    window_start_ = t;
    cuts_left_ = kStopsAfterEdit;
    std::vector<std::uint32_t> start_of(bodies_.count, kNowhere);
    for (std::uint32_t k = 0; k < starts.size(); ++k) start_of[starts[k].ball] = k;
    for_each_domain([&](std::size_t k) {
        DomainState& d = domains_[k];
        bool has_some = false;
        for (std::size_t i = 0; i < d.start.records.size(); ++i) {
            BallRecord& r = d.start.records[i];
            if (start_of[r.id()] == kNowhere) continue;
            has_some = true;
            NewStart& start = starts[start_of[r.id()]];
            BallExtra ignored;
            Vec2& acceleration = (d.start.extras.empty() ? ignored : d.start.extras[i]).acceleration;
            carom::start_anew(bodies_, r.anchor, r.periods, acceleration, t, start);
            ++r.anchor.stamp;
            r.next = {.time = kUnknown};  // the domains find it when they have their copies
            if (bodies_.accelerates_each())
                acceleration = bodies_.acceleration_at(r.id(), {r.anchor.x, r.anchor.y});
            start.state = state_at(bodies_, r.anchor, r.periods, acceleration, t);
        }
        if (has_some) index(d, d.start);
    });
    return true;
}

/// Each ball's last anchor until `t` among the overwritten ones, by the ball's place in the loop. One pass,
/// for a ball's chain costs a miss of the cache for every link.
std::vector<std::uint32_t> WindowedEngine::latest_until(const DomainState& d, const Time& t) const {
    std::vector<std::uint32_t> latest(held(d).places_end(), kNowhere);
    for (std::uint32_t o = 0; in_window_ && o < d.overwritten.size(); ++o)
        if (d.overwritten[o].time <= t) latest[d.overwritten[o].ball] = o;
    return latest;
}

WindowedEngine::Past WindowedEngine::past_of(const DomainState& d, std::size_t i,
                                             const std::vector<std::uint32_t>& latest_of,
                                             const Time& t) const {
    const BallRecord& r = held(d).records[i];
    if (!in_window_ || r.anchor.time <= t)
        return {r.anchor, r.periods, in_window_ && d.last_overwritten[i] != kNowhere};
    const std::uint32_t latest = latest_of[d.end.places[i]];
    if (latest == kNowhere) {
        const BallRecord& at_start = record_at_start(d, i);
        return {at_start.anchor, at_start.periods, false};
    }
    const OverwrittenAnchor& o = d.overwritten[latest];
    return {anchor_of(o), o.periods, o.previous != kNowhere};
}

/// What a ball of a domain's own was at the window's start. Precondition: its chain of overwritten anchors
/// ends there.
const BallRecord& WindowedEngine::record_at_start(const DomainState& d, std::size_t i) const {
    const Origin& origin = d.end.origins[i];
    return domains_[origin.domain].start.records[origin.index];
}

void WindowedEngine::read_domains(std::span<std::uint32_t> domains) const {
    for (std::size_t d = 0; d < domains_.size(); ++d)
        for (const BallRecord& record : held(domains_[d]).records)
            domains[record.id()] = static_cast<std::uint32_t>(d);
}

void WindowedEngine::visit_states(const Time& t, const VisitState& visit) const {
    for_each_domain([&](std::size_t k) {
        const DomainState& d = domains_[k];
        const auto& records = held(d).records;
        const auto& extras = held(d).extras;
        const std::vector<std::uint32_t> latest = latest_until(d, t);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const Past past = past_of(d, i, latest, t);
            visit(records[i].id(), state_at(bodies_, past.anchor, past.periods,
                                            extras.empty() ? Vec2(Vec2::Zero()) : extras[i].acceleration, t));
        }
    });
}

void WindowedEngine::visit_flights(const Stop& from, const Time& to, const VisitFlights& visit) const {
    for_each_domain([&](std::size_t k) {
        const DomainState& d = domains_[k];
        const auto& records = held(d).records;
        const auto& extras = held(d).extras;
        FlightList flights(bodies_);
        const bool has_starts = in_window_ && !d.end.origins.empty();
        for (std::size_t i = 0; i < records.size(); ++i)
            visit(records[i].id(),
                  flights.of({records[i].anchor, in_window_ ? d.last_overwritten[i] : kNowhere,
                              has_starts ? &record_at_start(d, i).anchor : nullptr},
                             extras.empty() ? Vec2(Vec2::Zero()) : extras[i].acceleration, d.overwritten,
                             from, to));
    });
}

/// An overwritten anchor does not tell the last collision; but within a window every event is one, and what
/// was before it the records of the window's start know.
void WindowedEngine::save(const Time& t, Snapshot& snapshot) const {
    std::vector<Time> before_window(in_window_ && bodies_.physics.contact_time > 0 ? bodies_.count : 0);
    for (const DomainState& d : domains_)
        for (std::size_t k = 0; !before_window.empty() && k < d.start.records.size(); ++k)
            before_window[d.start.records[k].id()] = d.start.extras[k].last_collision;
    // The window at hand is gone through anew from there; what it took is counted all the same.
    for (const DomainState& d : domains_)
        if (in_window_) snapshot.counts.events += d.events;
    BallSaver saver(bodies_, snapshot);
    for_each_domain([&](std::size_t k) {
        const DomainState& d = domains_[k];
        const auto& records = held(d).records;
        const auto& extras = held(d).extras;
        const std::vector<std::uint32_t> latest = latest_until(d, t);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const Past past = past_of(d, i, latest, t);
            BallExtra extra = extras.empty() ? BallExtra{} : extras[i];
            if (!before_window.empty())
                extra.last_collision = past.is_of_window ? past.anchor.time : before_window[records[i].id()];
            saver.save(records[i].id(), past.anchor, past.periods, extra);
        }
    });
}

std::uint32_t WindowedEngine::most_events() const {
    std::uint32_t most = 0;
    for (const DomainState& d : domains_) most = std::max(most, Engine::most_events(held(d).records));
    return most;
}

void WindowedEngine::audit(std::vector<Violation>& found) const {
    const std::unique_ptr<EventLoop> loop = make_event_loop(bodies_);
    loop->clear({bodies_.grid, whole(bodies_.grid.x), whole(bodies_.grid.y), 0},
                in_window_ ? window_end_.time : window_start_);
    for (const DomainState& d : domains_) {
        const auto& records = held(d).records;
        const auto& extras = held(d).extras;
        for (std::size_t i = 0; i < records.size(); ++i)
            loop->add(records[i], extras.empty() ? nullptr : &extras[i], true);
    }
    loop->start();
    loop->audit(found);
}

/// Back to the time that the world sees: what lies ahead of it is forgotten.
void WindowedEngine::rewind_to_now() {
    if (!in_window_ || (window_end_.time == now_ && window_end_.is_whole)) return;
    // The window again, up to now only; its events are counted and told already.
    window_end_ = run_together({now_}, false);
    for (DomainState& d : domains_) d.forget_notes();
}

void WindowedEngine::listen(std::function<void(const Collision&)> listener) {
    rewind_to_now();
    listener_ = std::move(listener);
}

}  // namespace carom
