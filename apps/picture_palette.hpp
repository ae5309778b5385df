// The colours of a picture's parts that do not stand for a number.
#pragma once

#include <cairo.h>

#include "colour_map.hpp"

namespace carom::app::palette {

inline constexpr Colour kPage{0.043, 0.051, 0.071};
inline constexpr Colour kGround{0.075, 0.086, 0.118};
inline constexpr Colour kText{0.91, 0.92, 0.94};
inline constexpr Colour kFaintText{0.58, 0.61, 0.67};
inline constexpr Colour kFrame{0.72, 0.75, 0.80};
inline constexpr Colour kWall{0.94, 0.91, 0.84};
inline constexpr Colour kStaticBall{0.36, 0.39, 0.45};
inline constexpr Colour kStaticHatch{0.53, 0.56, 0.62};
inline constexpr Colour kSensor{0.35, 0.85, 0.72};
inline constexpr Colour kPullGlow{1.0, 0.62, 0.24};
inline constexpr Colour kPushGlow{0.36, 0.68, 1.0};

}  // namespace carom::app::palette

namespace carom::app {

inline void set_colour(cairo_t* context, const Colour& colour, double alpha = 1) {
    cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, alpha);
}

}  // namespace carom::app
