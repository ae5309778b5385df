// The baseline against brute force, its own reversal, conservation laws, and the exact result for two discs.
#include "plain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "gas.hpp"

namespace carom {
namespace {

using Vector = PlainSimulation::Vector;

// Every pair and its nine nearest images, every disc moved at every event: no cells, no queue, no partners.
class BruteForce {
 public:
    explicit BruteForce(const plain::Gas& gas) : side_(gas.side), x_(gas.positions), v_(gas.velocities) {}

    PlainEvent resolve_next() {
        Hit next;
        for (std::uint32_t i = 0; i < x_.size(); ++i) {
            for (std::uint32_t j = i + 1; j < x_.size(); ++j) {
                for (int image = 0; image < 9; ++image) consider(i, j, image % 3 - 1, image / 3 - 1, next);
            }
        }
        for (std::size_t k = 0; k < x_.size(); ++k) {
            for (int c = 0; c < 2; ++c) x_[k][c] = std::fmod(x_[k][c] + v_[k][c] * next.after + side_, side_);
        }
        time_ += next.after;
        Vector r = {x_[next.i][0] - x_[next.j][0], x_[next.i][1] - x_[next.j][1]};
        for (double& c : r) c -= side_ * std::round(c / side_);
        const double along =
            (r[0] * (v_[next.i][0] - v_[next.j][0]) + r[1] * (v_[next.i][1] - v_[next.j][1])) /
            (r[0] * r[0] + r[1] * r[1]);
        for (int c = 0; c < 2; ++c) {
            v_[next.i][c] -= along * r[c];
            v_[next.j][c] += along * r[c];
        }
        return {time_, next.i, next.j};
    }

 private:
    struct Hit {
        double after = std::numeric_limits<double>::infinity();
        std::uint32_t i = 0, j = 0;
    };

    void consider(std::uint32_t i, std::uint32_t j, int image_x, int image_y, Hit& next) const {
        const double rx = x_[i][0] - x_[j][0] + image_x * side_, ry = x_[i][1] - x_[j][1] + image_y * side_;
        const double wx = v_[i][0] - v_[j][0], wy = v_[i][1] - v_[j][1];
        const double b = rx * wx + ry * wy, a = wx * wx + wy * wy, c = rx * rx + ry * ry - 1;
        if (b >= 0 || b * b - a * c < 0) return;
        const double after = std::max(0.0, (-b - std::sqrt(b * b - a * c)) / a);
        if (after < next.after) next = {after, i, j};
    }

    double side_;
    std::vector<Vector> x_, v_;
    double time_ = 0;
};

PlainSimulation simulation_of(const plain::Gas& gas) {
    return {gas.positions, gas.velocities, 1.0, gas.side};
}

double nearest(double d, double side) {
    return d - side * std::round(d / side);
}

// Smallest distance of two centres, over all pairs.
double smallest_distance(const std::vector<Vector>& positions, double side) {
    double smallest_squared = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double dx = nearest(positions[i][0] - positions[j][0], side);
            const double dy = nearest(positions[i][1] - positions[j][1], side);
            smallest_squared = std::min(smallest_squared, dx * dx + dy * dy);
        }
    }
    return std::sqrt(smallest_squared);
}

struct Setting {
    double packing;
    double collisions_a_disc;  // few enough for chaos to stay below the tolerance
    std::uint64_t seed;
};

class PlainGas : public testing::TestWithParam<Setting> {};

// Errors grow as exp(lambda k) in k collisions a disc, lambda = 4.3, 1.2, 0.5 at packing 0.05, 0.30, 0.60,
// and the unluckiest discs have several times the mean. From 1e-15 that stays below 1e-6; one wrong event is
// off by a mean free time or path, which is above 1e-3 here.
TEST_P(PlainGas, HasTheEventsOfBruteForce) {
    SCOPED_TRACE("seed " + std::to_string(GetParam().seed));
    const plain::Gas gas = plain::make_gas(64, GetParam().packing, GetParam().seed);
    PlainSimulation simulation = simulation_of(gas);
    std::vector<PlainEvent> log;
    simulation.log_to(&log);
    simulation.run_events(static_cast<std::uint64_t>(32 * GetParam().collisions_a_disc));
    BruteForce oracle(gas);
    for (const PlainEvent& event : log) {
        const PlainEvent expected = oracle.resolve_next();
        ASSERT_EQ(event.i, expected.i);
        ASSERT_EQ(event.j, expected.j);
        ASSERT_NEAR(event.time, expected.time, 1e-6);
    }
}

TEST_P(PlainGas, RunsBackToItsStart) {
    SCOPED_TRACE("seed " + std::to_string(GetParam().seed));
    const plain::Gas gas = plain::make_gas(1024, GetParam().packing, GetParam().seed);
    PlainSimulation simulation = simulation_of(gas);
    std::vector<PlainEvent> log;
    simulation.log_to(&log);
    simulation.run_events(static_cast<std::uint64_t>(512 * std::min(1.0, GetParam().collisions_a_disc)));
    const double turned = simulation.time();
    // An instant later, so that the last pair has parted and is the first to meet again.
    simulation.advance_to(std::nextafter(turned, 2 * turned));
    const std::size_t forward = log.size();
    simulation.reverse();
    simulation.advance_to(2 * simulation.time());

    ASSERT_EQ(log.size(), 2 * forward);
    for (std::size_t k = 0; k < forward; ++k) {
        EXPECT_EQ(log[k].i, log[2 * forward - 1 - k].i);
        EXPECT_EQ(log[k].j, log[2 * forward - 1 - k].j);
    }
    const std::vector<Vector> back = simulation.positions();
    for (std::size_t i = 0; i < back.size(); ++i) {
        EXPECT_NEAR(nearest(back[i][0] - gas.positions[i][0], gas.side), 0, 1e-6);
        EXPECT_NEAR(nearest(back[i][1] - gas.positions[i][1], gas.side), 0, 1e-6);
    }
}

// A position below 100 carries an error of some 1e-14 an event, and contact is solved from it; a missed
// collision overlaps by 1e-2.
TEST_P(PlainGas, NeverOverlapsAndConserves) {
    SCOPED_TRACE("seed " + std::to_string(GetParam().seed));
    const plain::Gas gas = plain::make_gas(64, GetParam().packing, GetParam().seed);
    PlainSimulation simulation = simulation_of(gas);
    const double energy = simulation.kinetic_energy();
    for (int audit = 0; audit < 300; ++audit) {
        simulation.run_events(61);
        ASSERT_GT(smallest_distance(simulation.positions(), gas.side), 1 - 1e-11) << "audit " << audit;
    }
    // a random walk of 2 * 18,300 roundings of a few ulp of one disc's share
    EXPECT_NEAR(simulation.kinetic_energy() / energy, 1, 1e-12);
    Vector momentum = {0, 0};
    for (const Vector& v : simulation.velocities()) momentum = {momentum[0] + v[0], momentum[1] + v[1]};
    EXPECT_NEAR(momentum[0], 0, 1e-11);
    EXPECT_NEAR(momentum[1], 0, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Packings, PlainGas,
                         testing::Values(Setting{0.01, 0.25, 11}, Setting{0.05, 1, 12}, Setting{0.2, 2, 13},
                                         Setting{0.3, 4, 14}, Setting{0.5, 5, 15}, Setting{0.6, 8, 16},
                                         Setting{0.7, 8, 17}, Setting{0.75, 8, 18}));

// Z = (1 - eta) / (1 - 2 eta) for two discs without momentum, whatever the box (reduced to one point outside
// a disc of radius 1 in a box, it is the ratio of free perimeter to free area). 40 runs give the mean's own
// standard error; 5 of them is the bound.
TEST(PlainTwoDiscs, HasTheExactEquationOfState) {
    for (const double packing : {0.02, 0.10, 0.17}) {
        const double side = std::sqrt(2 * std::acos(-1.0) / 4 / packing);
        double sum = 0, sum_of_squares = 0;
        constexpr int kRuns = 40;
        for (int run = 0; run < kRuns; ++run) {
            const double angle = 0.03 + 0.61 * run, offset = 1.5 + 0.0131 * run;
            const std::vector<Vector> velocities = {{std::cos(angle), std::sin(angle)},
                                                    {-std::cos(angle), -std::sin(angle)}};
            PlainSimulation simulation({{0.2, 0.3}, {0.2 + side / 2, 0.3 + offset / 3 * side / 2}},
                                       velocities, 1.0, side);
            simulation.run_events(20000);
            const double z = 1 + simulation.virial() / (4 * simulation.kinetic_energy() * simulation.time());
            sum += z, sum_of_squares += z * z;
        }
        const double mean = sum / kRuns, variance = (sum_of_squares / kRuns - mean * mean) / (kRuns - 1);
        EXPECT_NEAR(mean, (1 - packing) / (1 - 2 * packing), 5 * std::sqrt(variance))
            << "packing " << packing;
        EXPECT_LT(std::sqrt(variance), 0.005) << "the estimate is too coarse to say anything";
    }
}

TEST(PlainSimulation, StopsAtTheTimeAskedFor) {
    const std::vector<Vector> velocities = {{1, 0}, {-1, 0}};
    PlainSimulation simulation({{2, 5}, {8, 5}}, velocities, 1.0, 10);
    simulation.advance_to(1.25);
    EXPECT_EQ(simulation.time(), 1.25);
    EXPECT_EQ(simulation.positions()[0][0], 3.25);
    EXPECT_EQ(simulation.collisions(), 0U);
    simulation.advance_to(2.5);  // the gap of 5 closes at speed 2
    EXPECT_EQ(simulation.collisions(), 1U);
    EXPECT_EQ(simulation.velocities()[0][0], -1);
    EXPECT_EQ(simulation.virial(), 2);
}

TEST(PlainSimulation, RunsNoEventsWhereNothingMeets) {
    const std::vector<Vector> velocities = {{0, 0}, {0, 0}};
    PlainSimulation simulation({{2, 5}, {8, 5}}, velocities, 1.0, 10);
    EXPECT_EQ(simulation.run_events(5), 0U);
}

TEST(PlainSimulation, RefusesWhatItCannotRun) {
    using Discs = std::vector<Vector>;
    EXPECT_THROW(PlainSimulation(Discs{}, Discs{}, 1, 10), std::invalid_argument);
    EXPECT_THROW(PlainSimulation(Discs{{1, 1}}, Discs{}, 1, 10), std::invalid_argument);
    EXPECT_THROW(PlainSimulation(Discs{{1, 1}}, Discs{{0, 0}}, 1, 2.9), std::invalid_argument);
    EXPECT_THROW(PlainSimulation(Discs{{1, 1}}, Discs{{0, 0}}, -1, 10), std::invalid_argument);
    EXPECT_THROW(PlainSimulation(Discs{{1, NAN}}, Discs{{0, 0}}, 1, 10), std::invalid_argument);
    EXPECT_THROW(PlainSimulation(Discs(8, Vector{1, 1}), Discs(8, Vector{0, 0}), 1, 10),
                 std::invalid_argument);
    EXPECT_THROW(plain::make_gas(100, 0.9), std::invalid_argument);
}

TEST(Tournament, KnowsTheEarliestOfManyChangingTimes) {
    for (const std::uint32_t leaves : {1U, 7U, 8U, 9U, 65U, 700U}) {
        plain::Tournament tournament(leaves);
        std::vector<double> times(leaves, std::numeric_limits<double>::infinity());
        EXPECT_EQ(tournament.earliest(), 0U);
        std::mt19937_64 random(leaves);
        for (int change = 0; change < 5000; ++change) {
            const auto leaf = static_cast<std::uint32_t>(random() % leaves);
            times[leaf] = static_cast<double>(random() % 200);  // with ties
            tournament.set(leaf, times[leaf]);
            const auto first = std::min_element(times.begin(), times.end());
            ASSERT_EQ(tournament.earliest(), static_cast<std::uint32_t>(first - times.begin()));
            ASSERT_EQ(tournament.earliest_time(), *first);
            ASSERT_EQ(tournament.time(leaf), times[leaf]);
        }
    }
}

}  // namespace
}  // namespace carom
