// Cutting the plane in domains.
#include <algorithm>
#include <tuple>
#include <utility>

#include "windowed_engine.hpp"

namespace carom {
namespace {

// What a window costs for each ball that it keeps, whatever the ball does, is one: some 0.1 us.
constexpr double kLoadOfEvent = 5;
// For each ball, of filling the domains' loops anew, and of cutting the plane, for which all wait.
constexpr double kLoadOfFilling = 2;
constexpr double kLoadOfCutting = 1;
// Loads are those of so many windows, the more of late the more. Cells are too coarse to even out less than
// this.
constexpr double kWindowsOfLoad = 64;
constexpr double kUnevenLoad = 1.04;
// Where a thread has many domains, one may have so many times the mean of balls before the plane is cut anew.
constexpr double kUneven = 1.5;
constexpr int kWindowsBetweenCuts = 16;

}  // namespace

/// Cuts a rectangle of cells that holds the records into `parts` domains with about as many balls each.
void WindowedEngine::split(const std::vector<BallRecord>& records, const std::vector<BallExtra>& extras,
                           Span x, Span y, int parts) {
    std::vector<BallInCell> balls;
    balls.reserve(records.size());
    for (const BallRecord& r : records)
        balls.push_back(
            {fold_periodic(bodies_.grid, r.anchor.cell), static_cast<std::uint32_t>(balls.size()), 1});
    cut(balls, x, y, parts, [&](std::span<const BallInCell> own, Span own_x, Span own_y) {
        DomainState& d = domains_.emplace_back();
        d.x = own_x;
        d.y = own_y;
        d.start.records.reserve(own.size());
        for (const BallInCell& ball : own) d.start.records.push_back(records[ball.record]);
        if (!extras.empty())
            for (const BallInCell& ball : own) d.start.extras.push_back(extras[ball.record]);
        index(d, d.start);
        d.outcomes.resize(own.size());
    });
}

/// Cuts a rectangle of cells into parts of about the same load, at right angles to the longer side of what is
/// occupied, and calls make_domain(balls, x, y) for each. Only cells and numbers are sorted, for the records
/// are large; within a part they keep their order.
void WindowedEngine::cut(std::span<BallInCell> balls, Span x, Span y, int parts,
                         const MakeDomain& make_domain) const {
    const auto extent = [&balls](std::int32_t CellCoordinates::* axis) {
        const auto [low, high] =
            std::ranges::minmax(balls, {}, [axis](const BallInCell& b) { return b.cell.*axis; });
        return Span{low.cell.*axis, high.cell.*axis + 1};
    };
    const int left_parts = parts / 2;
    for (int attempt = 0; parts > 1 && !balls.empty() && attempt < 2; ++attempt) {
        const Span extent_x = extent(&CellCoordinates::x);
        const Span extent_y = extent(&CellCoordinates::y);
        const bool across = (extent_x.size() >= extent_y.size()) == (attempt == 0);
        const auto axis = across ? &CellCoordinates::x : &CellCoordinates::y;
        const Span occupied = across ? extent_x : extent_y;
        const auto cells = static_cast<std::size_t>(occupied.size());
        if (cells < 2 || cells > 64 * balls.size() + 1024) continue;
        std::vector<double> loads(cells, 0);
        double all = 0;
        for (const BallInCell& b : balls) {
            loads[static_cast<std::size_t>(b.cell.*axis - occupied.first)] += b.load;
            all += b.load;
        }
        const double share = all * left_parts / parts;
        std::int32_t cut_at = occupied.first + 1;
        double before = loads[0];
        while (cut_at < occupied.last - 1 &&
               before + loads[static_cast<std::size_t>(cut_at - occupied.first)] / 2 < share)
            before += loads[static_cast<std::size_t>(cut_at++ - occupied.first)];

        std::vector<BallInCell> beyond;
        auto kept = balls.begin();
        for (const BallInCell& b : balls) {
            if (b.cell.*axis < cut_at)
                *kept++ = b;
            else
                beyond.push_back(b);
        }
        std::ranges::copy(beyond, kept);
        beyond = {};
        const auto count = static_cast<std::size_t>(kept - balls.begin());
        Span& side = across ? x : y;
        const Span lower{side.first, cut_at};
        const Span upper{cut_at, side.last};
        side = lower;
        cut(balls.first(count), x, y, left_parts, make_domain);
        side = upper;
        cut(balls.subspan(count), x, y, parts - left_parts, make_domain);
        return;
    }
    make_domain(balls, x, y);
}

/// Whether each domain went through the last window on its own, with balls that can be told from others.
bool WindowedEngine::knows_loads() const {
    return std::ranges::all_of(
        domains_, [](const DomainState& d) { return d.start.origins.size() == d.start.records.size(); });
}

/// Adds what the domains had to do in a window.
void WindowedEngine::weigh_window() {
    ++since_cut_;
    if (!knows_loads()) return;
    for (DomainState& d : domains_) {
        d.load *= 1 - 1 / kWindowsOfLoad;
        d.load += double(d.start.records.size()) + kLoadOfEvent * double(d.events);
    }
}

/// Whether it is worth while to cut the plane anew, a window having ended. Where each thread has one domain
/// all wait for the busiest one, and what that has cost of late pays for another one. Where a
/// thread has many they even out; then the balls count, which a domain's tables must hold.
bool WindowedEngine::is_uneven() const {
    double most = 0;
    double all = 0;
    for (const DomainState& d : domains_) {
        const double share = loops_stay_ ? d.load : double(d.start.records.size());
        most = std::max(most, share);
        all += share;
    }
    const auto domains = double(domains_.size());
    if (!loops_stay_) return since_cut_ >= kWindowsBetweenCuts && most * domains > kUneven * all;
    const double price = (kLoadOfFilling + kLoadOfCutting * domains) * double(bodies_.moving);
    return knows_loads() && most * domains > kUnevenLoad * all && most * domains - all > patience_ * price;
}

/// What each ball, in the order of domains and of their rosters when a window has ended, counts where the
/// plane is cut: one, or where each thread has one domain what it has cost in the window, its collisions and
/// its share of the domain's other events.
std::vector<float> WindowedEngine::loads() const {
    std::vector<float> loads;
    loads.reserve(bodies_.moving);
    for (const DomainState& d : domains_) {
        const std::size_t first = loads.size();
        loads.resize(first + d.start.records.size(), 1);
        if (!loops_stay_) continue;
        double others = double(d.events);
        for (std::size_t k = 0; k < d.start.records.size(); ++k) {
            const Origin& origin = d.start.origins[k];
            // What the window has started from lies where the next one will end.
            const Anchor& before = domains_[origin.domain].end.records[origin.index].anchor;
            const double collisions =
                double(d.start.records[k].anchor.stamp - before.stamp) / 2;  // of two balls
            loads[first + k] += static_cast<float>(kLoadOfEvent * collisions);
            others -= collisions;
        }
        const double each = std::max(0.0, others) / double(std::max<std::size_t>(1, d.start.records.size()));
        for (std::size_t k = first; k < loads.size(); ++k)
            loads[k] += static_cast<float>(kLoadOfEvent * each);
    }
    return loads;
}

/// Cuts the plane in domains of about the same load, those of the records at a window's start. Who has
/// another rectangle of cells than before is sent its balls when it fills.
void WindowedEngine::cut_anew() {
    const std::vector<float> loads = this->loads();
    std::vector<BallInCell> balls;
    balls.reserve(loads.size());
    for (const DomainState& d : domains_)
        for (const CellCoordinates& cell : d.start.cells)
            balls.push_back({cell, static_cast<std::uint32_t>(balls.size()), loads[balls.size()]});
    std::vector<std::pair<Span, Span>> parts;
    cut(balls, whole(bodies_.grid.x), whole(bodies_.grid.y), wanted_domains_,
        [&parts](std::span<const BallInCell>, Span x, Span y) { parts.emplace_back(x, y); });
    since_cut_ = 0;
    patience_ = 2 * patience_;  // in vain where the cells are too coarse for more
    if (parts.size() != domains_.size()) return split_anew();
    for (std::size_t k = 0; k < parts.size(); ++k) {
        DomainState& d = domains_[k];
        d.load = 0;
        if (std::pair(d.x, d.y) == parts[k]) continue;
        std::tie(d.x, d.y) = parts[k];
        index(d, d.start);
        patience_ = 1;
    }
}

/// The same with as many domains as can be, each of which begins with its own balls.
void WindowedEngine::split_anew() {
    std::vector<BallRecord> records;
    std::vector<BallExtra> extras;
    records.reserve(bodies_.moving);
    for (DomainState& d : domains_) {
        records.insert(records.end(), d.start.records.begin(), d.start.records.end());
        extras.insert(extras.end(), d.start.extras.begin(), d.start.extras.end());
        d.start = {};
    }
    domains_.clear();
    split(records, extras, whole(bodies_.grid.x), whole(bodies_.grid.y), wanted_domains_);
}

/// Where the balls of one of domain d's rosters are.
void WindowedEngine::index(const DomainState& d, Roster& roster) const {
    Index index(*this, d, roster);
    for (std::uint32_t k = 0; k < roster.records.size(); ++k) index.add(k, roster.records[k]);
}

}  // namespace carom
