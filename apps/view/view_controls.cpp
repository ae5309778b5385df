#include "view_controls.hpp"

#include <algorithm>
#include <cmath>

#include "picture.hpp"

namespace carom::app {

std::optional<Action> action_of_key(int key) {
    constexpr int kEscape = 27;
    switch (key) {
        case ' ':
            return Action::kPause;
        case '.':
        case 'n':
            return Action::kOneEvent;
        case '+':
        case '=':
            return Action::kFaster;
        case '-':
            return Action::kSlower;
        case 'c':
            return Action::kNextColour;
        case 'f':
            return Action::kFit;
        case 'h':
            return Action::kPanel;
        case 'r':
            return Action::kRestart;
        case 'a':
            return Action::kAddBall;
        case 'b':
            return Action::kAddAttractor;
        case 'q':
        case kEscape:
            return Action::kQuit;
        default:
            return std::nullopt;
    }
}

void ViewControls::act(Action action) {
    switch (action) {
        case Action::kPause:
            is_paused = !is_paused;
            break;
        case Action::kOneEvent:
            is_paused = true;
            (void)simulation_.play_one_event();
            break;
        case Action::kFaster:
            speed = std::min(speed * 2, kFastest);
            break;
        case Action::kSlower:
            speed = std::max(speed / 2, kSlowest);
            break;
        case Action::kNextColour:
            colour_by = kAllColourBy[(std::size_t(colour_by) + 1) % kAllColourBy.size()];
            break;
        case Action::kFit:
            fit();
            break;
        case Action::kPanel:
            shows_panel = !shows_panel;
            break;
        case Action::kRestart:
            held_.reset();
            simulation_.restart(restarts);
            break;
        case Action::kAddBall:
            (void)simulation_.add_ball(camera.to_place(mouse_));
            break;
        case Action::kAddAttractor:
            (void)simulation_.add_attractor(camera.to_place(mouse_));
            break;
        case Action::kQuit:
            has_quit = true;
            break;
    }
}

std::optional<std::uint32_t> ViewControls::ball_at(const Vec2& pixel) const {
    constexpr double kSlack = 3;  // pixels around a ball too small to hit
    return simulation_.ball_at(camera.to_place(pixel), kSlack / camera.scale());
}

void ViewControls::press(const Vec2& pixel) {
    pressed_at_ = last_ = mouse_ = pixel;
    is_dragging_ = false;
    held_ = ball_at(pixel);
    if (held_ && simulation_.balls()[*held_].is_static) held_.reset();
}

void ViewControls::move(const Vec2& pixel) {
    constexpr double kStill = 4;  // pixels that a hand moves without meaning it
    mouse_ = pixel;
    if (!pressed_at_) return;
    is_dragging_ = is_dragging_ || (pixel - *pressed_at_).norm() > kStill;
    if (!is_dragging_ || held_) return;
    camera.pan(pixel - last_);
    last_ = pixel;
}

void ViewControls::release(const Vec2& pixel) {
    mouse_ = pixel;
    if (pressed_at_ && !is_dragging_) simulation_.look_at(ball_at(pixel));
    if (const auto drawn = held(); drawn && is_paused)
        (void)simulation_.throw_ball(drawn->first,
                                     (drawn->second - simulation_.balls()[drawn->first].position) / speed);
    pressed_at_.reset();
    held_.reset();
}

void ViewControls::pull() {
    constexpr double kDelay = 0.1;  // real seconds that it is behind the mouse
    if (const auto drawn = held(); drawn && !is_paused)
        (void)simulation_.throw_ball(
            drawn->first, (drawn->second - simulation_.balls()[drawn->first].position) / (kDelay * speed));
}

std::optional<std::pair<std::uint32_t, Vec2>> ViewControls::held() const {
    if (!held_ || !is_dragging_ || *held_ >= simulation_.balls().size()) return std::nullopt;
    return std::pair(*held_, camera.to_place(mouse_));
}

void ViewControls::wheel(double clicks, const Vec2& pixel) {
    constexpr double kZoomOfAClick = 1.2;
    camera.zoom(std::pow(kZoomOfAClick, clicks), pixel);
}

void ViewControls::resize(int width, int height) {
    camera.resize(width, height);
    fit();
}

void ViewControls::fit() {
    PictureContent content;
    content.domain = simulation_.scene().domain;
    content.walls = simulation_.scene().walls;
    content.attractors = simulation_.scene().attractors;
    if (!content.domain) content.balls = simulation_.balls();
    camera.fit(view_of(content), shows_panel ? panel_width : 0);
}

}  // namespace carom::app
