// What one question about two bodies costs: time of impact and response, in nanoseconds a query.
//
// Each benchmark asks its question of 65536 random cases in turn, too many for a branch predictor to learn.
// `hits` is the share of cases with an impact; the mixes are those of an engine that asks about neighbours:
// many recede, many pass by.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>
#include <carom/core/disc_time.hpp>
#include <carom/core/response.hpp>
#include <carom/core/wall_time.hpp>

#include "random_inputs.hpp"

namespace carom::bench {
namespace {

constexpr std::size_t kCases = 65536;
constexpr double kRadiusSum = 1;

struct Pair {
    Vec2 offset, velocity, acceleration;
};

struct WallCase {
    Motion<double> motion;
    Vec2 from, to;
};

// Discs one to two radii's sums apart, as neighbours in a grid are.
std::vector<Pair> neighbours() {
    Uniform uniform(1);
    std::vector<Pair> pairs(kCases);
    for (Pair& pair : pairs) pair = {uniform.vector(1, 2), uniform.vector(0.1, 2), uniform.vector(0.1, 2)};
    return pairs;
}

// A ball of radius 0.5 near a wall of length 1 to 4, which it often passes beside.
std::vector<WallCase> near_walls(bool accelerated) {
    Uniform uniform(2);
    std::vector<WallCase> cases(kCases);
    for (WallCase& c : cases) {
        c.motion.position = uniform.vector(0.5, 3);
        c.motion.velocity = uniform.vector(0.1, 2);
        if (accelerated) c.motion.acceleration = uniform.vector(0.1, 2);
        const Vec2 middle = uniform.vector(0, 1), half = uniform.vector(0.5, 2);
        c.from = middle - half;
        c.to = middle + half;
    }
    return cases;
}

// Asks `time_of` of every case, again and again, and reports the time a query.
template <class Case, class TimeOf>
void ask(benchmark::State& state, const std::vector<Case>& cases, TimeOf&& time_of) {
    for ([[maybe_unused]] const auto _ : state) {
        for (const Case& c : cases) benchmark::DoNotOptimize(time_of(c));
    }
    std::size_t hits = 0;
    for (const Case& c : cases) hits += std::isfinite(time_of(c)) ? 1 : 0;
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cases.size()));
    state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(cases.size());
    state.counters["s/query"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(cases.size()),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void impact_disc_quadratic(benchmark::State& state) {
    ask(state, neighbours(),
        [](const Pair& p) { return disc_time_of_impact<double>(p.offset, p.velocity, kRadiusSum); });
}
BENCHMARK(impact_disc_quadratic);

void impact_disc_quartic(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        return disc_time_of_impact<double>(p.offset, p.velocity, p.acceleration, kRadiusSum);
    });
}
BENCHMARK(impact_disc_quartic);

// As an engine asks that has an earlier impact already: most cases end at the first comparison.
void impact_disc_quartic_within_short_duration(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        return disc_time_of_impact<double>(p.offset, p.velocity, p.acceleration, kRadiusSum, 0.1);
    });
}
BENCHMARK(impact_disc_quartic_within_short_duration);

// The price of the seam: the general question of a pair that has no relative acceleration.
void impact_disc_quartic_without_acceleration(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        return disc_time_of_impact<double>(p.offset, p.velocity, Vec2(p.acceleration - p.acceleration),
                                           kRadiusSum);
    });
}
BENCHMARK(impact_disc_quartic_without_acceleration);

void impact_wall(benchmark::State& state) {
    ask(state, near_walls(false), [](const WallCase& c) {
        return wall_time_of_impact<double>(c.motion, kRadiusSum / 2, c.from, c.to).time;
    });
}
BENCHMARK(impact_wall);

void impact_wall_accelerated(benchmark::State& state) {
    ask(state, near_walls(true), [](const WallCase& c) {
        return wall_time_of_impact<double>(c.motion, kRadiusSum / 2, c.from, c.to).time;
    });
}
BENCHMARK(impact_wall_accelerated);

void impact_side(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        return side_time_of_impact<double>(std::abs(p.offset.x()), p.velocity.x(), 0.0);
    });
}
BENCHMARK(impact_side);

void impact_side_accelerated(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        return side_time_of_impact<double>(std::abs(p.offset.x()), p.velocity.x(), p.acceleration.x());
    });
}
BENCHMARK(impact_side_accelerated);

// Approaching and receding pairs half and half; `hits` means nothing here.
void response_collide(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        const PairVelocities<double> after =
            collide<double>(p.velocity, p.acceleration, p.offset, 1.0, 2.0, 0.9);
        return after.a.x() + after.b.y();
    });
}
BENCHMARK(response_collide);

void response_bounce(benchmark::State& state) {
    ask(state, neighbours(), [](const Pair& p) {
        const Vec2 after = bounce<double>(p.velocity, p.offset, 0.9);
        return after.x() + after.y();
    });
}
BENCHMARK(response_bounce);

}  // namespace
}  // namespace carom::bench
