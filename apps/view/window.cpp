#include "window.hpp"

#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "imgui_renderer.hpp"
#include "picture_file.hpp"

namespace carom::app {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error(what + ": " + SDL_GetError());
}

SDL_Window* open_window(const Window::Wish& wish) {
    std::uint32_t flags = SDL_WINDOW_RESIZABLE;
    if (wish.fills_screen) flags |= SDL_WINDOW_FULLSCREEN_DESKTOP;
    SDL_Window* const window = SDL_CreateWindow(wish.title.c_str(), SDL_WINDOWPOS_CENTERED,
                                                SDL_WINDOWPOS_CENTERED, wish.width, wish.height, flags);
    if (window == nullptr) fail("cannot open a window");
    return window;
}

SDL_Renderer* open_renderer(SDL_Window* window, bool waits_for_screen) {
    const std::uint32_t flags = waits_for_screen ? SDL_RENDERER_PRESENTVSYNC : 0;
    SDL_Renderer* renderer = SDL_CreateRenderer(window, -1, flags);
    if (renderer == nullptr) renderer = SDL_CreateRenderer(window, -1, SDL_RENDERER_SOFTWARE);
    if (renderer == nullptr) fail("cannot draw in the window");
    return renderer;
}

bool is_of_mouse(const SDL_Event& event) {
    return event.type == SDL_MOUSEBUTTONDOWN || event.type == SDL_MOUSEWHEEL;
}

}  // namespace

Window::Library::Library() {
    // Ctrl-C stays with the program's own handler.
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) fail("cannot open a window");
    // Where there is no screen SDL takes one of its own that nobody sees, and would run for ever.
    const std::string driver = SDL_GetCurrentVideoDriver();
    if (std::getenv("SDL_VIDEODRIVER") == nullptr && (driver == "offscreen" || driver == "dummy")) {
        SDL_Quit();
        throw std::runtime_error("cannot open a window: there is no display (DISPLAY, WAYLAND_DISPLAY)");
    }
}

Window::Library::~Library() {
    SDL_Quit();
}

/// ImGui's context, for as long as the window is there.
struct Window::Panel {
    Panel(SDL_Window* window, SDL_Renderer* renderer) {
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
        ImGui::StyleColorsDark();
        ImGui_ImplSDL2_InitForSDLRenderer(window);
        drawer = std::make_unique<ImguiRenderer>(renderer);
    }
    ~Panel() {
        drawer.reset();
        ImGui_ImplSDL2_Shutdown();
        ImGui::DestroyContext();
    }
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    std::unique_ptr<ImguiRenderer> drawer;
};

Window::Window(const Wish& wish)
    : window_(open_window(wish), SDL_DestroyWindow),
      renderer_(open_renderer(window_.get(), wish.waits_for_screen), SDL_DestroyRenderer),
      texture_(nullptr, SDL_DestroyTexture),
      panel_(std::make_unique<Panel>(window_.get(), renderer_.get())) {
    if (wish.fills_screen) SDL_ShowCursor(SDL_DISABLE);
}

Window::~Window() = default;

int Window::width() const {
    int width = 0;
    SDL_GetRendererOutputSize(renderer_.get(), &width, nullptr);
    return width;
}

int Window::height() const {
    int height = 0;
    SDL_GetRendererOutputSize(renderer_.get(), nullptr, &height);
    return height;
}

void Window::take_events(const std::function<void(const SDL_Event&)>& handle) {
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0) {
        ImGui_ImplSDL2_ProcessEvent(&event);
        const ImGuiIO& io = ImGui::GetIO();
        if (io.WantCaptureMouse && is_of_mouse(event)) continue;
        if (io.WantCaptureKeyboard && event.type == SDL_KEYDOWN) continue;
        handle(event);
    }
}

void Window::upload(const Canvas& canvas) {
    int width = 0;
    int height = 0;
    if (texture_) SDL_QueryTexture(texture_.get(), nullptr, nullptr, &width, &height);
    if (width != canvas.width() || height != canvas.height()) {
        texture_.reset(SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_ARGB8888,
                                         SDL_TEXTUREACCESS_STREAMING, canvas.width(), canvas.height()));
        if (!texture_) fail("cannot draw in the window");
    }
    SDL_UpdateTexture(texture_.get(), nullptr, canvas.pixels().data(), 4 * canvas.width());
}

void Window::draw(const Canvas& canvas, const std::function<void()>& panel) {
    upload(canvas);
    SDL_RenderCopy(renderer_.get(), texture_.get(), nullptr, nullptr);
    ImGui_ImplSDL2_NewFrame();
    ImGui::NewFrame();
    panel();
    ImGui::Render();
    panel_->drawer->draw(*ImGui::GetDrawData());
}

void Window::show() {
    SDL_RenderPresent(renderer_.get());
}

std::string Window::screenshot() const {
    const int across = width();
    const int down = height();
    std::vector<std::uint32_t> pixels(std::size_t(across) * std::size_t(down));
    if (SDL_RenderReadPixels(renderer_.get(), nullptr, SDL_PIXELFORMAT_ARGB8888, pixels.data(), 4 * across) !=
        0)
        fail("cannot read the window's picture");
    return png_of_pixels(pixels.data(), across, down);
}

}  // namespace carom::app
