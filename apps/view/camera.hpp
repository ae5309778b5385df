// What part of the plane a window shows, and where: y up in the plane, down in the window.
#pragma once

#include <algorithm>

#include <carom/core/scene.hpp>

namespace carom::app {

class Camera {
 public:
    /// Window size in pixels.
    void resize(int width, int height) { width_ = width, height_ = height; }
    /// Shows the whole box with a margin, in the part of the window right of `left` pixels.
    void fit(const Box& box, double left = 0);

    [[nodiscard]] Vec2 to_pixel(const Vec2& place) const {
        return {width_ / 2.0 + (place.x() - centre_.x()) * scale_,
                height_ / 2.0 - (place.y() - centre_.y()) * scale_};
    }
    [[nodiscard]] Vec2 to_place(const Vec2& pixel) const {
        return {centre_.x() + (pixel.x() - width_ / 2.0) / scale_,
                centre_.y() - (pixel.y() - height_ / 2.0) / scale_};
    }
    [[nodiscard]] double scale() const { return scale_; }  ///< pixels a length
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    /// Moves what is shown by so many pixels.
    void pan(const Vec2& pixels) { centre_ += Vec2{-pixels.x(), pixels.y()} / scale_; }
    /// What is under the pixel stays there.
    void zoom(double factor, const Vec2& pixel);

 private:
    int width_ = 1;
    int height_ = 1;
    Vec2 centre_ = Vec2::Zero();
    double scale_ = 1;
    double fitted_ = 1;  // the scale that shows all, from which one can go only so far
};

}  // namespace carom::app
