// A window of SDL's with a canvas and a panel of Dear ImGui's over it.
#pragma once

#include <SDL.h>

#include <functional>
#include <memory>
#include <string>

#include "canvas.hpp"

namespace carom::app {

class ImguiRenderer;

/// Throws std::runtime_error with SDL's words where there is no display.
class Window {
 public:
    struct Wish {
        std::string title;
        int width = 1280;
        int height = 800;
        bool fills_screen = false;
        bool waits_for_screen = true;  ///< a frame takes as long as the screen's
    };
    explicit Window(const Wish& wish);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// Calls `handle` for each event since the last call that the panel does not take for itself.
    void take_events(const std::function<void(const SDL_Event&)>& handle);
    /// Draws the canvas and what `panel` says to ImGui.
    void draw(const Canvas& canvas, const std::function<void()>& panel);
    void show();
    /// Of what was drawn, before it is shown: the bytes of a PNG file.
    [[nodiscard]] std::string screenshot() const;

 private:
    void upload(const Canvas& canvas);

    template <class T>
    using Owned = std::unique_ptr<T, void (*)(T*)>;
    struct Library {
        Library();
        ~Library();
        Library(const Library&) = delete;
        Library& operator=(const Library&) = delete;
    };
    struct Panel;

    Library library_;
    Owned<SDL_Window> window_;
    Owned<SDL_Renderer> renderer_;
    Owned<SDL_Texture> texture_;
    std::unique_ptr<Panel> panel_;
};

}  // namespace carom::app
