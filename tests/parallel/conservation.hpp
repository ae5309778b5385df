// What an elastic gas keeps, whatever the method.
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include <carom/parallel/world.hpp>

namespace carom::test {

/// Momentum and energy through thousands of collisions of an elastic gas without forces.
inline void expect_conserved(const Scene& elastic_gas) {
    World world(elastic_gas);
    const double energy = world.energy();
    const Vec2 momentum = world.momentum();
    world.advance_to(20);
    const auto collisions = double(world.counts().ball_collisions);
    EXPECT_GT(collisions, 4000);
    // Each collision rounds two momenta and energies by a few ulp; their signs are random.
    const double bound = 8 * 1.1e-16 * std::sqrt(collisions);
    EXPECT_NEAR(world.energy() / energy, 1, bound);
    EXPECT_NEAR(world.momentum().x(), momentum.x(), bound * 4);
    EXPECT_NEAR(world.momentum().y(), momentum.y(), bound * 4);
}

}  // namespace carom::test
