#include "imgui_renderer.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>

namespace carom::app {

ImguiRenderer::ImguiRenderer(SDL_Renderer* renderer) : renderer_(renderer) {
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    ImFontAtlas* const fonts = ImGui::GetIO().Fonts;
    fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    font_ = SDL_CreateTexture(renderer_, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, width, height);
    if (font_ == nullptr) throw std::runtime_error(std::string("no texture for letters: ") + SDL_GetError());
    SDL_UpdateTexture(font_, nullptr, pixels, 4 * width);
    SDL_SetTextureBlendMode(font_, SDL_BLENDMODE_BLEND);
    fonts->SetTexID(font_);
}

ImguiRenderer::~ImguiRenderer() {
    SDL_DestroyTexture(font_);
}

void ImguiRenderer::draw(const ImDrawData& data) const {
    for (int i = 0; i < data.CmdListsCount; ++i) draw(*data.CmdLists[i], data);
    SDL_RenderSetClipRect(renderer_, nullptr);
}

void ImguiRenderer::draw(const ImDrawList& list, const ImDrawData& data) const {
    constexpr int kStride = sizeof(ImDrawVert);
    for (const ImDrawCmd& command : list.CmdBuffer) {
        const ImVec2 low{command.ClipRect.x - data.DisplayPos.x, command.ClipRect.y - data.DisplayPos.y};
        const ImVec2 high{command.ClipRect.z - data.DisplayPos.x, command.ClipRect.w - data.DisplayPos.y};
        const SDL_Rect clip{int(low.x), int(low.y), int(high.x - low.x), int(high.y - low.y)};
        if (clip.w <= 0 || clip.h <= 0 || command.UserCallback != nullptr) continue;
        SDL_RenderSetClipRect(renderer_, &clip);
        const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
        SDL_RenderGeometryRaw(renderer_, static_cast<SDL_Texture*>(command.GetTexID()), &vertices->pos.x,
                              kStride, reinterpret_cast<const SDL_Color*>(&vertices->col), kStride,
                              &vertices->uv.x, kStride, list.VtxBuffer.Size - int(command.VtxOffset),
                              list.IdxBuffer.Data + command.IdxOffset, int(command.ElemCount),
                              sizeof(ImDrawIdx));
    }
}

}  // namespace carom::app
