// One domain through a window: what it is sent, what it does, and whether that agrees with its neighbours.
#include <algorithm>
#include <stdexcept>

#include "fault.hpp"
#include "windowed_engine.hpp"

namespace carom {
namespace {

// So many cells of a halo are simulated to the window's end; the domain's own balls come there.
constexpr std::int32_t kKept = 6;
// A window aims at a few collisions a ball; more than so many, and it was too long by far.
constexpr std::uint64_t kMostCollisionsOfBall = 32;

}  // namespace

/// Appends to a message what a domain holds for the region of another one: plain data, all that the receiver
/// needs.
void WindowedEngine::pack(std::uint32_t from, const Region& region, std::int32_t halo,
                          std::vector<BallMessage>& message) const {
    const DomainState& source = domains_[from];
    if (!region.x.meets(source.cells_x) || !region.y.meets(source.cells_y)) return;
    const auto pack_one = [&](std::uint32_t k) {
        const CellCoordinates& c = source.cells[k];
        if (!region.x.covers(c.x) || !region.y.covers(c.y)) return;
        BallMessage& ball = message.emplace_back();
        ball.record = source.records[k];
        if (!source.extras.empty()) ball.extra = source.extras[k];
        ball.origin = {from, k};
        ball.depth = region.depth(region.framed(c));
    };
    if (halo <= halo_)
        std::ranges::for_each(source.near_border, pack_one);
    else
        for (std::uint32_t k = 0; k < source.records.size(); ++k) pack_one(k);
}

/// Adds what domain `self` holds and stays with it; the message gets what has left it for the halo.
void WindowedEngine::add_residents(std::uint32_t self, const Region& region, Workshop& w) const {
    const DomainState& d = domains_[self];
    w.residents.assign(d.records.size(), kNowhere);
    const BallExtra none;
    for (std::uint32_t k = 0; k < d.records.size(); ++k) {
        const CellCoordinates& c = d.cells[k];
        const BallExtra& extra = d.extras.empty() ? none : d.extras[k];
        const std::int32_t depth = region.depth(region.framed(c));
        if (depth == 0) {
            w.residents[k] = w.loop->size();
            w.loop->add(d.records[k], &extra, true);
            w.origins.push_back({self, k});
        } else if (region.x.covers(c.x) && region.y.covers(c.y)) {
            w.message.push_back({d.records[k], extra, {self, k}, depth});
        }
    }
    // Partners that stayed as well are told apart by where they were, and need not be looked for.
    for (std::uint32_t k = 0; k < d.records.size(); ++k) {
        const std::uint32_t partner = d.records[k].next.local;
        if (w.residents[k] != kNowhere && partner < w.residents.size() && w.residents[partner] != kNowhere)
            w.loop->suggest_partner(w.residents[k], w.residents[partner]);
    }
}

/// Fills a loop from a message: first balls that are the domain's own, then copies of the others. With
/// `ends_early` a copy is given up the sooner the deeper in the halo it starts: what it does later cannot
/// reach the domain before the window ends.
void WindowedEngine::unpack(const std::vector<BallMessage>& message, std::int32_t halo,
                            const Time& window_end, bool ends_early, Workshop& w) const {
    const Clock& clock = bodies_.physics.clock;
    std::vector<Time> ends;  // of copies, by depth
    const double length = clock.difference(window_end, window_start_);
    for (std::int32_t depth = 0; depth <= halo; ++depth) {
        const double share =
            depth <= kKept ? 1.0 : double(halo - depth + 1) / double(std::max(1, halo - kKept + 1));
        ends.push_back(share < 1 && ends_early ? clock.after(window_start_, share * length) : kNever);
    }
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

/// Fills a loop for a region, that of domain `self` or the whole plane where that is none.
void WindowedEngine::load(Workshop& w, std::size_t self, const Region& region, std::int32_t halo,
                          const Time& window_end, bool ends_early) const {
    w.message.clear();
    w.origins.clear();
    w.loop->clear(region, window_start_);
    for (std::uint32_t d = 0; d < domains_.size(); ++d) {
        if (d == self)
            add_residents(d, region, w);
        else
            pack(d, region, self == kAll ? kEverything : halo, w.message);
    }
    unpack(w.message, halo, window_end, ends_early, w);
}

void WindowedEngine::run(DomainState& d, const Stop& window_end) {
    const Lease lease(*this);
    Workshop& w = *lease;
    w.loop->keeps_window = w.loop->keeps_anchors = true;
    w.loop->is_patient = false;  // all balls together will tell
    d.region = {bodies_.grid, d.x, d.y, d.halo};
    load(w, static_cast<std::size_t>(&d - domains_.data()), d.region, d.halo, window_end.time, true);
    w.loop->room = w.loop->room_for(kMostCollisionsOfBall);
    w.loop->start();
    try {
        w.loop->advance_to(window_end.time, window_end.is_whole);
        d.failed = w.loop->has_failed() || w.loop->is_full();
    } catch (const std::runtime_error&) {
        d.failed = true;  // perhaps only because a copy went astray: all balls together will tell
    }
    d.is_full = w.loop->is_full();
    keep_outcome(d, w, window_end.time);
}

void WindowedEngine::keep_outcome(DomainState& d, Workshop& w, const Time& window_end) {
    EventLoop& loop = *w.loop;
    d.clear_outcome();
    std::swap(d.overwritten, loop.overwritten);
    std::swap(d.notes, loop.notes);
    std::swap(d.collisions, loop.collisions);
    std::swap(d.touched, loop.touched);
    d.events = loop.events;
    d.copied_collisions =
        loop.collisions_of_all - std::min<std::uint64_t>(loop.collisions_of_all, d.notes.size());
    d.results.assign(loop.records().begin(), loop.records().begin() + w.own);
    index_results(d);
    for (std::uint32_t i = 0; i < w.own; ++i) {
        if (bodies_.needs_extras()) d.result_extras.push_back(loop.extra(i));
        d.last_overwritten.push_back(loop.last_overwritten(i));
        domains_[w.origins[i].domain].histories[w.origins[i].index] = loop.history(i);
    }
    d.copies.reserve(loop.size() - w.own);
    for (std::uint32_t i = w.own; i < loop.size(); ++i) {
        const CellCoordinates c = domains_[w.origins[i].domain].cells[w.origins[i].index];
        d.copies.push_back(
            {w.origins[i], loop.history(i), d.region.mark(d.region.framed(c)), loop.is_lost(i, window_end)});
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
    if (is_active(Fault::kUnlikeCopies)) return true;
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
            const std::int32_t mark = d.region.mark(d.region.framed(v.cell));
            if (mark < 0 || !d.touched[static_cast<std::size_t>(mark)]) continue;
            const auto copy = std::ranges::lower_bound(d.copies, v.origin, {}, &CopyOutcome::origin);
            if (copy == d.copies.end() || copy->origin != v.origin ||
                !is_right[static_cast<std::size_t>(copy - d.copies.begin())])
                return false;
        }
    }
    return true;
}

}  // namespace carom
