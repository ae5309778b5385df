#include "edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "draw.hpp"
#include "hash.hpp"

namespace carom::stress {
namespace {

Draw draw_of(std::uint64_t seed, std::uint32_t number) {
    return Draw(mix(mix(seed + 17) + number));
}

/// Draws one change after the other. All sizes are those of balls that are there: a scene has units of its
/// own.
class EditsDraw {
 public:
    EditsDraw(Draw& draw, const Scene& scene, const World& world)
        : draw_(draw), scene_(scene), world_(world), ids_(world.ball_ids()), box_(world.domain().box) {
        // No faster than the scene began: batch by batch, what grows with what is there has no end.
        const auto fastest = [](const std::vector<Ball>& balls) {
            double speed = 0;
            for (const Ball& b : balls)
                speed = std::max(speed, std::sqrt(length_squared<double>(b.velocity)));
            return speed;
        };
        speed_ = std::min(fastest(world.balls()), fastest(scene.balls));
        if (!(speed_ > 0)) speed_ = (box_.max - box_.min).maxCoeff() / scene.until;
    }

    void add_to(Edits& edits) {
        if (ids_.empty()) return;
        const std::uint32_t id = ids_[draw_.below(ids_.size())];
        const Ball ball = world_.ball(id);
        switch (draw_.below(10)) {
            case 0:
            case 1:
                edits.added_balls.push_back(another(ball));
                break;
            case 2:
                if (std::ranges::find(edits.removed_balls, id) == edits.removed_balls.end())
                    edits.removed_balls.push_back(id);
                break;
            case 3:
                change_walls(edits);
                break;
            case 4:
                change_forces(edits, ball);
                break;
            default:
                edits.changed_balls.push_back(change(id, ball));
        }
    }

 private:
    Vec2 place() { return draw_.in_box(box_.min, box_.max); }

    /// Like one that is there, anywhere or touching it.
    Ball another(const Ball& like) {
        Ball b = like;
        b.radius *= draw_.uniform(0.2, 1);
        b.mass *= draw_.decades(-1, 1);
        b.is_static = draw_.one_in(5);
        b.position =
            draw_.one_in(3) ? Vec2(like.position + draw_.direction(like.radius + b.radius)) : place();
        b.velocity = b.is_static ? Vec2(Vec2::Zero()) : draw_.direction(draw_.uniform(0, speed_));
        if (b.is_static) b.acceleration.setZero();
        if (draw_.one_in(4)) b.restitution = draw_.uniform(0, 1);
        if (draw_.one_in(8)) b.filter = draw_.filter();
        return b;
    }

    BallChange change(std::uint32_t id, const Ball& ball) {
        BallChange c{.id = id};
        const std::size_t kind = draw_.below(8);
        if (kind == 0) c.position = place();
        if (kind <= 2 && !ball.is_static) c.velocity = draw_.direction(draw_.uniform(0, 2 * speed_));
        if (kind == 3 && !ball.is_static)
            c.acceleration = draw_.direction(draw_.uniform(0, 1) * pull(ball.radius));
        if (kind == 4) c.radius = ball.radius * draw_.uniform(0.3, 1.2);
        if (kind == 5) c.mass = ball.mass * draw_.decades(-1, 1);
        if (kind == 6) c.restitution = draw_.one_in(2) ? 1 : draw_.uniform(0, 1);
        if (kind == 7) c.filter = draw_.filter();
        return c;
    }

    void change_walls(Edits& edits) {
        const std::vector<std::uint32_t> walls = world_.wall_ids();
        if (!walls.empty() && edits.removed_walls.empty() && draw_.one_in(2)) {
            edits.removed_walls.push_back(walls[draw_.below(walls.size())]);
            return;
        }
        Wall w;
        w.from = place();
        const Vec2 other = place();  // apart: in one expression compilers differ in what they draw first
        w.to = w.from + draw_.uniform(0.01, 0.3) * (other - w.from);
        if (draw_.one_in(3)) w.restitution = draw_.uniform(0, 1);
        if (draw_.one_in(6)) w.filter = draw_.filter();
        edits.added_walls.push_back(w);
    }

    void change_forces(Edits& edits, const Ball& ball) {
        if (draw_.one_in(2)) {
            edits.gravity = draw_.one_in(3) ? Vec2(Vec2::Zero())
                                            : draw_.direction(draw_.uniform(0, 0.3) * pull(ball.radius));
            return;
        }
        edits.attractors.emplace();
        constexpr double kMostUpdates = 1e4;
        if (draw_.one_in(3) || scene_.until > kMostUpdates * scene_.field_interval) return;
        const double softening = ball.radius * draw_.uniform(1, 4);
        const double strength = draw_.uniform(-0.3, 1) * pull(ball.radius) * softening * softening;
        edits.attractors->push_back({place(), strength, softening});
    }

    /// Turns the fastest within some ten radii, unless it would make them several times as fast by the end.
    [[nodiscard]] double pull(double radius) const {
        return speed_ * std::min(speed_ / (20 * radius), 4 / scene_.until);
    }

    Draw& draw_;
    const Scene& scene_;
    const World& world_;
    std::vector<std::uint32_t> ids_;
    Box box_;
    double speed_ = 0;
};

/// The ids that bodies must have after edits: of those that stay the old ones, and of those that come the
/// least that nobody had.
std::vector<std::uint32_t> expected_ids(const std::vector<std::uint32_t>& before,
                                        const std::vector<std::uint32_t>& removed,
                                        const std::vector<std::uint32_t>& added) {
    const std::set<std::uint32_t> had(before.begin(), before.end());
    std::set<std::uint32_t> ids = had;
    for (const std::uint32_t id : removed) ids.erase(id);
    std::uint32_t next = 0;
    for (const std::uint32_t id : added) {
        while (had.contains(next)) ++next;
        if (id != next) return {};
        ids.insert(next++);
    }
    return {ids.begin(), ids.end()};
}

bool is_same_body(const Ball& a, const Ball& b) {
    return a.acceleration == b.acceleration && a.radius == b.radius && a.mass == b.mass &&
           a.restitution == b.restitution && a.is_static == b.is_static && a.filter == b.filter;
}

/// A ball that no edit names moves on from where it was; in float its place may be rounded, once.
bool moves_on(const Ball& before, const Ball& after, bool is_rounded) {
    if (!is_rounded) return before.position == after.position && before.velocity == after.velocity;
    const auto near = [](const Vec2& a, const Vec2& b) {
        return ((a - b).cwiseAbs().array() <= 0x1p-23 * a.cwiseAbs().array()).all();
    };
    return near(before.velocity, after.velocity) && near(before.position, after.position);
}

std::string find_fault(const World& world, const Edits& edits, const Added& added,
                       const std::vector<std::uint32_t>& ids, const std::vector<std::uint32_t>& wall_ids,
                       const std::vector<Ball>& balls, bool in_float) {
    if (world.ball_ids() != expected_ids(ids, edits.removed_balls, added.balls))
        return "balls have other ids than they must have";
    if (world.wall_ids() != expected_ids(wall_ids, edits.removed_walls, added.walls))
        return "walls have other ids than they must have";
    std::set<std::uint32_t> named(edits.removed_balls.begin(), edits.removed_balls.end());
    for (const BallChange& c : edits.changed_balls) named.insert(c.id);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (named.contains(ids[i])) continue;
        const Ball now = world.ball(ids[i]);
        // The empirical method ends a step where it is edited.
        const bool goes_on = world.counts().steps || moves_on(balls[i], now, in_float && !now.is_static);
        if (!is_same_body(balls[i], now) || !goes_on)
            return fmt::format("ball {} is not what it was, though no edit names it", ids[i]);
    }
    for (std::size_t k = 0; k < added.balls.size(); ++k) {
        if (!is_same_body(edits.added_balls[k], world.ball(added.balls[k])))
            return fmt::format("ball {} is not what was added", added.balls[k]);
    }
    if (edits.gravity && world.gravity() != *edits.gravity) return "gravity is not what it was set to";
    return {};
}

/// Steps may be as short as lets the smallest moving ball go a part of its radius.
void keep_steps_long(Edits& edits, const Scene& scene) {
    double smallest = HUGE_VAL;
    for (const Ball& b : scene.balls)
        if (!b.is_static) smallest = std::min(smallest, b.radius);
    for (Ball& b : edits.added_balls) b.radius = std::max(b.radius, smallest);
    for (BallChange& c : edits.changed_balls)
        if (c.radius) c.radius = std::max(*c.radius, smallest);
}

}  // namespace

std::vector<std::uint32_t> all_edits() {
    std::vector<std::uint32_t> numbers(kMostEdits);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

std::vector<std::uint32_t> drawn_edits(std::uint64_t seed) {
    Draw draw = draw_of(seed, kMostEdits);
    std::vector<std::uint32_t> numbers = all_edits();
    numbers.resize(draw.one_in(2) ? 0 : 1 + draw.below(kMostEdits));
    return numbers;
}

std::size_t stretch_of_edit(std::uint64_t seed, std::uint32_t number, std::size_t stretches) {
    return draw_of(seed, number).below(stretches);
}

Edits draw_edits(std::uint64_t seed, std::uint32_t number, const Scene& scene, const World& world) {
    Draw draw = draw_of(seed, number);
    static_cast<void>(draw.bits());  // has given the stretch
    Edits edits;
    EditsDraw one(draw, scene, world);
    for (std::size_t k = draw.one_in(3) ? 1 + draw.below(8) : 1; k > 0; --k) one.add_to(edits);
    if (scene.method == Method::kEmpirical) keep_steps_long(edits, scene);
    return edits;
}

Edited apply_edits(World& world, const Edits& edits) {
    const std::vector<Ball> balls = world.balls();
    const std::vector<std::uint32_t> ids = world.ball_ids();
    const std::vector<std::uint32_t> wall_ids = world.wall_ids();
    const std::uint64_t hash = world.state_hash();
    const std::uint64_t scene_hash = world.scene_hash();
    Edited result;
    try {
        const Added added = world.apply(edits);
        result.answer =
            fmt::format("balls {}, walls {}", fmt::join(added.balls, " "), fmt::join(added.walls, " "));
        result.fault = find_fault(world, edits, added, ids, wall_ids, balls, world.kernel().rounds_to_float);
    } catch (const SceneError& error) {
        result.is_refused = true;
        result.answer = error.what();
        if (world.state_hash() != hash || world.scene_hash() != scene_hash || world.ball_ids() != ids)
            result.fault = "refused, but not as if it had never been asked for";
    }
    return result;
}

Scene scene_now(const Scene& scene, const World& world) {
    Scene now = scene;
    now.balls = world.balls();
    now.walls = world.walls();
    now.attractors = world.attractors();
    now.gravity = world.gravity();
    return now;
}

}  // namespace carom::stress
