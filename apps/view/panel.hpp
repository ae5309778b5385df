// The panel at the window's left: buttons, counters, curves, the ball that is looked at.
#pragma once

#include "view_controls.hpp"

namespace carom::app {

inline constexpr float kPanelWidth = 300;

/// What the panel shows beside the simulation.
struct PanelReading {
    double frames_per_second = 0;
    double real_speed = 0;  ///< simulated time in a second, as reached
};

/// To be called between ImGui's NewFrame and Render.
void show_panel(const Simulation& simulation, ViewControls& controls, const PanelReading& reading,
                const std::optional<BallFacts>& looked_at);

}  // namespace carom::app
