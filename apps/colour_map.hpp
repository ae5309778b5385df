// Colours that stand for numbers.
#pragma once

#include <cstdint>

namespace carom::app {

/// Red, green and blue in sRGB, each in [0, 1].
struct Colour {
    double red = 0;
    double green = 0;
    double blue = 0;
};

/// The colour of a fraction of the range, from slow (0, violet) to fast (1, yellow); fractions outside are
/// clamped, NaN counts as 0. Equal differences look equal, and the order survives in grey and for the
/// colour-blind: it is viridis without its darkest eighth, which would be lost on a dark ground.
[[nodiscard]] Colour map_colour(double fraction);

/// One native 32-bit number 0xAARRGGBB, each colour times alpha, as cairo and SDL have it.
[[nodiscard]] std::uint32_t pixel_of(const Colour& colour, double alpha = 1);

/// `a` at 0, `b` at 1.
[[nodiscard]] Colour mix(const Colour& a, const Colour& b, double share_of_b);

}  // namespace carom::app
