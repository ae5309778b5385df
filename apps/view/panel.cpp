#include "panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

#include "picture_layout.hpp"

namespace carom::app {
namespace {

void show(const std::string& text) {
    ImGui::TextUnformatted(text.c_str());
}

void show_row(const char* name, const std::string& value) {
    constexpr float kColumn = 105;
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(kColumn);
    show(value);
}

void button(const char* label, Action action, ViewControls& controls) {
    if (ImGui::Button(label)) controls.act(action);
}

void show_buttons(ViewControls& controls) {
    button(controls.is_paused ? "Go on" : "Pause", Action::kPause, controls);
    ImGui::SameLine();
    button("One event", Action::kOneEvent, controls);
    ImGui::SameLine();
    button("Restart", Action::kRestart, controls);
    ImGui::SameLine();
    button("All", Action::kFit, controls);
    ImGui::SetNextItemWidth(-60);
    constexpr ImGuiSliderFlags kFlags = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat;
    constexpr double kLow = 1e-6;
    constexpr double kHigh = 1e3;
    ImGui::SliderScalar("speed", ImGuiDataType_Double, &controls.speed, &kLow, &kHigh, "%.3g", kFlags);
    ImGui::SetNextItemWidth(-60);
    if (ImGui::BeginCombo("colour", name_of(controls.colour_by))) {
        for (const ColourBy by : kAllColourBy)
            if (ImGui::Selectable(name_of(by), by == controls.colour_by)) controls.colour_by = by;
        ImGui::EndCombo();
    }
}

void show_counters(const Simulation& simulation, const ViewControls& controls, const PanelReading& reading) {
    const World& world = simulation.world();
    const Counts counts = world.counts();
    show_row("time", fmt::format("{:.10g}", world.time()));
    show_row("speed", controls.is_paused ? "paused" : fmt::format("{:.3g}", reading.real_speed));
    show_row("balls", with_thousands(world.ball_count()));
    show_row("collisions", with_thousands(counts.ball_collisions));
    show_row("with walls", with_thousands(counts.wall_collisions));
    show_row("frames", fmt::format("{:.0f} a second", reading.frames_per_second));
}

void show_curve(const char* name, const std::vector<float>& curve, bool from_zero) {
    if (curve.empty()) return;
    const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
    // A conserved energy is a line in the middle, not its rounding blown up.
    const float margin = std::max({(*high - *low) * 0.1F, std::abs(*high) * 1e-6F, 1e-30F});
    show_row(name, fmt::format("{:.6g}", double(curve.back())));
    ImGui::PlotLines(fmt::format("##{}", name).c_str(), curve.data(), int(curve.size()), 0, nullptr,
                     from_zero ? 0 : *low - margin, *high + margin, {kPanelWidth - 20, 60});
}

std::string body_name(const Simulation& simulation, CollisionKind kind, std::uint32_t other) {
    if (kind == CollisionKind::kBall) return fmt::format("ball {}", other);
    const std::size_t walls = simulation.scene().walls.size();
    if (other < walls) return fmt::format("wall {}", other);
    constexpr const char* kSides[] = {"left side", "right side", "bottom", "top"};
    return kSides[std::min<std::size_t>(other - walls, 3)];
}

void show_ball(const Simulation& simulation, const BallFacts& facts) {
    ImGui::Separator();
    const Ball& ball = facts.ball;
    show(fmt::format("Ball {}{}", facts.id, ball.is_static ? ", static" : ""));
    show_row("position", fmt::format("{:.6g}, {:.6g}", ball.position.x(), ball.position.y()));
    show_row("velocity", fmt::format("{:.6g}, {:.6g}", ball.velocity.x(), ball.velocity.y()));
    show_row("radius, mass", fmt::format("{:.4g}, {:.4g}", ball.radius, ball.mass));
    show_row("collisions", with_thousands(facts.collisions));
    if (facts.anchor) {
        show_row("anchor",
                 fmt::format("{:.6g}, {:.6g}", facts.anchor->position.x(), facts.anchor->position.y()));
        show_row("", fmt::format("{:.6g} ago", facts.anchor_age));
    }
    if (facts.next) {
        show_row("next",
                 fmt::format("{} in {:.4g}", body_name(simulation, facts.next->kind, facts.next->other),
                             facts.next->delay));
    } else {
        show_row("next", "nothing in its way");
    }
    for (const Collision& c : facts.history) {
        const bool is_first = c.i == facts.id;
        show_row(&c == &facts.history.front() ? "history" : "",
                 fmt::format(
                     "{:.6g} {}", c.time,
                     body_name(simulation, c.kind, is_first || c.kind == CollisionKind::kWall ? c.j : c.i)));
    }
}

}  // namespace

void show_panel(const Simulation& simulation, ViewControls& controls, const PanelReading& reading,
                const std::optional<BallFacts>& looked_at) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({kPanelWidth, float(controls.camera.height())});
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNavInputs;
    const std::string& name = simulation.scene().name;
    ImGui::Begin(fmt::format("{}###panel", name.empty() ? "Carom" : name).c_str(), nullptr, kFlags);
    show_buttons(controls);
    ImGui::Separator();
    show_counters(simulation, controls, reading);
    show_curve("energy", simulation.curves().energy, false);
    show_curve("rate", simulation.curves().collision_rate, true);
    if (looked_at) show_ball(simulation, *looked_at);
    ImGui::Separator();
    ImGui::TextDisabled("space . + - c f h r a b q; drag, wheel, click");
    if (!simulation.refusal().empty()) ImGui::TextWrapped("%s", simulation.refusal().c_str());
    ImGui::End();
}

}  // namespace carom::app
