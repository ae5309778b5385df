#include "scene_hash.hpp"

#include "hash.hpp"

namespace carom {
namespace {

/// Only where it is not the usual one, as scenes had before there were filters.
void add(Hash& h, const CollisionFilter& filter) {
    if (filter != CollisionFilter{}) h << std::uint64_t{filter.category} << std::uint64_t{filter.mask};
}

Hash hash_of(const Ball& b, std::size_t id) {
    Hash h{mix(id + 1)};
    h << b.position << b.velocity << b.acceleration << b.radius << b.mass << b.restitution
      << std::uint64_t{b.is_static};
    add(h, b.filter);
    return h;
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene, const Physics& physics, std::span<const Ball> balls,
                         const Executor& executor) {
    const Domain& domain = physics.domain;
    Hash h;
    h << domain.box.min << domain.box.max << domain.restitution;
    for (const Boundary b : domain.boundary) h << static_cast<std::uint64_t>(b);
    h << physics.gravity << static_cast<std::uint64_t>(physics.restitution_rule) << physics.contact_time
      << physics.rest_time << physics.speed_factor << std::uint64_t{physics.in_float}
      << std::uint64_t{scene.allows_overlap} << physics.typical_virial << physics.clock.epoch_length();
    h << std::uint64_t{scene.walls.size()};
    for (const Wall& w : scene.walls) {
        h << w.from << w.to << w.restitution;
        add(h, w.filter);
    }
    h << std::uint64_t{scene.attractors.size()};
    for (const Attractor& a : scene.attractors) h << a.position << a.strength << a.softening;
    if (!scene.attractors.empty()) h << scene.field_interval;
    if (physics.empirical)
        h << physics.empirical->longest << physics.empirical->travel << physics.empirical->tolerance;
    h << std::uint64_t{balls.size()};
    h << executor.sum(balls.size(), std::uint64_t{0}, [balls](std::size_t first, std::size_t last) {
        std::uint64_t sum = 0;
        for (std::size_t i = first; i < last; ++i) sum += hash_of(balls[i], i).value;
        return sum;
    });
    return h.value;
}

}  // namespace carom
