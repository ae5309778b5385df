// The reference engine: no grid, no queue, no staleness. It keeps the predicted time of every pair of bodies
// in a table, takes the least, resolves it, and predicts the two rows anew. It shares with the engine the
// functions of core alone, so that every event must agree to the bit. Gravity, walls, periodic boxes, mixed
// sizes and losses; no attractors.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include <carom/core/clock.hpp>
#include <carom/core/disc_time.hpp>
#include <carom/core/response.hpp>
#include <carom/core/scene.hpp>
#include <carom/core/snapshot.hpp>
#include <carom/core/wall_time.hpp>

#include "physics.hpp"

namespace carom::stress {

struct BruteForceRules {
    Domain domain;
    Vec2 gravity = Vec2::Zero();
    RestitutionRule rule = RestitutionRule::kMin;
    double contact_time = 0;
    double rest_time = 0;
    double speed_factor = 1;
    Clock clock;
    bool in_float = false;
    int images = 1;  ///< periods beyond the nearest image, to either side, in which a partner is looked for
};

inline BruteForceRules rules_of(const Physics& p) {
    return {p.domain,   p.gravity, p.restitution_rule, p.contact_time, p.rest_time, p.speed_factor, p.clock,
            p.in_float, 1};
}

/// The rules by which World runs a scene whose fills are placed.
inline BruteForceRules rules_of(const Scene& scene) {
    return rules_of(derive_physics(scene, scene.balls));
}

struct BruteForceEvent {
    double time;
    std::size_t i;
    std::size_t j;  ///< ball, or ball count + wall, or ball count + wall count + side
};

class BruteForce {
 public:
    BruteForce(const BruteForceRules& rules, const std::vector<Ball>& balls, const std::vector<Wall>& walls)
        : rules_(rules), walls_(walls), bodies_(balls.size()), partners_(balls.size() + walls.size() + 4) {
        for (std::size_t i = 0; i < balls.size(); ++i) {
            Body& b = bodies_[i];
            b.ball = balls[i];
            wrap(b);
            b.acceleration =
                balls[i].is_static ? Vec2(Vec2::Zero()) : Vec2(rules.gravity + balls[i].acceleration);
        }
        predict_all();
    }
    /// From where a world was: anchors as the snapshot has them.
    BruteForce(const BruteForceRules& rules, const std::vector<Ball>& balls, const std::vector<Wall>& walls,
               const Snapshot& from)
        : BruteForce(rules, balls, walls) {
        std::size_t moving = 0;
        for (Body& b : bodies_) {
            if (b.ball.is_static) continue;
            b.ball.position = from.anchors[moving].position;
            b.ball.velocity = from.anchors[moving].velocity;
            b.anchor = from.anchors[moving].time;
            if (!from.last_collisions.empty()) b.last_collision = from.last_collisions[moving];
            ++moving;
        }
        predict_all();
    }

    /// Resolves the next event and says which it was.
    BruteForceEvent next() {
        std::size_t i = 0;  // of equals the first, which has the smallest (i, j)
        for (std::size_t k = 1; k < bodies_.size(); ++k)
            if (at(k, row_best_[k]).time < at(i, row_best_[i]).time) i = k;
        const std::size_t j = row_best_[i];
        const Entry event = at(i, j);
        resolve(i, j, event);
        return {rules_.clock.to_seconds(event.time), i, j};
    }

    [[nodiscard]] bool finished() const {
        for (std::size_t i = 0; i < bodies_.size(); ++i)
            if (at(i, row_best_[i]).time != kNever) return false;
        return true;
    }

    /// Position and velocity at `seconds`.
    [[nodiscard]] std::pair<Vec2, Vec2> state_at(std::size_t i, double seconds) const {
        Body b = bodies_[i];
        move(b, rules_.clock.from_seconds(seconds));
        return {b.ball.position, b.ball.velocity};
    }

 private:
    struct Body {
        Ball ball;
        Vec2 acceleration;
        Time anchor;
        Time last_collision{std::numeric_limits<std::int64_t>::min(), 0};
    };
    struct Entry {
        Time time = kNever;
        int nx = 0, ny = 0;  // periods by which the partner is moved
        WallFeature feature = WallFeature::kFace;
    };

    [[nodiscard]] bool periodic(int axis) const {
        return rules_.domain.boundary[axis] == Boundary::kPeriodic;
    }
    [[nodiscard]] double length(int axis) const {
        return rules_.domain.box.max[axis] - rules_.domain.box.min[axis];
    }
    [[nodiscard]] Vec2 shift(int nx, int ny) const { return {nx * length(0), ny * length(1)}; }

    void wrap(Body& b) const {
        wrap_once(b);
        if (!rules_.in_float) return;
        b.ball.position = rounded_to_float(b.ball.position);
        wrap_once(b);  // rounding may have reached the upper side
        b.ball.position = rounded_to_float(b.ball.position);
    }
    [[nodiscard]] Vec2 held(const Vec2& velocity) const {
        return rules_.in_float ? rounded_to_float(velocity) : velocity;
    }
    void wrap_once(Body& b) const {
        for (int axis = 0; axis < 2; ++axis) {
            if (!periodic(axis)) continue;
            const double low = rules_.domain.box.min[axis];
            double& x = b.ball.position[axis];
            const double n = std::floor((x - low) / length(axis));
            if (n != 0) x -= n * length(axis);
            if (x < low || x >= low + length(axis)) x = low;
        }
    }
    void move(Body& b, const Time& t) const {
        const double since = rules_.clock.difference(t, b.anchor);
        const Motion<double> m{b.ball.position, b.ball.velocity, b.acceleration};
        b.ball.position = position_at(m, since);
        b.ball.velocity = held(velocity_at(m, since));
        b.anchor = t;
        wrap(b);
    }

    [[nodiscard]] const Entry& at(std::size_t i, std::size_t j) const { return table_[i * partners_ + j]; }

    /// Changes one entry and keeps the row's best, the first of equals.
    void set(std::size_t i, std::size_t j, const Entry& entry) {
        table_[i * partners_ + j] = entry;
        std::size_t& best = row_best_[i];
        if (j == best) {
            for (std::size_t k = best = 0; k < partners_; ++k)
                if (at(i, k).time < at(i, best).time) best = k;
        } else if (entry.time < at(i, best).time || (entry.time == at(i, best).time && j < best)) {
            best = j;
        }
    }

    /// The best over the periodic images around the nearest one, `offset` being where the ball is seen from
    /// its partner.
    template <class Predict>
    [[nodiscard]] Entry best_image(const Vec2& offset, Predict&& predict) const {
        Entry best;
        const auto nearest = [&](int axis) {
            return periodic(axis) ? static_cast<int>(std::lround(offset[axis] / length(axis))) : 0;
        };
        const int x = nearest(0);
        const int y = nearest(1);
        const int across = periodic(0) ? rules_.images : 0;
        const int along = periodic(1) ? rules_.images : 0;
        for (int nx = x - across; nx <= x + across; ++nx)
            for (int ny = y - along; ny <= y + along; ++ny)
                if (const Entry e = predict(nx, ny); e.time < best.time) best = e;
        return best;
    }

    [[nodiscard]] Entry pair_entry(std::size_t i, std::size_t j) const {
        const Body& a = bodies_[i];
        const Body& b = bodies_[j];
        const Time reference = std::max(a.anchor, b.anchor);
        const Motion<double> ma{a.ball.position, a.ball.velocity, a.acceleration};
        const Motion<double> mb{b.ball.position, b.ball.velocity, b.acceleration};
        const double ta = rules_.clock.difference(reference, a.anchor);
        const double tb = rules_.clock.difference(reference, b.anchor);
        const Vec2 offset = position_at(ma, ta) - position_at(mb, tb);
        const Vec2 v = velocity_at(ma, ta) - velocity_at(mb, tb);
        return best_image(offset, [&](int nx, int ny) -> Entry {
            const double t = disc_time_of_impact<double>(
                offset - shift(nx, ny), v, a.acceleration - b.acceleration, a.ball.radius + b.ball.radius);
            return {rules_.clock.after(reference, t), nx, ny, WallFeature::kFace};
        });
    }

    [[nodiscard]] Entry wall_entry(std::size_t i, const Wall& wall) const {
        const Body& b = bodies_[i];
        return best_image(b.ball.position - wall.from, [&](int nx, int ny) -> Entry {
            const Motion<double> m{b.ball.position - shift(nx, ny), b.ball.velocity, b.acceleration};
            const WallHit<double> hit = wall_time_of_impact<double>(m, b.ball.radius, wall.from, wall.to);
            return {rules_.clock.after(b.anchor, hit.time), nx, ny, hit.feature};
        });
    }

    [[nodiscard]] Entry side_entry(std::size_t i, std::size_t side) const {
        const int axis = static_cast<int>(side / 2);
        if (rules_.domain.boundary[axis] != Boundary::kWall) return {};
        const Body& b = bodies_[i];
        const bool upper = side % 2 == 1;
        const double gap = upper ? (rules_.domain.box.max[axis] - b.ball.radius) - b.ball.position[axis]
                                 : b.ball.position[axis] - (rules_.domain.box.min[axis] + b.ball.radius);
        const double sign = upper ? -1 : 1;
        const double t = side_time_of_impact(gap, sign * b.ball.velocity[axis], sign * b.acceleration[axis]);
        return {rules_.clock.after(b.anchor, t), 0, 0, WallFeature::kFace};
    }

    void predict_all() {
        table_.assign(bodies_.size() * partners_, Entry());
        row_best_.assign(bodies_.size(), 0);
        for (std::size_t i = 0; i < bodies_.size(); ++i) predict_row(i);
    }

    void predict_row(std::size_t i) {
        const std::size_t n = bodies_.size();
        for (std::size_t j = 0; j < n; ++j) {
            if (j == i || (bodies_[i].ball.is_static && bodies_[j].ball.is_static)) continue;
            if (!may_collide(bodies_[i].ball.filter, bodies_[j].ball.filter)) continue;
            set(std::min(i, j), std::max(i, j), pair_entry(std::min(i, j), std::max(i, j)));
        }
        if (bodies_[i].ball.is_static) return;
        for (std::size_t w = 0; w < walls_.size(); ++w)
            if (may_collide(bodies_[i].ball.filter, walls_[w].filter))
                set(i, n + w, wall_entry(i, walls_[w]));
        for (std::size_t s = 0; s < 4; ++s) set(i, n + walls_.size() + s, side_entry(i, s));
    }

    [[nodiscard]] double tc(double e, const Time& t, const Body& a, const Body& b) const {
        return tc_restitution(e, rules_.clock.difference(t, std::max(a.last_collision, b.last_collision)),
                              rules_.contact_time);
    }

    /// The least speed of separation of a contact that an acceleration presses together.
    [[nodiscard]] double separation(double pressure, double distance) const {
        return pressure > 0 ? pressure / distance * rules_.rest_time / 2 : 0.0;
    }

    void resolve(std::size_t i, std::size_t j, const Entry& event) {
        if (j >= bodies_.size() || bodies_[i].ball.is_static || bodies_[j].ball.is_static) {
            resolve_obstacle(i, j, event);
            return;
        }
        Body& a = bodies_[i];
        Body& b = bodies_[j];
        const Vec2 r = contact_offset(a, &b, event);
        const Vec2 v = a.ball.velocity - b.ball.velocity;
        const double pressure = a.acceleration == b.acceleration
                                    ? 0.0
                                    : -(length_squared(v) + dot<double>(r, a.acceleration - b.acceleration));
        const double e =
            tc(pair_restitution(rules_.rule, a.ball.restitution, b.ball.restitution), event.time, a, b);
        const PairVelocities<double> after =
            collide<double>(a.ball.velocity, b.ball.velocity, r, a.ball.mass, b.ball.mass, e,
                            separation(pressure, std::sqrt(length_squared(r))), nullptr,
                            [this](const Vec2& u) { return held(u); });
        a.ball.velocity = after.a;
        b.ball.velocity = after.b;
        a.last_collision = b.last_collision = event.time;
        predict_row(i);
        predict_row(j);
    }

    /// Moves the bodies to the event and gives centre a less centre b (or the periodic shift alone), as it
    /// was predicted but wrapped.
    Vec2 contact_offset(Body& a, Body* b, const Entry& event) {
        const auto periods = [this](const Vec2& before, const Vec2& after, int axis) {
            return periodic(axis) ? static_cast<int>(std::lround((before[axis] - after[axis]) / length(axis)))
                                  : 0;
        };
        const auto moved = [&](Body& body) {
            const Motion<double> m{body.ball.position, body.ball.velocity, body.acceleration};
            const Vec2 free = position_at(m, rules_.clock.difference(event.time, body.anchor));
            move(body, event.time);
            return std::pair(periods(free, body.ball.position, 0), periods(free, body.ball.position, 1));
        };
        const auto [ax, ay] = moved(a);
        const auto [bx, by] = b != nullptr && !b->ball.is_static ? moved(*b) : std::pair(0, 0);
        const Vec2 s = shift(event.nx - ax + bx, event.ny - ay + by);
        return b != nullptr ? Vec2(a.ball.position - b->ball.position - s) : s;
    }

    void resolve_obstacle(std::size_t i, std::size_t j, const Entry& event) {
        const std::size_t n = bodies_.size();
        const bool with_ball = j < n;
        const bool i_is_static = bodies_[i].ball.is_static;
        const std::size_t mover = i_is_static ? j : i;
        Body& a = bodies_[mover];
        Vec2 normal = Vec2::Zero();
        double e = rules_.domain.restitution;
        bool round = with_ball;
        if (with_ball) {
            Entry seen = event;
            if (i_is_static) seen.nx = -event.nx, seen.ny = -event.ny;
            const Body& still = bodies_[i_is_static ? i : j];
            e = still.ball.restitution;
            normal = i_is_static ? still_first_offset(a, still, seen) : contact_offset(a, &bodies_[j], seen);
        } else if (j < n + walls_.size()) {
            const Wall& wall = walls_[j - n];
            e = wall.restitution;
            const Vec2 s = contact_offset(a, nullptr, event);
            normal = contact_normal<double>(a.ball.position - s, event.feature, wall.from, wall.to);
            round = event.feature != WallFeature::kFace;
        } else {
            const std::size_t side = j - n - walls_.size();
            contact_offset(a, nullptr, event);
            normal[static_cast<Eigen::Index>(side / 2)] = side % 2 == 1 ? -1 : 1;
        }
        e = pair_restitution(rules_.rule, a.ball.restitution, e);
        const bool lasts = tc(0, event.time, a, a) == 1;
        const double lasting = lasts ? 1 : e;
        const double pressure =
            a.acceleration.isZero(0)
                ? 0.0
                : -(dot(normal, a.acceleration) + (round ? length_squared(a.ball.velocity) : 0.0));
        const double factor = lasts ? 1 : rules_.speed_factor;
        a.ball.velocity = bounce<double>(a.ball.velocity, normal, lasting,
                                         separation(pressure, std::sqrt(length_squared(normal))) / factor,
                                         [&](const Vec2& u) { return held(Vec2(u * factor)); });
        a.last_collision = event.time;
        predict_row(mover);
    }

    Vec2 still_first_offset(Body& a, const Body& still, const Entry& seen) {
        const Vec2 s = contact_offset(a, nullptr, seen);  // from the still body's side the signs turn
        return -(still.ball.position - a.ball.position + s);
    }

    BruteForceRules rules_;
    std::vector<Wall> walls_;
    std::vector<Body> bodies_;
    std::size_t partners_;
    std::vector<Entry> table_;
    std::vector<std::size_t> row_best_;
};

}  // namespace carom::stress
