// The table is every 15th row from the 30th on of viridis by Nathaniel J. Smith, Stefan van der Walt and Eric
// Firing (2015), https://bids.github.io/colormap, released under CC0.
#include "colour_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace carom::app {
namespace {

constexpr std::array<Colour, 16> kViridis = {{
    {0.280255, 0.165693, 0.476498},
    {0.263663, 0.237631, 0.518762},
    {0.237441, 0.305202, 0.541921},
    {0.208623, 0.367752, 0.552675},
    {0.182256, 0.426184, 0.557120},
    {0.159194, 0.482237, 0.558073},
    {0.137770, 0.537492, 0.554906},
    {0.121148, 0.592739, 0.544641},
    {0.128087, 0.647749, 0.523491},
    {0.180653, 0.701402, 0.488189},
    {0.274149, 0.751988, 0.436601},
    {0.395174, 0.797475, 0.367757},
    {0.535621, 0.835785, 0.281908},
    {0.688944, 0.865448, 0.182725},
    {0.845561, 0.887322, 0.099702},
    {0.993248, 0.906157, 0.143936},
}};

}  // namespace

Colour mix(const Colour& a, const Colour& b, double share_of_b) {
    return {a.red + share_of_b * (b.red - a.red), a.green + share_of_b * (b.green - a.green),
            a.blue + share_of_b * (b.blue - a.blue)};
}

std::uint32_t pixel_of(const Colour& colour, double alpha) {
    const auto byte = [](double value) {
        return std::uint32_t(std::lround(255 * std::clamp(value, 0.0, 1.0)));
    };
    return byte(alpha) << 24U | byte(colour.red * alpha) << 16U | byte(colour.green * alpha) << 8U |
           byte(colour.blue * alpha);
}

Colour map_colour(double fraction) {
    // The comparison is false for NaN, which must not become an index.
    const double clamped = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
    const double place = clamped * double(kViridis.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
    return mix(kViridis[below], kViridis[below + 1], place - double(below));
}

}  // namespace carom::app
