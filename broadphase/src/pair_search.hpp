// All pairs of near balls, whatever the ratio of radii and the extent: a grid for every octave of radii, its
// cells in a hash table.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::detail {

/// One axis of the plane: a circle of the given period, or a line (period 0).
struct Axis {
    double min = 0;
    double period = 0;

    [[nodiscard]] double wrapped(double x) const {
        if (period == 0 || (x > min && x - min < period)) return x;  // as what follows gives, undivided
        const double turned = x - period * std::floor((x - min) / period);
        return turned - min < period ? turned : min;  // a hair below min rounds up to max
    }
    /// The difference of two wrapped coordinates, by the shorter way round.
    [[nodiscard]] double nearest(double difference) const {
        const double half = period / 2;
        if (difference > half) return difference - period;
        return difference < -half ? difference + period : difference;
    }
};

/// The axes of a scene's domain.
[[nodiscard]] std::array<Axis, 2> axes_of(const Scene& scene);

/// The balls as they were when this was made.
class PairSearch {
 public:
    struct Disc {
        double x;
        double y;
        double radius;
        std::uint32_t id;
        bool is_static;
    };

    PairSearch(const std::vector<Ball>& balls, const Scene& scene);

    [[nodiscard]] const std::array<Axis, 2>& axes() const { return axes_; }
    /// The offset from b to a by the shorter way round.
    [[nodiscard]] Vec2 offset(const Disc& a, const Disc& b) const {
        Vec2 plain(a.x - b.x, a.y - b.y);
        if (axes_[0].period > 0) plain.x() = axes_[0].nearest(plain.x());
        if (axes_[1].period > 0) plain.y() = axes_[1].nearest(plain.y());
        return plain;
    }

    /// For each pair (a, b) whose surfaces may be near, and both of which are not static, calls visit(a, b)
    /// once: no pair that overlaps is left out. The pairs of one a with the balls of one cell come in the
    /// order of b.id; visit returns whether to go on with them.
    template <class Visit>
    void for_each_pair(Visit&& visit) const {
        for (std::size_t fine = 0; fine < levels_.size(); ++fine)
            for (const Disc& a : levels_[fine].discs)
                for (std::size_t coarse = fine; coarse < levels_.size(); ++coarse)
                    visit_around(a, levels_[coarse], coarse == fine, visit);
    }

 private:
    /// Cells of one side for all balls of an octave: the diameters are at most the side and more than about
    /// half. The balls are sorted by bucket and, in it, by id.
    struct Level {
        int exponent = 0;
        std::array<double, 2> inverse{};          // cells a length
        std::array<std::int64_t, 2> count{};      // cells of a periodic axis; 0 on a line
        std::array<std::int64_t, 2> first{};      // lowest cell in use
        std::array<std::int64_t, 2> extent{};     // cells from the lowest to the highest in use
        bool hashed = false;                      // several cells may share a bucket
        std::uint64_t mask = 0;                   // of the hash
        std::vector<std::uint32_t> bucket_begin;  // one more than buckets
        std::vector<Disc> discs;
    };
    using Cell = std::array<std::int64_t, 2>;

    [[nodiscard]] std::int64_t cell_index(const Level& level, int axis, double x) const;
    [[nodiscard]] Cell cell_of(const Level& level, const Disc& disc) const {
        return {cell_index(level, 0, disc.x), cell_index(level, 1, disc.y)};
    }
    /// None where no ball can be: beyond the cells in use.
    [[nodiscard]] static std::int64_t bucket_of(const Level& level, const Cell& cell);
    /// The distinct cells at most one from `index` along an axis; returns how many.
    static int neighbours(const Level& level, int axis, std::int64_t index, std::array<std::int64_t, 3>& out);
    void lay_out(Level& level, int exponent);
    void sort(Level& level);

    template <class Visit>
    void visit_around(const Disc& a, const Level& level, bool same_level, Visit& visit) const {
        std::array<std::int64_t, 3> columns;
        std::array<std::int64_t, 3> rows;
        const Cell centre = cell_of(level, a);
        const int column_count = neighbours(level, 0, centre[0], columns);
        const int row_count = neighbours(level, 1, centre[1], rows);
        for (int row = 0; row < row_count; ++row)
            for (int column = 0; column < column_count; ++column)
                visit_cell(a, level, same_level, {columns[column], rows[row]}, visit);
    }

    template <class Visit>
    void visit_cell(const Disc& a, const Level& level, bool same_level, const Cell& cell,
                    Visit& visit) const {
        const std::int64_t bucket = bucket_of(level, cell);
        if (bucket < 0) return;
        const auto first = level.discs.begin() + level.bucket_begin[bucket];
        const auto last = level.discs.begin() + level.bucket_begin[bucket + 1];
        // Of the same level each pair is met once. In a crowd the search for the first partner must not pass
        // all the others.
        auto disc = first;
        if (same_level && last - first > 16)
            disc = std::upper_bound(first, last, a.id,
                                    [](std::uint32_t id, const Disc& d) { return id < d.id; });
        for (; disc != last; ++disc) {
            const Disc& b = *disc;
            if (same_level && b.id <= a.id) continue;
            if (a.is_static && b.is_static) continue;
            if (level.hashed && cell_of(level, b) != cell) continue;
            if (!visit(a, b)) return;
        }
    }

    std::array<Axis, 2> axes_;
    std::vector<Level> levels_;  // from fine to coarse, none empty
};

}  // namespace carom::detail
