// Random sequential adsorption (Feder 1980), with discs of different sizes from the largest down.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "placement_methods.hpp"

namespace carom::detail {
namespace {

// Equal discs never pass a packing of 0.547. Places that are known to be taken are seldom tried.
constexpr std::uint64_t kTriesPerDisc = 64;
constexpr std::uint64_t kMostFruitlessTries = 20000;
// Cells of the map below: at most so many a disc, and no finer than this share of the smallest radius.
constexpr double kCellsPerDisc = 53;
constexpr double kCellOfRadius = 0.35;
// A tile of the map: what lies around it stays in the cache.
constexpr std::size_t kWordsOfTile = 4;
constexpr std::size_t kRowsOfTile = 256;
// A round aims at this share of the discs that are missing, or at more than all of the last few.
constexpr double kShareOfRound = 0.8;
constexpr std::size_t kFewDiscs = 2048;
constexpr double kShareOfFew = 4;
constexpr double kFewestTries = 1024;
constexpr double kLeastRate = 1e-6;
// Cells are listed where at most one in so many is open; fewer tries of a tile are not worth to fetch it for.
constexpr std::size_t kMostlyCovered = 4;
constexpr std::size_t kTriesWorthFetching = 128;

/// Words of some rows of the map below.
struct Tile {
    std::size_t first_word, last_word;
    std::size_t first_row, last_row;
};

struct MapCell {
    std::uint32_t column, row;
};

/// A bit for every cell of a fine grid over the places that the smallest disc's centre may take: set where it
/// would overlap a body, wherever in the cell. The other cells are open.
class CoverMap {
 public:
    explicit CoverMap(const Space& space) : space_(space), radius_(space.smallest_scaled_radius()) {
        const double most = kCellsPerDisc * space.count();
        const double side =
            std::max(kCellOfRadius * radius_, std::sqrt(space.width(0) * space.width(1) / most));
        for (int axis = 0; axis < 2; ++axis) {
            low_[axis] = space.low(axis, radius_);
            high_[axis] = space.high(axis, radius_);
            const double width = high_[axis] - low_[axis];
            const double cells = std::clamp(std::floor(width / side), 1.0, most);
            count_[axis] = static_cast<std::size_t>(cells);
            side_[axis] = width / cells;
            inverse_[axis] = width > 0 ? cells / width : 0;
        }
        words_ = (count_[0] + 63) / 64;
        bits_.assign(words_ * count_[1], 0);
        for (std::size_t row = 0; row < count_[1]; ++row) set(row, count_[0], 64 * words_);
    }

    [[nodiscard]] Tile whole() const { return {0, words_, 0, count_[1]}; }
    [[nodiscard]] std::vector<Tile> tiles() const {
        std::vector<Tile> tiles;
        for (std::size_t row = 0; row < count_[1]; row += kRowsOfTile)
            for (std::size_t word = 0; word < words_; word += kWordsOfTile)
                tiles.push_back({word, std::min(word + kWordsOfTile, words_), row,
                                 std::min(row + kRowsOfTile, count_[1])});
        return tiles;
    }
    [[nodiscard]] static MapCell first_cell(const Tile& tile) {
        return {static_cast<std::uint32_t>(64 * tile.first_word), static_cast<std::uint32_t>(tile.first_row)};
    }
    [[nodiscard]] MapCell last_cell(const Tile& tile) const {
        return {static_cast<std::uint32_t>(std::min(64 * tile.last_word, count_[0]) - 1),
                static_cast<std::uint32_t>(tile.last_row - 1)};
    }
    [[nodiscard]] std::size_t cells(const Tile& tile) const {
        return (std::min(64 * tile.last_word, count_[0]) - 64 * tile.first_word) *
               (tile.last_row - tile.first_row);
    }
    [[nodiscard]] std::size_t open_cells(const Tile& tile) const {
        std::size_t open = 0;
        for_each_word(tile, [&](std::size_t row, std::size_t word) {
            open += static_cast<std::size_t>(std::popcount(~word_at(row, word)));
        });
        return open;
    }
    /// The open cells of a tile.
    void list_open(const Tile& tile, std::vector<MapCell>& cells) const {
        cells.clear();
        for_each_word(tile, [&](std::size_t row, std::size_t word) {
            for (std::uint64_t open = ~word_at(row, word); open != 0; open &= open - 1)
                cells.push_back({static_cast<std::uint32_t>(64 * word) +
                                     static_cast<std::uint32_t>(std::countr_zero(open)),
                                 static_cast<std::uint32_t>(row)});
        });
    }
    [[nodiscard]] bool is_open(const MapCell& cell) const {
        return (word_at(cell.row, cell.column / 64) >> (cell.column % 64) & 1) == 0;
    }
    /// The place at these shares, in [0, 1), of the sides of a cell.
    [[nodiscard]] Vec2 place(const MapCell& cell, double share_x, double share_y) const {
        const auto along = [this](int axis, std::uint32_t index, double share) {
            return std::min(low_[axis] + (index + share) * side_[axis], high_[axis]);
        };
        return space_.wrapped({along(0, cell.column, share_x), along(1, cell.row, share_y)});
    }

    /// Asks for the memory of a tile and of the bodies around, ahead of its use.
    void fetch(const Tile& tile) const {
        for (std::size_t row = tile.first_row; row < tile.last_row; ++row)
            __builtin_prefetch(&word_at(row, tile.first_word), 1);
        space_.fetch(place(first_cell(tile), 0, 0), place(last_cell(tile), 0, 0));
    }

    void add(const Space::Body& body) {
        // Cells are taken a hair larger than they are: a centre on a cell's edge may be counted in either.
        const double reach = (body.radius + radius_) * (1 - 1e-6);
        const double x = body.x - low_[0];
        const double y = body.y - low_[1];
        const auto [first, last] = whole_cells(1, y, reach);
        if (last - first >= signed_count(1)) return;  // as wide as the region: not worth the care
        for (std::int64_t row = first; row < last; ++row) {
            const double below = std::abs(static_cast<double>(row) * side_[1] - y);
            const double above = std::abs(static_cast<double>(row + 1) * side_[1] - y);
            const double away = std::max(below, above);
            const auto [left, right] =
                whole_cells(0, x, std::sqrt(std::max(0.0, reach * reach - away * away)));
            if (left >= right || right - left >= signed_count(0)) continue;
            const std::int64_t count = signed_count(0);
            const auto in_row = static_cast<std::size_t>(turned(row, signed_count(1)));
            if (left < 0) set(in_row, static_cast<std::size_t>(left + count), count_[0]);
            if (right > count) set(in_row, 0, static_cast<std::size_t>(right - count));
            set(in_row, static_cast<std::size_t>(std::max(left, std::int64_t{0})),
                static_cast<std::size_t>(std::min(right, count)));
        }
    }

 private:
    [[nodiscard]] const std::uint64_t& word_at(std::size_t row, std::size_t word) const {
        return bits_[row * words_ + word];
    }
    [[nodiscard]] std::int64_t signed_count(int axis) const {
        return static_cast<std::int64_t>(count_[axis]);
    }
    [[nodiscard]] static std::int64_t turned(std::int64_t k, std::int64_t n) {
        return k < 0 ? k + n : k >= n ? k - n : k;
    }

    /// The cells that lie within x - reach and x + reach: the first, and the one after the last.
    [[nodiscard]] std::array<std::int64_t, 2> whole_cells(int axis, double x, double reach) const {
        double first = std::ceil((x - reach) * inverse_[axis]);
        double last = std::floor((x + reach) * inverse_[axis]);
        if (!space_.wraps(axis)) {
            first = std::max(first, 0.0);
            last = std::min(last, static_cast<double>(count_[axis]));
        }
        if (!(last > first)) return {0, 0};
        return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
    }

    /// Covers the cells of a row from the first to before the last.
    void set(std::size_t row, std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; k = (k / 64 + 1) * 64) {
            const std::uint64_t to_the_end = ~std::uint64_t{0} << (k % 64);
            const std::size_t beyond = (k / 64 + 1) * 64;
            bits_[row * words_ + k / 64] |=
                beyond <= last ? to_the_end : to_the_end & ~(~std::uint64_t{0} << (last % 64));
        }
    }

    template <class Visit>
    void for_each_word(const Tile& tile, Visit&& visit) const {
        for (std::size_t row = tile.first_row; row < tile.last_row; ++row)
            for (std::size_t word = tile.first_word; word < tile.last_word; ++word) visit(row, word);
    }

    const Space& space_;
    double radius_;
    std::array<double, 2> low_{}, high_{};
    std::array<double, 2> side_{};
    std::array<double, 2> inverse_{};
    std::array<std::size_t, 2> count_{};
    std::size_t words_ = 0;  // of a row; bits beyond its cells are set
    std::vector<std::uint64_t> bits_;
};

/// Rounds of tries at uniformly random places that are not known to be covered. Where discs are many and
/// alike, those of a round go from tile to tile, so that the bodies around them are in the cache; within a
/// tile their order is random. Such a round does not find room for all discs that are missing, so that it
/// does not end before its last tile: the outcome is that of a random order, but for tries within reach of
/// each other across a tile's edge. Discs that differ must not: the first tiles would get the largest.
class Adsorption {
 public:
    Adsorption(Space& space, Random& random)
        : space_(space),
          random_(random),
          map_(space),
          order_(largest_first(space)),
          left_(kTriesPerDisc * space.count() + kMostFruitlessTries) {
        for (std::uint32_t id = space.count(); id < space.body_count(); ++id) map_.add(space.body(id));
    }

    /// Until all discs have a place or it is time to give up; gives those without.
    std::vector<std::uint32_t> run() {
        const std::vector<Tile> all{map_.whole()};
        const bool are_alike = space_.smallest_radius() == space_.largest_radius();
        const std::vector<Tile> tiles = are_alike ? map_.tiles() : all;
        double rate = 1;  // of success, in open cells
        std::uint64_t fruitless = 0;
        while (goes_on() && fruitless < kMostFruitlessTries) {
            const std::size_t missing = order_.size() - done_;
            const bool few = missing < kFewDiscs;
            const double wanted = (few ? kShareOfFew : kShareOfRound) * static_cast<double>(missing) / rate;
            const std::uint64_t before = left_;
            rate = round(few ? all : tiles, std::max(wanted, kFewestTries));
            fruitless = missing > order_.size() - done_ ? 0 : fruitless + (before - left_);
        }
        return {order_.begin() + static_cast<std::ptrdiff_t>(done_), order_.end()};
    }

 private:
    /// Two shares in [0, 1).
    std::array<double, 2> shares() {
        const auto [x, y] = random_.symmetric_pair();
        return {(x + 1) / 2, (y + 1) / 2};
    }
    [[nodiscard]] bool goes_on() const { return done_ < order_.size() && left_ > 0; }
    void put(const Vec2& p) {
        const std::uint32_t id = order_[done_];
        if (!space_.is_clear(p, space_.body(id).radius)) return;
        space_.insert(id, p);
        map_.add(space_.body(id));
        ++done_;
    }

    /// Tries until so many went to cells that are open; gives how many of these found room.
    double round(const std::vector<Tile>& tiles, double wanted) {
        std::vector<std::size_t> open;
        open.reserve(tiles.size());
        for (const Tile& tile : tiles) open.push_back(map_.open_cells(tile));
        const std::size_t cells = map_.cells(map_.whole());
        const std::size_t all_open = std::accumulate(open.begin(), open.end(), std::size_t{0});
        if (all_open == 0) {
            left_ = 0;
            return kLeastRate;
        }
        // Where few cells are open they are listed and one of them is taken; else any cell.
        const bool lists = kMostlyCovered * all_open < cells;
        std::vector<std::size_t> end;  // of the cells that may be taken, tile after tile
        end.reserve(tiles.size());
        for (std::size_t k = 0; k < tiles.size(); ++k)
            end.push_back((k == 0 ? 0 : end.back()) + (lists ? open[k] : map_.cells(tiles[k])));
        const double tries = wanted * double(end.back()) / double(all_open);
        const std::vector<std::size_t> share =
            shares_of_tiles(end, std::min(left_, static_cast<std::uint64_t>(tries)));
        const std::size_t before = done_;
        for (std::size_t k = 0; k < tiles.size() && goes_on(); ++k) {
            if (tiles.size() > 1 && share[k] > kTriesWorthFetching) map_.fetch(tiles[k]);
            if (lists) {
                map_.list_open(tiles[k], listed_);
                try_listed(open[k], share[k]);
            } else {
                try_any(tiles[k], share[k]);
            }
        }
        return std::max(static_cast<double>(done_ - before) / wanted, kLeastRate);
    }

    /// How many of the tries fall to each tile.
    std::vector<std::size_t> shares_of_tiles(const std::vector<std::size_t>& end, std::size_t tries) {
        // The first tile that a k-th of the cells may belong to; mostly it is that one.
        std::vector<std::size_t> guide(16 * end.size());
        const auto cells = static_cast<double>(end.back());
        const auto parts = static_cast<double>(guide.size());
        for (std::size_t k = 0, tile = 0; k < guide.size(); ++k) {
            while (static_cast<double>(end[tile]) * parts <= static_cast<double>(k) * cells) ++tile;
            guide[k] = tile;
        }
        std::vector<std::size_t> share(end.size(), 0);
        for (std::size_t k = 0; k < tries; k += 2) {
            for (const double at : shares()) {
                const auto cell = static_cast<std::size_t>(at * cells);
                std::size_t tile = guide[static_cast<std::size_t>(at * parts)];
                while (end[tile] <= cell) ++tile;
                ++share[tile];
            }
        }
        return share;
    }

    void try_any(const Tile& tile, std::size_t tries) {
        const MapCell first = map_.first_cell(tile);
        const MapCell last = map_.last_cell(tile);
        const double width = last.column - first.column + 1;
        const double height = last.row - first.row + 1;
        for (; tries > 0 && goes_on(); --tries) {
            const auto [share_x, share_y] = shares();
            const double x = share_x * width;
            const double y = share_y * height;
            const auto column = static_cast<std::uint32_t>(x);
            const auto row = static_cast<std::uint32_t>(y);
            const MapCell cell{first.column + column, first.row + row};
            --left_;
            if (map_.is_open(cell)) put(map_.place(cell, x - column, y - row));
        }
    }

    /// Of `cells` that were open when the round began, those listed still are.
    void try_listed(std::size_t cells, std::size_t tries) {
        for (; tries > 0 && goes_on(); --tries) {
            const auto k = static_cast<std::size_t>(random_.uniform() * static_cast<double>(cells));
            --left_;
            if (k >= listed_.size() || !map_.is_open(listed_[k])) continue;
            const auto [x, y] = shares();
            put(map_.place(listed_[k], x, y));
        }
    }

    Space& space_;
    Random& random_;
    CoverMap map_;
    std::vector<std::uint32_t> order_;

    std::size_t done_ = 0;
    std::uint64_t left_;
    std::vector<MapCell> listed_;
};

}  // namespace

std::vector<std::uint32_t> largest_first(const Space& space) {
    std::vector<std::uint32_t> order(space.count());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    if (space.smallest_radius() == space.largest_radius()) return order;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double of_a = space.full_radius(a);
        const double of_b = space.full_radius(b);
        return of_a != of_b ? of_a > of_b : a < b;
    });
    return order;
}

std::vector<std::uint32_t> adsorb(Space& space, Random& random) {
    space.clear();
    return Adsorption(space, random).run();
}

}  // namespace carom::detail
