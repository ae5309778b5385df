// Cutting the plane in domains.
#include <algorithm>

#include "windowed_engine.hpp"

namespace carom {

/// Cuts a rectangle of cells that holds the records into `parts` domains with about as many balls each, at
/// right angles to the longer side of what is occupied.
void WindowedEngine::split(const std::vector<BallRecord>& records, const std::vector<BallExtra>& extras,
                           Span x, Span y, int parts) {
    std::vector<BallInCell> balls;
    balls.reserve(records.size());
    for (const BallRecord& r : records)
        balls.push_back(
            {fold_periodic(bodies_.grid, r.anchor.cell), static_cast<std::uint32_t>(balls.size())});
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

/// Calls make_domain(balls, x, y) for each part. Only cells and numbers are sorted, for the records are
/// large; within a part they keep their order.
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
        std::vector<std::size_t> counts(static_cast<std::size_t>(occupied.size()), 0);
        if (counts.size() < 2 || counts.size() > 64 * balls.size() + 1024) continue;
        for (const BallInCell& b : balls) ++counts[static_cast<std::size_t>(b.cell.*axis - occupied.first)];
        const double share = double(balls.size()) * left_parts / parts;
        std::int32_t cut_at = occupied.first + 1;
        std::size_t before = counts[0];
        while (cut_at < occupied.last - 1 &&
               double(before) + double(counts[static_cast<std::size_t>(cut_at - occupied.first)]) / 2 < share)
            before += counts[static_cast<std::size_t>(cut_at++ - occupied.first)];

        std::vector<BallInCell> beyond;
        beyond.reserve(balls.size() - before);
        auto kept = balls.begin();
        for (const BallInCell& b : balls) {
            if (b.cell.*axis < cut_at)
                *kept++ = b;
            else
                beyond.push_back(b);
        }
        std::ranges::copy(beyond, kept);
        beyond = {};
        Span& side = across ? x : y;
        const Span lower{side.first, cut_at};
        const Span upper{cut_at, side.last};
        side = lower;
        cut(balls.first(before), x, y, left_parts, make_domain);
        side = upper;
        cut(balls.subspan(before), x, y, parts - left_parts, make_domain);
        return;
    }
    make_domain(balls, x, y);
}

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
    since_split_ = 0;
}

/// Where the balls of one of domain d's rosters are.
void WindowedEngine::index(const DomainState& d, Roster& roster) const {
    Index index(*this, d, roster);
    for (std::uint32_t k = 0; k < roster.records.size(); ++k) index.add(k, roster.records[k]);
}

}  // namespace carom
