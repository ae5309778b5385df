// A scene run to its end, measured on the way.
#pragma once

#include <optional>

#include <carom/core/scene.hpp>
#include <carom/parallel/world.hpp>

#include "curves.hpp"
#include "driver.hpp"

namespace carom::app {

/// Energy, rate of collisions and, where it is defined, pressure over time; g(r) and speeds over the second
/// half. None where an interrupt came before the end.
[[nodiscard]] std::optional<Plot> plot_of(World& world, const Scene& scene, double until, Driver& driver);

}  // namespace carom::app
