// Dear ImGui's drawings through SDL's renderer: Debian's package brings the input side for SDL compiled, but
// not this one.
#pragma once

#include <SDL.h>
#include <imgui.h>

namespace carom::app {

/// Makes the font's texture, which lives as long as the object.
class ImguiRenderer {
 public:
    explicit ImguiRenderer(SDL_Renderer* renderer);
    ~ImguiRenderer();
    ImguiRenderer(const ImguiRenderer&) = delete;
    ImguiRenderer& operator=(const ImguiRenderer&) = delete;

    void draw(const ImDrawData& data) const;

 private:
    void draw(const ImDrawList& list, const ImDrawData& data) const;

    SDL_Renderer* renderer_;
    SDL_Texture* font_ = nullptr;
};

}  // namespace carom::app
