// The distribution of velocities that collisions lead to.
#include <fmt/format.h>

#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "accuracy/physics_run.hpp"
#include "core/random.hpp"

namespace carom::accuracy {
namespace {

constexpr int kVelocityClasses = 64;

/// The same gas with speeds that are all equal, but for the total momentum.
Scene with_equal_speeds(Scene scene, std::uint64_t seed) {
    scene.balls = World(scene, {.threads = 1}).balls();
    scene.fills.clear();
    test::Random random(seed);
    Vec2 sum = Vec2::Zero();
    for (Ball& b : scene.balls) sum += b.velocity = random.direction(std::sqrt(2.0));
    for (Ball& b : scene.balls) b.velocity -= sum / static_cast<double>(scene.balls.size());
    return scene;
}

/// Upper ends of the classes but the last, for a component v of N velocities without total momentum: v =
/// sqrt(1 - 1/N) R u with u a component of a unit vector in D = 2 (N - 1) dimensions, and u^2 has the
/// distribution Beta(1/2, (D - 1) / 2).
std::vector<double> class_ends(std::size_t discs, double energy) {
    const double dimensions = 2 * static_cast<double>(discs - 1);
    const double reach = std::sqrt(2 * energy * (1 - 1 / static_cast<double>(discs)));
    std::vector<double> ends;
    for (int k = 1; k < kVelocityClasses; ++k) {
        const double centred = 2.0 * k / kVelocityClasses - 1;  // probability of |v| below, with v's sign
        const double square = boost::math::ibeta_inv(0.5, (dimensions - 1) / 2, std::abs(centred));
        ends.push_back(std::copysign(reach * std::sqrt(square), centred));
    }
    return ends;
}

/// Mean of the fourth powers over the square of that of the squares.
double kurtosis(const PlaneVectors& velocities) {
    double second = 0, fourth = 0;
    for (const Vec2& v : velocities)
        for (const double x : {v.x(), v.y()}) {
            second += x * x;
            fourth += x * x * x * x;
        }
    return fourth * 2 * static_cast<double>(velocities.size()) / (second * second);
}

/// Energy and momentum are the same at each look, which fixes two of the sums that the classes make, those of
/// v and v^2, to within a twentieth for classes as fine as these; the others it changes by about 1 / N.
Figure chi_square(const GasRun& run, const EqualClasses& classes) {
    const double freedom = kVelocityClasses - 1 - 2;
    return {fmt::format("chi-square of {:.0f} velocity components in {} classes", classes.total(),
                        kVelocityClasses),
            system_name(run),
            {classes.chi_square(), std::sqrt(2 * freedom)},
            freedom,
            0.1 + freedom / static_cast<double>(run.discs)};
}

}  // namespace

std::vector<Figure> maxwell_distribution(const GasRun& run) {
    World world(with_equal_speeds(filled_box(run, kEqualDiscs, Boundary::kPeriodic), run.seed), run.options);
    const double rate = collision_rate(run.packing);
    constexpr double kRelaxation = 50;  // collisions of a disc
    world.advance_to(kRelaxation / rate);
    EqualClasses classes(class_ends(run.discs, world.kinetic_energy()));
    std::vector<double> kurtoses;
    // Collisions of a disc between two looks. What is left of its velocity, some e^-2, enters chi-square by
    // its sixth power, for the moments that energy and momentum do not fix are the third and higher ones.
    constexpr double kBetweenLooks = 5;
    run_blocks(world, static_cast<int>(run.collisions / kBetweenLooks), kBetweenLooks / rate, [&] {
        const PlaneVectors velocities = world.velocities();
        kurtoses.push_back(kurtosis(velocities));
        for (const Vec2& v : velocities)
            for (const double x : {v.x(), v.y()}) classes.count(x);
    });
    const double dimensions = 2 * static_cast<double>(run.discs - 1);
    return {chi_square(run, classes),
            {"kurtosis of the velocity components", system_name(run), mean_of(kurtoses),
             3 * dimensions / (dimensions + 2), 0}};
}

}  // namespace carom::accuracy
