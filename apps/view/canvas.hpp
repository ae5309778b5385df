// A picture in memory that discs and lines are painted on, fast enough for 100,000 balls a frame: the cost is
// the pixels that are painted. The same on every machine, whatever draws the window.
#pragma once

#include <cstdint>
#include <vector>

#include <carom/core/vector.hpp>

#include "colour_map.hpp"

namespace carom::app {

class Canvas {
 public:
    void resize(int width, int height);
    void clear(std::uint32_t colour);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] const std::vector<std::uint32_t>& pixels() const { return pixels_; }
    [[nodiscard]] std::uint32_t at(int x, int y) const {
        return pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
    }

    /// A disc with soft edges; one smaller than a pixel is a pixel of as much less colour.
    void disc(const Vec2& centre, double radius, std::uint32_t colour);
    /// A ring inside the radius, `width` wide.
    void ring(const Vec2& centre, double radius, double width, std::uint32_t colour);
    /// A line with round ends.
    void line(const Vec2& from, const Vec2& to, double width, std::uint32_t colour);

 private:
    void blend(int x, int y, std::uint32_t colour, double share);
    void dot(const Vec2& centre, double radius, std::uint32_t colour);
    template <class Share>
    void paint(const Vec2& low, const Vec2& high, std::uint32_t colour, Share share);

    int width_ = 0;
    int height_ = 0;
    std::vector<std::uint32_t> pixels_;
};

}  // namespace carom::app
