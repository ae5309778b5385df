// Lattices of rows fitted to a region: the triangular one, stretched to meet the sides, and for few discs in
// a box without sides every lattice that closes on itself.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "placement_methods.hpp"

namespace carom::detail {
namespace {

// Few enough for a search over all lattices of so many sites, which takes about the square of them.
constexpr std::size_t kMostSitesOfSearch = 1000;
// Where obstacles take sites, lattices with more are tried: so often, and up to so many.
constexpr int kMostTries = 24;
constexpr std::size_t kMostSitesPerDisc = 16;

/// Rows along the axis `along`, numbered across it. Row k is shifted by k * shift columns, of which the whole
/// ones drop out.
struct Lattice {
    int along = 0;
    std::size_t rows = 0;
    std::size_t columns = 0;
    double column_spacing = 0;
    double row_spacing = 0;
    double shift = 0;
    double spacing_squared = 0;  // of the two nearest sites; 0: there is no lattice
};

double shortest_squared(Vec2 a, Vec2 b) {  // Gauss's reduction of the lattice that a and b span
    for (;;) {
        if (length_squared(a) > length_squared(b)) std::swap(a, b);
        const Vec2 shorter = b - std::round(dot(a, b) / length_squared(a)) * a;
        if (!(length_squared(shorter) < length_squared(b))) return length_squared(a);
        b = shorter;
    }
}

class LatticeSearch {
 public:
    LatticeSearch(const Space& space, double inset) : space_(space), inset_(inset) {}

    /// The lattice of at least `sites` sites whose sites are farthest apart.
    [[nodiscard]] Lattice best(std::size_t sites) {
        best_ = {};
        for (int along = 0; along < 2; ++along) {
            const double ideal = std::sqrt(static_cast<double>(sites) * usable(1 - along) /
                                           (usable(along) * std::numbers::sqrt3 / 2 + 1e-300));
            const double most = static_cast<double>(sites);
            const auto first = static_cast<std::size_t>(std::clamp(ideal / 2 - 4, 1.0, most));
            const auto last = static_cast<std::size_t>(std::clamp(2 * ideal + 4, 1.0, most));
            for (std::size_t rows = first; rows <= last; ++rows) try_rows(along, rows, sites);
        }
        if (space_.wraps(0) && space_.wraps(1) && sites <= kMostSitesOfSearch) try_all(sites);
        return best_;
    }

 private:
    /// The length along which centres may lie.
    [[nodiscard]] double usable(int axis) const {
        return space_.wraps(axis) ? space_.width(axis) : std::max(0.0, space_.width(axis) - 2 * inset_);
    }

    void try_rows(int along, std::size_t rows, std::size_t sites) {
        const bool closed_along = space_.wraps(along);
        const bool closed_across = space_.wraps(1 - along);
        if (closed_across && rows % 2 != 0 && rows != 1)
            return;  // the last row would meet the first unshifted
        Lattice l{
            .along = along, .rows = rows, .columns = (sites + rows - 1) / rows, .shift = rows > 1 ? 0.5 : 0};
        const auto columns = static_cast<double>(l.columns);
        const double gaps = closed_along ? columns : columns - 1 + l.shift;
        const double row_gaps = static_cast<double>(closed_across ? rows : rows - 1);
        l.column_spacing = gaps > 0 ? usable(along) / gaps : 0;
        l.row_spacing = row_gaps > 0 ? usable(1 - along) / row_gaps : 0;
        const double w_squared = l.column_spacing * l.column_spacing;
        const double h_squared = l.row_spacing * l.row_spacing;
        double nearest = std::numeric_limits<double>::max();
        if (closed_along || l.columns > 1) nearest = std::min(nearest, w_squared);
        if (rows > 1) nearest = std::min(nearest, w_squared / 4 + h_squared);
        if (rows > 2 || closed_across) nearest = std::min(nearest, (rows == 1 ? 1 : 4) * h_squared);
        l.spacing_squared = nearest;
        keep(l);
    }

    void try_all(std::size_t sites) {
        for (std::size_t rows = 1; rows <= sites; ++rows) {
            Lattice l{.along = 0, .rows = rows, .columns = (sites + rows - 1) / rows};
            l.column_spacing = space_.width(0) / static_cast<double>(l.columns);
            l.row_spacing = space_.width(1) / static_cast<double>(rows);
            for (std::size_t k = 0; k < rows; ++k) {
                l.shift = static_cast<double>(k) / static_cast<double>(rows);
                l.spacing_squared =
                    shortest_squared({l.column_spacing, 0}, {l.shift * l.column_spacing, l.row_spacing});
                keep(l);
            }
        }
    }

    void keep(const Lattice& l) {
        // A hair's lead decides nothing: of lattices as good as each other the first is kept, however
        // distances are rounded.
        if (l.spacing_squared > best_.spacing_squared * (1 + 1e-12)) best_ = l;
    }

    const Space& space_;
    double inset_;
    Lattice best_;
};

/// The sites at which a disc of the given radius is clear of everything.
std::vector<Vec2> clear_sites(const Space& space, const Lattice& l, double inset, double radius) {
    std::vector<Vec2> sites;
    sites.reserve(l.rows * l.columns);
    const int across = 1 - l.along;
    const Vec2 origin(space.wraps(0) ? 0 : inset, space.wraps(1) ? 0 : inset);
    for (std::size_t row = 0; row < l.rows; ++row) {
        // Two shifts of 1/2 must return to the first row exactly.
        const double shift =
            l.shift == 0.5 ? 0.5 * static_cast<double>(row % 2) : l.shift * static_cast<double>(row);
        for (std::size_t column = 0; column < l.columns; ++column) {
            Vec2 p = space.region().min + origin;
            const double place = static_cast<double>(column) + (shift - std::floor(shift));
            p[l.along] += place * l.column_spacing;
            p[across] += static_cast<double>(row) * l.row_spacing;
            if (l.rows == 1 && !space.wraps(across))
                p[across] = (space.region().min[across] + space.region().max[across]) / 2;
            p = space.wrapped(space.moved_inside(p, radius));
            if (space.is_clear(p, radius)) sites.push_back(p);
        }
    }
    return sites;
}

}  // namespace

std::vector<Vec2> lattice_sites(const Space& space, std::size_t wanted, double radius, double spacing) {
    const std::size_t most = kMostSitesPerDisc * wanted + 1000;
    // A gap is left at the sides like that between discs: the room is shared by all.
    const double room = std::sqrt(std::max(1.0, 0.9 / space.packing())) - 1;
    for (const double inset : {radius * (1 + 0.2 * std::min(room, 1.0)), radius}) {
        LatticeSearch search(space, inset);
        std::size_t sites = wanted;
        for (int k = 0; k < kMostTries && sites <= most; ++k) {
            const Lattice lattice = search.best(sites);
            if (!(lattice.spacing_squared > spacing * spacing)) break;
            std::vector<Vec2> clear = clear_sites(space, lattice, inset, radius);
            if (clear.size() >= wanted) return clear;
            const double growth =
                static_cast<double>(wanted) / static_cast<double>(std::max<std::size_t>(clear.size(), 1));
            sites = static_cast<std::size_t>(static_cast<double>(sites) * std::clamp(growth, 1.001, 2.0)) + 1;
        }
    }
    return {};
}

}  // namespace carom::detail
