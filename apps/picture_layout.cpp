// Margins, scale and ticks of a picture.
#include "picture_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace carom::app {
namespace {

// In layout units. Left and bottom hold tick labels, top the title and its second line, right the legend.
constexpr double kLeftMargin = 66;
constexpr double kRightMargin = 112;
constexpr double kTopMargin = 76;
constexpr double kBottomMargin = 48;

constexpr double kDefaultFrameSide = 1000;
constexpr double kShortestFrameSide = 220;  // room for the legend beside a flat scene

double unit_of(PictureSize size) {
    return std::clamp(std::sqrt(double(size.width) * double(size.height)) / 1000, 0.4, 4.0);
}

}  // namespace

PictureLayout::PictureLayout(const Box& view_box, PictureSize picture_size)
    : view(view_box), size(picture_size), unit(unit_of(picture_size)) {
    const Vec2 extent = view.max - view.min;
    // Extreme aspects squeeze the margins before they squeeze the frame away.
    const double room_x = std::max(size.width - unit * (kLeftMargin + kRightMargin), size.width * 0.25);
    const double room_y = std::max(size.height - unit * (kTopMargin + kBottomMargin), size.height * 0.25);
    scale = std::min(room_x / extent.x(), room_y / extent.y());
    const double margin_share_x = kLeftMargin / (kLeftMargin + kRightMargin);
    const double margin_share_y = kTopMargin / (kTopMargin + kBottomMargin);
    // Centred between the margins, on whole pixels so that the frame's lines are sharp.
    left = std::round((size.width - room_x) * margin_share_x + (room_x - scale * extent.x()) / 2);
    top = std::round((size.height - room_y) * margin_share_y + (room_y - scale * extent.y()) / 2);
    right = left + scale * extent.x();
    bottom = top + scale * extent.y();
}

PictureSize default_size(const Box& view) {
    const Vec2 extent = view.max - view.min;
    const double scale = kDefaultFrameSide / std::max(extent.x(), extent.y());
    const double frame_x = std::max(extent.x() * scale, kShortestFrameSide);
    const double frame_y = std::max(extent.y() * scale, kShortestFrameSide);
    // The margins scale with the picture's size, which they are part of: a few rounds settle it.
    double unit = 1;
    PictureSize size;
    for (int round = 0; round < 8; ++round) {
        size = {int(std::lround(frame_x + unit * (kLeftMargin + kRightMargin))),
                int(std::lround(frame_y + unit * (kTopMargin + kBottomMargin)))};
        unit = unit_of(size);
    }
    return size;
}

Ticks nice_ticks(double low, double high, int wanted) {
    const double rough = (high - low) / std::max(wanted, 1);
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double ratio = rough / power;
    // 1, 2, 5 or 10: the nearest in proportion, split at the geometric means.
    const double multiple = ratio < 1.4142 ? 1 : ratio < 3.1623 ? 2 : ratio < 7.0711 ? 5 : 10;
    Ticks ticks{{}, multiple * power};
    const double slack = 1e-9 * (high - low) / ticks.step;
    const double first = std::ceil(low / ticks.step - slack);
    const double last = std::floor(high / ticks.step + slack);
    // Far from zero the step can vanish beside the numbers: then there are no ticks rather than thousands.
    if (!(last - first < 4.0 * std::max(wanted, 1) + 4)) return ticks;
    const auto count = static_cast<int>(last - first) + 1;
    for (int k = 0; k < count; ++k) ticks.values.push_back((first + k) * ticks.step);
    return ticks;
}

std::string tick_label(double value, double step) {
    const double size = std::max(std::abs(value), step);
    const int step_power = int(std::floor(std::log10(step) + 1e-9));
    const int decimals = std::max(0, -step_power);
    if (std::abs(value) < step / 2) return "0";
    std::string label;
    if (size < 1e6 && decimals <= 5) {
        label = fmt::format("{:.{}f}", std::abs(value), decimals);
    } else {
        const int digits = int(std::floor(std::log10(size))) - step_power + 1;
        label = fmt::format("{:.{}g}", std::abs(value), std::clamp(digits, 1, 12));
    }
    return (value < 0 ? "\u2212" : "") + label;
}

std::string with_thousands(unsigned long long number) {
    std::string digits = fmt::format("{}", number);
    for (std::size_t place = digits.size(); place > 3;) {
        place -= 3;
        digits.insert(place, 1, ',');
    }
    return digits;
}

}  // namespace carom::app
