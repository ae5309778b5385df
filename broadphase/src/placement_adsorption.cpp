// Random sequential adsorption (Feder 1980), with discs of different sizes from the largest down.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "placement_methods.hpp"

namespace carom::detail {
namespace {

// Equal discs need some 40 tries a disc, all in all, to reach a packing of 0.5; they never pass 0.547.
constexpr std::uint64_t kTriesPerDisc = 64;
constexpr std::uint64_t kMostTriesInARow = 20000;
// See Rounds.
constexpr double kDiscsOfTile = 2048;
constexpr std::size_t kDiscsOfLastRound = 1024;
constexpr double kMostTriesOfRound = 0x1p21;
// Cells of the map below: at most so many a disc, and no finer than this share of the smallest radius.
constexpr double kCellsPerDisc = 40;
constexpr double kCellOfRadius = 0.4;

/// A bit for every cell of a fine grid: set where even the smallest disc of the fill would overlap a body,
/// wherever in the cell its centre. Most tries end here, at the price of one bit, long before the place would
/// be searched.
class CoveredCells {
 public:
    explicit CoveredCells(const Space& space)
        : origin_(space.region().min), radius_(space.smallest_scaled_radius()) {
        const double side = std::max(kCellOfRadius * radius_, std::sqrt(space.width(0) * space.width(1) /
                                                                        (kCellsPerDisc * space.count())));
        for (int axis = 0; axis < 2; ++axis) {
            const double most = kCellsPerDisc * space.count();
            const double cells = std::clamp(std::floor(space.width(axis) / side), 1.0, most);
            count_[axis] = static_cast<std::int64_t>(cells);
            side_[axis] = space.width(axis) / cells;
            inverse_[axis] = cells / space.width(axis);
            wraps_[axis] = space.wraps(axis);
        }
        bits_.assign(static_cast<std::size_t>(count_[0] * count_[1]) / 64 + 1, 0);
    }

    [[nodiscard]] bool covers(const Vec2& p) const {
        const auto index = [&](int axis) {
            return std::clamp(static_cast<std::int64_t>((p[axis] - origin_[axis]) * inverse_[axis]),
                              std::int64_t{0}, count_[axis] - 1);
        };
        const auto bit = static_cast<std::size_t>(index(1) * count_[0] + index(0));
        return (bits_[bit / 64] >> (bit % 64) & 1) != 0;
    }

    void add(const Space::Body& body) {
        // Cells are taken a hair larger than they are: a centre on a cell's edge may be counted in either.
        const double reach = (body.radius + radius_) * (1 - 1e-6);
        const double x = body.x - origin_.x();
        const double y = body.y - origin_.y();
        const auto [first, last] = whole_cells(1, y, reach);
        if (last - first >= count_[1]) return;  // as wide as the region: not worth the care
        for (std::int64_t row = first; row < last; ++row) {
            const double below = std::abs(static_cast<double>(row) * side_[1] - y);
            const double above = std::abs(static_cast<double>(row + 1) * side_[1] - y);
            const double away = std::max(below, above);
            const auto [left, right] =
                whole_cells(0, x, std::sqrt(std::max(0.0, reach * reach - away * away)));
            if (right - left >= count_[0]) continue;
            for (std::int64_t column = left; column < right; ++column) set(column, row);
        }
    }

 private:
    /// The cells that lie within x - reach and x + reach: the first, and the one after the last.
    [[nodiscard]] std::array<std::int64_t, 2> whole_cells(int axis, double x, double reach) const {
        double first = std::ceil((x - reach) * inverse_[axis]);
        double last = std::floor((x + reach) * inverse_[axis]);
        if (!wraps_[axis]) {
            first = std::max(first, 0.0);
            last = std::min(last, static_cast<double>(count_[axis]));
        }
        if (!(last > first)) return {0, 0};
        return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
    }

    void set(std::int64_t column, std::int64_t row) {
        const auto turned = [](std::int64_t k, std::int64_t n) { return k < 0 ? k + n : k >= n ? k - n : k; };
        const auto bit =
            static_cast<std::size_t>(turned(row, count_[1]) * count_[0] + turned(column, count_[0]));
        bits_[bit / 64] |= std::uint64_t{1} << (bit % 64);
    }

    Vec2 origin_;
    double radius_;
    std::array<std::int64_t, 2> count_{};
    std::array<double, 2> side_{};
    std::array<double, 2> inverse_{};
    std::array<bool, 2> wraps_{};
    std::vector<std::uint64_t> bits_;
};

/// Rounds of tries at uniformly random places. Those of a round are sorted by tiles of the region, so that
/// the bodies around them are in the cache; within a tile their order stays. A round is so small that about
/// half of the discs still missing find a place in it and it never ends before its last tile: the outcome is
/// that of a random order, but for tries within reach of each other across a tile's edge.
class Rounds {
 public:
    using Share = std::array<double, 2>;  // of the way from the lowest to the highest place

    explicit Rounds(const Space& space) {
        const double side = std::sqrt(space.width(0) * space.width(1) * kDiscsOfTile / space.count());
        for (int axis = 0; axis < 2; ++axis)
            tiles_[axis] = std::clamp(std::floor(space.width(axis) / side), 1.0, 4096.0);
    }

    /// The next round's shares, for a number of missing discs and the rate of success of late.
    const std::vector<Share>& draw(std::size_t missing, double rate, Random& random) {
        const bool last = missing < kDiscsOfLastRound || tiles_[0] * tiles_[1] == 1;
        const double wanted = static_cast<double>(missing) / (2 * rate);
        shares_.resize(last ? kDiscsOfLastRound
                            : static_cast<std::size_t>(std::min(wanted, kMostTriesOfRound)));
        for (Share& share : shares_) share = {random.uniform(), random.uniform()};
        if (!last) sort();
        return shares_;
    }

 private:
    void sort() {  // by counting
        const auto tile = [&](const Share& s) {
            return static_cast<std::size_t>(std::floor(s[1] * tiles_[1]) * tiles_[0] +
                                            std::floor(s[0] * tiles_[0]));
        };
        next_.assign(static_cast<std::size_t>(tiles_[0] * tiles_[1]) + 1, 0);
        for (const Share& share : shares_) ++next_[tile(share) + 1];
        for (std::size_t k = 0; k + 1 < next_.size(); ++k) next_[k + 1] += next_[k];
        sorted_.resize(shares_.size());
        for (const Share& share : shares_) sorted_[next_[tile(share)]++] = share;
        shares_.swap(sorted_);
    }

    std::array<double, 2> tiles_{};
    std::vector<Share> shares_;
    std::vector<Share> sorted_;
    std::vector<std::size_t> next_;
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
    CoveredCells covered(space);
    for (std::uint32_t id = space.count(); id < space.body_count(); ++id) covered.add(space.body(id));
    const std::vector<std::uint32_t> order = largest_first(space);
    Rounds rounds(space);
    double rate = 1;
    std::uint64_t left = kTriesPerDisc * space.count() + kMostTriesInARow;
    std::uint64_t in_a_row = 0;
    std::size_t done = 0;
    double radius = 0;
    std::optional<Places> places;  // of that radius
    while (done < order.size() && left > 0 && in_a_row < kMostTriesInARow) {
        const std::size_t before = done;
        const auto& shares = rounds.draw(order.size() - done, rate, random);
        for (const auto& [share_x, share_y] : shares) {
            if (done == order.size() || left == 0) break;
            const std::uint32_t id = order[done];
            if (space.body(id).radius != radius) {
                radius = space.body(id).radius;
                places.emplace(space, radius);
            }
            const Vec2 p = places->at(share_x, share_y);
            --left;
            ++in_a_row;
            if (covered.covers(p) || !space.is_clear(p, radius)) continue;
            space.insert(id, p);
            covered.add(space.body(id));
            in_a_row = 0;
            ++done;
        }
        rate = std::max(static_cast<double>(done - before) / static_cast<double>(shares.size()), 1e-6);
    }
    return {order.begin() + static_cast<std::ptrdiff_t>(done), order.end()};
}

}  // namespace carom::detail
