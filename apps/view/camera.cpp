#include "camera.hpp"

namespace carom::app {

void Camera::fit(const Box& box, double left) {
    constexpr double kMargin = 24;  // pixels
    const Vec2 extent = box.max - box.min;
    const double room_x = std::max(width_ - left - 2 * kMargin, 16.0);
    const double room_y = std::max(height_ - 2 * kMargin, 16.0);
    scale_ = fitted_ = std::min(room_x / extent.x(), room_y / extent.y());
    centre_ = (box.min + box.max) / 2;
    pan({left / 2, 0});
}

void Camera::zoom(double factor, const Vec2& pixel) {
    constexpr double kFarthest = 1.0 / 64;
    constexpr double kNearest = 1e9;
    const Vec2 fixed = to_place(pixel);
    scale_ = std::clamp(scale_ * factor, fitted_ * kFarthest, fitted_ * kNearest);
    pan(pixel - to_pixel(fixed));
}

}  // namespace carom::app
