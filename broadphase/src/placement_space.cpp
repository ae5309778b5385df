// Lays out the region's grids and keeps the discs in them.
#include "placement_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace carom::detail {
namespace {

// On squared distances: gaps are never below 5e-10 of the radii's sum, whatever the way in which a distance
// is rounded.
constexpr double kClearance = 1 + 1e-9;
// On the reach of a search: covers the rounding of cell indices.
constexpr double kReachMargin = 1 + 1e-6;
// A region that ends within this of a periodic side, in units of the period, ends at the side.
constexpr double kSpanTolerance = 1e-12;
constexpr int kMostOctaves =
    200;  // bodies that are smaller or larger share the last grid; a level's number fits 8 bits

int octave_of(double ratio) {
    int exponent = 0;
    const double fraction = std::frexp(ratio, &exponent);
    return std::clamp(fraction == 0.5 ? exponent - 1 : exponent, -kMostOctaves / 2, kMostOctaves / 2);
}

/// Shifts of an axis: one on a line, three on a circle.
std::vector<double> shifts(const Axis& axis, bool wraps_within) {
    if (axis.period == 0 || wraps_within) return {0};
    return {0, -axis.period, axis.period};
}

}  // namespace

Space::Space(const Scene& scene, const std::vector<Ball>& present, const Box& region,
             const std::vector<double>& radii)
    : region_(region), full_radius_(radii) {
    const std::array<Axis, 2> periodic = axes_of(scene);
    for (int axis = 0; axis < 2; ++axis) {
        if (!scene.domain || scene.domain->boundary[axis] == Boundary::kOpen) continue;
        const Box& box = scene.domain->box;  // a region is within it but for rounding
        region_.min[axis] = std::max(region_.min[axis], box.min[axis]);
        region_.max[axis] = std::min(region_.max[axis], box.max[axis]);
        const double period = periodic[axis].period;
        if (period > 0 && width(axis) >= period * (1 - kSpanTolerance)) {
            region_.min[axis] = box.min[axis];
            region_.max[axis] = box.max[axis];
            axes_[axis] = periodic[axis];
        }
    }
    const auto [smallest, largest] = std::minmax_element(radii.begin(), radii.end());
    smallest_radius_ = *smallest;
    largest_radius_ = *largest;
    bodies_.reserve(radii.size());
    double squares = 0;
    for (const double radius : radii) {
        bodies_.push_back({0, 0, radius});
        squares += radius * radius;
    }
    packing_ = std::numbers::pi * squares / (width(0) * width(1));
    add_obstacles(present, periodic);
    add_walls(scene.walls, periodic);
    lay_out_levels();
    clear();
}

void Space::add_obstacles(const std::vector<Ball>& present, const std::array<Axis, 2>& periodic) {
    const std::vector<double> shifts_x = shifts(periodic[0], wraps(0));
    const std::vector<double> shifts_y = shifts(periodic[1], wraps(1));
    const auto misses = [&](int axis, double x, double radius) {
        return !wraps(axis) && (x + radius < region_.min[axis] || x - radius > region_.max[axis]);
    };
    for (const Ball& ball : present) {
        for (const double shift_x : shifts_x) {
            for (const double shift_y : shifts_y) {
                const Vec2 p = wrapped({ball.position.x() + shift_x, ball.position.y() + shift_y});
                if (misses(0, p.x(), ball.radius) || misses(1, p.y(), ball.radius)) continue;
                bodies_.push_back({p.x(), p.y(), ball.radius});
            }
        }
    }
}

void Space::add_walls(const std::vector<Wall>& walls, const std::array<Axis, 2>& periodic) {
    std::vector<Wall> near;
    const Vec2 reach = Vec2::Constant(largest_radius_);
    for (const Wall& wall : walls) {
        for (const double shift_x : shifts(periodic[0], false)) {
            for (const double shift_y : shifts(periodic[1], false)) {
                const Vec2 shift(shift_x, shift_y);
                const Wall image{wall.from + shift, wall.to + shift, 1};
                const Vec2 low = image.from.cwiseMin(image.to) - reach;
                const Vec2 high = image.from.cwiseMax(image.to) + reach;
                if ((low.array() <= region_.max.array()).all() && (high.array() >= region_.min.array()).all())
                    near.push_back(image);
            }
        }
    }
    walls_ = WallTree(std::move(near));
}

void Space::lay_out_levels() {
    std::array<std::size_t, kMostOctaves + 1> size{};
    std::array<double, kMostOctaves + 1> largest{};
    const auto slot = [&](const Body& body) {
        return octave_of(body.radius / largest_radius_) + kMostOctaves / 2;
    };
    for (const Body& body : bodies_) {
        const int k = slot(body);
        ++size[k];
        largest[k] = std::max(largest[k], body.radius);
    }
    std::array<std::uint8_t, kMostOctaves + 1> place{};
    std::size_t cells = 0;
    for (int k = kMostOctaves; k >= 0; --k) {  // large bodies first: they are the likelier to be met
        if (size[k] == 0) continue;
        place[k] = static_cast<std::uint8_t>(levels_.size());
        Level level{.octave = k, .largest_radius = largest[k], .size = size[k], .first_cell = cells};
        const double bodies = static_cast<double>(size[k]);
        const double side = std::max(2 * largest[k], std::sqrt(width(0) * width(1) / (2 * bodies)));
        for (int axis = 0; axis < 2; ++axis) {
            level.count[axis] =
                static_cast<std::int64_t>(std::clamp(std::floor(width(axis) / side), 1.0, 2 * bodies));
            level.inverse[axis] = static_cast<double>(level.count[axis]) / width(axis);
        }
        cells += static_cast<std::size_t>(level.count[0] * level.count[1]);
        levels_.push_back(level);
    }
    level_of_.reserve(bodies_.size());
    for (const Body& body : bodies_) level_of_.push_back(place[slot(body)]);
    head_.resize(cells);
}

void Space::clear() {
    std::fill(head_.begin(), head_.end(), kNone);
    for (std::uint32_t id = count(); id < bodies_.size(); ++id) insert(id, {bodies_[id].x, bodies_[id].y});
}

double Space::low(int axis, double radius) const {
    if (wraps(axis)) return region_.min[axis];
    double x = region_.min[axis] + radius;
    while (x - region_.min[axis] < radius) x = std::nextafter(x, std::numeric_limits<double>::infinity());
    return x;
}

double Space::high(int axis, double radius) const {
    if (wraps(axis)) return region_.max[axis];
    double x = region_.max[axis] - radius;
    while (region_.max[axis] - x < radius) x = std::nextafter(x, -std::numeric_limits<double>::infinity());
    return x;
}

std::int64_t Space::index(const Level& level, int axis, double x) const {
    const double cell = (x - region_.min[axis]) * level.inverse[axis];
    if (!(cell > 0)) return 0;
    if (cell >= static_cast<double>(level.count[axis])) return level.count[axis] - 1;
    return static_cast<std::int64_t>(cell);
}

std::array<std::int64_t, 2> Space::range(const Level& level, int axis, double x, double reach) const {
    const std::int64_t count = level.count[axis];
    const double from = x - reach * kReachMargin;
    const double to = x + reach * kReachMargin;
    if (!wraps(axis)) {
        const std::int64_t first = index(level, axis, from);
        return {first, index(level, axis, to) - first + 1};
    }
    const double first = std::floor((from - region_.min[axis]) * level.inverse[axis]);
    const double last = std::floor((to - region_.min[axis]) * level.inverse[axis]);
    if (last - first + 1 >= static_cast<double>(count)) return {0, count};
    auto cell = static_cast<std::int64_t>(first);
    if (cell < 0) cell += count;
    if (cell >= count) cell -= count;
    return {cell, static_cast<std::int64_t>(last - first) + 1};
}

std::size_t Space::cell_of(const Body& body, std::uint32_t id) const {
    const Level& level = levels_[level_of_[id]];
    return level.first_cell + index(level, 1, body.y) * level.count[0] + index(level, 0, body.x);
}

bool Space::is_clear(const Vec2& p, double radius, std::uint32_t self) const {
    for (int axis = 0; axis < 2; ++axis) {
        if (wraps(axis)) continue;
        if (p[axis] - region_.min[axis] < radius || region_.max[axis] - p[axis] < radius) return false;
    }
    bool clear = true;
    for_each_near(p, radius, [&](std::uint32_t id) {
        if (id == self) return true;
        const Body& other = bodies_[id];
        const double radius_sum = radius + other.radius;
        clear = length_squared<double>(offset(p, other)) >= radius_sum * radius_sum * kClearance;
        return clear;
    });
    if (!clear || walls_.empty()) return clear;
    walls_.for_each_near(p, radius * kReachMargin, [&](std::uint32_t wall) {
        clear = distance_squared_to(walls_.walls()[wall], p) >= radius * radius * kClearance;
        return clear;
    });
    return clear;
}

void Space::fetch(const Vec2& low, const Vec2& high) const {
    for (const Level& level : levels_) {
        const std::int64_t left = index(level, 0, low.x());
        const std::int64_t right = index(level, 0, high.x());
        const std::int64_t top = index(level, 1, high.y());
        for (std::int64_t row = index(level, 1, low.y()); row <= top; ++row) {
            const std::uint32_t* heads = &head_[level.first_cell + row * level.count[0]];
            for (std::int64_t column = left; column <= right; ++column)
                if (heads[column] != kNone) __builtin_prefetch(&bodies_[heads[column]]);
        }
    }
}

void Space::insert(std::uint32_t id, const Vec2& p) {
    Body& body = bodies_[id];
    body.x = p.x();
    body.y = p.y();
    std::uint32_t& head = head_[cell_of(body, id)];
    body.next = head;
    head = id;
}

void Space::remove(std::uint32_t id) {
    std::uint32_t* link = &head_[cell_of(bodies_[id], id)];
    while (*link != id) link = &bodies_[*link].next;
    *link = bodies_[id].next;
}

void Space::move(std::uint32_t id, const Vec2& p) {
    Body& body = bodies_[id];
    const Body moved{p.x(), p.y(), body.radius};
    if (cell_of(body, id) == cell_of(moved, id)) {
        body.x = p.x();
        body.y = p.y();
        return;
    }
    remove(id);
    insert(id, p);
}

void Space::set_scale(double scale) {
    scale_ = scale;
    for (std::uint32_t id = 0; id < count(); ++id) bodies_[id].radius = scale * full_radius_[id];
}

std::vector<std::uint32_t> Space::order_by_place() const {
    // A counting sort by the finest grid's cells.
    const Level& finest = levels_.back();
    std::vector<std::uint32_t> cell(count());
    std::vector<std::uint32_t> next(static_cast<std::size_t>(finest.count[0] * finest.count[1]) + 1, 0);
    for (std::uint32_t id = 0; id < count(); ++id) {
        const Body& body = bodies_[id];
        cell[id] =
            static_cast<std::uint32_t>(index(finest, 1, body.y) * finest.count[0] + index(finest, 0, body.x));
        ++next[cell[id] + 1];
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<std::uint32_t> order(count());
    for (std::uint32_t id = 0; id < count(); ++id) order[next[cell[id]]++] = id;
    return order;
}

void Space::sort_by_place() {
    const std::vector<std::uint32_t> order = order_by_place();
    const std::vector<Body> bodies(bodies_.begin(), bodies_.begin() + count());
    const std::vector<double> radii = full_radius_;
    const std::vector<std::uint8_t> levels(level_of_.begin(), level_of_.begin() + count());
    for (std::uint32_t id = 0; id < count(); ++id) {
        bodies_[id] = bodies[order[id]];
        full_radius_[id] = radii[order[id]];
        level_of_[id] = levels[order[id]];
    }
    clear();
    for (std::uint32_t id = 0; id < count(); ++id) insert(id, {bodies_[id].x, bodies_[id].y});
}

}  // namespace carom::detail
