// A picture's view, and the order of its layers.
#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "picture_parts.hpp"

namespace carom::app {
namespace {

constexpr double kViewMargin = 0.03;  // of the longer side, around a scene without a domain

void include_disc(Box& box, const Vec2& centre, double radius) {
    if (!centre.allFinite()) return;
    box.min = box.min.cwiseMin(Vec2(centre.array() - radius));
    box.max = box.max.cwiseMax(Vec2(centre.array() + radius));
}

Box bounding_box(const PictureContent& content) {
    constexpr double kHuge = std::numeric_limits<double>::infinity();
    Box box{{kHuge, kHuge}, {-kHuge, -kHuge}};
    for (const Ball& ball : content.balls) include_disc(box, ball.position, ball.radius);
    for (const Wall& wall : content.walls) {
        include_disc(box, wall.from, 0);
        include_disc(box, wall.to, 0);
    }
    for (const Attractor& attractor : content.attractors) {
        include_disc(box, attractor.position, attractor.softening);
    }
    for (const Sensor& sensor : content.sensors)
        for (const Vec2& corner : sensor.corners) include_disc(box, corner, sensor.radius);
    return box;
}

}  // namespace

Box view_of(const PictureContent& content) {
    if (content.view) return *content.view;
    if (content.domain) return content.domain->box;
    Box box = bounding_box(content);
    if (!(box.min.x() <= box.max.x())) return {{-1, -1}, {1, 1}};  // nothing there
    const Vec2 extent = box.max - box.min;
    const double longer = extent.maxCoeff();
    const double margin = longer > 0 ? kViewMargin * longer : 1;
    // A row of tiny things still gets a band to stand in.
    const Vec2 grow = (Vec2(extent.array() + 2 * margin).cwiseMax(longer / 8) - extent) / 2;
    return {box.min - grow, box.max + grow};
}

std::size_t count_outside(const std::vector<Ball>& balls, const Box& view) {
    const auto is_outside = [&view](const Ball& ball) {
        return ball.position.x() + ball.radius < view.min.x() ||
               ball.position.x() - ball.radius > view.max.x() ||
               ball.position.y() + ball.radius < view.min.y() ||
               ball.position.y() - ball.radius > view.max.y();
    };
    return static_cast<std::size_t>(std::count_if(balls.begin(), balls.end(), is_outside));
}

void draw_picture(cairo_t* context, const PictureContent& content, const PictureLayout& layout,
                  double pixels_per_unit) {
    const Colouring colouring =
        colouring_of(content.balls, content.colour_by, content.numbers, content.colour_top);
    draw_ground(context, layout);
    cairo_save(context);
    cairo_rectangle(context, layout.left, layout.top, layout.right - layout.left, layout.bottom - layout.top);
    cairo_clip(context);
    draw_attractors(context, content, layout);
    draw_sensors(context, content, layout);
    if (content.balls.size() <= kVectorBalls) {
        draw_balls_singly(context, content, layout, colouring);
    } else {
        draw_balls_gathered(context, content, layout, colouring, pixels_per_unit);
    }
    draw_walls(context, content, layout);
    cairo_restore(context);
    draw_frame(context, content, layout);
    draw_legend(context, layout, colouring);
    draw_title(context, content, layout);
}

}  // namespace carom::app
