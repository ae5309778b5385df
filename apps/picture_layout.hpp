// Where things go in a picture: the map from the scene's plane to pixels, margins, ticks.
#pragma once

#include <string>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::app {

/// Pixels of a PNG, points of an SVG.
struct PictureSize {
    int width = 0;
    int height = 0;
};

inline constexpr int kSmallestSide = 160;
inline constexpr int kLargestSide = 8192;

/// Places a view in a picture: same scale on both axes, y up, as large as the margins for title, ticks and
/// legend leave room for.
struct PictureLayout {
    /// Preconditions: the view has an area; the sides lie between kSmallestSide and kLargestSide.
    PictureLayout(const Box& view_box, PictureSize picture_size);

    [[nodiscard]] Vec2 to_pixel(const Vec2& position) const {
        return {left + (position.x() - view.min.x()) * scale, bottom - (position.y() - view.min.y()) * scale};
    }

    Box view;
    PictureSize size;
    double unit = 1;   ///< the size of small things (lines, letters): 1 in a picture of a megapixel
    double scale = 1;  ///< pixels per length
    double left = 0, right = 0, top = 0, bottom = 0;  ///< sides of the frame, in pixels
};

/// A size that fits the view's aspect with no empty bands: the frame's longer side has about 1,000 pixels.
[[nodiscard]] PictureSize default_size(const Box& view);

/// About `wanted` multiples of 1, 2 or 5 times a power of ten, from low to high, both included. Precondition:
/// low < high, finite.
struct Ticks {
    std::vector<double> values;
    double step = 1;
};
[[nodiscard]] Ticks nice_ticks(double low, double high, int wanted);

/// The number as a tick's label: no more digits than the step needs, a true minus sign.
[[nodiscard]] std::string tick_label(double value, double step);

/// 1234567 as "1,234,567".
[[nodiscard]] std::string with_thousands(unsigned long long number);

}  // namespace carom::app
