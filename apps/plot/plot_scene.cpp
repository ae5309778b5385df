#include "plot_scene.hpp"

#include <algorithm>
#include <cmath>

#include "statistics.hpp"

namespace carom::app {
namespace {

constexpr int kSamples = 200;
constexpr int kStatistics = 20;  // samples for distributions, in the second half

/// g(r) is of interest over some diameters, and defined up to half of a periodic box; between walls it needs
/// room for balls that far inside.
double reach_of(const std::vector<Ball>& balls, const Domain& domain) {
    double radii = 0;
    double moving = 0;
    for (const Ball& ball : balls) {
        if (ball.is_static) continue;
        radii += ball.radius;
        moving += 1;
    }
    const double diameter = moving > 0 ? 2 * radii / moving : 1;
    const Vec2 extent = domain.box.max - domain.box.min;
    double reach = 5 * diameter;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const bool is_periodic = domain.boundary[axis] == Boundary::kPeriodic;
        reach = std::min(reach, extent[Eigen::Index(axis)] / (is_periodic ? 2 : 4));
    }
    return reach;
}

class Recorder {
 public:
    Recorder(const World& world, const Scene& scene)
        : world_(world),
          has_gravity_(!scene.gravity.isZero(0)),
          reach_(reach_of(world.balls(), world.domain())),
          distances_(world.domain(), reach_, 100),
          speeds_(45) {}

    void sample() {
        const double time = world_.time();
        const Counts counts = world_.counts();
        const double collisions = double(counts.ball_collisions + counts.wall_collisions);
        const double kinetic = world_.kinetic_energy();
        energy_.emplace_back(time, world_.energy());
        kinetic_.emplace_back(time, kinetic);
        if (const double passed = time - last_time_; passed > 0) {
            const double moving = double(world_.ball_count());
            const double middle = time - passed / 2;
            rate_.emplace_back(middle, (collisions - last_collisions_) / (passed * moving));
            // The virial's growth over the stretch, as World::compressibility_factor has it since time 0.
            if (world_.compressibility_factor())
                pressure_.emplace_back(middle, 1 + (world_.virial() - last_virial_) * (moving - 1) /
                                                       (2 * moving * kinetic * passed));
        }
        last_time_ = time;
        last_collisions_ = collisions;
        last_virial_ = world_.virial();
    }
    void sample_distributions() {
        const std::vector<Ball> balls = world_.balls();
        distances_.add(balls);
        speeds_.add(balls);
    }

    [[nodiscard]] std::vector<PlotPanel> panels() const {
        std::vector<PlotPanel> panels;
        panels.push_back({"time", "energy", true, {{has_gravity_ ? "with potential" : "", energy_}}});
        if (has_gravity_) panels[0].curves.push_back({"kinetic", kinetic_});
        panels.push_back({"time", "collisions a ball and unit of time", true, {{"", rate_}}});
        if (!pressure_.empty()) panels.push_back({"time", "pressure PA / NkT", false, {{"", pressure_}}});
        if (const auto points = distances_.points(); !points.empty()) {
            const Curve one{"", {{0, 1}, {reach_, 1}}, true};
            panels.push_back({"r", "g(r)", true, {one, {"", points}}});
        }
        if (const auto points = speeds_.points(); !points.empty()) {
            Curve maxwell{"Maxwell", {}, true};
            for (int i = 0; i <= 200; ++i) {
                const double speed = SpeedHistogram::kReach * i / 200;
                maxwell.points.emplace_back(speed, maxwell_speed_density(speed));
            }
            panels.push_back({"speed / \u221a(T/m)",
                              "density of speeds",
                              true,
                              {{"measured", points, false, true}, maxwell}});
        }
        return panels;
    }

 private:
    const World& world_;
    bool has_gravity_;
    double reach_;
    std::vector<Vec2> energy_, kinetic_, rate_, pressure_;
    RadialDistribution distances_;
    SpeedHistogram speeds_;
    double last_time_ = 0;
    double last_collisions_ = 0;
    double last_virial_ = 0;
};

}  // namespace

std::optional<Plot> plot_of(World& world, const Scene& scene, double until, Driver& driver) {
    Recorder recorder(world, scene);
    for (int k = 0; k <= kSamples; ++k) {
        if (!driver.advance_to(until * k / kSamples)) return std::nullopt;
        recorder.sample();
        if (k > kSamples / 2 && k % (kSamples / 2 / kStatistics) == 0) recorder.sample_distributions();
    }
    return Plot{scene.name, recorder.panels()};
}

}  // namespace carom::app
