// Sorts the balls into octaves of radii and, within each, into cells.
#include "pair_search.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace carom::detail {
namespace {

// Of a periodic axis, a side is larger than the diameters by this factor at least, so that rounding never
// puts near balls two cells apart.
constexpr double kMargin = 1.001;
// Keeps cell indices, and what is added to them, within 64 bits.
constexpr double kFarthestCell = 1e18;
// With more, the rounding of (x - min) * inverse would outgrow the margin.
constexpr double kMostPeriodicCells = 1e9;

std::uint64_t mixed(std::uint64_t x) {  // the finaliser of splitmix64 (Steele, Lea and Flood 2014)
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// The least power of two that is not below the diameter.
int octave(double radius) {
    int exponent = 0;
    return std::frexp(2 * radius, &exponent) == 0.5 ? exponent - 1 : exponent;
}

}  // namespace

std::array<Axis, 2> axes_of(const Scene& scene) {
    std::array<Axis, 2> axes;
    for (int axis = 0; axis < 2; ++axis) {
        if (!scene.domain || scene.domain->boundary[axis] != Boundary::kPeriodic) continue;
        const Box& box = scene.domain->box;
        axes[axis] = {box.min[axis], box.max[axis] - box.min[axis]};
    }
    return axes;
}

PairSearch::PairSearch(const std::vector<Ball>& balls, const Scene& scene) : axes_(axes_of(scene)) {
    constexpr int kLowest = -1100;  // below the exponent of every double
    std::array<std::size_t, 2300> size{};
    for (const Ball& ball : balls) ++size[octave(ball.radius) - kLowest];
    std::array<std::size_t, 2300> place{};
    for (std::size_t k = 0; k < size.size(); ++k) {
        if (size[k] == 0) continue;
        place[k] = levels_.size();
        lay_out(levels_.emplace_back(), static_cast<int>(k) + kLowest);
        levels_.back().discs.reserve(size[k]);
    }
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const Ball& ball = balls[i];
        levels_[place[octave(ball.radius) - kLowest]].discs.push_back(
            {axes_[0].wrapped(ball.position.x()), axes_[1].wrapped(ball.position.y()), ball.radius,
             static_cast<std::uint32_t>(i), ball.is_static});
    }
    for (Level& level : levels_) sort(level);
}

void PairSearch::lay_out(Level& level, int exponent) {
    level.exponent = exponent;
    for (int axis = 0; axis < 2; ++axis) {
        // On a line the side is a power of two and cells start at 0: the index is exact, however far out the
        // ball is.
        level.inverse[axis] = std::ldexp(1.0, -exponent);
        if (axes_[axis].period == 0) continue;
        const double cells = std::clamp(std::floor(axes_[axis].period * level.inverse[axis] / kMargin), 1.0,
                                        kMostPeriodicCells);
        level.count[axis] = static_cast<std::int64_t>(cells);
        level.inverse[axis] = cells / axes_[axis].period;
    }
}

std::int64_t PairSearch::cell_index(const Level& level, int axis, double x) const {
    const double cell = std::floor((x - axes_[axis].min) * level.inverse[axis]);
    if (level.count[axis] > 0) {
        if (!(cell > 0)) return 0;
        return std::min(static_cast<std::int64_t>(std::min(cell, kFarthestCell)), level.count[axis] - 1);
    }
    if (!(cell > -kFarthestCell)) return -static_cast<std::int64_t>(kFarthestCell);
    return static_cast<std::int64_t>(std::min(cell, kFarthestCell));
}

std::int64_t PairSearch::bucket_of(const Level& level, const Cell& cell) {
    const std::int64_t column = cell[0] - level.first[0];
    const std::int64_t row = cell[1] - level.first[1];
    if (column < 0 || row < 0 || column >= level.extent[0] || row >= level.extent[1]) return -1;
    if (!level.hashed) return row * level.extent[0] + column;
    const std::uint64_t hash =
        mixed(static_cast<std::uint64_t>(column) + mixed(static_cast<std::uint64_t>(row)));
    return static_cast<std::int64_t>(hash & level.mask);
}

int PairSearch::neighbours(const Level& level, int axis, std::int64_t index,
                           std::array<std::int64_t, 3>& out) {
    const std::int64_t count = level.count[axis];
    if (count == 1 || count == 2) {
        out = {0, 1, 0};
        return static_cast<int>(count);
    }
    out = {index - 1, index, index + 1};
    if (count > 0 && index == 0) out[0] = count - 1;
    if (count > 0 && index == count - 1) out[2] = 0;
    return 3;
}

void PairSearch::sort(Level& level) {
    std::vector<Disc>& discs = level.discs;
    Cell last;
    level.first.fill(std::numeric_limits<std::int64_t>::max());
    last.fill(std::numeric_limits<std::int64_t>::min());
    for (const Disc& disc : discs) {
        const Cell cell = cell_of(level, disc);
        for (int axis = 0; axis < 2; ++axis) {
            level.first[axis] = std::min(level.first[axis], cell[axis]);
            last[axis] = std::max(last[axis], cell[axis]);
        }
    }
    for (int axis = 0; axis < 2; ++axis) level.extent[axis] = last[axis] - level.first[axis] + 1;
    const std::size_t enough = std::bit_ceil(2 * discs.size());
    const double cells = static_cast<double>(level.extent[0]) * static_cast<double>(level.extent[1]);
    level.hashed = cells > 4 * static_cast<double>(enough);
    level.mask = enough - 1;
    const std::size_t buckets = level.hashed ? enough : static_cast<std::size_t>(cells);

    // A counting sort: stable, so that the ids of a bucket stay in order.
    std::vector<std::uint32_t> bucket(discs.size());
    level.bucket_begin.assign(buckets + 1, 0);
    for (std::size_t k = 0; k < discs.size(); ++k) {
        bucket[k] = static_cast<std::uint32_t>(bucket_of(level, cell_of(level, discs[k])));
        ++level.bucket_begin[bucket[k] + 1];
    }
    for (std::size_t k = 0; k < buckets; ++k) level.bucket_begin[k + 1] += level.bucket_begin[k];
    std::vector<std::uint32_t> next(level.bucket_begin.begin(), level.bucket_begin.end() - 1);
    std::vector<Disc> sorted(discs.size());
    for (std::size_t k = 0; k < discs.size(); ++k) sorted[next[bucket[k]]++] = discs[k];
    discs = std::move(sorted);
}

}  // namespace carom::detail
