// Letters and small lines of a picture.
#pragma once

#include <cairo.h>

#include <cstdint>
#include <string>

#include <carom/core/vector.hpp>

namespace carom::app {

enum class Align : std::uint8_t { kLeft, kCentre, kRight };

void select_font(cairo_t* context, double size, bool bold = false);

[[nodiscard]] double text_width(cairo_t* context, const std::string& text);

void draw_text(cairo_t* context, const std::string& text, double x, double baseline, Align align);

/// The text with what is no UTF-8 and no letter replaced: cairo refuses it, and a file's name may be
/// anything.
[[nodiscard]] std::string printable(const std::string& text);

/// Cut to a width, at a character's start, with an ellipsis.
[[nodiscard]] std::string shortened(cairo_t* context, std::string text, double width);

/// A short line of the frame's faint colour.
void draw_tick(cairo_t* context, const Vec2& from, const Vec2& to, double unit);

}  // namespace carom::app
