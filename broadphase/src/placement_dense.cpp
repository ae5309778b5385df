// The dense arrangements: relaxed from a lattice or from overlapping places, then shaken.
#include <algorithm>
#include <cmath>

#include "placement_methods.hpp"

namespace carom::detail {
namespace {

// The start of discs of different sizes: their radii are scaled to this packing, adsorbed, and given back
// their size.
constexpr double kPackingOfScaledStart = 0.35;
// Discs within this ratio of radii can start from a lattice.
constexpr double kSimilar = 1.5;
// Sites of a lattice whose discs are to be pushed about need be clear for so much of a disc only.
constexpr double kRoomOfSite = 0.5;
// A lattice is used as it is when its discs have this gap at least, in units of the diameter.
constexpr double kSmallestGap = 1e-6;

/// Puts the discs on as many of the sites, chosen at random; the order of both is kept.
void put_on_sites(Space& space, const std::vector<Vec2>& sites, Random& random) {
    std::uint32_t id = 0;
    for (std::size_t k = 0; k < sites.size() && id < space.count(); ++k)
        if (random.below(sites.size() - k) < space.count() - id) space.insert(id++, sites[k]);
}

/// Scaled discs adsorbed, those without room put anywhere, all with their full radius then.
void put_anywhere(Space& space, Random& random) {
    space.set_scale(std::min(1.0, std::sqrt(kPackingOfScaledStart / space.packing())));
    const std::vector<std::uint32_t> left_over = adsorb(space, random);
    space.set_scale(1);
    for (const std::uint32_t id : left_over) {
        const double share_x = random.uniform();
        space.insert(id, Places(space, space.full_radius(id)).at(share_x, random.uniform()));
    }
    for (std::uint32_t id = 0; id < space.count();
         ++id) {  // scaled discs may lie closer to the sides than full ones can
        const Space::Body& body = space.body(id);
        space.move(id, space.moved_inside({body.x, body.y}, body.radius));
    }
}

/// How many discs, the largest first, have room where they stand; the others are taken out.
std::size_t keep_clear_ones(Space& space) {
    std::vector<Space::Body> bodies;
    bodies.reserve(space.count());
    for (std::uint32_t id = 0; id < space.count(); ++id) bodies.push_back(space.body(id));
    space.clear();
    std::size_t kept = 0;
    for (const std::uint32_t id : largest_first(space)) {
        const Vec2 p(bodies[id].x, bodies[id].y);
        if (!space.is_clear(p, bodies[id].radius)) continue;
        space.insert(id, p);
        ++kept;
    }
    return kept;
}

/// The overlapping start of the k-th try: on a lattice or anywhere.
void start_overlapping(Space& space, int k, Random& random) {
    space.clear();
    std::vector<Vec2> sites;
    const double radius = space.largest_radius();
    if (k % 2 == 0 && radius <= kSimilar * space.smallest_radius())
        sites = lattice_sites(space, space.count(), kRoomOfSite * radius, 0);
    if (!sites.empty()) return put_on_sites(space, sites, random);
    put_anywhere(space, random);
    space.sort_by_place();
}

/// The factor, at most 1, that would make all radii small enough for no disc to overlap anything; 0 where
/// none would.
double largest_clear_scale(const Space& space) {
    double scale = 1;
    for (std::uint32_t id = 0; id < space.count(); ++id) {
        const Space::Body& body = space.body(id);
        const Vec2 p(body.x, body.y);
        space.for_each_near(p, body.radius, [&](std::uint32_t k) {
            if (k == id) return true;
            const Space::Body& other = space.body(k);
            const double distance = std::sqrt(length_squared(space.offset(p, other)));
            scale = std::min(scale, space.is_fixed(k) ? (distance - other.radius) / body.radius
                                                      : distance / (body.radius + other.radius));
            return true;
        });
        space.walls().for_each_near(p, body.radius, [&](std::uint32_t k) {
            scale =
                std::min(scale, std::sqrt(distance_squared_to(space.walls().walls()[k], p)) / body.radius);
            return true;
        });
    }
    return std::max(scale, 0.0);
}

int tries(std::size_t count) {
    return count <= 2000 ? 6 : count <= 20000 ? 3 : 1;
}

}  // namespace

DenseResult place_dense(Space& space, Random& random) {
    const double radius = space.largest_radius();
    space.clear();
    if (space.smallest_radius() == radius) {
        const std::vector<Vec2> sites =
            lattice_sites(space, space.count(), radius, 2 * radius * (1 + kSmallestGap));
        if (!sites.empty()) {
            put_on_sites(space, sites, random);
            shake(space, random);
            return {.complete = true};
        }
    }
    DenseResult best;
    for (int k = 0; k < tries(space.count()); ++k) {
        start_overlapping(space, k, random);
        if (relax(space, random)) {
            shake(space, random);
            return {.complete = true};
        }
        const double scale = largest_clear_scale(space);
        best.packing = std::max(best.packing, space.packing() * scale * scale);
        best.placed = std::max(best.placed, keep_clear_ones(space));
    }
    return best;
}

}  // namespace carom::detail
