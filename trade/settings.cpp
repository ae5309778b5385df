#include <carom/trade/settings.hpp>

#include <algorithm>
#include <cmath>

namespace carom::trade {

double moving_balls(const Scene& scene) {
    return static_cast<double>(std::ranges::count(scene.balls, false, &Ball::is_static));
}

double smallest_radius(const Scene& scene) {
    double radius = HUGE_VAL;
    for (const Ball& b : scene.balls)
        if (!b.is_static) radius = std::min(radius, b.radius);
    return radius;
}

double step_unit(const Scene& scene) {
    double squares = 0;
    for (const Ball& b : scene.balls)
        if (!b.is_static) squares += length_squared(b.velocity);
    return smallest_radius(scene) / std::sqrt(squares / moving_balls(scene));
}

Scene stepped(const Scene& from, const Course& course, double step) {
    Scene scene = from;
    scene.method = Method::kEmpirical;
    scene.max_travel.reset();
    const double sample = course.time_of(1);
    const double whole = step <= sample ? sample : course.stretch;
    scene.step = whole / std::ceil(whole / step);
    return scene;
}

}  // namespace carom::trade
