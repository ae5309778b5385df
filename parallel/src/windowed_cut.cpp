// Cutting the plane in domains.
#include <algorithm>

#include "windowed_engine.hpp"

namespace carom {

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
    d.results = std::move(records);
    d.result_extras = std::move(extras);
    index_results(d);
    take_results(d);
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

void WindowedEngine::index_results(DomainState& d) const {
    d.result_cells.clear();
    d.result_cells.reserve(d.results.size());
    for (const BallRecord& r : d.results)
        d.result_cells.push_back(fold_periodic(bodies_.grid, r.anchor.cell));
}

/// The results become the records.
void WindowedEngine::take_results(DomainState& d) const {
    std::swap(d.records, d.results);
    std::swap(d.extras, d.result_extras);
    std::swap(d.cells, d.result_cells);
    d.cells_x = d.cells_y = {GridAxis::kFarthest, -GridAxis::kFarthest};
    d.near_border.clear();
    const auto is_near = [this](const Span& own, std::int32_t k) {
        return k < own.first + halo_ || k >= own.last - halo_;
    };
    for (std::uint32_t k = 0; k < d.cells.size(); ++k) {
        const CellCoordinates& c = d.cells[k];
        if (is_near(d.x, c.x) || is_near(d.y, c.y)) d.near_border.push_back(k);
        d.cells_x = {std::min(d.cells_x.first, c.x), std::max(d.cells_x.last, c.x + 1)};
        d.cells_y = {std::min(d.cells_y.first, c.y), std::max(d.cells_y.last, c.y + 1)};
    }
    d.histories.assign(d.records.size(), 0);
}

}  // namespace carom
