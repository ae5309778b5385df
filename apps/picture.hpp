// A still of a scene: coloured balls, walls, static balls and attractors in a frame with ticks.
#pragma once

#include <cairo.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

#include "colouring.hpp"
#include "picture_layout.hpp"

namespace carom::app {

/// What is drawn. Positions in the scene's units; the picture's y axis points up.
struct PictureContent {
    std::string title;
    double time = 0;
    int time_digits = 6;           ///< of the time in the title
    std::optional<Domain> domain;  ///< where absent the view is what holds everything
    std::vector<Ball> balls;
    std::vector<Wall> walls;
    std::vector<Attractor> attractors;
    std::vector<Sensor> sensors;
    ColourBy colour_by = ColourBy::kSpeed;
    std::vector<std::uint32_t> numbers;  ///< collisions or domains, one a ball, where the colours show them
    std::optional<double> colour_top;  ///< value at the colours' upper end; where absent it follows the balls
    std::optional<Box> view;           ///< shown instead of the domain
};

/// The rectangle that the picture shows: the content's view, or the domain, or where there is none a box
/// around everything with a margin.
[[nodiscard]] Box view_of(const PictureContent& content);

/// How many balls lie wholly outside the view.
[[nodiscard]] std::size_t count_outside(const std::vector<Ball>& balls, const Box& view);

/// Draws the picture over the context's whole surface of `layout.size` units. Up to kVectorBalls balls become
/// discs of the surface's own kind; more are gathered into an image of `pixels_per_unit` pixels a unit, in
/// which a pixel's colour is of the mean value of the balls in it and its strength follows the area they
/// cover. Takes time in proportion to the balls and the pixels.
void draw_picture(cairo_t* context, const PictureContent& content, const PictureLayout& layout,
                  double pixels_per_unit);

/// Beyond so many balls single discs are too small to tell apart, and a vector file of them too large to
/// open.
inline constexpr std::size_t kVectorBalls = 20'000;

}  // namespace carom::app
