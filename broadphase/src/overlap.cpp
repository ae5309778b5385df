// Overlaps among balls and of balls with walls and walled sides.
#include <carom/broadphase/overlap.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "pair_search.hpp"
#include "wall_tree.hpp"

namespace carom {
namespace {

using detail::Axis;
using detail::PairSearch;

// Touching balls written in decimals overlap by the rounding of their coordinates and no more.
constexpr double kTouch = 1e-12;
constexpr double kUlps = 4 * std::numeric_limits<double>::epsilon();

double largest(double x, double y) {
    return std::max(std::abs(x), std::abs(y));
}

double touch(double radius_sum, double largest_coordinate) {
    return kTouch * radius_sum + kUlps * largest_coordinate;
}

double touch(const PairSearch::Disc& a, const PairSearch::Disc& b) {
    return touch(a.radius + b.radius, std::max(largest(a.x, a.y), largest(b.x, b.y)));
}

/// How deep two discs reach into each other; 0 where they do not. The square root is spared where they are
/// apart.
double depth_of(const PairSearch& search, const PairSearch::Disc& a, const PairSearch::Disc& b) {
    const double radius_sum = a.radius + b.radius;
    const double distance_squared = length_squared<double>(search.offset(a, b));
    if (distance_squared >= radius_sum * radius_sum) return 0;
    return std::max(0.0, radius_sum - std::sqrt(distance_squared));
}

/// The same for the balls behind them; none where they do not collide.
double depth_of(const PairSearch& search, const std::vector<Ball>& balls, const PairSearch::Disc& a,
                const PairSearch::Disc& b) {
    const double depth = depth_of(search, a, b);
    return depth > 0 && may_collide(balls[a.id].filter, balls[b.id].filter) ? depth : 0;
}

Overlap in_order(std::uint32_t i, std::uint32_t j, double depth) {
    return {std::min(i, j), std::max(i, j), depth};
}

bool comes_before(const Overlap& a, const Overlap& b) {
    return a.i != b.i ? a.i < b.i : a.j < b.j;
}

/// How deep a ball reaches into its own images; 0 where it does not.
double depth_in_itself(const Ball& ball, const std::array<Axis, 2>& axes) {
    double depth = 0;
    for (const Axis& axis : axes)
        if (axis.period > 0 && !ball.is_static) depth = std::max(depth, 2 * ball.radius - axis.period);
    return depth;
}

/// What balls can hit that are not balls, and how deep they are in it.
class Walls {
 public:
    explicit Walls(const Scene& scene) : axes_(detail::axes_of(scene)), tree_(scene.walls) {
        if (!scene.domain) return;
        box_ = scene.domain->box;
        for (int axis = 0; axis < 2; ++axis) walled_[axis] = scene.domain->boundary[axis] == Boundary::kWall;
    }

    [[nodiscard]] bool empty() const { return tree_.empty() && !walled_[0] && !walled_[1]; }

    /// Calls visit(wall, depth) for each that the ball reaches into, in no particular order; depth > 0.
    template <class Visit>
    void for_each_depth(const Ball& ball, Visit&& visit) const {
        for (int x = -1; x <= 1 && !tree_.empty(); ++x) {
            if (x != 0 && axes_[0].period == 0) continue;
            for (int y = -1; y <= 1; ++y) {
                if (y != 0 && axes_[1].period == 0) continue;
                const Vec2 p(axes_[0].wrapped(ball.position.x()) + x * axes_[0].period,
                             axes_[1].wrapped(ball.position.y()) + y * axes_[1].period);
                tree_.for_each_near(p, ball.radius, [&](std::uint32_t wall) {
                    if (!may_collide(ball.filter, tree_.walls()[wall].filter)) return true;
                    const double distance_squared = detail::distance_squared_to(tree_.walls()[wall], p);
                    if (distance_squared < ball.radius * ball.radius)
                        report(wall, ball.radius - std::sqrt(distance_squared), visit);
                    return true;
                });
            }
        }
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (!walled_[axis]) continue;
            const std::size_t side = tree_.walls().size() + 2 * axis;
            const auto k = static_cast<Eigen::Index>(axis);
            report(side, ball.radius - (ball.position[k] - box_.min[k]), visit);
            report(side + 1, ball.radius - (box_.max[k] - ball.position[k]), visit);
        }
    }

    /// The rounding of a distance from wall `j`.
    [[nodiscard]] double touch_at(const Ball& ball, std::size_t j) const {
        const Box ends = j < tree_.walls().size() ? Box{tree_.walls()[j].from, tree_.walls()[j].to} : box_;
        const double coordinate =
            std::max({largest(ball.position.x(), ball.position.y()), largest(ends.min.x(), ends.min.y()),
                      largest(ends.max.x(), ends.max.y())});
        return touch(ball.radius, coordinate);
    }

    [[nodiscard]] std::size_t count() const { return tree_.walls().size(); }

 private:
    template <class Visit>
    static void report(std::size_t wall, double depth, Visit& visit) {
        if (depth > 0) visit(wall, depth);
    }

    std::array<Axis, 2> axes_;
    detail::WallTree tree_;
    Box box_;
    std::array<bool, 2> walled_{};
};

/// The overlaps of one ball with walls, each wall once (a ball may meet several images of one), in the order
/// of the walls.
std::vector<Overlap> overlaps_with(const Walls& walls, const Ball& ball, std::size_t i) {
    std::vector<Overlap> found;
    if (ball.is_static) return found;
    walls.for_each_depth(ball, [&](std::size_t wall, double depth) {
        if (depth > walls.touch_at(ball, wall)) found.push_back({i, wall, depth});
    });
    std::sort(found.begin(), found.end(),
              [](const Overlap& a, const Overlap& b) { return a.j != b.j ? a.j < b.j : a.depth > b.depth; });
    found.erase(std::unique(found.begin(), found.end(),
                            [](const Overlap& a, const Overlap& b) { return a.j == b.j; }),
                found.end());
    return found;
}

/// Which overlaps count, and what the bodies are called; all and by index where there is no selection.
class View {
 public:
    explicit View(const Selection* selection) : selection_(selection) {}

    [[nodiscard]] bool has_ball(std::size_t i) const {
        return selection_ == nullptr || selection_->balls[i] != 0;
    }
    [[nodiscard]] bool has_wall(std::size_t j) const {
        return selection_ == nullptr || (j < selection_->walls.size() && selection_->walls[j] != 0);
    }
    [[nodiscard]] std::string ball(std::size_t i) const {
        return fmt::format(
            "balls[{}]", selection_ == nullptr || selection_->ball_ids.empty() ? i : selection_->ball_ids[i]);
    }
    /// Of a wall, or after `count` walls of a side.
    [[nodiscard]] std::string wall(std::size_t j, std::size_t count) const {
        constexpr std::array<const char*, 4> kSides = {"left", "right", "lower", "upper"};
        if (j >= count) return fmt::format("the domain's {} side", kSides[j - count]);
        return fmt::format(
            "walls[{}]", selection_ == nullptr || selection_->wall_ids.empty() ? j : selection_->wall_ids[j]);
    }

 private:
    const Selection* selection_;
};

/// The overlap of two balls with the smallest (i, j), its i the number of balls where there is none.
Overlap first_overlap(const std::vector<Ball>& balls, const PairSearch& search, const View& view) {
    Overlap first{balls.size(), balls.size(), 0};
    const auto take = [&](const Overlap& found) {
        if (comes_before(found, first)) first = found;
    };
    for (std::size_t i = 0; i < balls.size() && first.i == balls.size(); ++i) {
        const double depth = depth_in_itself(balls[i], search.axes());
        if (depth > kTouch * 2 * balls[i].radius && view.has_ball(i)) take({i, i, depth});
    }
    // Of one a and the balls of one cell, which come in order, the first overlap has the smallest pair, and
    // once both ids are larger than the smallest i so far none can be smaller. With both stops even a heap of
    // balls on one point takes linear time.
    search.for_each_pair([&](const PairSearch::Disc& a, const PairSearch::Disc& b) {
        if (std::min(a.id, b.id) > first.i) return false;
        const double depth = depth_of(search, balls, a, b);
        if (depth <= 0 || depth <= touch(a, b)) return true;
        if (!view.has_ball(a.id) && !view.has_ball(b.id)) return true;
        take(in_order(a.id, b.id, depth));
        return false;
    });
    return first;
}

void check_balls(const std::vector<Ball>& balls, const Scene& scene, const View& view) {
    const Overlap first = first_overlap(balls, PairSearch(balls, scene), view);
    if (first.i == balls.size()) return;
    const double radius_sum = balls[first.i].radius + balls[first.j].radius;
    const std::string other = first.i == first.j ? "its own periodic image" : view.ball(first.j);
    throw SceneError(view.ball(first.i),
                     fmt::format("overlaps {} by {:.6g} (distance {:.6g}, radii's sum {:.6g})", other,
                                 first.depth, radius_sum - first.depth, radius_sum));
}

void check_walls(const std::vector<Ball>& balls, const Scene& scene, const View& view) {
    const Walls walls(scene);
    for (std::size_t i = 0; i < balls.size() && !walls.empty(); ++i) {
        for (const Overlap& found : overlaps_with(walls, balls[i], i)) {
            if (!view.has_ball(i) && !view.has_wall(found.j)) continue;
            throw SceneError(view.ball(i),
                             fmt::format("overlaps {} by {:.6g} (distance {:.6g}, radius {:.6g})",
                                         view.wall(found.j, walls.count()), found.depth,
                                         balls[i].radius - found.depth, balls[i].radius));
        }
    }
}

void check_overlaps(const std::vector<Ball>& balls, const Scene& scene, const View& view) {
    check_balls(balls, scene, view);
    check_walls(balls, scene, view);
}

}  // namespace

std::vector<Overlap> find_overlaps(const std::vector<Ball>& balls, const Scene& scene) {
    const PairSearch search(balls, scene);
    std::vector<Overlap> found;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const double depth = depth_in_itself(balls[i], search.axes());
        if (depth > kTouch * 2 * balls[i].radius) found.push_back({i, i, depth});
    }
    search.for_each_pair([&](const PairSearch::Disc& a, const PairSearch::Disc& b) {
        const double depth = depth_of(search, balls, a, b);
        if (depth > 0 && depth > touch(a, b)) found.push_back(in_order(a.id, b.id, depth));
        return true;
    });
    std::sort(found.begin(), found.end(), comes_before);
    return found;
}

std::vector<Overlap> find_wall_overlaps(const std::vector<Ball>& balls, const Scene& scene) {
    const Walls walls(scene);
    std::vector<Overlap> found;
    for (std::size_t i = 0; i < balls.size() && !walls.empty(); ++i) {
        const std::vector<Overlap> of_ball = overlaps_with(walls, balls[i], i);
        found.insert(found.end(), of_ball.begin(), of_ball.end());
    }
    return found;
}

void check_overlaps(const std::vector<Ball>& balls, const Scene& scene) {
    check_overlaps(balls, scene, View(nullptr));
}

void check_overlaps(const std::vector<Ball>& balls, const Scene& scene, const Selection& selection) {
    // Where few are selected, what is not near them need not be put in order.
    constexpr std::size_t kFew = 16;
    std::vector<Ball> few;
    for (std::size_t i = 0; i < balls.size() && few.size() <= kFew; ++i)
        if (selection.balls[i] != 0) few.push_back(balls[i]);
    if (few.size() > kFew || std::ranges::count(selection.walls, 0) != std::ssize(selection.walls))
        return check_overlaps(balls, scene, View(&selection));

    const std::array<Axis, 2> axes = detail::axes_of(scene);
    const auto is_near = [&axes](const Ball& a, const Ball& b) {
        constexpr double kRounding = 1e-9;
        const double reach = (1 + kRounding) * (a.radius + b.radius);
        const auto is_within = [&](int k) {
            const Axis& axis = axes[static_cast<std::size_t>(k)];
            const double x = axis.wrapped(a.position[k]);
            const double y = axis.wrapped(b.position[k]);
            const double apart = axis.period > 0 ? axis.nearest(x - y) : x - y;
            return std::abs(apart) <= reach + kRounding * (std::abs(x) + std::abs(y));
        };
        return is_within(0) && is_within(1);
    };
    std::vector<Ball> near;
    Selection of_near{.walls = selection.walls, .wall_ids = selection.wall_ids};
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (std::ranges::none_of(few, [&](const Ball& ball) { return is_near(ball, balls[i]); })) continue;
        near.push_back(balls[i]);
        of_near.balls.push_back(selection.balls[i]);
        of_near.ball_ids.push_back(selection.ball_ids.empty() ? static_cast<std::uint32_t>(i)
                                                              : selection.ball_ids[i]);
    }
    check_overlaps(near, scene, View(&of_near));
}

double max_overlap(const std::vector<Ball>& balls, const Scene& scene) {
    const PairSearch search(balls, scene);
    double deepest = 0;
    for (const Ball& ball : balls)
        deepest = std::max(deepest, depth_in_itself(ball, search.axes()) / (2 * ball.radius));
    search.for_each_pair([&](const PairSearch::Disc& a, const PairSearch::Disc& b) {
        deepest = std::max(deepest, depth_of(search, balls, a, b) / (a.radius + b.radius));
        return true;
    });
    const Walls walls(scene);
    for (const Ball& ball : balls) {
        if (ball.is_static || walls.empty()) continue;
        walls.for_each_depth(
            ball, [&](std::size_t, double depth) { deepest = std::max(deepest, depth / ball.radius); });
    }
    return deepest;
}

}  // namespace carom
