// Balls and attractors in a picture: few as single discs, many gathered into an image.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "cairo_handles.hpp"
#include "colour_map.hpp"
#include "picture_palette.hpp"
#include "picture_parts.hpp"

namespace carom::app {
namespace {

// A static ball that reaches far beyond any picture is plain: its hatch would be millions of lines, almost
// all out of sight.
constexpr double kLargestHatched = 1e5;

// False also for what is no number. cairo's coordinates are 24 bits wide and wrap beyond.
bool meets_frame(const PictureLayout& layout, const Vec2& centre, double radius) {
    return centre.x() + radius > layout.left && centre.x() - radius < layout.right &&
           centre.y() + radius > layout.top && centre.y() - radius < layout.bottom;
}

void disc_path(cairo_t* context, const Vec2& centre, double radius) {
    cairo_new_path(context);
    cairo_arc(context, centre.x(), centre.y(), radius, 0, 2 * std::numbers::pi);
}

void hatch(cairo_t* context, const Vec2& centre, double radius, double spacing) {
    cairo_save(context);
    cairo_clip_preserve(context);
    set_colour(context, palette::kStaticHatch, 0.8);
    cairo_set_line_width(context, spacing * 0.22);
    cairo_new_path(context);
    // Lines x + y = multiple of the spacing, in the page's frame, so that neighbours' hatches continue each
    // other.
    const double middle = centre.x() + centre.y();
    const double reach = radius * std::numbers::sqrt2;
    const auto first = static_cast<int>(std::ceil((middle - reach) / spacing));
    const auto last = static_cast<int>(std::floor((middle + reach) / spacing));
    for (int k = first; k <= last; ++k) {
        const double sum = k * spacing;
        cairo_move_to(context, centre.x() - radius, sum - (centre.x() - radius));
        cairo_line_to(context, centre.x() + radius, sum - (centre.x() + radius));
    }
    cairo_stroke(context);
    cairo_restore(context);
}

void draw_static_ball(cairo_t* context, const Vec2& centre, double radius, double unit) {
    disc_path(context, centre, radius);
    set_colour(context, palette::kStaticBall);
    cairo_fill_preserve(context);
    if (radius > 4 * unit && radius < kLargestHatched) hatch(context, centre, radius, 6 * unit);
    disc_path(context, centre, std::max(radius - unit / 2, radius / 2));
    set_colour(context, palette::kStaticHatch);
    cairo_set_line_width(context, std::min(unit, radius / 4));
    cairo_stroke(context);
}

// A disc with a rim of the ground's colour inside its edge, so that touching balls of one colour stay apart.
void draw_moving_ball(cairo_t* context, const Vec2& centre, double radius, double unit,
                      const Colour& colour) {
    disc_path(context, centre, radius);
    set_colour(context, colour);
    cairo_fill(context);
    if (radius < 2 * unit) return;
    const double rim = std::min(0.9 * unit, 0.14 * radius);
    disc_path(context, centre, radius - rim / 2);
    set_colour(context, palette::kGround, 0.55);
    cairo_set_line_width(context, rim);
    cairo_stroke(context);
}

// A line from the centre towards where the ball goes; its length is the speed's share of the top speed.
void draw_heading(cairo_t* context, const Vec2& centre, double radius, const Vec2& velocity, double top) {
    const Vec2 along = velocity * (0.82 * radius / std::max(top, velocity.norm()));
    if (along.norm() < 2) return;
    cairo_new_path(context);
    cairo_move_to(context, centre.x(), centre.y());
    cairo_line_to(context, centre.x() + along.x(), centre.y() - along.y());
    cairo_set_line_width(context, std::clamp(0.11 * radius, 1.0, 4.0));
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
    set_colour(context, palette::kPage, 0.75);
    cairo_stroke(context);
}

void paint_glow(cairo_t* context, const Vec2& centre, double core, double reach, const Colour& colour) {
    const CairoPattern glow(
        cairo_pattern_create_radial(centre.x(), centre.y(), core, centre.x(), centre.y(), reach));
    // A sum of two falls, steep by the disc and shallow far out, looks like light.
    constexpr int kStops = 8;
    for (int stop = 0; stop <= kStops; ++stop) {
        const double place = double(stop) / kStops;
        const double alpha = 0.75 * std::pow(1 - place, 5) + 0.22 * std::pow(1 - place, 2);
        cairo_pattern_add_color_stop_rgba(glow.get(), place, colour.red, colour.green, colour.blue, alpha);
    }
    cairo_set_source(context, glow.get());
    disc_path(context, centre, reach);
    cairo_fill(context);
}

}  // namespace

void draw_attractors(cairo_t* context, const PictureContent& content, const PictureLayout& layout) {
    const double frame = std::min(layout.right - layout.left, layout.bottom - layout.top);
    for (const Attractor& attractor : content.attractors) {
        const Vec2 centre = layout.to_pixel(attractor.position);
        const double core = std::clamp(attractor.softening * layout.scale, 6 * layout.unit,
                                       std::max(0.03 * frame, 7 * layout.unit));
        const Colour& colour = attractor.strength < 0 ? palette::kPushGlow : palette::kPullGlow;
        paint_glow(context, centre, core * 0.9, 6 * core, colour);
        disc_path(context, centre, core);
        set_colour(context, {0, 0, 0});
        cairo_fill_preserve(context);
        set_colour(context, mix(colour, {1, 1, 1}, 0.35));
        cairo_set_line_width(context, 1.6 * layout.unit);
        cairo_stroke(context);
    }
}

void draw_balls_singly(cairo_t* context, const PictureContent& content, const PictureLayout& layout,
                       const Colouring& colouring) {
    const double top = top_speed(content.balls);
    for (std::size_t i = 0; i < content.balls.size(); ++i) {
        const Ball& ball = content.balls[i];
        // A ball too small to see is drawn as a dot rather than as nothing.
        const double radius = std::max(ball.radius * layout.scale, 0.4 * layout.unit);
        for_each_image(content.domain, ball, [&](const Vec2& position) {
            const Vec2 centre = layout.to_pixel(position);
            if (!meets_frame(layout, centre, radius)) return;
            if (ball.is_static) {
                draw_static_ball(context, centre, radius, layout.unit);
                return;
            }
            draw_moving_ball(context, centre, radius, layout.unit, colouring.colour_of(i));
            if (radius > 7 * layout.unit && !ball.velocity.isZero(0)) {
                draw_heading(context, centre, radius, ball.velocity, top);
            }
        });
    }
}

}  // namespace carom::app
