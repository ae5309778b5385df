// What the balls' colours stand for, and the range of numbers that the colours span.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

#include "colour_map.hpp"

namespace carom::app {

enum class ColourBy : std::uint8_t { kSpeed, kSize, kCollisions, kDomain };
inline constexpr std::array kAllColourBy = {ColourBy::kSpeed, ColourBy::kSize, ColourBy::kCollisions,
                                            ColourBy::kDomain};

/// As options, legends and buttons have it.
[[nodiscard]] const char* name_of(ColourBy by);

struct Colouring {
    ColourBy by = ColourBy::kSpeed;
    std::vector<float> values;  ///< one a ball
    double low = 0;             ///< the value of the colours' lower end,
    double high = 1;            ///< and of their upper end; low < high
    bool has_more = false;      ///< some values lie beyond the upper end

    [[nodiscard]] double fraction_of(double value) const;
    [[nodiscard]] Colour colour_of(std::size_t ball) const { return map_colour(fraction_of(values[ball])); }
};

/// The value below which the given share of the values lies; 0 where there are none.
[[nodiscard]] double quantile(std::vector<float> values, double share);

/// The speed at the upper end of the colours: the 99th percentile of the moving balls' speeds, so that a few
/// fast ones do not take the colours from the rest; 0 where nothing moves.
[[nodiscard]] double top_speed(const std::vector<Ball>& balls);

/// Colours for balls. `numbers` are their collisions or domains, one a ball, where that is asked for. Static
/// balls have no say in the range. `top` fixes the upper end.
[[nodiscard]] Colouring colouring_of(const std::vector<Ball>& balls, ColourBy by,
                                     const std::vector<std::uint32_t>& numbers = {},
                                     std::optional<double> top = std::nullopt);

}  // namespace carom::app
