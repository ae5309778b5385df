// From a fill to its balls: how many and how large, then where, then how heavy and how fast.
#include <carom/broadphase/placement.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "placement_methods.hpp"

namespace carom {
namespace {

using detail::Random;
using detail::Space;
using detail::Stream;

// Above it adsorption takes too many tries, and at 0.547 it ends.
// A hair more than 0.5, for radii that were scaled to just that.
constexpr double kAdsorbedPacking = 0.5 + 1e-9;

class FillPlacer {
 public:
    FillPlacer(const Scene& scene, std::size_t index)
        : scene_(scene), fill_(scene.fills[index]), index_(index) {
        const std::optional<Box>& region = scene.fills[index].region;
        if (region)
            region_ = *region;
        else if (scene.domain)
            region_ = scene.domain->box;
        else
            throw SceneError(place("region"), "is required where the scene has no domain");
    }

    void append_to(std::vector<Ball>& balls) const {
        std::vector<double> drawn = radii();
        if (drawn.empty()) return;
        check_width(*std::max_element(drawn.begin(), drawn.end()));
        Space space(scene_, balls, region_, drawn);
        drawn = {};  // the space has its own
        put(space);
        const std::size_t first = balls.size();
        balls.reserve(first + space.count());
        for (const std::uint32_t id : space.order_by_place()) balls.push_back(ball(space.body(id)));
        if (fill_.temperature > 0) set_in_motion(balls, first);
    }

 private:
    [[nodiscard]] std::string place(const char* field) const {
        return fmt::format("fill[{}].{}", index_, field);
    }
    /// The field to blame when there is no room.
    [[nodiscard]] std::string amount() const {
        return place(fill_.packing_fraction ? "packing_fraction" : "count");
    }
    [[nodiscard]] double area() const {
        return (region_.max.x() - region_.min.x()) * (region_.max.y() - region_.min.y());
    }

    [[nodiscard]] double draw_radius(Random& random) const {
        return std::min(fill_.radius_max,
                        fill_.radius_min + random.uniform() * (fill_.radius_max - fill_.radius_min));
    }

    [[nodiscard]] std::vector<double> radii() const {
        Random random(fill_.seed, index_, Stream::kRadii);
        return fill_.count ? radii_by_count(*fill_.count, random) : radii_by_packing(random);
    }

    [[nodiscard]] std::vector<double> radii_by_count(std::uint64_t count, Random& random) const {
        std::vector<double> radii(count);
        double squares = 0;
        for (double& radius : radii) {
            radius = draw_radius(random);
            squares += radius * radius;
        }
        if (!fill_.packing_fraction) {
            if (std::numbers::pi * squares > area())
                throw SceneError(
                    place("count"),
                    fmt::format("must be less: the area of {} discs is {:.6g}, that of the region {:.6g}",
                                radii.size(), std::numbers::pi * squares, area()));
            return radii;
        }
        const double scale = std::sqrt(*fill_.packing_fraction * area() / (std::numbers::pi * squares));
        for (double& radius : radii) radius *= scale;
        return radii;
    }

    /// Discs are drawn as long as each brings the packing nearer to what is asked for.
    [[nodiscard]] std::vector<double> radii_by_packing(Random& random) const {
        const double packing = fill_.packing_fraction.value_or(0);
        const double wanted = packing * area() / std::numbers::pi;
        const double mean_square =
            (fill_.radius_min * fill_.radius_min + fill_.radius_min * fill_.radius_max +
             fill_.radius_max * fill_.radius_max) /
            3;
        std::vector<double> radii;
        radii.reserve(static_cast<std::size_t>(1.01 * wanted / mean_square + 16));
        double squares = 0;
        for (;;) {
            const double radius = draw_radius(random);
            if (squares + 0.5 * radius * radius > wanted) break;
            squares += radius * radius;
            radii.push_back(radius);
        }
        if (radii.empty())
            throw SceneError(place("packing_fraction"),
                             fmt::format("must be at least {:.6g}, for one disc in the region, is {:.6g}",
                                         std::numbers::pi * mean_square / area(), packing));
        return radii;
    }

    void check_width(double radius) const {
        for (int axis = 0; axis < 2; ++axis) {
            const double half_width = (region_.max[axis] - region_.min[axis]) / 2;
            if (radius <= half_width) continue;
            const bool scaled = fill_.count && fill_.packing_fraction;
            throw SceneError(
                scaled ? amount() : place("radius"),
                fmt::format("must fit the region: its half width is {:.6g}, the largest radius {:.6g}",
                            half_width, radius));
        }
    }

    void put(Space& space) const {
        Random random(fill_.seed, index_, Stream::kPlaces);
        if (space.packing() <= kAdsorbedPacking && detail::adsorb(space, random).empty()) return;
        const detail::DenseResult result = detail::place_dense(space, random);
        if (result.complete) return;
        throw SceneError(
            amount(),
            fmt::format("must leave room for every disc: of {} with packing {:.4g} in the region, {} found "
                        "a place beside walls and balls that are there (all, had they packing {:.3g})",
                        space.count(), space.packing(), result.placed, result.packing));
    }

    [[nodiscard]] Ball ball(const Space::Body& body) const {
        Ball ball;
        ball.position = {body.x, body.y};
        ball.radius = body.radius;
        ball.restitution = fill_.restitution;
        ball.filter = fill_.filter;
        if (fill_.mass) ball.mass = *fill_.mass;
        if (fill_.density) ball.mass = *fill_.density * std::numbers::pi * body.radius * body.radius;
        return ball;
    }

    void set_in_motion(std::vector<Ball>& balls, std::size_t first) const {
        Random random(fill_.seed, index_, Stream::kVelocities);
        for (std::size_t i = first; i < balls.size(); ++i) {
            const double deviation = std::sqrt(fill_.temperature / balls[i].mass);
            const auto [x, y] = random.normal_pair();
            balls[i].velocity = {deviation * x, deviation * y};
        }
        for (int k = 0; k < 2; ++k) {  // the second time for what rounding left of the first
            Vec2 momentum = Vec2::Zero();
            double mass = 0;
            for (std::size_t i = first; i < balls.size(); ++i) {
                momentum += balls[i].mass * balls[i].velocity;
                mass += balls[i].mass;
            }
            const Vec2 velocity = momentum / mass;
            for (std::size_t i = first; i < balls.size(); ++i) balls[i].velocity -= velocity;
        }
    }

    const Scene& scene_;
    const Fill& fill_;
    std::size_t index_;
    Box region_;
};

}  // namespace

std::vector<Ball> place_balls(const Scene& scene) {
    std::vector<Ball> balls = scene.balls;
    for (std::size_t k = 0; k < scene.fills.size(); ++k) FillPlacer(scene, k).append_to(balls);
    return balls;
}

}  // namespace carom
