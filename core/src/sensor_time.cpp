// A sensor is a union of discs around its corners, strips along its sides and, of a polygon, the inside. Of
// each the stretches are found from the turning points of a distance, and put together.
#include <carom/core/sensor_time.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <carom/core/polynomial.hpp>

namespace carom {
namespace {

using Stretches = std::vector<Stretch>;

constexpr double kForEver = std::numeric_limits<double>::infinity();

/// Of a flight what its search needs: `scale` is a time in which the ball gets noticeably on, from which the
/// search beyond the last turning point starts.
struct Search {
    double horizon;
    double scale;
};

/// The end of [low, high] at which it is no longer `is_inside`, to the last bit.
template <class F>
double bisect(const F& f, bool is_inside, double low, double high) {
    for (;;) {
        const double middle = low + (high - low) / 2;
        if (!(middle > low && middle < high)) return high;
        ((f(middle) < 0) == is_inside ? low : high) = middle;
    }
}

/// Where f < 0. Between the turning points, which rise, and beyond the last one f rises or falls throughout.
template <class F>
Stretches where_negative(const F& f, std::span<const double> turning_points, const Search& search) {
    Stretches found;
    bool is_inside = f(0.0) < 0;
    double entry = 0;
    double low = 0;
    const auto look_until = [&](double high) {
        if ((f(high) < 0) == is_inside) return false;
        const double t = bisect(f, is_inside, low, high);
        if (is_inside)
            found.push_back({entry, t});
        else
            entry = t;
        is_inside = !is_inside;
        return true;
    };
    for (const double t : turning_points) {
        if (low > search.horizon) break;
        look_until(t);
        low = t;
    }
    for (double step = search.scale; low <= search.horizon && std::isfinite(low + step); step *= 2) {
        if (look_until(low + step)) break;
        low += step;
    }
    if (is_inside) found.push_back({entry, kForEver});
    std::erase_if(found, [&](const Stretch& s) { return s.from > search.horizon; });
    return found;
}

/// Where c0 + c1 t + c2 t^2 < 0.
Stretches where_negative(double c0, double c1, double c2, const Search& search) {
    const double turn = -c1 / (2 * c2);
    const bool turns = turn > 0 && std::isfinite(turn);
    return where_negative([=](double t) { return c0 + t * (c1 + t * c2); },
                          std::span<const double>(&turn, turns ? 1 : 0), search);
}

Stretches intersected(const Stretches& a, const Stretches& b) {
    Stretches both;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size(); ++(a[i].to < b[j].to ? i : j)) {
        const Stretch common{std::max(a[i].from, b[j].from), std::min(a[i].to, b[j].to)};
        if (common.from < common.to) both.push_back(common);
    }
    return both;
}

/// Within `reach` of the origin.
Stretches inside_disc(const Motion<double>& m, double reach, const Search& search) {
    // The derivative of half the squared distance.
    const Cubic<double> rate{dot<double>(m.position, m.velocity),
                             dot<double>(m.velocity, m.velocity) + dot<double>(m.position, m.acceleration),
                             1.5 * dot<double>(m.velocity, m.acceleration),
                             0.5 * dot<double>(m.acceleration, m.acceleration)};
    std::vector<double> turning_points;
    const auto add = [&](double t) {
        if (t > 0 && std::isfinite(t) && (turning_points.empty() || t > turning_points.back()))
            turning_points.push_back(t);
    };
    if (rate.c3 > 0) {
        visit_negative_stretches(rate, [&](double from, double to) {
            add(from);
            add(to);
            return false;
        });
    } else {
        add(-rate.c0 / rate.c1);
    }
    return where_negative([&](double t) { return length_squared<double>(position_at(m, t)) - reach * reach; },
                          turning_points, search);
}

/// The motion seen along a direction from a point.
struct Along {
    double c0, c1, c2;
    Along(const Motion<double>& m, const Vec2& point, const Vec2& direction)
        : c0(dot<double>(m.position - point, direction)),
          c1(dot<double>(m.velocity, direction)),
          c2(0.5 * dot<double>(m.acceleration, direction)) {}
    [[nodiscard]] Stretches below(double bound, const Search& search) const {
        return where_negative(c0 - bound, c1, c2, search);
    }
    [[nodiscard]] Stretches above(double bound, const Search& search) const {
        return where_negative(bound - c0, -c1, -c2, search);
    }
};

/// Beside the segment, nearer than `reach`.
Stretches inside_strip(const Motion<double>& m, const Vec2& from, const Vec2& to, double reach,
                       const Search& search) {
    const double length = std::sqrt(length_squared<double>(to - from));
    const Vec2 unit = (to - from) / length;
    const Along across(m, from, {-unit.y(), unit.x()});
    const Along along(m, from, unit);
    Stretches s = intersected(across.below(reach, search), across.above(-reach, search));
    if (!s.empty()) s = intersected(s, along.above(0, search));
    if (!s.empty()) s = intersected(s, along.below(length, search));
    return s;
}

Stretches inside_polygon(const Motion<double>& m, const std::vector<Vec2>& corners, const Search& search) {
    const std::size_t n = corners.size();
    const double turn = cross<double>(corners[1] - corners[0], corners[2] - corners[1]);
    Stretches s = {{0, kForEver}};
    for (std::size_t k = 0; k < n && !s.empty(); ++k) {
        const Vec2 side = corners[(k + 1) % n] - corners[k];
        const Vec2 inward = turn > 0 ? Vec2(-side.y(), side.x()) : Vec2(side.y(), -side.x());
        s = intersected(s, Along(m, corners[k], inward).above(0, search));
    }
    return s;
}

}  // namespace

std::vector<Stretch> united(std::vector<Stretch> a, const std::vector<Stretch>& b) {
    a.insert(a.end(), b.begin(), b.end());
    std::ranges::sort(a, {}, [](const Stretch& s) { return s.from; });
    std::vector<Stretch> all;
    for (const Stretch& s : a) {
        // Parts of one sensor touch: what rounding leaves between them is no way out.
        constexpr double kSeam = 1 + 0x1p-44;
        if (!all.empty() && s.from <= all.back().to * kSeam)
            all.back().to = std::max(all.back().to, s.to);
        else
            all.push_back(s);
    }
    return all;
}

std::vector<Stretch> stretches_inside(const Motion<double>& motion, double radius, const Sensor& sensor,
                                      double horizon) {
    const double reach = radius + sensor.radius;
    const double speed = std::sqrt(length_squared(motion.velocity));
    const double pull = std::sqrt(length_squared(motion.acceleration));
    const double quickness = speed + std::sqrt(pull * reach);
    const Search search{horizon, std::max(reach / quickness, std::numeric_limits<double>::min())};
    const std::vector<Vec2>& corners = sensor.corners;
    const std::size_t n = corners.size();
    std::vector<Stretch> all;
    if (n > 2) all = inside_polygon(motion, corners, search);
    for (std::size_t k = 0; k < n; ++k) {
        const Motion<double> from_corner{motion.position - corners[k], motion.velocity, motion.acceleration};
        all = united(std::move(all), inside_disc(from_corner, reach, search));
        if (k + 1 < n || n > 2)
            all =
                united(std::move(all), inside_strip(motion, corners[k], corners[(k + 1) % n], reach, search));
    }
    return all;
}

}  // namespace carom
