// The barometric profile of a gas over a floor, dilute and dense.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "accuracy/physics_column.hpp"
#include "accuracy/physics_run.hpp"

namespace carom::accuracy {
namespace {

constexpr int kHeightClasses = 32;
constexpr double kColumnRelaxation = 4000;  // collisions of a disc at the floor: the slowest sound dies away

/// Heights of an ideal gas over a floor, of N discs of energy E, of which a height takes m g h: the others
/// share the rest in N - 1 heights and 2 N - 1 velocities, so that P(h' > h) = (1 - m g h / E)^(2 N - 3/2).
struct IdealHeights {
    double top, power;  ///< E / (m g), the exponent

    [[nodiscard]] double mean() const { return top / (power + 1); }
    [[nodiscard]] double mean_square() const { return 2 * top * mean() / (power + 2); }
    /// Ends of equally probable classes.
    [[nodiscard]] std::vector<double> class_ends() const {
        std::vector<double> ends;
        for (int k = 1; k < kHeightClasses; ++k)
            ends.push_back(top * -std::expm1(std::log1p(-static_cast<double>(k) / kHeightClasses) / power));
        return ends;
    }
};

/// Moments of the heights over the floor at each look, and all of them in classes.
class Heights {
 public:
    explicit Heights(const IdealHeights& ideal) : ideal_(ideal), classes_(ideal.class_ends()) {}

    void look(const World& world) {
        double first = 0, second = 0;
        for (const Vec2& x : world.positions()) {
            const double height = x.y() - 0.5;
            first += height;
            second += height * height;
            classes_.count(height);
        }
        first_.push_back(first / static_cast<double>(world.ball_count()));
        second_.push_back(second / static_cast<double>(world.ball_count()));
    }

    /// `interaction`: what the discs' size changes, relative.
    void append(std::vector<Figure>& figures, const std::string& system, double interaction) const {
        // The sum of the heights fluctuates half as much at given energy as it does at given temperature.
        const double freedom = kHeightClasses - 1 - 0.5;
        figures.push_back({"mean height over that of an ideal gas", system,
                           scaled(mean_of(first_), 1 / ideal_.mean()), 1, interaction});
        figures.push_back({"mean squared height over that of an ideal gas", system,
                           scaled(mean_of(second_), 1 / ideal_.mean_square()), 1, 2 * interaction});
        figures.push_back(
            {fmt::format("chi-square of {:.0f} heights in {} classes", classes_.total(), kHeightClasses),
             system,
             {classes_.chi_square(), std::sqrt(2 * freedom)},
             freedom,
             0.5});
    }

 private:
    IdealHeights ideal_;
    EqualClasses classes_;
    std::vector<double> first_, second_;
};

/// What is seen of some heights in a dense column.
class Profile {
 public:
    explicit Profile(const std::vector<double>& heights) {
        for (const double height : heights) levels_.push_back({height, {}, {}});
    }

    void look(const World& world) {
        const PlaneVectors positions = world.positions();
        for (Level& level : levels_) {
            double over = 0, around = 0;
            for (const Vec2& x : positions) {
                over += x.y() > level.height ? 1 : 0;
                around += std::abs(x.y() - level.height) < kSlab / 2 ? 1 : 0;
            }
            level.above.push_back(over);
            level.near.push_back(around);
        }
        // Momentum is kept along the floor only.
        temperature_.push_back(2 * world.kinetic_energy() / static_cast<double>(2 * world.ball_count() - 1));
    }

    void append(std::vector<Figure>& figures, const Column& column, std::size_t discs) const {
        for (const Level& level : levels_) figures.push_back(figure(level, column, discs));
    }

 private:
    static constexpr double kSlab = 2;
    struct Level {
        double height;
        std::vector<double> above, near;  ///< discs above it and in the slab around it
    };

    /// The pressure is exactly the weight above per width. Over n k T that is the local Z, to be compared
    /// with the fluid's of the local packing. The error is that of the difference, to first order in density
    /// and temperature.
    [[nodiscard]] Figure figure(const Level& level, const Column& column, std::size_t discs) const {
        const double area = column.width() * kSlab;
        const double density = mean_of(level.near).value / area;
        const double warmth = mean_of(temperature_).value;
        const double packing = density * std::numbers::pi / 4;
        const double z = compressibility(packing);
        const double dp_dn = warmth * stiffness(packing);
        std::vector<double> differences(level.above.size()), pressures(level.above.size());
        for (std::size_t i = 0; i < level.above.size(); ++i) {
            pressures[i] = level.above[i] / (column.scale_height() * column.width());
            differences[i] = pressures[i] - dp_dn * level.near[i] / area - density * z * temperature_[i];
        }
        Estimate measured = scaled(mean_of(differences), 1 / (density * warmth));
        measured.value = mean_of(pressures).value / (density * warmth);
        // The density changes over the length dP/dn / (m g): the gradient's own effect is of second order in
        // a diameter over it. The temperature is known to 1 / N.
        const double length = column.scale_height() * dp_dn;
        const std::string system =
            fmt::format("{} discs over a floor, packing {:.3f} at height {}", discs, packing, level.height);
        return {"local Z from the weight above", system, measured, z,
                z * (1 / (length * length) + 1 / static_cast<double>(discs))};
    }

    std::vector<Level> levels_;
    std::vector<double> temperature_;
};

std::string column_name(const GasRun& run) {
    return fmt::format("{} discs over a floor, packing {} there", run.discs, run.packing);
}

}  // namespace

// Width and scale height are about equal: density times their product is N.
std::vector<Figure> dilute_column(const GasRun& run) {
    const auto discs = static_cast<double>(run.discs);
    const double scale_height = std::sqrt(discs / (run.packing * 4 / std::numbers::pi));
    const Column column(run.discs, run.packing, scale_height, scale_height / 5);
    World world(column.scene(run.seed), run.options);
    const double rate = collision_rate(run.packing) / 2;  // the density that a disc meets is half the floor's
    constexpr double kBetweenLooks = 5;                   // collisions of a disc, and some falls
    world.advance_to(10 * kBetweenLooks / rate);
    Load load(world);  // NOLINT(misc-const-correctness): its listener counts
    // The lowest place of a centre is a radius above the floor.
    const double top = world.energy() * scale_height - discs * 0.5;
    Heights heights({top, 2 * discs - 1.5});
    run_blocks(world, static_cast<int>(run.collisions / kBetweenLooks), kBetweenLooks / rate,
               [&] { heights.look(world); });
    std::vector<Figure> figures = load.figures(column, column_name(run));
    // P = k T (n + B n^2) with B n = 2 eta at the floor lifts the mean by half of that.
    heights.append(figures, column_name(run), run.packing);
    return figures;
}

std::vector<Figure> dense_column(const GasRun& run) {
    const Column column(run.discs, run.packing, 10, 10);
    World world(column.scene(run.seed), run.options);
    const double rate = collision_rate(run.packing);
    world.advance_to(kColumnRelaxation / rate);
    Load load(world);  // NOLINT(misc-const-correctness): its listener counts
    Profile profile({8, 14, 20, 27, 35, 45});
    run_blocks(world, static_cast<int>(run.collisions), 1 / rate, [&] { profile.look(world); });
    std::vector<Figure> figures = load.figures(column, column_name(run));
    profile.append(figures, column, run.discs);
    return figures;
}

}  // namespace carom::accuracy
