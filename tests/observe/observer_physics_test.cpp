// What an observer measures of gases, against statistical mechanics. Bounds are four standard errors, which
// are estimated from the number of independent values as said at each, and what theory itself leaves out.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <carom/observe/observer.hpp>

#include "accuracy/physics_theory.hpp"
#include "core/table.hpp"

namespace carom {
namespace {

constexpr Boundary kPeriodic = Boundary::kPeriodic;
constexpr Boundary kWall = Boundary::kWall;

/// Discs of diameter 1 and mass 1 at k T = 1.
Scene gas_of(std::uint64_t count, double packing, Boundary x, Boundary y) {
    Scene s;
    const double side = std::sqrt(double(count) * std::numbers::pi / 4 / packing);
    s.domain = Domain{{{0, 0}, {side, side}}, {x, y}, 1};
    Fill fill;
    fill.count = count;
    fill.temperature = 1;
    fill.seed = 7;
    s.fills = {fill};
    s.until = 1;
    return s;
}

struct Means {
    double temperature = 0, pressure = 0, free_path = 0, side_pressure = 0;
    Structure structure;
};

/// Means over `samples` samples `interval` apart, after as long as a fifth of them.
Means measure(const Scene& scene, int samples, double interval) {
    World world(scene, {.threads = 1});
    const double settled = interval * samples / 5;
    world.advance_to(settled);
    Observer observer(world, {.records_collisions = scene.domain->boundary[0] == kWall});
    if (scene.domain->boundary[0] == kWall)
        world.on_collision([&observer](const Collision& c) { observer.record(c); });
    (void)observer.sample(world);
    Means m;
    for (int k = 1; k <= samples; ++k) {
        world.advance_to(settled + k * interval);
        const Sample s = observer.sample(world);
        m.temperature += *s.temperature / samples;
        m.pressure += s.pressure.value_or(0) / samples;
        m.free_path += s.mean_free_path.value_or(0) / samples;
        m.side_pressure += (s.wall_pressure[0].value_or(0) + s.wall_pressure[1].value_or(0)) / 2 / samples;
    }
    m.structure = observer.structure();
    return m;
}

// The pressure of the reference table, and the mean free path 1 / (2 sqrt 2 n sigma chi), chi = (Z - 1) / (2
// eta). 1000 discs for 200 times the interval have 10^5 collisions and more: 0.3 % for the rate, as for the
// pressure's excess, which correlations can double; the mean speed of 1000 discs at one energy is off by
// 0.5 % a sample, by 0.05 % in the mean. Finite size: 1 / N. Four standard errors: 2 %.
TEST(ObserverPhysics, PressureAndFreePathOfThePeriodicGas) {
    for (const test::Row& row : test::read_table("hard_disc_equation_of_state.csv")) {
        const double packing = std::stod(row[0]);
        if (packing > 0.6) continue;  // takes longer to settle
        SCOPED_TRACE(packing);
        const double z = std::stod(row[1]);
        const double density = packing * 4 / std::numbers::pi;
        const Means m = measure(gas_of(1000, packing, kPeriodic, kPeriodic), 200, packing < 0.2 ? 2 : 0.5);
        EXPECT_NEAR(m.pressure / (density * m.temperature), z, 0.02 * z);
        const double chi = (z - 1) / (2 * packing);
        const double path = 1 / (2 * std::numbers::sqrt2 * density * chi);
        EXPECT_NEAR(m.free_path, path, 0.02 * path);
    }
}

// A wall feels the pressure of the gas in the middle of the box, between which and the wall there is
// equilibrium: the equation of state at the density that the profile has there. 2 10^5 hits on walls: 0.2 %;
// the middle's density to 0.3 %, which the pressure's slope makes 0.8 %. Four standard errors: 3 %.
TEST(ObserverPhysics, WallsFeelThePressureOfTheMiddle) {
    const Means m = measure(gas_of(2000, 0.3, kWall, kPeriodic), 200, 1);
    double density = 0;
    for (std::size_t k = 25; k < 75; ++k) density += m.structure.density_x.value[k] / 50;
    const double expected =
        density * m.temperature * accuracy::compressibility(density * std::numbers::pi / 4);
    EXPECT_NEAR(m.side_pressure, expected, 0.03 * expected);
}

double lens(double distance) {
    if (distance >= 2) return 0;
    return 2 * std::acos(distance / 2) - distance / 2 * std::sqrt(4 - distance * distance);
}

// g(r) = 1 + n lens(r) to first order in the density n, lens the area common to two circles of radius sigma.
// The next order is less than 0.006, which is what it is at contact by Henderson's value
// chi = (1 - 7 eta / 16) / (1 - eta)^2 at this packing. A bin has 3000 pairs: 1.8 %, five of them 0.8 %.
TEST(ObserverPhysics, DilutePairsFollowTheLens) {
    const double packing = 0.05;
    const double density = packing * 4 / std::numbers::pi;
    const Means m = measure(gas_of(1000, packing, kPeriodic, kPeriodic), 300, 3);
    const Curve& g = m.structure.radial_distribution;
    ASSERT_EQ(g.at.size(), 100U);
    for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(g.value[k], 0);  // discs do not overlap
    double inner = 0;
    for (std::size_t first = 20; first < 100; first += 5) {
        double deviation = 0;
        for (std::size_t k = first; k < first + 5; ++k)
            deviation += (g.value[k] - 1 - density * lens(g.at[k])) / 5;
        EXPECT_NEAR(deviation, 0, 4 * 0.008 + 0.006) << g.at[first];
        if (first < 40) inner += deviation / 4;
    }
    EXPECT_NEAR(inner, 0, 4 * 0.004 + 0.006);  // without the lens it would be 0.037
}

// To first order in t the velocity autocorrelation of equal discs falls as exp(-rate t), rate that of a
// disc's collisions (Enskog): a collision takes (v . n)(g . n) of v . v, g the relative velocity, in the mean
// over both discs (g . n)^2 / 2, which has the mean 2 k T among collisions, as v . v has. Long before that,
// displacements are ballistic.
TEST(ObserverPhysics, CorrelationsBeginAsEnskogSays) {
    const double packing = 0.1;
    World world(gas_of(4000, packing, kPeriodic, kPeriodic), {.threads = 1});
    world.advance_to(20);
    Observer observer(world, {.lags = 10});
    const double interval = 0.05;
    double t = 0;
    for (int k = 0; k <= 60; ++k) {
        t = 20 + k * interval;
        world.advance_to(t);
        (void)observer.sample(world);
    }
    const Structure s = observer.structure();
    const Curve& velocity = s.velocity_autocorrelation;
    const Curve& displacement = s.mean_square_displacement;
    ASSERT_EQ(velocity.at.size(), 11U);
    const double rate = accuracy::collision_rate(packing);
    for (std::size_t lag = 1; lag <= 10; ++lag) {
        const double x = rate * velocity.at[lag];
        // Second order in x is left, and 4000 discs' worth of collisions: 60 / 10 independent stretches.
        const double noise = 4 * std::sqrt(2 * x / (4000 * 6.0));
        EXPECT_NEAR(velocity.value[lag] / velocity.value[0], std::exp(-x), 0.2 * x * x + noise) << lag;
        const double flight = velocity.value[0] * displacement.at[lag] * displacement.at[lag];
        // The integral of the above, twice: 1 - x / 3 + ...
        EXPECT_NEAR(displacement.value[lag] / flight, 1 - x / 3, 0.15 * x * x + noise) << lag;
    }
}

// A gas over a floor is exp(-m g y / k T) dense, as far as it is ideal: second virial coefficient times
// density at the floor is 0.0025. 200 balls with a collision each 20 units of time in 4000 are 40,000
// independent values; a slice of a tenth of the height has a share p of them and a standard error of
// 1 / sqrt(40,000 p). One energy for 200 balls instead of a temperature: 1 %.
TEST(ObserverPhysics, ColumnIsBarometric) {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {20, 30}}, {kPeriodic, kWall}, 1};
    scene.gravity = {0, -0.1};
    Fill fill;
    fill.count = 200;
    fill.radius_min = fill.radius_max = 0.02;
    fill.temperature = 1;
    scene.fills = {fill};
    scene.until = 1;
    World world(scene, {.threads = 1});
    world.advance_to(400);
    Observer observer(world, {.profile_bins = 10});
    double temperature = 0;
    const int samples = 1000;
    for (int k = 0; k < samples; ++k) {
        world.advance_to(400 + 4.0 * k);
        temperature += *observer.sample(world).temperature / samples;
    }
    const Curve density = observer.structure().density_y;
    const double height = temperature / 0.1;
    const auto below = [&](double y) { return (1 - std::exp(-y / height)) / (1 - std::exp(-30 / height)); };
    for (std::size_t k = 0; k < 10; ++k) {
        const double share = below(3.0 * double(k + 1)) - below(3.0 * double(k));
        const double measured = density.value[k] * 20 * 3 / 200;
        EXPECT_NEAR(measured, share, share * (0.01 + 0.005 + 4 / std::sqrt(40000 * share))) << k;
    }
}

}  // namespace
}  // namespace carom
