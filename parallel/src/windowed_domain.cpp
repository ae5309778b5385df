// One domain through a window: what it is sent, what it does, and whether that agrees with its neighbours.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fault.hpp"
#include "windowed_engine.hpp"

namespace carom {
namespace {

// A window aims at a few collisions a ball; there is no room for more than so many.
constexpr std::uint64_t kMostCollisionsOfBall = 32;
// A message of more would lie in no cache when it is read.
constexpr std::size_t kBallsOfMessage = 64;
const Time& end_at(const std::vector<Time>& ends, std::int32_t depth) {
    return ends[std::min(static_cast<std::size_t>(depth), ends.size() - 1)];
}

}  // namespace

/// Sends what a domain holds for the region of another one: plain data, all that the receiver needs, in
/// messages that deliver() has done with when it returns.
template <class F>
void WindowedEngine::pack(std::uint32_t from, const Region& region, std::int32_t halo,
                          std::vector<BallMessage>& message, F&& deliver) const {
    const Roster& source = domains_[from].start;
    if (!region.x.meets(source.cells_x) || !region.y.meets(source.cells_y)) return;
    const BallExtra none;
    message.clear();
    const auto pack_one = [&](std::uint32_t k) {
        const CellCoordinates& c = source.cells[k];
        if (!region.x.covers(c.x) || !region.y.covers(c.y)) return;
        message.emplace_back(source.records[k], source.extras.empty() ? none : source.extras[k],
                             Origin{from, k}, source.origins.empty() ? Origin{} : source.origins[k],
                             region.depth(region.framed(c)));
        if (message.size() < kBallsOfMessage) return;
        deliver();
        message.clear();
    };
    if (halo <= halo_) {
        const std::vector<std::uint32_t>& near = source.near_border;
        for (std::size_t n = 0; n < near.size(); ++n) {
            if (n + kFetchedAhead < near.size()) fetch(source.records[near[n + kFetchedAhead]]);
            pack_one(near[n]);
        }
    } else {
        for (std::uint32_t k = 0; k < source.records.size(); ++k) pack_one(k);
    }
    deliver();
}

/// Adds what domain `self` holds and stays with it; the message gets what has left it for the halo.
void WindowedEngine::add_residents(std::uint32_t self, const Region& region, Workshop& w) const {
    const DomainState& d = domains_[self];
    w.residents.assign(d.start.places_end(), kNowhere);
    const BallExtra none;
    for (std::uint32_t k = 0; k < d.start.records.size(); ++k) {
        const CellCoordinates& c = d.start.cells[k];
        const BallExtra& extra = d.start.extras.empty() ? none : d.start.extras[k];
        const std::int32_t depth = region.depth(region.framed(c));
        if (depth == 0) {
            if (!d.start.places.empty()) w.residents[d.start.places[k]] = w.loop->size();
            w.own.push_back(w.loop->size());
            w.loop->add(d.start.records[k], &extra, true);
            w.origins.push_back({self, k});
        } else if (region.x.covers(c.x) && region.y.covers(c.y)) {
            w.message.push_back({d.start.records[k], extra, {self, k}, {}, depth});
        }
    }
    // Partners that stayed as well are told apart by where they were, and need not be looked for.
    for (std::uint32_t k = 0; k < d.start.places.size(); ++k) {
        const std::uint32_t self_here = w.residents[d.start.places[k]];
        const std::uint32_t partner = d.start.records[k].next.local;
        if (self_here != kNowhere && partner < w.residents.size() && w.residents[partner] != kNowhere)
            w.loop->suggest_partner(self_here, w.residents[partner]);
    }
}

/// When copies are given up, by their depth: the sooner the deeper in the halo they start, for what they do
/// later cannot reach the domain before the window ends.
std::vector<Time> WindowedEngine::ends_of_copies(std::int32_t halo, const Time& window_end) const {
    const Clock& clock = bodies_.physics.clock;
    const double length = clock.difference(window_end, window_start_);
    std::vector<Time> ends;
    for (std::int32_t depth = 0; depth <= halo; ++depth) {
        const double share =
            depth <= widest_kept_ ? 1.0 : double(halo - depth + 1) / double(halo - widest_kept_ + 1);
        ends.push_back(share < 1 ? clock.after(window_start_, share * length) : kNever);
    }
    return ends;
}

/// Fills a loop for a region, that of domain `self` or the whole plane where that is none. With `ends_early`
/// copies are given up in time.
void WindowedEngine::load(Workshop& w, std::size_t self, const Region& region, std::int32_t halo,
                          const Time& window_end, bool ends_early) const {
    empty(w.own, w.copies, w.origins);
    w.loop->clear(region, window_start_);
    const std::vector<Time> ends = ends_early ? ends_of_copies(halo, window_end) : std::vector{kNever};
    const auto add_message = [&] {
        for (const BallMessage& ball : w.message) {
            (ball.depth == 0 ? w.own : w.copies).push_back(w.loop->size());
            w.loop->add(ball.record, &ball.extra, ball.depth == 0, end_at(ends, ball.depth));
            w.origins.push_back(ball.origin);
        }
    };
    for (std::uint32_t d = 0; d < domains_.size(); ++d) {
        if (d == self) {
            w.message.clear();
            add_residents(d, region, w);
            add_message();
        } else {
            pack(d, region, self == kAll ? kEverything : halo, w.message, add_message);
        }
    }
}

/// Makes the loop that domain `self` has gone through the last window with ready for the next one: its balls
/// are what they are, copies become what their owners say, some come and some go.
void WindowedEngine::go_on(Workshop& w, std::size_t self, const Region& region, std::int32_t halo,
                           const Time& window_end) const {
    EventLoop& loop = *w.loop;
    loop.go_on();
    const std::vector<Time> ends = ends_of_copies(halo, window_end);
    const auto here = [&w](const Origin& o) -> std::uint32_t& {
        if (w.here.size() <= o.domain) w.here.resize(o.domain + 1);
        std::vector<std::uint32_t>& places = w.here[o.domain];
        if (places.size() <= o.index) places.resize(o.index + 1, kNowhere);
        return places[o.index];
    };
    for (const std::uint32_t i : w.copies) here(w.origins[i]) = i;

    empty(w.unknown, w.arrivals, w.newcomers);
    const auto renew = [&] {
        for (const BallMessage& ball : w.message) {
            const std::uint32_t place = std::exchange(here(ball.before), kNowhere);
            w.arrivals.push_back({ball.origin, place, ball.depth == 0});
            if (place != kNowhere) fetch(loop.records()[place]);
        }
        const Workshop::Arrival* arrival = w.arrivals.data() + (w.arrivals.size() - w.message.size());
        for (const BallMessage& ball : w.message) {
            const std::uint32_t place = (arrival++)->place;
            if (place == kNowhere) {
                w.newcomers.push_back(ball);
                continue;
            }
            loop.renew(place, ball.record, ball.extra, ball.depth == 0, end_at(ends, ball.depth));
            if (ball.record.next.time == kUnknown) w.unknown.push_back(place);
        }
    };
    for (std::uint32_t d = 0; d < domains_.size(); ++d)
        if (d != self) pack(d, region, halo, w.message, renew);
    for (const std::uint32_t i : w.copies) {
        std::uint32_t& place = here(w.origins[i]);
        if (place == i) loop.remove(std::exchange(place, kNowhere));
    }

    // The domain's own balls, and those of them that have left its cells.
    const DomainState& d = domains_[self];
    for (std::uint32_t k = 0; k < d.start.places.size(); ++k)
        w.origins[d.start.places[k]] = {static_cast<std::uint32_t>(self), k};
    w.own = d.start.places;
    w.copies.clear();
    std::vector<std::uint32_t> left;
    for (const std::uint32_t k : d.start.near_border) {
        const CellCoordinates& c = d.start.cells[k];
        const std::int32_t depth = region.depth(region.framed(c));
        if (depth == 0) continue;
        const std::uint32_t i = std::exchange(w.own[k], kNowhere);
        if (region.x.covers(c.x) && region.y.covers(c.y)) {
            loop.hand_over(i, end_at(ends, depth));
            left.push_back(i);
        } else {
            loop.remove(i);
        }
    }
    std::erase(w.own, kNowhere);
    for (const std::uint32_t k : d.start.unknown)
        if (loop.id(d.start.places[k]) != kNowhere) w.unknown.push_back(d.start.places[k]);
    auto newcomer = w.newcomers.begin();
    for (const Workshop::Arrival& arrival : w.arrivals) {
        std::uint32_t i = arrival.place;
        if (i == kNowhere) {
            const BallMessage& ball = *newcomer++;
            i = loop.enter(ball.record, ball.extra, arrival.is_own, end_at(ends, ball.depth));
            if (ball.record.next.time == kUnknown) w.unknown.push_back(i);
        }
        if (w.origins.size() <= i) w.origins.resize(i + 1);
        w.origins[i] = arrival.origin;
        (arrival.is_own ? w.own : w.copies).push_back(i);
    }
    loop.look_again(w.unknown);
    const auto after = std::ranges::partition_point(
        w.copies, [&w, self](std::uint32_t i) { return w.origins[i].domain < self; });
    w.copies.insert(after, left.begin(), left.end());
}

void WindowedEngine::run(DomainState& d, const Stop& window_end) {
    if (!loops_stay_) {
        const Lease lease(*this);
        return run(d, window_end, *lease);
    }
    if (!d.workshop) d.workshop = make_workshop();
    d.workshop->loop->listens = static_cast<bool>(listener_);
    run(d, window_end, *d.workshop);
    d.can_go_on = !d.failed;
}

void WindowedEngine::run(DomainState& d, const Stop& window_end, Workshop& w) {
    const auto self = static_cast<std::size_t>(&d - domains_.data());
    w.loop->keeps_window = true;
    w.loop->keeps_anchors = Keeps::kAllButFirst;
    w.loop->is_patient = false;  // all balls together will tell
    d.region = {bodies_.grid, d.x, d.y, d.halo};
    d.swap_tables(*w.loop);
    if (d.can_go_on && w.loop->can_go_on(d.region, window_start_)) {
        go_on(w, self, d.region, d.halo, window_end.time);
    } else {
        load(w, self, d.region, d.halo, window_end.time, true);
        w.loop->start();
    }
    w.loop->room = w.loop->room_for(kMostCollisionsOfBall);
    w.loop->most_collisions = static_cast<std::uint64_t>(too_many());
    try {
        w.loop->advance_to(window_end.time, window_end.is_whole);
        d.failed = w.loop->has_failed() || w.loop->is_full();
    } catch (const std::runtime_error&) {
        d.failed = true;  // perhaps only because a copy went astray: all balls together will tell
    }
    d.is_full = w.loop->is_full();
    d.full_at = w.loop->time_now();
    keep_outcome(d, w, window_end.time);
}

void WindowedEngine::keep_outcome(DomainState& d, Workshop& w, const Time& window_end) {
    EventLoop& loop = *w.loop;
    const auto self = static_cast<std::uint32_t>(&d - domains_.data());
    d.clear_outcome();
    d.swap_tables(loop);
    d.events = loop.events;
    const std::uint64_t collisions = d.note_count();
    d.in_turn = loop.in_turn(collisions);
    d.copied_collisions = loop.collisions_of_all - std::min(loop.collisions_of_all, collisions);
    d.copies.reserve(w.copies.size());
    std::vector<std::uint32_t>& copy_of = w.copy_of;
    copy_of.assign(loop.size(), kNowhere);
    for (const std::uint32_t i : w.copies) {
        copy_of[i] = static_cast<std::uint32_t>(d.copies.size());
        const bool is_lost = loop.is_lost(i, window_end);
        d.copies.push_back({w.origins[i], loop.take_trace(i).history, is_lost});
    }
    d.last_overwritten.resize(w.own.size());
    keep_own(d, w, [&](std::uint32_t k, std::uint32_t i) {
        const Origin& origin = w.origins[i];
        const EventLoop::Trace trace = loop.take_trace(i);
        d.last_overwritten[k] = trace.last_overwritten;
        domains_[origin.domain].outcomes[origin.index] = {trace.history, self};
        const NextEvent& next = loop.records()[i].next;
        const std::uint32_t copy = next.local == kNowhere ? kNowhere : copy_of[next.local];
        // The partner's place may be another ball's where the partner has left the region.
        if (copy != kNowhere && loop.id(next.local) == next.partner)
            d.partners_of_copies.push_back({k, copy});
    });
    for (Meeting& m : d.meetings) m.copy = copy_of[m.copy];
    for (const Visit& v : d.visits)
        if (!d.region.is_deep_inside(v.cell, halo_))
            d.visits_near_border.push_back({w.origins[v.ball], fold_periodic(bodies_.grid, v.cell)});
}

/// The visits of a domain's own balls, for another one whose halo has been widened.
std::vector<OwnVisit> WindowedEngine::all_visits(const DomainState& d) const {
    std::vector<Origin> origins(d.end.places_end());
    for (std::size_t k = 0; k < d.end.places.size(); ++k) origins[d.end.places[k]] = d.end.origins[k];
    std::vector<OwnVisit> all;
    all.reserve(d.visits.size());
    for (const Visit& v : d.visits) all.push_back({origins[v.ball], fold_periodic(bodies_.grid, v.cell)});
    return all;
}

/// What a domain knows of the foreign balls that could have met its own: those that it has not followed as
/// they went at their owners, and what it has had to do with the others.
void WindowedEngine::compare(DomainState& d) const {
    empty(d.unseen, d.sums);
    if (d.failed || is_active(Fault::kUnlikeCopies)) return;
    // A cell that the domain has touched, of a ball that it has not followed.
    const auto see = [this, &d](const Origin& ball, const CellCoordinates& cell) {
        d.unseen.push_back({domains_[ball.domain].outcomes[ball.index].owner, cell});
    };
    const auto has_touched = [&d](const CellCoordinates& cell) {
        const std::int32_t mark = d.region.mark(d.region.framed(cell));
        return mark >= 0 && d.touched[static_cast<std::size_t>(mark)] != 0;
    };
    std::vector<std::uint8_t> is_right(d.copies.size());
    std::vector<std::vector<std::uint8_t>> followed(domains_.size());  // the same by the balls' origins
    for (std::size_t k = 0; k < d.copies.size(); ++k) {
        const CopyOutcome& copy = d.copies[k];
        const DomainState& holder = domains_[copy.origin.domain];
        is_right[k] = !copy.is_lost && copy.history == holder.outcomes[copy.origin.index].history;
        std::vector<std::uint8_t>& of_holder = followed[copy.origin.domain];
        if (of_holder.empty()) of_holder.resize(holder.outcomes.size());
        of_holder[copy.origin.index] = is_right[k];
        if (is_right[k]) continue;
        if (const CellCoordinates& cell = holder.start.cells[copy.origin.index]; has_touched(cell))
            see(copy.origin, cell);
    }
    for (const DomainState& other : domains_) {
        if (&other == &d || !d.region.meets(other.region)) continue;
        const std::vector<OwnVisit> widely = d.halo > halo_ ? all_visits(other) : std::vector<OwnVisit>{};
        for (const OwnVisit& v : d.halo > halo_ ? widely : other.visits_near_border) {
            if (!has_touched(v.cell)) continue;
            const std::vector<std::uint8_t>& of_holder = followed[v.origin.domain];
            if (of_holder.empty() || of_holder[v.origin.index] == 0) see(v.origin, v.cell);
        }
    }
    for (const Meeting& m : d.meetings) {
        const Origin& ball = d.copies[m.copy].origin;
        const std::uint32_t owner = domains_[ball.domain].outcomes[ball.index].owner;
        auto sum = std::ranges::find(d.sums, owner, &SumOfMeetings::domain);
        if (sum == d.sums.end()) sum = d.sums.insert(sum, {owner, 0});
        sum->sum += m.mark;
    }
    forget_predictions(d, is_right);
}

/// Next events that the domain may have foretold wrongly are to be looked for anew: with a copy that went
/// astray, or of a ball beside one that it has not followed.
void WindowedEngine::forget_predictions(DomainState& d, const std::vector<std::uint8_t>& is_right) const {
    const auto forget = [&d](std::uint32_t k) {
        NextEvent& next = d.end.records[k].next;
        if (next.time == kUnknown) return;
        next = {.time = kUnknown};
        d.end.unknown.push_back(k);
    };
    for (const PartnerOfCopy& p : d.partners_of_copies)
        if (!is_right[p.copy]) forget(p.ball);
    if (d.unseen.empty() || is_active(Fault::kOldForecasts)) return;
    std::vector<std::uint8_t> is_beside(static_cast<std::size_t>(d.region.mark_count()));
    for (const UnseenVisit& v : d.unseen)
        d.region.for_each_mark_beside(d.region.framed(v.cell), [&is_beside](std::int32_t mark) {
            if (mark >= 0) is_beside[static_cast<std::size_t>(mark)] = 1;
        });
    const auto forget_if_beside = [&](std::uint32_t k) {
        const std::int32_t mark = d.region.mark(d.region.framed(d.end.cells[k]));
        if (mark < 0 || is_beside[static_cast<std::size_t>(mark)]) forget(k);
    };
    const bool some_lie_deep = std::ranges::any_of(d.unseen, [&](const UnseenVisit& v) {
        return d.region.is_deep_inside(d.region.framed(v.cell), halo_ - 1);
    });
    if (some_lie_deep)
        for (std::uint32_t k = 0; k < d.end.cells.size(); ++k) forget_if_beside(k);
    else
        std::ranges::for_each(d.end.near_border, forget_if_beside);
}

/// Whether two cells, folded into the box on periodic axes, are the same or neighbours.
bool WindowedEngine::are_beside(const CellCoordinates& a, const CellCoordinates& b) const {
    const auto is_near = [](const GridAxis& axis, std::int32_t distance) {
        const std::int32_t cells = std::abs(distance);
        return cells <= 1 || (axis.periodic() && cells >= axis.count() - 1);
    };
    return is_near(bodies_.grid.x, a.x - b.x) && is_near(bodies_.grid.y, a.y - b.y);
}

/// Whether a ball that domain d has not followed may have met one of d's that its owner has not followed.
bool WindowedEngine::is_blind(std::uint32_t d, const UnseenVisit& visit) const {
    if (is_active(Fault::kBlindDomains)) return false;
    constexpr std::size_t kMost = 1 << 20;  // pairs worth a look
    const std::vector<UnseenVisit>& theirs = domains_[visit.owner].unseen;
    return domains_[d].unseen.size() * theirs.size() > kMost ||
           std::ranges::any_of(
               theirs, [&](const UnseenVisit& v) { return v.owner == d && are_beside(v.cell, visit.cell); });
}

/// The domains that have to go through the window again, one flag each: those that have failed, and of the
/// others each two that have not had the same collisions with each other, or were blind to one.
std::vector<std::uint8_t> WindowedEngine::disagreeing() const {
    std::vector<std::uint8_t> all(domains_.size());
    for (std::uint32_t d = 0; d < domains_.size(); ++d) {
        if (domains_[d].failed) all[d] = 1;
        const auto compare_with = [&](std::uint32_t other, bool agrees) {
            if (agrees || domains_[d].failed || domains_[other].failed) return;
            all[d] = all[other] = 1;
        };
        for (const SumOfMeetings& mine : domains_[d].sums) {
            const auto& theirs = domains_[mine.domain].sums;
            const auto sum = std::ranges::find(theirs, d, &SumOfMeetings::domain);
            compare_with(mine.domain, sum != theirs.end() && sum->sum == mine.sum);
        }
        for (const UnseenVisit& v : domains_[d].unseen)
            if (v.owner > d) compare_with(v.owner, !is_blind(d, v));  // what is blind is so both ways
    }
    return all;
}

}  // namespace carom
