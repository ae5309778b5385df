// Plots as bytes of a PNG or SVG file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "curves.hpp"
#include "picture_file.hpp"

namespace carom::app {

/// Where a panel is and what it shows.
struct PanelLayout {
    double left, right, top, bottom;  ///< of its frame
    Vec2 low, high;                   ///< values at the frame's corners

    [[nodiscard]] Vec2 to_pixel(const Vec2& value) const {
        const Vec2 share = (value - low).cwiseQuotient(high - low);
        return {left + share.x() * (right - left), bottom - share.y() * (bottom - top)};
    }
};

/// Two panels a row, but one alone.
[[nodiscard]] PictureSize default_plot_size(std::size_t panels);
[[nodiscard]] PanelLayout panel_layout(const Plot& plot, std::size_t panel, PictureSize size);

/// The colour of a panel's curve, by its place among those that are no theory.
[[nodiscard]] Colour curve_colour(std::size_t curve);

[[nodiscard]] std::string render_plot(const Plot& plot, PictureFormat format,
                                      const std::optional<PictureSize>& size = std::nullopt);

}  // namespace carom::app
