// Letters and small lines of a picture.
#include "picture_text.hpp"

#include <algorithm>
#include <cstddef>

#include "picture_palette.hpp"

namespace carom::app {
namespace {

// The length of the UTF-8 sequence at `place`, 0 where there is none.
std::size_t sequence_length(const std::string& text, std::size_t place) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    };
    const unsigned lead = byte(place);
    if (lead < 0x80U) return 1;
    const std::size_t length = lead >= 0xC2U && lead < 0xE0U   ? 2
                               : (lead & 0xF0U) == 0xE0U       ? 3
                               : lead >= 0xF0U && lead < 0xF5U ? 4
                                                               : 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(place + i) & 0xC0U) != 0x80U) return 0;
    }
    // The second byte tells overlong forms, surrogates and what lies beyond Unicode.
    const unsigned second = byte(place + 1);
    const bool wrong = (lead == 0xE0U && second < 0xA0U) || (lead == 0xEDU && second >= 0xA0U) ||
                       (lead == 0xF0U && second < 0x90U) || (lead == 0xF4U && second >= 0x90U);
    return wrong ? 0 : length;
}

}  // namespace

void select_font(cairo_t* context, double size, bool bold) {
    cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context, size);
}

double text_width(cairo_t* context, const std::string& text) {
    cairo_text_extents_t extents;
    cairo_text_extents(context, text.c_str(), &extents);
    return extents.x_advance;
}

void draw_text(cairo_t* context, const std::string& text, double x, double baseline, Align align) {
    const double width = text_width(context, text);
    const double shift = align == Align::kLeft ? 0 : align == Align::kCentre ? width / 2 : width;
    cairo_move_to(context, x - shift, baseline);
    cairo_show_text(context, text.c_str());
}

// cairo refuses what is no UTF-8, and a file's name may be anything.
std::string printable(const std::string& text) {
    std::string clean;
    for (std::size_t place = 0; place < text.size();) {
        const std::size_t length = sequence_length(text, place);
        const bool is_control = length == 1 && static_cast<unsigned char>(text[place]) < 0x20U;
        if (length == 0) {
            clean += "\ufffd";
        } else if (is_control) {
            clean += ' ';
        } else {
            clean.append(text, place, length);
        }
        place += std::max<std::size_t>(length, 1);
    }
    return clean;
}

// Cut at a character's start, never within a UTF-8 sequence.
std::string shortened(cairo_t* context, std::string text, double width) {
    if (text_width(context, text) <= width) return text;
    while (!text.empty() && text_width(context, text + "\u2026") > width) {
        while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
        if (!text.empty()) text.pop_back();
    }
    return text + "\u2026";
}

void draw_tick(cairo_t* context, const Vec2& from, const Vec2& to, double unit) {
    cairo_set_line_width(context, unit);
    set_colour(context, palette::kFaintText);
    cairo_move_to(context, from.x(), from.y());
    cairo_line_to(context, to.x(), to.y());
    cairo_stroke(context);
}

}  // namespace carom::app
