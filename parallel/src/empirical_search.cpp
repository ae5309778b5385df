// The contacts of a step: pairs that overlap at its end, traced back to the contact.
#include <algorithm>
#include <cmath>
#include <functional>

#include <carom/core/bisection.hpp>

#include "empirical_engine.hpp"

namespace carom {
namespace {

constexpr std::size_t kCellsOfPart = 1024;

/// What two bodies that overlap at the end of a stretch of time do in it.
struct Contact {
    bool overlaps = false;       ///< at the end
    std::optional<double> time;  ///< of the contact, if they approach there
};

/// The contact within [0, duration], at 0 <= gap <= tolerance, or now where they overlap already; `rate` has
/// the sign of the gap's rate of change. Where they part at first and accelerate back, the contact comes
/// after they have turned.
template <class Gap, class Rate>
Contact trace_back(double duration, double tolerance, Gap&& gap, Rate&& rate) {
    const std::optional<double> free = detail::bisect_contact<double>(duration, tolerance, gap);
    if (!free) return {};
    if (rate(*free) < 0) return {true, free};
    if (!(rate(duration) < 0)) return {true, std::nullopt};
    double parting = *free;
    double turned = duration;
    for (;;) {
        const double middle = parting + (turned - parting) / 2;
        if (!(middle > parting && middle < turned)) break;
        (rate(middle) < 0 ? turned : parting) = middle;
    }
    const double rest = detail::bisect_contact<double>(duration - turned, tolerance, [&](double t) {
                            return gap(turned + t);
                        }).value_or(0);
    if (!(rate(turned + rest) < 0)) return {true, std::nullopt};
    return {true, turned + rest};
}

}  // namespace

Motion<double> EmpiricalEngine::motion_from(std::uint32_t slot, double time) const {
    const Motion<double> m{{x_[slot], y_[slot]}, {vx_[slot], vy_[slot]}, acceleration_of(slot)};
    const double since = time - start_of(slot);
    return {position_at(m, since), velocity_at(m, since), m.acceleration};
}

EmpiricalEngine::Pair EmpiricalEngine::pair_of(std::uint32_t a, std::uint32_t b, const Image& image) const {
    if (id_[b] < id_[a]) return {b, a, id_[a], -image};
    return {a, b, id_[b], image};
}

EmpiricalEngine::Meeting EmpiricalEngine::meeting_of(const Pair& pair, double time) const {
    const std::uint32_t id = id_[pair.slot];
    return {time, std::min(id, pair.partner), std::max(id, pair.partner),
            pair, stamp_of(pair.slot),        stamp_of(pair.other)};
}

/// Centres at one time; `other` is the second ball's, or of no meaning.
EmpiricalEngine::Touch EmpiricalEngine::touch(const Pair& pair, const Vec2& centre, const Vec2& other) const {
    const double radius = radius_of(pair.slot);
    if (pair.other != kNowhere || pair.partner < bodies_.count) {
        const bool moves = pair.other != kNowhere;
        const Vec2 line = centre - (moves ? other : bodies_.fixed[pair.partner]) - offset_of(pair.image);
        const double sum = radius + (moves ? radius_of(pair.other) : bodies_.radius.of(pair.partner));
        return {std::sqrt(length_squared(line)) - sum, line, true};
    }
    if (pair.partner < bodies_.first_side()) {
        const Wall& wall = bodies_.walls[pair.partner - bodies_.count];
        const Vec2 near = centre - offset_of(pair.image);
        const auto [distance, feature] = detail::distance_to_wall<double>(near, wall.from, wall.to);
        return {distance - radius, contact_normal<double>(near, feature, wall.from, wall.to),
                feature != WallFeature::kFace, feature};
    }
    const Side side(pair.partner - bodies_.first_side());
    const Box& box = bodies_.physics.domain.box;
    Vec2 line = Vec2::Zero();
    line[side.axis] = side.upper ? -1 : 1;
    const double inside = side.upper ? (box.max[side.axis] - radius) - centre[side.axis]
                                     : centre[side.axis] - (box.min[side.axis] + radius);
    return {inside, line, false};
}

/// Enters a pair that overlaps at the end of the step.
void EmpiricalEngine::examine(const Pair& pair, Part& part) const {
    const bool moves = pair.other != kNowhere;
    const double from = std::max(start_of(pair.slot), moves ? start_of(pair.other) : 0);
    const Motion<double> a = motion_from(pair.slot, from);
    const Motion<double> b = moves ? motion_from(pair.other, from) : Motion<double>{};
    const auto touch_at = [&](double t) { return touch(pair, position_at(a, t), position_at(b, t)); };
    const Contact contact = trace_back(
        duration_ - from, steps_.tolerance, [&](double t) { return touch_at(t).gap; },
        [&](double t) { return dot<double>(touch_at(t).line, velocity_at(a, t) - velocity_at(b, t)); });
    if (contact.time)
        part.contacts.push_back(meeting_of(pair, from + *contact.time));
    else if (contact.overlaps)
        part.lasting.push_back(meeting_of(pair, duration_));
}

/// A pair that overlapped when the last step ended responds now where it approaches, or parts too slowly.
void EmpiricalEngine::examine_start(const Meeting& lasting, Part& part) const {
    const Pair& pair = lasting.pair;
    const Motion<double> a = motion_from(pair.slot, 0);
    const Motion<double> b = pair.other != kNowhere ? motion_from(pair.other, 0) : Motion<double>{};
    const Touch now = touch(pair, a.position, b.position);
    const double rate = dot<double>(now.line, a.velocity - b.velocity);
    const double least = recovery(now.gap, pair.slot) * std::sqrt(length_squared(now.line));
    if (now.gap < 0 && (rate < 0 || rate < least)) part.contacts.push_back(meeting_of(pair, 0));
}

/// Whether the ends of two balls overlap, the second moved by `shift`.
bool EmpiricalEngine::overlap_at_end(std::uint32_t a, std::uint32_t b, const Vec2& shift) const {
    const double dx = wrapped_x_[a] - wrapped_x_[b] - shift.x();
    const double dy = wrapped_y_[a] - wrapped_y_[b] - shift.y();
    const double sum = radius_of(a) + radius_of(b);
    return dx * dx + dy * dy < sum * sum;
}

/// All contacts, as if there were no responses.
void EmpiricalEngine::search() {
    serial_.contacts.clear();
    serial_.lasting.clear();
    for (const Meeting& m : lasting_) examine_start(m, serial_);
    search_large(serial_);
    contacts_.clear();
    lasting_.clear();
    for_parts(static_cast<std::size_t>(grid_.cell_count()), kCellsOfPart,
              [this](Part& part, std::size_t first, std::size_t last) {
                  for (std::size_t c = first; c < last; ++c) search_cell(static_cast<std::int32_t>(c), part);
              });
    const auto take = [this](const Part& part) {
        contacts_.insert(contacts_.end(), part.contacts.begin(), part.contacts.end());
        lasting_.insert(lasting_.end(), part.lasting.begin(), part.lasting.end());
    };
    take(serial_);
    for (const Part& part : parts_) take(part);
    std::ranges::sort(contacts_, std::less<>());
}

void EmpiricalEngine::search_cell(std::int32_t cell, Part& part) const {
    const std::uint32_t begin = grid_.first(cell);
    const std::uint32_t end = grid_.first(cell + 1);
    if (begin == end) return;
    const auto near = grid_.around(cell);
    const std::span<const double> xs = grid_.xs();
    const std::span<const double> ys = grid_.ys();
    const std::span<const std::uint32_t> slots = grid_.numbers();
    const bool is_one = radius_.empty();
    const double one_sum = is_one ? 2 * bodies_.radius.of(id_[slots[begin]]) : 0;
    constexpr std::size_t kAhead = 5;
    for (std::size_t n = 0; n < kAhead; ++n) {
        const Image shift = {near[n].shift_x, near[n].shift_y};
        const Vec2 moved = offset_of(shift);
        const std::uint32_t first = grid_.first(near[n].cell);
        const std::uint32_t last = grid_.first(near[n].cell + 1);
        for (std::uint32_t k = begin; k < end; ++k) {
            const double x = xs[k] - moved.x();
            const double y = ys[k] - moved.y();
            for (std::uint32_t l = n == 0 ? k + 1 : first; l < last; ++l) {
                const double dx = x - xs[l];
                const double dy = y - ys[l];
                const double sum = is_one ? one_sum : radius_[slots[k]] + radius_[slots[l]];
                if (dx * dx + dy * dy < sum * sum && k != l)
                    examine(pair_of(slots[k], slots[l], shift + turns_of(slots[k]) - turns_of(slots[l])),
                            part);
            }
        }
    }
    for (std::uint32_t k = begin; k < end; ++k) search_obstacles(slots[k], part);
}

/// The balls that are in no cell: against all that lie near, and against each other.
void EmpiricalEngine::search_large(Part& part) const {
    for (std::size_t n = 0; n < large_.size(); ++n) {
        const std::uint32_t i = large_[n];
        const double reach = (radius_of(i) + bodies_.largest_listed_radius) * (1 + kCellMargin);
        const Vec2 margin = Vec2::Constant(reach);
        grid_.for_each_in(
            wrapped_end(i) - margin, wrapped_end(i) + margin, [&](const EmpiricalGrid::Near& c) {
                const Image shift = {c.shift_x, c.shift_y};
                for (std::uint32_t k = grid_.first(c.cell); k < grid_.first(c.cell + 1); ++k)
                    if (const std::uint32_t j = grid_.numbers()[k]; overlap_at_end(i, j, offset_of(shift)))
                        examine(pair_of(i, j, shift + turns_of(i) - turns_of(j)), part);
            });
        for (std::size_t m = n + 1; m < large_.size(); ++m) {
            const std::uint32_t j = large_[m];
            for_each_image(wrapped_end(i) - wrapped_end(j), radius_of(i) + radius_of(j),
                           [&](const Image& shift) {
                               if (overlap_at_end(i, j, offset_of(shift)))
                                   examine(pair_of(i, j, shift + turns_of(i) - turns_of(j)), part);
                           });
        }
        search_obstacles(i, part);
    }
}

void EmpiricalEngine::collect_obstacles(std::uint32_t slot, const Vec2& low, const Vec2& high,
                                        std::vector<Pair>& found) const {
    found.clear();
    const bool is_large = !is_large_.empty() && is_large_[slot] != 0;
    const ObstacleMap& map = is_large ? bodies_.obstacles_of_large : bodies_.obstacles;
    if (map.empty()) return;
    const Grid& grid = bodies_.grid;
    const auto last_of = [](const GridAxis& axis, std::int32_t first, double to) {
        const std::int32_t last = axis.coordinate(to);
        // On an axis without period the fold meets every storage cell once in `count` steps.
        return axis.periodic() ? last : std::min(last, first + axis.count() - 1);
    };
    const CellCoordinates first = grid.coordinates(low);
    const CellCoordinates last = {last_of(grid.x, first.x, high.x()), last_of(grid.y, first.y, high.y())};
    for (std::int32_t y = first.y; y <= last.y; ++y)
        for (std::int32_t x = first.x; x <= last.x; ++x)
            for (const ObstacleEntry& entry : map.at(grid.index({x, y})))
                found.push_back({slot,
                                 kNowhere,
                                 entry.id,
                                 {grid.x.turns(x) + entry.shift_x, grid.y.turns(y) + entry.shift_y}});
    if (first == last) return;
    const auto key = [](const Pair& p) { return std::tuple(p.partner, p.image.x, p.image.y); };
    std::ranges::sort(found, {}, key);
    const auto repeated = std::ranges::unique(found, {}, key);
    found.erase(repeated.begin(), repeated.end());
}

void EmpiricalEngine::search_obstacles(std::uint32_t slot, Part& part) const {
    const Vec2 end = wrapped_end(slot);
    collect_obstacles(slot, end, end, part.obstacles);
    for (Pair& pair : part.obstacles) {
        if (!(touch(pair, end, end).gap < 0)) continue;
        pair.image = pair.image + turns_of(slot);
        examine(pair, part);
    }
    const Domain& domain = bodies_.physics.domain;
    const double radius = radius_of(slot);
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        if (domain.boundary[axis] != Boundary::kWall) continue;
        if (end[axis] < domain.box.min[axis] + radius)
            examine({slot, kNowhere, bodies_.first_side() + 2 * axis, {}}, part);
        if (end[axis] > domain.box.max[axis] - radius)
            examine({slot, kNowhere, bodies_.first_side() + 2 * axis + 1, {}}, part);
    }
}

/// Ball `slot` after a response, against all around its new end.
void EmpiricalEngine::look_around(std::uint32_t slot, Part& part) const {
    const auto consider = [&](std::uint32_t j, const Image& shift) {
        if (j != slot && overlap_at_end(slot, j, offset_of(shift)))
            examine(pair_of(slot, j, shift + turns_of(slot) - turns_of(j)), part);
    };
    const auto visit = [&](const EmpiricalGrid::Near& c) {
        const Image shift = {c.shift_x, c.shift_y};
        for (std::uint32_t k = grid_.first(c.cell); k < grid_.first(c.cell + 1); ++k)
            if (!is_touched(grid_.numbers()[k])) consider(grid_.numbers()[k], shift);
        for (std::uint32_t t = first_touched_[static_cast<std::size_t>(c.cell)]; t != kNowhere;
             t = touched_[t].next_in_cell)
            consider(touched_[t].slot, shift);
    };
    const Vec2 end = wrapped_end(slot);
    if (!is_large_.empty() && is_large_[slot] != 0) {
        const double reach = (radius_of(slot) + bodies_.largest_listed_radius) * (1 + kCellMargin);
        grid_.for_each_in(end - Vec2::Constant(reach), end + Vec2::Constant(reach), visit);
    } else {
        for (const EmpiricalGrid::Near& c : grid_.around(grid_.cell(end.x(), end.y()))) visit(c);
    }
    for (const std::uint32_t j : large_)
        for_each_image(end - wrapped_end(j), radius_of(slot) + radius_of(j),
                       [&](const Image& shift) { consider(j, shift); });
    search_obstacles(slot, part);
}

}  // namespace carom
