// One frame of the window without its panel.
#pragma once

#include "canvas.hpp"
#include "view_controls.hpp"

namespace carom::app {

/// Fills the canvas, which takes the camera's size.
void draw_view(Canvas& canvas, const Simulation& simulation, const ViewControls& controls,
               const std::optional<BallFacts>& looked_at);

}  // namespace carom::app
