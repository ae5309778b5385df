// From SDL's events to actions, from the simulation to the screen, frame after frame.
#include "view_loop.hpp"

#include <SDL.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>

#include <carom/io/atomic_file.hpp>
#include <carom/io/scene_file.hpp>

#include "commands.hpp"
#include "draw_view.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "panel.hpp"
#include "picture_file.hpp"
#include "window.hpp"

namespace carom::app {
namespace {

using Clock = std::chrono::steady_clock;

class ViewLoop {
 public:
    ViewLoop(const ViewOptions& options, Scene scene)
        : options_(options),
          simulation_(std::move(scene), {.threads = options.threads}),
          controls_(simulation_),
          window_(wish_of(options, simulation_.scene())) {
        controls_.speed = options.speed;
        controls_.is_paused = options.is_paused;
        controls_.colour_by = options.colour_by;
        controls_.shows_panel = !options.is_screensaver;
        controls_.panel_width = double(kPanelWidth);
        controls_.resize(window_.width(), window_.height());
        if (options.pick && *options.pick >= simulation_.balls().size())
            throw std::runtime_error("--pick: must be below " + std::to_string(simulation_.balls().size()) +
                                     ", the number of balls");
        if (options.from > 0) simulation_.play(options.from, 1, std::nullopt);
        simulation_.look_at(options.pick);
    }

    int run() {
        for (int frame = 0; !controls_.has_quit && frame != options_.frames.value_or(-1); ++frame) {
            if (interrupt_requested()) return kInterrupted;
            window_.take_events([this](const SDL_Event& event) { take(event); });
            move_on();
            draw_frame();
            const bool is_last = options_.frames && frame + 1 == *options_.frames;
            if (is_last && !options_.screenshot.empty())
                write_file(options_.screenshot, window_.screenshot());
            window_.show();
        }
        return kGood;
    }

 private:
    static Window::Wish wish_of(const ViewOptions& options, const Scene& scene) {
        Window::Wish wish;
        wish.title = scene.name.empty() ? "Carom" : scene.name + " - Carom";
        wish.fills_screen = options.is_screensaver && !options.frames;
        wish.waits_for_screen = !options.frames;
        if (!options.size.empty()) {
            const PictureSize size = parse_picture_size(options.size);
            wish.width = size.width, wish.height = size.height;
        }
        return wish;
    }

    void take(const SDL_Event& event) {
        switch (event.type) {
            case SDL_QUIT:
                controls_.has_quit = true;
                break;
            case SDL_KEYDOWN:
                if (options_.is_screensaver)
                    controls_.has_quit = true;
                else if (const auto action = action_of_key(event.key.keysym.sym))
                    controls_.act(*action);
                break;
            case SDL_MOUSEBUTTONDOWN:
                controls_.press({double(event.button.x), double(event.button.y)});
                break;
            case SDL_MOUSEBUTTONUP:
                controls_.release({double(event.button.x), double(event.button.y)});
                break;
            case SDL_MOUSEMOTION:
                controls_.move({double(event.motion.x), double(event.motion.y)});
                break;
            case SDL_MOUSEWHEEL: {
                int x = 0;
                int y = 0;
                SDL_GetMouseState(&x, &y);
                controls_.wheel(event.wheel.y, {double(x), double(y)});
                break;
            }
            case SDL_WINDOWEVENT:
                if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED)
                    controls_.resize(window_.width(), window_.height());
                break;
            default:
                break;
        }
    }

    void move_on() {
        constexpr double kFrame = 1.0 / 60;
        constexpr double kBudget = 0.012;  // of a frame, for the simulation
        const Clock::time_point now = Clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        const double before = simulation_.world().time();
        controls_.pull();
        if (!controls_.is_paused) {
            if (options_.frames)
                simulation_.play(kFrame, controls_.speed, std::nullopt);
            else
                simulation_.play(seconds, controls_.speed, kBudget);
        }
        const double passed = simulation_.world().time() - before;
        // Smoothed, so that the numbers can be read.
        constexpr double kShare = 0.1;
        if (seconds > 0) {
            reading_.frames_per_second += kShare * (1 / seconds - reading_.frames_per_second);
            reading_.real_speed += kShare * (passed / seconds - reading_.real_speed);
        }
        const double end = simulation_.scene().until;
        if (options_.is_screensaver && end > 0 && simulation_.world().time() >= end)
            simulation_.restart(++controls_.restarts);
    }

    void draw_frame() {
        look_again();
        draw_view(canvas_, simulation_, controls_, facts_);
        window_.draw(canvas_, [this] {
            if (controls_.shows_panel) show_panel(simulation_, controls_, shown_reading(), facts_);
        });
    }

    /// In a run of so many frames the panel shows nothing that depends on the clock.
    [[nodiscard]] PanelReading shown_reading() const {
        return options_.frames ? PanelReading{60, controls_.speed} : reading_;
    }

    /// What is known of the ball that is looked at costs a pass over all: with many, not in every frame.
    void look_again() {
        constexpr std::size_t kFew = 5000;
        constexpr auto kPause = std::chrono::milliseconds(250);
        const Clock::time_point now = Clock::now();
        const bool same_ball = facts_ && simulation_.looked_at() == facts_->id;
        if (same_ball && simulation_.balls().size() > kFew && now - looked_ < kPause) {
            facts_->ball = simulation_.balls()[facts_->id];
            return;
        }
        facts_ = simulation_.facts();
        looked_ = now;
    }

    const ViewOptions& options_;
    Simulation simulation_;
    ViewControls controls_;
    Window window_;
    Canvas canvas_;
    PanelReading reading_;
    std::optional<BallFacts> facts_;
    Clock::time_point looked_;
    Clock::time_point last_ = Clock::now();
};

}  // namespace

int view(const ViewOptions& options) {
    require_distinct({"the scene", options.scene}, {{"--screenshot", options.screenshot}});
    Scene scene = read_scene(options.scene);
    watch_for_interrupts();
    return ViewLoop(options, std::move(scene)).run();
}

}  // namespace carom::app
