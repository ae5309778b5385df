// Where balls may not be: in each other, by a look at every pair, and beyond the walled sides.
#pragma once

#include <string>

#include <carom/core/scene.hpp>
#include <carom/parallel/world.hpp>

namespace carom::stress {

/// One line on the first ball that is where it may not be, in a world of `scene` where no ball has had more
/// than `events` collisions and renewals of the field; empty where all is well. Looks at every pair, of at
/// most some hundred balls.
[[nodiscard]] std::string find_misplaced(const Scene& scene, const World& world, double events);

}  // namespace carom::stress
