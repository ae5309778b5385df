// Scenes for the engine's tests, built in code: one for each thing that the engine does differently.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::test {

/// Uniform in [low, high), the same everywhere (std's distributions are not).
inline double uniform(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * (double(random() >> 11) * 0x1p-53);
}

inline Vec2 random_velocity(std::mt19937_64& random, double speed) {
    const double x = uniform(random, -speed, speed);
    return {x, uniform(random, -speed, speed)};
}

struct GasOptions {
    std::size_t count = 200;
    double packing = 0.3;
    Boundary boundary_x = Boundary::kPeriodic;
    Boundary boundary_y = Boundary::kPeriodic;
    double restitution = 1;
    double radius_spread = 0;  ///< radii in 0.5 * [1 - spread, 1]
    double speed = 1;
};

/// Balls on a jittered square lattice in a square box that gives the packing (as if all had radius 0.5), at
/// random velocities.
inline Scene gas(std::uint64_t seed, const GasOptions& o) {
    std::mt19937_64 random(seed);
    const double side = std::sqrt(double(o.count) * std::numbers::pi / 4 / o.packing);
    const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(double(o.count))));
    const double pitch = side / double(across);
    Scene s;
    s.name = "gas";
    s.domain = Domain{{{0, 0}, {side, side}}, {o.boundary_x, o.boundary_y}, o.restitution};
    s.until = 10;
    for (std::size_t i = 0; i < o.count; ++i) {
        Ball b;
        b.radius = 0.5 * (1 - o.radius_spread * uniform(random, 0, 1));
        b.mass = o.radius_spread > 0 ? 4 * b.radius * b.radius : 1;
        b.restitution = o.restitution;
        const double play = (pitch - 1) / 2.01;
        const Vec2 jitter = {uniform(random, -play, play), uniform(random, -play, play)};
        b.position = Vec2((double(i % across) + 0.5) * pitch, (double(i / across) + 0.5) * pitch) + jitter;
        b.velocity = random_velocity(random, o.speed);
        s.balls.push_back(b);
    }
    return s;
}

struct NamedScene {
    std::string name;
    Scene scene;
    friend std::ostream& operator<<(std::ostream& out, const NamedScene& s) { return out << s.name; }
};

/// What a parameterised test over such scenes is called.
inline constexpr auto kNameOfScene = [](const auto& test) {
    std::string name = test.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
};

/// The feature space of the event method: 200 balls each.
inline std::vector<NamedScene> feature_scenes() {
    std::vector<NamedScene> all;
    const auto add = [&all](std::string name, Scene scene) {
        all.push_back({std::move(name), std::move(scene)});
    };
    constexpr Boundary kWall = Boundary::kWall;
    constexpr Boundary kOpen = Boundary::kOpen;

    add("elastic periodic", gas(1, {}));
    add("elastic periodic dilute", gas(2, {.packing = 0.02}));
    add("elastic periodic dense", gas(3, {.packing = 0.68}));
    add("elastic walled", gas(4, {.boundary_x = kWall, .boundary_y = kWall}));
    add("periodic by walled", gas(5, {.packing = 0.5, .boundary_y = kWall}));
    add("inelastic periodic", gas(6, {.restitution = 0.8}));
    add("mixed sizes", gas(7, {.packing = 0.5, .radius_spread = 0.8}));
    add("mixed sizes inelastic walled",
        gas(8, {.boundary_x = kWall, .boundary_y = kWall, .restitution = 0.9, .radius_spread = 0.9}));

    // Walls from side to side, and one that sticks out of the box on both sides: more rows of cells than the
    // box has.
    Scene divided = gas(18, {.packing = 0.2, .boundary_x = kWall, .boundary_y = kWall, .radius_spread = 0.5});
    const double side = divided.domain->box.max.x();
    divided.walls = {{{0.2 * side, 0}, {0.75 * side, side}, 1},
                     {{-3 * side, -1.2 * side}, {4 * side, 2.5 * side}, 1}};
    std::erase_if(divided.balls, [&](const Ball& b) {
        return std::ranges::any_of(divided.walls, [&](const Wall& w) {
            const Vec2 d = w.to - w.from;
            return std::abs(cross<double>(b.position - w.from, d)) < 0.6 * std::sqrt(length_squared(d));
        });
    });
    add("walls from side to side", divided);

    // Five balls wider than a cell: the grown ones take the place of those that they would overlap.
    const auto with_large = [](Scene s) {
        for (int k = 0; k < 5; ++k) {
            Ball big;
            big.radius = 1.2 + 0.5 * k;
            big.mass = 10;
            big.position =
                s.domain->box.min + (s.domain->box.max - s.domain->box.min)
                                        .cwiseProduct(Vec2(0.15 + 0.18 * k, k % 2 == 0 ? 0.3 : 0.7));
            big.velocity = {0.5 - 0.2 * k, 0.3};
            std::erase_if(s.balls, [&](const Ball& b) {
                return (b.position - big.position).norm() < b.radius + big.radius + 0.5;
            });
            s.balls.push_back(big);
        }
        return s;
    };
    add("large balls periodic", with_large(gas(16, {.count = 300, .packing = 0.3, .radius_spread = 0.3})));
    Scene large_walled = with_large(gas(
        17, {.count = 300, .packing = 0.3, .boundary_x = kWall, .boundary_y = kWall, .restitution = 0.9}));
    large_walled.gravity = {0.1, -0.3};
    large_walled.walls = {{{0.3, 0.3}, {0.3, 2}, 1}};
    std::erase_if(large_walled.balls, [](const Ball& b) {
        return b.position.x() < 2 * b.radius + 0.3 && b.position.y() < 2 + b.radius;
    });
    add("large balls walled under gravity", large_walled);

    Scene gravity = gas(9, {.packing = 0.2, .boundary_y = kWall});
    gravity.gravity = {0, -0.5};
    add("gravity", gravity);

    Scene slanted_gravity = gas(10, {.packing = 0.3,
                                     .boundary_x = kWall,
                                     .boundary_y = kWall,
                                     .restitution = 0.85,
                                     .radius_spread = 0.5});
    slanted_gravity.gravity = {0.3, -0.7};
    slanted_gravity.restitution_rule = RestitutionRule::kProduct;
    add("slanted gravity inelastic mixed walled", slanted_gravity);

    Scene own = gas(11, {.packing = 0.2, .boundary_x = kWall, .boundary_y = kWall});
    for (std::size_t i = 0; i < own.balls.size(); i += 3)
        own.balls[i].acceleration = {0.2 * double(i % 5) - 0.4, 0.1 * double(i % 7) - 0.3};
    own.gravity = {0, -0.1};
    add("own accelerations", own);

    // Every seventh ball nailed down and grown a little; walls of several slants in the gaps that others
    // left.
    const auto furnish = [](Scene s) {
        std::vector<Ball> kept;
        for (std::size_t i = 0; i < s.balls.size(); ++i) {
            Ball b = s.balls[i];
            if (i % 7 == 0) {
                b.is_static = true;
                b.velocity = Vec2::Zero();
            }
            if (i % 9 == 4) {
                const double angle = 0.7 * double(i);
                const Vec2 half = 0.45 * Vec2(std::cos(angle), std::sin(angle));
                s.walls.push_back({b.position - half, b.position + half, b.restitution});
                continue;
            }
            kept.push_back(b);
        }
        s.balls = kept;
        return s;
    };
    add("static balls and walls periodic", furnish(gas(12, {.packing = 0.3})));
    add("static balls and walls in the open",
        furnish(gas(13, {.packing = 0.3, .boundary_x = kOpen, .boundary_y = kOpen})));
    Scene pins = furnish(gas(14, {.packing = 0.25, .boundary_y = kWall, .restitution = 0.7}));
    pins.gravity = {0, -1};
    pins.speed_factor = 0.95;
    add("static balls and walls under gravity with losses", pins);
    Scene swept = furnish(gas(15, {.packing = 0.25, .radius_spread = 0.4}));
    for (std::size_t i = 1; i < swept.balls.size(); i += 2)
        if (!swept.balls[i].is_static) swept.balls[i].acceleration = {0.05, -0.05};
    add("static balls and walls with own accelerations", swept);

    // Three kinds: the first meets all, the second not its own kind, the third no walls and not the second.
    Scene kinds = furnish(gas(16, {.packing = 0.3, .boundary_y = kWall}));
    for (std::size_t i = 0; i < kinds.balls.size(); ++i) {
        constexpr std::array<CollisionFilter, 3> kKinds = {{{1, 0xff}, {2, 0xff - 2}, {4, 0xff - 2 - 8}}};
        kinds.balls[i].filter = kKinds[i % 3];
    }
    for (Wall& wall : kinds.walls) wall.filter.category = 8;
    add("categories and masks", kinds);

    const auto in_float = [](Scene s) {
        s.precision = Precision::kFloat;
        for (Ball& b : s.balls) {  // as World does: the scales follow from what it simulates
            b.position = rounded_to_float(b.position);
            b.velocity = rounded_to_float(b.velocity);
        }
        return s;
    };
    add("in float elastic periodic dense", in_float(gas(3, {.packing = 0.68})));
    add("in float slanted gravity inelastic mixed walled", in_float(slanted_gravity));
    add("in float static balls and walls under gravity with losses", in_float(pins));
    add("in float static balls and walls with own accelerations", in_float(swept));
    add("in float large balls walled under gravity", in_float(large_walled));
    return all;
}

/// The feature scenes and two with attractors, whose field is held constant for a while.
inline std::vector<NamedScene> all_scenes() {
    std::vector<NamedScene> all = feature_scenes();
    Scene holes = gas(
        21,
        {.packing = 0.1, .boundary_x = Boundary::kWall, .boundary_y = Boundary::kWall, .radius_spread = 0.5});
    holes.attractors = {{{10, 10}, 20, 1}, {{25, 30}, 10, 0.5}};
    holes.gravity = {0, -0.2};
    all.push_back({"attractors walled", holes});
    Scene open = gas(
        22,
        {.packing = 0.1, .boundary_x = Boundary::kOpen, .boundary_y = Boundary::kOpen, .restitution = 0.8});
    open.attractors = {{{20, 20}, 30, 1}};
    open.field_interval = 0.05;
    all.push_back({"attractor in the open inelastic", open});
    return all;
}

/// The same scenes under the empirical method, with steps of three kinds.
inline std::vector<NamedScene> by_steps(std::vector<NamedScene> scenes) {
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        Scene& s = scenes[k].scene;
        s.method = Method::kEmpirical;
        if (k % 3 != 0) s.step = 0.07;
        if (k % 3 == 2) s.max_travel = 0.1;
    }
    return scenes;
}

}  // namespace carom::test
