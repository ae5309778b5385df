// The layers of a picture, from the back to the front. draw_picture puts them together.
#pragma once

#include <cairo.h>

#include <array>

#include "picture.hpp"

namespace carom::app {

/// Page, and the view's ground.
void draw_ground(cairo_t* context, const PictureLayout& layout);

/// Attractors: a dark disc in a glow, warm where it pulls and blue where it pushes.
void draw_attractors(cairo_t* context, const PictureContent& content, const PictureLayout& layout);

/// Sensors: a veil over where they reach, and the line of their corners.
void draw_sensors(cairo_t* context, const PictureContent& content, const PictureLayout& layout);

/// The balls one by one.
void draw_balls_singly(cairo_t* context, const PictureContent& content, const PictureLayout& layout,
                       const Colouring& colouring);

/// The balls gathered into an image with `pixels_per_unit` pixels to a unit of the layout.
void draw_balls_gathered(cairo_t* context, const PictureContent& content, const PictureLayout& layout,
                         const Colouring& colouring, double pixels_per_unit);

/// The scene's segments.
void draw_walls(cairo_t* context, const PictureContent& content, const PictureLayout& layout);

/// The view's sides (full: wall, dashed: periodic, dotted: open), with ticks.
void draw_frame(cairo_t* context, const PictureContent& content, const PictureLayout& layout);

/// The colours' scale.
void draw_legend(cairo_t* context, const PictureLayout& layout, const Colouring& colouring);

/// Title, time and count of balls.
void draw_title(cairo_t* context, const PictureContent& content, const PictureLayout& layout);

/// Calls `draw(position)` for a ball at every place where it shows: its own, and across periodic sides where
/// it overlaps them.
template <class Draw>
void for_each_image(const std::optional<Domain>& domain, const Ball& ball, Draw draw) {
    const Box box = domain ? domain->box : Box{};
    const auto shift_range = [&](std::size_t axis) {
        const auto place = Eigen::Index(axis);
        const bool periodic = domain && domain->boundary[axis] == Boundary::kPeriodic;
        const int low = periodic && ball.position[place] + ball.radius > box.max[place] ? -1 : 0;
        const int high = periodic && ball.position[place] - ball.radius < box.min[place] ? 1 : 0;
        return std::array<int, 2>{low, high};
    };
    const Vec2 extent = box.max - box.min;
    const auto [low_x, high_x] = shift_range(0);
    const auto [low_y, high_y] = shift_range(1);
    for (int y = low_y; y <= high_y; ++y) {
        for (int x = low_x; x <= high_x; ++x) {
            draw(Vec2{ball.position.x() + x * extent.x(), ball.position.y() + y * extent.y()});
        }
    }
}

}  // namespace carom::app
