// Turns a scene's fills into balls: random, without overlap, the same on every machine.
#pragma once

#include <vector>

#include <carom/core/scene.hpp>

namespace carom {

/// The scene's balls, followed by those of each fill in their order; a ball's id is its index.
///
/// A fill's discs lie in its region (the domain's box, where it has none) and keep clear of walls, of the
/// domain's walled sides, of the balls before them, and of each other: the squared distance is at least that
/// of the radii's sum, in double. An axis of the region that spans the whole of a periodic axis has no sides;
/// elsewhere whole discs stay inside the region.
///
/// Up to a packing of 0.5 discs are put down one by one at uniformly random places, the largest first (random
/// sequential adsorption). Above, or where that finds no room, equal discs start from a triangular lattice
/// fitted to the region, with vacancies at random, and others, or what no lattice fits, from overlapping
/// places that are pushed apart (soft discs, overlaps minimised sweep by sweep); both are then shaken by
/// Monte Carlo moves of hard discs. Such a start is no equilibrium: let it run a while.
///
/// A fill's discs are numbered from row to row of its region, for they are looked up with their neighbours.
///
/// Velocities are normal with variance temperature / mass, less the velocity of the fill's centre of mass,
/// and zero at temperature zero. The same seed, index of the fill and scene give the same bits with every
/// compiler: no function of the mathematical library is used but the exact ones.
///
/// Precondition: check(scene) has passed; balls already there may overlap. Throws SceneError, with the place
/// `fill[k].radius`,
/// `.count` or `.packing_fraction`, where discs do not fit; near the limit (packing above some 0.82 of mixed
/// sizes, above 0.88 of equal ones) also where the bounded search finds no arrangement. Cost: about linear;
/// memory some 150 bytes a ball.
[[nodiscard]] std::vector<Ball> place_balls(const Scene& scene);

}  // namespace carom
