// What stands around and over the balls: ground, walls, frame with ticks, legend, title.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "cairo_handles.hpp"
#include "colour_map.hpp"
#include "picture_palette.hpp"
#include "picture_parts.hpp"
#include "picture_text.hpp"

namespace carom::app {
namespace {

Boundary side_kind(const PictureContent& content, std::size_t axis) {
    return content.domain && !content.view ? content.domain->boundary[axis] : Boundary::kOpen;
}

void draw_side(cairo_t* context, const Vec2& from, const Vec2& to, Boundary kind, double unit) {
    const double dash_periodic[] = {7 * unit, 5 * unit};
    const double dash_open[] = {1 * unit, 4 * unit};
    double width = 2.4 * unit;
    cairo_set_dash(context, nullptr, 0, 0);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_SQUARE);
    set_colour(context, palette::kFrame);
    if (kind != Boundary::kWall) {
        width = 1.2 * unit;
        cairo_set_line_cap(context, CAIRO_LINE_CAP_BUTT);
        cairo_set_dash(context, kind == Boundary::kPeriodic ? dash_periodic : dash_open, 2, 0);
        set_colour(context, palette::kFrame, 0.8);
    }
    cairo_set_line_width(context, width);
    cairo_move_to(context, from.x(), from.y());
    cairo_line_to(context, to.x(), to.y());
    cairo_stroke(context);
    cairo_set_dash(context, nullptr, 0, 0);
}

void draw_ticks(cairo_t* context, const PictureLayout& layout) {
    const double unit = layout.unit;
    select_font(context, 13 * unit);
    const auto wanted = [&](double pixels, double each) { return std::max(1, int(pixels / (each * unit))); };
    const Ticks along_x =
        nice_ticks(layout.view.min.x(), layout.view.max.x(), wanted(layout.right - layout.left, 110));
    for (const double value : along_x.values) {
        const double x = layout.to_pixel({value, layout.view.min.y()}).x();
        draw_tick(context, {x, layout.bottom + 4 * unit}, {x, layout.bottom + 9 * unit}, unit);
        draw_text(context, tick_label(value, along_x.step), x, layout.bottom + 25 * unit, Align::kCentre);
    }
    const Ticks along_y =
        nice_ticks(layout.view.min.y(), layout.view.max.y(), wanted(layout.bottom - layout.top, 110));
    for (const double value : along_y.values) {
        const double y = layout.to_pixel({layout.view.min.x(), value}).y();
        draw_tick(context, {layout.left - 9 * unit, y}, {layout.left - 4 * unit, y}, unit);
        draw_text(context, tick_label(value, along_y.step), layout.left - 13 * unit, y + 4.5 * unit,
                  Align::kRight);
    }
}

}  // namespace

void draw_ground(cairo_t* context, const PictureLayout& layout) {
    set_colour(context, palette::kPage);
    cairo_paint(context);
    set_colour(context, palette::kGround);
    cairo_rectangle(context, layout.left, layout.top, layout.right - layout.left, layout.bottom - layout.top);
    cairo_fill(context);
}

void draw_walls(cairo_t* context, const PictureContent& content, const PictureLayout& layout) {
    cairo_set_line_width(context, 2 * layout.unit);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
    set_colour(context, palette::kWall);
    for (const Wall& wall : content.walls) {
        const Vec2 from = layout.to_pixel(wall.from);
        const Vec2 to = layout.to_pixel(wall.to);
        cairo_move_to(context, from.x(), from.y());
        cairo_line_to(context, to.x(), to.y());
    }
    cairo_stroke(context);
}

void draw_sensors(cairo_t* context, const PictureContent& content, const PictureLayout& layout) {
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
    for (const Sensor& sensor : content.sensors) {
        const auto trace = [&] {
            for (const Vec2& corner : sensor.corners) {
                const Vec2 at = layout.to_pixel(corner);
                cairo_line_to(context, at.x(), at.y());
            }
            cairo_close_path(context);
        };
        cairo_push_group(context);
        set_colour(context, palette::kSensor);
        trace();
        cairo_fill_preserve(context);
        cairo_set_line_width(context, 2 * sensor.radius * layout.scale);
        cairo_stroke(context);
        cairo_pop_group_to_source(context);
        cairo_paint_with_alpha(context, 0.16);
        set_colour(context, palette::kSensor, 0.8);
        cairo_set_line_width(context, 1.2 * layout.unit);
        trace();
        cairo_stroke(context);
    }
}

void draw_frame(cairo_t* context, const PictureContent& content, const PictureLayout& layout) {
    const double unit = layout.unit;
    // A wall's line stands outside the view by half its width, so that its inner edge is where balls turn.
    const double off_x = side_kind(content, 0) == Boundary::kWall ? 1.2 * unit : 0;
    const double off_y = side_kind(content, 1) == Boundary::kWall ? 1.2 * unit : 0;
    const Vec2 low{layout.left - off_x, layout.bottom + off_y};
    const Vec2 high{layout.right + off_x, layout.top - off_y};
    draw_side(context, {low.x(), low.y()}, {low.x(), high.y()}, side_kind(content, 0), unit);
    draw_side(context, {high.x(), low.y()}, {high.x(), high.y()}, side_kind(content, 0), unit);
    draw_side(context, {low.x(), low.y()}, {high.x(), low.y()}, side_kind(content, 1), unit);
    draw_side(context, {low.x(), high.y()}, {high.x(), high.y()}, side_kind(content, 1), unit);
    draw_ticks(context, layout);
}

void draw_legend(cairo_t* context, const PictureLayout& layout, const Colouring& colouring) {
    if (colouring.by == ColourBy::kDomain) return;  // a colour is a name there, not a number
    const double unit = layout.unit;
    const double left = layout.right + 28 * unit;
    const double width = 14 * unit;
    const double height = std::min(layout.bottom - layout.top, 420 * unit);
    const double top = layout.top + (layout.bottom - layout.top - height) / 2 + 12 * unit;
    const double bottom = top + height - 24 * unit;

    const CairoPattern colours(cairo_pattern_create_linear(0, bottom, 0, top));
    constexpr int kStops = 32;
    for (int stop = 0; stop <= kStops; ++stop) {
        const double place = double(stop) / kStops;
        const Colour colour = map_colour(place);
        cairo_pattern_add_color_stop_rgb(colours.get(), place, colour.red, colour.green, colour.blue);
    }
    cairo_set_source(context, colours.get());
    cairo_rectangle(context, left, top, width, bottom - top);
    cairo_fill(context);
    if (colouring.has_more) {  // a point on top: the colour of the end stands for everything beyond it, too
        set_colour(context, map_colour(1));
        cairo_move_to(context, left, top);
        cairo_line_to(context, left + width / 2, top - 11 * unit);
        cairo_line_to(context, left + width, top);
        cairo_close_path(context);
        cairo_fill(context);
    }

    select_font(context, 13 * unit);
    const Ticks ticks =
        nice_ticks(colouring.low, colouring.high, std::max(1, int((bottom - top) / (70 * unit))));
    for (const double value : ticks.values) {
        const double y = bottom - (bottom - top) * colouring.fraction_of(value);
        draw_tick(context, {left + width, y}, {left + width + 5 * unit, y}, unit);
        draw_text(context, tick_label(value, ticks.step), left + width + 10 * unit, y + 4.5 * unit,
                  Align::kLeft);
    }
    draw_text(context, colouring.by == ColourBy::kSize ? "radius" : name_of(colouring.by), left,
              bottom + 20 * unit, Align::kLeft);
}

void draw_title(cairo_t* context, const PictureContent& content, const PictureLayout& layout) {
    const double unit = layout.unit;
    const double room = layout.size.width - layout.left - 10 * unit;
    select_font(context, 21 * unit, true);
    set_colour(context, palette::kText);
    draw_text(context, shortened(context, printable(content.title), room), layout.left,
              layout.top - 38 * unit, Align::kLeft);

    const std::size_t count = content.balls.size();
    std::string line = fmt::format("t = {:.{}g}  \u00b7  {} ball{}", content.time, content.time_digits,
                                   with_thousands(count), count == 1 ? "" : "s");
    if (const std::size_t outside = count_outside(content.balls, layout.view); outside > 0) {
        line += fmt::format("  \u00b7  {} outside", with_thousands(outside));
    }
    select_font(context, 14 * unit);
    set_colour(context, palette::kFaintText);
    draw_text(context, shortened(context, line, room), layout.left, layout.top - 15 * unit, Align::kLeft);
}

}  // namespace carom::app
