// Gas over a floor under gravity: the floor's load and the barometric profile.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "accuracy/physics_run.hpp"

namespace carom::accuracy {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kColumnRelaxation = 4000;  // collisions of a disc at the floor: the slowest sound dies away

/// Discs over a floor at y = 0, periodic in x, with k T = 1 and near their equilibrium from the start: put
/// down in layers, each with the density that it has at rest.
class Column {
 public:
    Column(const GasRun& run, double floor_packing, double scale_height, double layer)
        : scale_height_(scale_height), layer_(layer) {
        // dP/dh = -m g n with P = n k T Z: d eta/dh = -eta / (H (Z + eta Z')).
        constexpr int kSteps = 1000;
        double packing = floor_packing, sum = 0;
        while (packing > 1e-6 * floor_packing) {
            double filled = 0;
            for (int k = 0; k < kSteps; ++k) {
                const double step = layer / kSteps;
                filled += packing * 4 / kPi * step;
                packing -= step * packing / (scale_height * stiffness(packing));
            }
            per_width_.push_back(filled);
            sum += filled;
        }
        width_ = static_cast<double>(run.discs) / sum;
    }

    [[nodiscard]] Scene scene(const GasRun& run) const {
        Scene s;
        const double top = layer_ * static_cast<double>(per_width_.size()) + kAbove * scale_height_;
        s.domain = Domain{{{0, 0}, {width_, top}}, {Boundary::kPeriodic, Boundary::kWall}, 1};
        s.gravity = {0, -1 / scale_height_};
        s.until = 1;
        double sum = 0;
        std::uint64_t placed = 0;
        for (std::size_t k = 0; k < per_width_.size(); ++k) {
            sum += per_width_[k] * width_;
            const auto end = k + 1 < per_width_.size() ? static_cast<std::uint64_t>(sum + 0.5) : run.discs;
            if (end > placed)
                s.fills.push_back(fill(end - placed, static_cast<double>(k) * layer_, run.seed));
            placed = std::max(placed, end);
        }
        return s;
    }

    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double scale_height() const { return scale_height_; }  ///< k T / (m g) at k T = 1

    /// dP/dn over k T.
    static double stiffness(double packing) {
        return compressibility(packing) + packing * compressibility_slope(packing);
    }

 private:
    static constexpr double kAbove = 20;  // the ceiling, in scale heights

    [[nodiscard]] Fill fill(std::uint64_t count, double bottom, std::uint64_t seed) const {
        Fill f;
        f.count = count;
        f.region = Box{{0, bottom}, {width_, bottom + layer_}};
        f.temperature = 1;
        f.seed = seed;
        return f;
    }

    double scale_height_, layer_, width_;
    std::vector<double> per_width_;  ///< discs of each layer
};

/// What floor and ceiling take up while it lives.
class Load {
 public:
    explicit Load(World& world) : world_(world), start_(world.time()), before_(world.momentum().y()) {
        world_.on_collision([this](const Collision& c) {
            if (c.kind == CollisionKind::kWall) taken_ += c.normal.y() > 0 ? c.impulse : -c.impulse;
            ++collisions_;
        });
    }

    /// Impulse over the weight times time: 1 but for the gas's own momentum, which has the variance N m k T
    /// at both ends; and with that taken into account, where nothing is left but rounding: that of each
    /// impulse, of each sum of them, and of gravity's part of each velocity.
    [[nodiscard]] std::vector<Figure> figures(double scale_height, const std::string& system) const {
        const auto discs = static_cast<double>(world_.ball_count());
        const double weight = discs / scale_height * (world_.time() - start_);
        const double change = world_.momentum().y() - before_;
        return {{"floor's impulse over weight times time",
                 system,
                 {taken_ / weight, std::sqrt(2 * discs) / weight},
                 1,
                 0},
                {"the same, with the momentum at both ends",
                 system,
                 {taken_ / weight, static_cast<double>(collisions_) * 0x1p-52},
                 1 + change / weight,
                 0}};
    }

 private:
    World& world_;
    double start_, before_;
    double taken_ = 0;
    std::uint64_t collisions_ = 0;
};

/// Moments of the heights over the floor and a count of them in classes that are equally probable.
class Heights {
 public:
    static constexpr int kClasses = 32;

    /// An ideal gas of energy E over a floor: a height takes m g h of it and leaves the others 2 N - 3/2
    /// degrees of two halves, so that P(h' > h) = (1 - m g h / E)^(2 N - 3/2).
    Heights(double energy, double weight, double discs) : top_(energy / weight), power_(2 * discs - 1.5) {
        for (int k = 1; k < kClasses; ++k)
            ends_.push_back(top_ * -std::expm1(std::log1p(-static_cast<double>(k) / kClasses) / power_));
    }

    void look(const World& world) {
        double first = 0, second = 0;
        for (const Vec2& x : world.positions()) {
            const double height = x.y() - 0.5;
            first += height;
            second += height * height;
            ++counts_[static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), height) -
                                               ends_.begin())];
        }
        first_.push_back(first / static_cast<double>(world.ball_count()));
        second_.push_back(second / static_cast<double>(world.ball_count()));
    }

    /// `interaction`: what the discs' size changes, relative.
    [[nodiscard]] std::vector<Figure> figures(const std::string& system, double interaction) const {
        const double mean = top_ / (power_ + 1);
        double total = 0, sum = 0;
        for (const double n : counts_) total += n;
        for (const double n : counts_) sum += (n - total / kClasses) * (n - total / kClasses);
        // The sum of the heights fluctuates half as much at given energy as it does at given temperature.
        const double freedom = kClasses - 1 - 0.5;
        return {{"mean height over that of an ideal gas", system, scaled(mean_of(first_), 1 / mean), 1,
                 interaction},
                {"mean squared height over that of an ideal gas", system,
                 scaled(mean_of(second_), (power_ + 2) / (2 * mean * top_)), 1, 2 * interaction},
                {fmt::format("chi-square of {:.0f} heights in {} classes", total, kClasses),
                 system,
                 {sum * kClasses / total, std::sqrt(2 * freedom)},
                 freedom,
                 0.5}};
    }

 private:
    double top_, power_;
    std::vector<double> ends_, first_, second_, counts_ = std::vector<double>(kClasses);
};

std::vector<Figure> joined(std::vector<Figure> first, const std::vector<Figure>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

/// What is seen of a height in a dense column.
struct Level {
    double height;
    std::vector<double> above, near, temperature;  ///< discs above, in the slab around it; k T

    static constexpr double kSlab = 2;

    void look(const World& world) {
        double over = 0, around = 0;
        for (const Vec2& x : world.positions()) {
            over += x.y() > height ? 1 : 0;
            around += std::abs(x.y() - height) < kSlab / 2 ? 1 : 0;
        }
        above.push_back(over);
        near.push_back(around);
        // Momentum is kept along the floor only.
        temperature.push_back(2 * world.kinetic_energy() / static_cast<double>(2 * world.ball_count() - 1));
    }

    /// The pressure is exactly the weight above per width. Over n k T that is the local Z, to be compared
    /// with the fluid's of the local packing. The error is that of the difference, to first order in density
    /// and temperature.
    [[nodiscard]] Figure figure(const Column& column, std::size_t discs) const {
        const double density = mean_of(near).value / (column.width() * kSlab);
        const double warmth = mean_of(temperature).value;
        const double packing = density * kPi / 4;
        const double z = compressibility(packing);
        const double stiffness = Column::stiffness(packing);
        std::vector<double> differences(above.size()), weights(above.size());
        for (std::size_t i = 0; i < above.size(); ++i) {
            weights[i] = above[i] / (column.scale_height() * column.width());
            differences[i] = weights[i] - warmth * stiffness * near[i] / (column.width() * kSlab) -
                             density * z * temperature[i];
        }
        Estimate measured = scaled(mean_of(differences), 1 / (density * warmth));
        measured.value = mean_of(weights).value / (density * warmth);
        // The density changes over the length k T dP/dn / (m g): the gradient's own effect is of second order
        // in a diameter over it. The temperature is known to 1 / N.
        const double length = column.scale_height() * warmth * stiffness;
        return {"local Z from the weight above",
                fmt::format("{} discs over a floor, packing {:.3f} at height {:.0f}", discs, packing, height),
                measured, z, z * (1 / (length * length) + 1 / static_cast<double>(discs))};
    }
};

}  // namespace

// The packing is that of the floor. Width and scale height are about equal: density times their product is N.
std::vector<Figure> dilute_column(const GasRun& run) {
    const auto discs = static_cast<double>(run.discs);
    const double scale_height = std::sqrt(discs / (run.packing * 4 / kPi));
    const Column column(run, run.packing, scale_height, scale_height / 5);
    World world(column.scene(run), run.options);
    const double rate = collision_rate(run.packing) / 2;  // the density that a disc meets is half the floor's
    constexpr double kBetweenLooks = 5;                   // collisions of a disc, and some falls
    world.advance_to(10 * kBetweenLooks / rate);
    const Load load(world);
    Heights heights(world.energy() - discs * 0.5 / scale_height, 1 / scale_height, discs);
    run_blocks(world, static_cast<int>(run.collisions / kBetweenLooks), kBetweenLooks / rate,
               [&] { heights.look(world); });
    const std::string system = fmt::format("{} discs over a floor, packing {} there", run.discs, run.packing);
    // P = k T (n + B n^2) with B n = 2 eta at the floor lifts the mean by half of that.
    return joined(load.figures(scale_height, system), heights.figures(system, run.packing));
}

std::vector<Figure> dense_column(const GasRun& run) {
    constexpr double kScaleHeight = 10;
    const Column column(run, run.packing, kScaleHeight, 10);
    World world(column.scene(run), run.options);
    const double rate = collision_rate(run.packing);
    world.advance_to(kColumnRelaxation / rate);
    const Load load(world);
    std::vector<Level> levels;
    for (const double height : {8, 14, 20, 27, 35, 45}) levels.push_back({height, {}, {}, {}});
    run_blocks(world, static_cast<int>(run.collisions), 1 / rate, [&] {
        for (Level& level : levels) level.look(world);
    });
    std::vector<Figure> figures = load.figures(
        kScaleHeight, fmt::format("{} discs over a floor, packing {} there", run.discs, run.packing));
    for (const Level& level : levels) figures.push_back(level.figure(column, run.discs));
    return figures;
}

}  // namespace carom::accuracy
