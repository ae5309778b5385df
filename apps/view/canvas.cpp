#include "canvas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom::app {

void Canvas::resize(int width, int height) {
    width_ = width, height_ = height;
    pixels_.resize(std::size_t(width) * std::size_t(height));
}

void Canvas::clear(std::uint32_t colour) {
    std::ranges::fill(pixels_, colour);
}

void Canvas::blend(int x, int y, std::uint32_t colour, double share) {
    std::uint32_t& pixel = pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
    const auto weight = std::uint32_t(256 * share);
    // Two bytes at a time: red and blue, green.
    const std::uint32_t red_blue =
        ((pixel & 0xff00ffU) * (256 - weight) + (colour & 0xff00ffU) * weight) >> 8U & 0xff00ffU;
    const std::uint32_t green =
        ((pixel & 0x00ff00U) * (256 - weight) + (colour & 0x00ff00U) * weight) >> 8U & 0x00ff00U;
    pixel = 0xff000000U | red_blue | green;
}

// Calls `share` for the pixels of a rectangle that lie on the canvas.
template <class Share>
void Canvas::paint(const Vec2& low, const Vec2& high, std::uint32_t colour, Share share) {
    // Compared as numbers first: a place far outside does not fit an int, and what is no number is nowhere.
    if (!(high.x() >= 0 && low.x() < width_ && high.y() >= 0 && low.y() < height_)) return;
    const int first_x = int(std::max(low.x(), 0.0)), last_x = int(std::min(high.x(), width_ - 1.0));
    const int first_y = int(std::max(low.y(), 0.0)), last_y = int(std::min(high.y(), height_ - 1.0));
    for (int y = first_y; y <= last_y; ++y) {
        for (int x = first_x; x <= last_x; ++x) {
            const double covered = share(x + 0.5, y + 0.5);
            if (covered > 0) blend(x, y, colour, std::min(covered, 1.0));
        }
    }
}

void Canvas::dot(const Vec2& centre, double radius, std::uint32_t colour) {
    const double area = std::numbers::pi * radius * radius;
    if (!(centre.x() >= 0 && centre.x() < width_ && centre.y() >= 0 && centre.y() < height_)) return;
    // Thin clouds would sink into the ground: never fainter than this.
    blend(int(centre.x()), int(centre.y()), colour, std::clamp(area, 0.35, 1.0));
}

void Canvas::disc(const Vec2& centre, double radius, std::uint32_t colour) {
    if (radius < 0.6) {
        dot(centre, radius, colour);
        return;
    }
    const double outer = radius + 0.5;
    if (!(centre.x() + outer >= 0 && centre.x() - outer < width_)) return;
    if (!(centre.y() + outer >= 0 && centre.y() - outer < height_)) return;
    const int first_y = int(std::max(centre.y() - outer, 0.0));
    const int last_y = int(std::min(centre.y() + outer, height_ - 1.0));
    const double inner = radius - 0.5;
    for (int y = first_y; y <= last_y; ++y) {
        const double dy = y + 0.5 - centre.y();
        const double reach_squared = outer * outer - dy * dy;
        if (!(reach_squared > 0)) continue;
        const double reach = std::sqrt(reach_squared);
        const double full = inner * inner - dy * dy;
        const double solid = full > 0 ? std::sqrt(full) : 0;
        const int first_x = int(std::max(centre.x() - reach, 0.0));
        const int last_x = int(std::min(centre.x() + reach, width_ - 1.0));
        for (int x = first_x; x <= last_x; ++x) {
            const double dx = std::abs(x + 0.5 - centre.x());
            if (dx < solid) {
                pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] = colour;
            } else if (const double covered = outer - std::sqrt(dx * dx + dy * dy); covered > 0) {
                blend(x, y, colour, std::min(covered, 1.0));
            }
        }
    }
}

void Canvas::ring(const Vec2& centre, double radius, double width, std::uint32_t colour) {
    const Vec2 reach{radius + 0.5, radius + 0.5};
    paint(centre - reach, centre + reach, colour, [&](double x, double y) {
        const double distance = std::hypot(x - centre.x(), y - centre.y());
        return std::min(radius + 0.5 - distance, distance - (radius - width) + 0.5);
    });
}

void Canvas::line(const Vec2& from, const Vec2& to, double width, std::uint32_t colour) {
    const Vec2 along = to - from;
    const double length_squared = along.squaredNorm();
    const double outer = width / 2 + 0.5;
    const auto covered = [&](double x, double y) {
        const Vec2 place = Vec2{x, y} - from;
        const double share =
            length_squared > 0 ? std::clamp(place.dot(along) / length_squared, 0.0, 1.0) : 0.0;
        return outer - (place - share * along).norm();
    };
    const double first = std::max(std::min(from.y(), to.y()) - outer, 0.0);
    const double last = std::min(std::max(from.y(), to.y()) + outer, height_ - 1.0);
    // Row by row, each only as wide as the line is there: a slanted line is not its whole rectangle.
    for (double row = std::floor(first); row <= last; row += 1) {
        const auto x_at = [&](double y) {
            const double share = along.y() != 0 ? (y - from.y()) / along.y() : 0;
            return from.x() + std::clamp(share, 0.0, 1.0) * along.x();
        };
        const bool is_level = std::abs(along.y()) < 1;
        const double one = is_level ? from.x() : x_at(row + 0.5 - outer);
        const double other = is_level ? to.x() : x_at(row + 0.5 + outer);
        paint({std::min(one, other) - outer, row}, {std::max(one, other) + outer, row}, colour, covered);
    }
}

}  // namespace carom::app
