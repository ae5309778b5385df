// A gas over a floor under gravity: how it is put down, and what floor and ceiling take up.
#pragma once

#include <string>
#include <vector>

#include "accuracy/physics.hpp"

namespace carom::accuracy {

/// dP/dn over k T.
double stiffness(double packing);

/// Discs over a floor at y = 0, periodic in x, with k T = 1 and near their equilibrium from the start: put
/// down in layers, each with as many as it has at rest.
class Column {
 public:
    /// `scale_height`: k T / (m g).
    Column(std::size_t discs, double floor_packing, double scale_height, double layer);

    [[nodiscard]] Scene scene(std::uint64_t seed) const;
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double scale_height() const { return scale_height_; }

 private:
    [[nodiscard]] Fill fill(std::uint64_t count, double bottom, std::uint64_t seed) const;

    std::size_t discs_;
    double scale_height_, layer_, width_;
    std::vector<double> per_width_;  ///< discs of each layer
};

/// What floor and ceiling take up while it lives; the world must live longer.
class Load {
 public:
    explicit Load(World& world);
    Load(const Load&) = delete;
    Load& operator=(const Load&) = delete;

    /// Impulse over the weight times time: 1 but for the gas's own momentum, which has the variance N m k T
    /// at both ends; and with that taken into account, where nothing is left but rounding: that of each
    /// impulse, of each sum of them, and of gravity's part of each velocity.
    [[nodiscard]] std::vector<Figure> figures(const Column& column, const std::string& system) const;

 private:
    World& world_;
    double start_, before_;
    double taken_ = 0;
    std::uint64_t collisions_ = 0;
};

}  // namespace carom::accuracy
