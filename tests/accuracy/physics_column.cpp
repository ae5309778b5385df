#include "accuracy/physics_column.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace carom::accuracy {
namespace {

constexpr double kCeiling = 20;  // above the gas, in scale heights

}  // namespace

double stiffness(double packing) {
    return compressibility(packing) + packing * compressibility_slope(packing);
}

Column::Column(std::size_t discs, double floor_packing, double scale_height, double layer)
    : discs_(discs), scale_height_(scale_height), layer_(layer) {
    // dP/dh = -m g n with P = n k T Z: d eta/dh = -eta / (H (Z + eta Z')).
    constexpr int kSteps = 1000;
    const double step = layer / kSteps;
    double packing = floor_packing;
    while (packing > 1e-6 * floor_packing) {
        double filled = 0;
        for (int k = 0; k < kSteps; ++k) {
            filled += packing * 4 / std::numbers::pi * step;
            packing -= step * packing / (scale_height * stiffness(packing));
        }
        per_width_.push_back(filled);
    }
    width_ = static_cast<double>(discs) / std::accumulate(per_width_.begin(), per_width_.end(), 0.0);
}

Scene Column::scene(std::uint64_t seed) const {
    Scene s;
    const double top = layer_ * static_cast<double>(per_width_.size()) + kCeiling * scale_height_;
    s.domain = Domain{{{0, 0}, {width_, top}}, {Boundary::kPeriodic, Boundary::kWall}, 1};
    s.gravity = {0, -1 / scale_height_};
    s.until = 1;
    double sum = 0;
    std::uint64_t placed = 0;
    for (std::size_t k = 0; k < per_width_.size(); ++k) {
        sum += per_width_[k] * width_;
        const auto end = k + 1 < per_width_.size() ? static_cast<std::uint64_t>(std::llround(sum)) : discs_;
        if (end > placed) s.fills.push_back(fill(end - placed, static_cast<double>(k) * layer_, seed));
        placed = std::max(placed, end);
    }
    return s;
}

Fill Column::fill(std::uint64_t count, double bottom, std::uint64_t seed) const {
    Fill f;
    f.count = count;
    f.region = Box{{0, bottom}, {width_, bottom + layer_}};
    f.temperature = 1;
    f.seed = seed;
    return f;
}

Load::Load(World& world) : world_(world), start_(world.time()), before_(world.momentum().y()) {
    world_.on_collision([this](const Collision& c) {
        if (c.kind == CollisionKind::kWall) taken_ += c.normal.y() > 0 ? c.impulse : -c.impulse;
        ++collisions_;
    });
}

std::vector<Figure> Load::figures(const Column& column, const std::string& system) const {
    const auto discs = static_cast<double>(world_.ball_count());
    const double weight = discs / column.scale_height() * (world_.time() - start_);
    const double change = world_.momentum().y() - before_;
    const double rounding = static_cast<double>(collisions_) * 0x1p-52;
    return {{"floor's impulse over weight times time",
             system,
             {taken_ / weight, std::sqrt(2 * discs) / weight},
             1,
             0},
            {"the same, with the momentum at both ends",
             system,
             {taken_ / weight, rounding},
             1 + change / weight,
             0}};
}

}  // namespace carom::accuracy
