// What a step missed: bodies whose ways met by the exact time of impact, that ended the step apart and were
// not resolved in it. Nothing is changed by the count.
//
// Of two balls the one that travelled further looks for the other, around its whole way and as far again as
// it went itself; so steps in which balls go far cost much, slow ones two to three cells each way.
#include <algorithm>
#include <cmath>

#include <carom/core/disc_time.hpp>

#include "empirical_engine.hpp"

namespace carom {
namespace {

constexpr std::size_t kSlotsOfPart = 1024;

/// How far a coordinate goes to either side of where it ends.
void extend(double x, double v, double a, double duration, double end, double& low, double& high) {
    const auto include = [&](double place) {
        low = std::min(low, place - end);
        high = std::max(high, place - end);
    };
    include(x);
    include(coordinate_at(x, v, a, duration));
    if (a != 0)
        if (const double turn = -v / a; turn > 0 && turn < duration) include(coordinate_at(x, v, a, turn));
}

}  // namespace

EmpiricalEngine::Way EmpiricalEngine::way_of(std::uint32_t slot) const {
    Way way;
    const auto add = [&way](const Leg& leg) {
        if (way.count < way.legs.size()) way.legs[way.count++] = leg;
    };
    add({start_of(slot), x_[slot], y_[slot], vx_[slot], vy_[slot], kNowhere});
    if (is_touched(slot))
        for (std::uint32_t l = touched_[touched_index_[slot]].previous; l != kNowhere; l = legs_[l].previous)
            add(legs_[l]);
    std::reverse(way.legs.begin(), way.legs.begin() + static_cast<std::ptrdiff_t>(way.count));
    return way;
}

/// The greatest distance along an axis between the end and another place of a ball's way; `low` and `high`
/// are the box of the way, as seen from the end in the box of the domain.
double EmpiricalEngine::travel_of(std::uint32_t slot, Vec2& low, Vec2& high) const {
    low = high = Vec2::Zero();
    const Way way = way_of(slot);
    const Vec2 a = acceleration_of(slot);
    const Vec2 end = wrapped_end(slot) + offset_of(turns_of(slot));
    for (std::size_t n = 0; n < way.count; ++n) {
        const Leg& leg = way.legs[n];
        const double duration = (n + 1 < way.count ? way.legs[n + 1].start : duration_) - leg.start;
        extend(leg.x, leg.vx, a.x(), duration, end.x(), low.x(), high.x());
        extend(leg.y, leg.vy, a.y(), duration, end.y(), low.y(), high.y());
    }
    const Grid& grid = bodies_.grid;
    const Vec2 most = {within_periods(grid.x, high.x() - low.x()),
                       within_periods(grid.y, high.y() - low.y())};
    low = low.cwiseMax(-most);
    high = high.cwiseMin(most);
    const double travel = std::max(-low.minCoeff(), high.maxCoeff());
    low += wrapped_end(slot);
    high += wrapped_end(slot);
    return travel;
}

void EmpiricalEngine::count_missed() {
    std::ranges::sort(resolved_);
    executor_.for_ranges(size(), kSlotsOfPart, [this](std::size_t first, std::size_t last) {
        Vec2 low;
        Vec2 high;
        for (std::size_t i = first; i < last; ++i)
            travel_[i] = travel_of(static_cast<std::uint32_t>(i), low, high);
    });
    for_parts(size(), kSlotsOfPart, [this](Part& part, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) count_missed_of(static_cast<std::uint32_t>(i), part);
    });
    std::uint64_t missed = counts_.missed_collisions.value_or(0);
    for (std::size_t p = 0; p < (size() + kSlotsOfPart - 1) / kSlotsOfPart; ++p) missed += parts_[p].missed;
    counts_.missed_collisions = missed;
}

void EmpiricalEngine::count_missed_of(std::uint32_t slot, Part& part) const {
    Vec2 low;
    Vec2 high;
    const double travel = travel_of(slot, low, high);
    const double radius = radius_of(slot);
    const Grid& grid = bodies_.grid;
    const auto consider = [&](std::uint32_t j, const Image& shift) {
        const double reach = radius + radius_of(j) + travel + travel_[j];
        const Vec2 d = wrapped_end(slot) - wrapped_end(j) - offset_of(shift);
        if (std::abs(d.x()) > reach || std::abs(d.y()) > reach) return;
        if (misses(pair_of(slot, j, shift + turns_of(slot) - turns_of(j)))) ++part.missed;
    };
    const auto is_mine = [&](std::uint32_t j) {
        return travel_[j] < travel || (travel_[j] == travel && id_[j] < id_[slot]);
    };
    const bool is_large = !is_large_.empty() && is_large_[slot] != 0;
    if (!is_large) {
        const double reach = (radius + bodies_.largest_listed_radius + travel) * (1 + kCellMargin);
        const Vec2 beside = {within_periods(grid.x, reach), within_periods(grid.y, reach)};
        grid_.for_each_in(low - beside, high + beside, [&](const EmpiricalGrid::Near& c) {
            const Image shift = {c.shift_x, c.shift_y};
            for (std::uint32_t k = grid_.first(c.cell); k < grid_.first(c.cell + 1); ++k)
                if (const std::uint32_t j = grid_.numbers()[k]; !is_touched(j) && is_mine(j))
                    consider(j, shift);
            for (std::uint32_t t = first_touched_[static_cast<std::size_t>(c.cell)]; t != kNowhere;
                 t = touched_[t].next_in_cell)
                if (is_mine(touched_[t].slot)) consider(touched_[t].slot, shift);
        });
    }
    for (const std::uint32_t j : large_)
        if (!is_large || id_[j] < id_[slot])
            for_each_image(wrapped_end(slot) - wrapped_end(j), radius + radius_of(j) + travel + travel_[j],
                           [&](const Image& shift) { consider(j, shift); });
    count_missed_obstacles(slot, low, high, part);
}

void EmpiricalEngine::count_missed_obstacles(std::uint32_t slot, const Vec2& low, const Vec2& high,
                                             Part& part) const {
    collect_obstacles(slot, low, high, part.obstacles);
    for (Pair& pair : part.obstacles) {
        pair.image = pair.image + turns_of(slot);
        if (misses(pair)) ++part.missed;
    }
    // Who flies straight and ends inside a side has not met it.
    if (!is_touched(slot) && acceleration_of(slot).isZero(0)) return;
    const Domain& domain = bodies_.physics.domain;
    const double radius = radius_of(slot);
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        if (domain.boundary[axis] != Boundary::kWall) continue;
        const std::uint32_t lower = bodies_.first_side() + 2 * axis;
        if (low[axis] < domain.box.min[axis] + radius && misses({slot, kNowhere, lower, {}})) ++part.missed;
        if (high[axis] > domain.box.max[axis] - radius && misses({slot, kNowhere, lower + 1, {}}))
            ++part.missed;
    }
}

bool EmpiricalEngine::is_resolved(std::uint32_t slot, std::uint32_t partner) const {
    return is_touched(slot) && std::ranges::binary_search(resolved_, std::pair(std::min(id_[slot], partner),
                                                                               std::max(id_[slot], partner)));
}

/// For two balls with one leg and one acceleration: whether they came nearest within the step, and met there.
bool EmpiricalEngine::meet_straight(const Pair& pair) const {
    const Vec2 v = Vec2(vx_[pair.slot], vy_[pair.slot]) - Vec2(vx_[pair.other], vy_[pair.other]);
    const Vec2 r =
        Vec2(x_[pair.slot], y_[pair.slot]) - Vec2(x_[pair.other], y_[pair.other]) - offset_of(pair.image);
    if (!(dot(r, v) < 0) || !(dot<double>(r + duration_ * v, v) > 0)) return false;
    return disc_time_of_impact<double>(r, v, radius_of(pair.slot) + radius_of(pair.other)) <= duration_;
}

/// The exact time of impact of two motions from now on; infinity where there is none.
double EmpiricalEngine::impact_time(const Pair& pair, const Motion<double>& a,
                                    const Motion<double>& b) const {
    const double radius = radius_of(pair.slot);
    if (pair.other != kNowhere || pair.partner < bodies_.count) {
        const bool moves = pair.other != kNowhere;
        const Vec2 r =
            a.position - (moves ? b.position : bodies_.fixed[pair.partner]) - offset_of(pair.image);
        const double sum = radius + (moves ? radius_of(pair.other) : bodies_.radius.of(pair.partner));
        return disc_time_of_impact<double>(r, a.velocity - b.velocity, a.acceleration - b.acceleration, sum);
    }
    if (pair.partner < bodies_.first_side()) {
        Motion<double> centre = a;
        centre.position -= offset_of(pair.image);
        return wall_time_of_impact(centre, radius, bodies_.walls[pair.partner - bodies_.count]).time;
    }
    const Touch now = touch(pair, a.position, a.position);
    return side_time_of_impact(now.gap, dot(now.line, a.velocity), dot(now.line, a.acceleration));
}

bool EmpiricalEngine::misses(const Pair& pair) const {
    const bool moves = pair.other != kNowhere;
    if (moves && acceleration_.empty() && !is_touched(pair.slot) && !is_touched(pair.other)) {
        if (!meet_straight(pair)) return false;
    }
    const Vec2 end = wrapped_end(pair.slot) + offset_of(turns_of(pair.slot));
    const Vec2 other = moves ? Vec2(wrapped_end(pair.other) + offset_of(turns_of(pair.other))) : Vec2(0, 0);
    const double gap = touch(pair, end, other).gap;
    // No place of a way is further from its end than travel along either axis.
    const double reach = 1.5 * (travel_[pair.slot] + (moves ? travel_[pair.other] : 0));
    // Who ends it in contact, to rounding, is met in the next step.
    if (gap <= steps_.tolerance || gap > reach || is_resolved(pair.slot, pair.partner)) return false;
    const Way a = way_of(pair.slot);
    const Way b = moves ? way_of(pair.other) : Way{{}, 1};
    for (std::size_t i = 0, j = 0; i < a.count && j < b.count;) {
        const double start = std::max(a.legs[i].start, b.legs[j].start);
        const double a_ends = i + 1 < a.count ? a.legs[i + 1].start : duration_;
        const double b_ends = j + 1 < b.count ? b.legs[j + 1].start : duration_;
        const double stop = std::min(a_ends, b_ends);
        const auto motion = [start](const Leg& leg, const Vec2& acceleration) -> Motion<double> {
            const Motion<double> m{{leg.x, leg.y}, {leg.vx, leg.vy}, acceleration};
            return {position_at(m, start - leg.start), velocity_at(m, start - leg.start), acceleration};
        };
        const Motion<double> ma = motion(a.legs[i], acceleration_of(pair.slot));
        const Motion<double> mb = moves ? motion(b.legs[j], acceleration_of(pair.other)) : Motion<double>{};
        if (impact_time(pair, ma, mb) <= stop - start) return true;
        if (a_ends <= stop) ++i;
        if (b_ends <= stop) ++j;
    }
    return false;
}

}  // namespace carom
