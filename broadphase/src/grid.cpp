// The choice of the cells' width.
#include <carom/broadphase/grid.hpp>

namespace carom {
namespace {

// A cell holds about this many balls where the gas is dilute: fewer crossings against fewer pairs to test.
constexpr double kDiluteSpacing = 0.9;
// More cells than this many a ball cost more memory traffic than the smaller cells save.
constexpr double kCellsPerBall = 4;

// A periodic or walled axis is divided exactly, so that a side lies on a cell's border; where not even one
// cell fits between walls or open sides, the one cell sticks out.
GridAxis choose_axis(double min, double length, double width, bool periodic) {
    constexpr double kMost = 1 << 15;
    const auto count = static_cast<std::int32_t>(std::clamp(std::floor(length / width), 1.0, kMost));
    return {min, periodic ? length : std::max(length, width), count, periodic};
}

}  // namespace

Grid choose_grid(const Domain& domain, std::size_t count, double largest_diameter, double cell_size) {
    const Vec2 extent = domain.box.max - domain.box.min;
    const double balls = std::max<double>(1, double(count));
    const double spacing = std::sqrt(extent.x()) * std::sqrt(extent.y()) / std::sqrt(balls);
    const double least = largest_diameter * (1 + kCellMargin);
    const double wanted = cell_size > 0 ? cell_size : kDiluteSpacing * spacing;
    const double width = std::max({wanted, least, spacing / std::sqrt(kCellsPerBall)});
    return {choose_axis(domain.box.min.x(), extent.x(), width, domain.boundary[0] == Boundary::kPeriodic),
            choose_axis(domain.box.min.y(), extent.y(), width, domain.boundary[1] == Boundary::kPeriodic)};
}

}  // namespace carom
