// What the user can do with a window, and what that changes: keys and the mouse to actions. Knows no window.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "camera.hpp"
#include "colouring.hpp"
#include "simulation.hpp"

namespace carom::app {

enum class Action : std::uint8_t {
    kPause,
    kOneEvent,
    kFaster,
    kSlower,
    kNextColour,
    kFit,
    kPanel,
    kRestart,
    kAddBall,
    kAddAttractor,
    kQuit
};

/// Of a key's character; none for others.
[[nodiscard]] std::optional<Action> action_of_key(int key);

inline constexpr double kSlowest = 1e-9;
inline constexpr double kFastest = 1e9;

/// The state of a window that the user steers.
class ViewControls {
 public:
    explicit ViewControls(Simulation& simulation) : simulation_(simulation) {}

    void act(Action action);
    /// On a ball that moves: takes hold of it. Elsewhere a move shifts what is shown.
    void press(const Vec2& pixel);
    void move(const Vec2& pixel);
    /// Without a move since the press: the ball under the pixel is looked at. A ball that was held is let go:
    /// it flies on as it was drawn, or, where the world is paused, to here in a second.
    void release(const Vec2& pixel);
    /// Before the world moves on: draws the ball that is held towards the mouse.
    void pull();
    /// The ball that is drawn, and where to.
    [[nodiscard]] std::optional<std::pair<std::uint32_t, Vec2>> held() const;
    void wheel(double clicks, const Vec2& pixel);
    void resize(int width, int height);
    /// Shows everything, beside the panel.
    void fit();

    Camera camera;
    ColourBy colour_by = ColourBy::kSpeed;
    double speed = 1;  ///< simulated time in a second
    bool is_paused = false;
    bool shows_panel = true;
    bool has_quit = false;
    double panel_width = 0;  ///< pixels at the left that the panel hides
    std::uint64_t restarts = 0;

 private:
    [[nodiscard]] std::optional<std::uint32_t> ball_at(const Vec2& pixel) const;

    Simulation& simulation_;
    std::optional<Vec2> pressed_at_;
    std::optional<std::uint32_t> held_;
    Vec2 last_ = Vec2::Zero();
    Vec2 mouse_ = Vec2::Zero();
    bool is_dragging_ = false;
};

}  // namespace carom::app
