// The part of the plane that one domain simulates: the cells of its own and a halo around them.
#pragma once

#include <algorithm>
#include <cstdint>

#include <carom/broadphase/grid.hpp>

namespace carom {

/// Cells [first, last) along one axis.
struct Span {
    std::int32_t first = 0;
    std::int32_t last = 0;
    [[nodiscard]] std::int64_t size() const { return std::int64_t{last} - first; }
    [[nodiscard]] bool contains(std::int32_t k) const { return k >= first && k < last; }
    friend bool operator==(const Span&, const Span&) = default;
};

/// One axis of a region: the domain's own cells with a halo, or the whole axis where that is no less.
///
/// Cells are stored at places [0, size()). On a periodic axis a cell's coordinate is first moved by whole
/// periods into the region's frame; on any other axis a domain at the edge reaches out as far as balls fly,
/// and coordinates fold into the places as they do in the whole grid.
class RegionAxis {
 public:
    RegionAxis() = default;
    friend bool operator==(const RegionAxis&, const RegionAxis&) = default;
    RegionAxis(const GridAxis& axis, Span own, std::int32_t halo) : own_(own), count_(axis.count()) {
        constexpr std::int32_t kFarthest = GridAxis::kFarthest;
        if (axis.periodic()) {
            is_window_ = own.size() + 2 * std::int64_t{halo} < count_;
            reach_ = is_window_ ? Span{own.first - halo, own.last + halo} : Span{0, count_};
            size_ = static_cast<std::int32_t>(reach_.size());
            periodic_ = true;
            start_ = folded(reach_.first, count_);
            mark_base_ = is_window_ ? reach_.first : 0;
            mark_size_ = size_;
        } else {
            reach_ = {own.first <= -kFarthest ? -kFarthest : own.first - halo,
                      own.last >= kFarthest ? kFarthest : own.last + halo};
            const std::int32_t low = std::max(reach_.first, 0);
            // Two at least, so that a ball that comes to the next cell comes to another place.
            size_ = std::max(2, std::min(reach_.last, count_) - low);
            base_ = low;
            mark_base_ = own.first <= -kFarthest ? std::min(0, own.last - 1) : reach_.first;
            mark_size_ = (own.last >= kFarthest ? std::max(count_, own.first + 1) : reach_.last) - mark_base_;
        }
    }

    [[nodiscard]] std::int32_t size() const { return size_; }
    [[nodiscard]] const Span& own() const { return own_; }
    /// Whether it is all of a periodic axis, so that its ends meet.
    [[nodiscard]] bool is_whole_period() const { return periodic_ && !is_window_; }
    /// The middle of what is stored, in the region's frame.
    [[nodiscard]] double middle() const { return (is_window_ ? reach_.first : base_) + size_ / 2.0; }

    /// What to add to a ball's cell coordinate `k` to have it in the region's frame.
    [[nodiscard]] std::int32_t frame_of(std::int32_t k) const {
        if (!periodic_) return 0;
        return is_window_ ? reach_.first + folded(k - reach_.first, count_) - k : folded(k, count_) - k;
    }
    /// The same for a ball whose anchor has been wrapped by so many cells. Where the axis is whole every
    /// frame will do, and the box's own keeps the ball near, however often it goes round.
    [[nodiscard]] std::int32_t frame_after(std::int32_t frame, std::int32_t wrapped) const {
        return is_whole_period() ? 0 : frame + wrapped;
    }
    /// Whether a coordinate in the region's frame lies in it.
    [[nodiscard]] bool contains(std::int32_t k) const {
        return (periodic_ && !is_window_) || reach_.contains(k);
    }
    /// Marks tell all cells of the region apart, but that those far out at an edge of the plane, all the
    /// domain's own, share one: [0, mark_count()).
    [[nodiscard]] std::int32_t mark_count() const { return mark_size_ + 2; }
    [[nodiscard]] std::int32_t mark(std::int32_t k) const {
        if (periodic_) return place(k) + 1;
        return std::clamp(k - mark_base_, -1, mark_size_) + 1;
    }
    /// A coordinate in the region's frame that mark `m` stands for.
    [[nodiscard]] std::int32_t marked(std::int32_t m) const { return m - 1 + mark_base_; }
    /// How many cells a coordinate in the region's frame is beyond the domain's own, 0 inside.
    [[nodiscard]] std::int32_t depth(std::int32_t k) const {
        if (periodic_ && !is_window_) {
            const std::int32_t in = folded(k - own_.first, count_);
            const auto width = static_cast<std::int32_t>(own_.size());
            return in < width ? 0 : std::min(in - width + 1, count_ - in);
        }
        return k < own_.first ? own_.first - k : (k >= own_.last ? k - own_.last + 1 : 0);
    }
    /// Whether one of the cells [first, last) of the axis may lie in the region, in any image.
    [[nodiscard]] bool meets(Span cells) const {
        if (cells.size() <= 0) return false;
        if (!periodic_) return cells.first < reach_.last && cells.last > reach_.first;
        const std::int32_t in = folded(cells.first - reach_.first, count_);
        return in < size_ || in + cells.size() > count_;
    }
    [[nodiscard]] bool meets(const RegionAxis& other) const {
        if (!periodic_) return meets(other.reach_);
        return !is_window_ || !other.is_window_ ||
               meets(Span{folded(other.reach_.first, count_),
                          folded(other.reach_.first, count_) + other.size_});
    }
    /// Whether a coordinate in the region's frame is among the domain's own and `distance` cells from others.
    [[nodiscard]] bool is_deep_inside(std::int32_t k, std::int32_t distance) const {
        if (periodic_ && own_.size() >= count_) return true;
        return k >= own_.first + distance && k < own_.last - distance;  // no overflow far out
    }
    /// The place of a coordinate in the region's frame; -1 outside.
    [[nodiscard]] std::int32_t place(std::int32_t k) const {
        if (is_window_) {
            const std::int32_t in = k - reach_.first;
            return static_cast<std::uint32_t>(in) < static_cast<std::uint32_t>(size_) ? in : -1;
        }
        if (!contains(k)) return -1;
        const std::int32_t in = k - base_;
        return static_cast<std::uint32_t>(in) < static_cast<std::uint32_t>(size_) ? in : folded(in, size_);
    }

    /// Whether the region has a cell whose coordinate is folded into the box already.
    [[nodiscard]] bool covers(std::int32_t k) const {
        if (!is_window_) return periodic_ || reach_.contains(k);
        const std::int32_t in = k - start_;
        return (in < 0 ? in + count_ : in) < size_;
    }

    [[nodiscard]] static std::int32_t folded(std::int32_t k, std::int32_t count) {
        if (static_cast<std::uint32_t>(k) < static_cast<std::uint32_t>(count)) return k;
        if (k < 0 && k >= -count) return k + count;
        const std::int32_t rest = k % count;
        return rest < 0 ? rest + count : rest;
    }

 private:
    Span own_;
    Span reach_;
    std::int32_t count_ = 1;  // cells of the whole axis
    std::int32_t size_ = 1;
    std::int32_t base_ = 0;
    std::int32_t start_ = 0;  // of `reach_`, folded
    std::int32_t mark_base_ = 0;
    std::int32_t mark_size_ = 1;
    bool periodic_ = false;
    bool is_window_ = false;  // periodic, and not the whole axis
};

struct Region {
    RegionAxis x;
    RegionAxis y;

    Region() = default;
    friend bool operator==(const Region&, const Region&) = default;
    Region(const Grid& grid, Span own_x, Span own_y, std::int32_t halo)
        : x(grid.x, own_x, halo), y(grid.y, own_y, halo) {}

    [[nodiscard]] std::int32_t size() const { return x.size() * y.size(); }
    /// The place of a cell in the region's frame; -1 outside.
    [[nodiscard]] std::int32_t place(const CellCoordinates& c) const {
        const std::int32_t px = x.place(c.x);
        const std::int32_t py = y.place(c.y);
        return (px | py) < 0 ? -1 : py * x.size() + px;
    }
    [[nodiscard]] std::int32_t mark_count() const { return x.mark_count() * y.mark_count(); }
    /// The mark of a cell in the region's frame; -1 outside.
    [[nodiscard]] std::int32_t mark(const CellCoordinates& c) const {
        return x.contains(c.x) && y.contains(c.y) ? y.mark(c.y) * x.mark_count() + x.mark(c.x) : -1;
    }
    /// Calls f(mark) for the cell, in the region's frame, and those beside it.
    template <class F>
    void for_each_mark_beside(const CellCoordinates& c, F&& f) const {
        for (std::int32_t row = c.y - 1; row <= c.y + 1; ++row)
            for (std::int32_t column = c.x - 1; column <= c.x + 1; ++column) f(mark({column, row}));
    }
    [[nodiscard]] bool meets(const Region& other) const { return x.meets(other.x) && y.meets(other.y); }
    [[nodiscard]] std::int32_t depth(const CellCoordinates& c) const {
        return std::max(x.depth(c.x), y.depth(c.y));
    }
    /// Whether a cell in the region's frame is among the domain's own and `distance` cells from others.
    [[nodiscard]] bool is_deep_inside(const CellCoordinates& c, std::int32_t distance) const {
        return x.is_deep_inside(c.x, distance) && y.is_deep_inside(c.y, distance);
    }
    /// What to add to a ball's cell to have it in the region's frame.
    [[nodiscard]] CellCoordinates frame_of(const CellCoordinates& c) const {
        return {x.frame_of(c.x), y.frame_of(c.y)};
    }
    /// A ball's cell in the region's frame.
    [[nodiscard]] CellCoordinates framed(const CellCoordinates& c) const {
        return {c.x + x.frame_of(c.x), c.y + y.frame_of(c.y)};
    }
};

/// The whole axis: all that a ball can reach.
[[nodiscard]] inline Span whole(const GridAxis& axis) {
    if (axis.periodic()) return {0, axis.count()};
    return {-GridAxis::kFarthest, GridAxis::kFarthest};
}

/// A cell with its coordinates on periodic axes folded into the box.
[[nodiscard]] inline CellCoordinates fold_periodic(const Grid& grid, const CellCoordinates& c) {
    return {grid.x.periodic() ? grid.x.fold(c.x) : c.x, grid.y.periodic() ? grid.y.fold(c.y) : c.y};
}

}  // namespace carom
