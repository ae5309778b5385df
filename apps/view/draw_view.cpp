#include "draw_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "picture_palette.hpp"
#include "picture_parts.hpp"

namespace carom::app {
namespace {

constexpr std::uint32_t kLookedAt = 0xffffffffU;

/// The colours as pixels: computed once and not for each of 100,000 balls.
class PixelTable {
 public:
    PixelTable() {
        for (std::size_t i = 0; i < table_.size(); ++i)
            table_[i] = pixel_of(map_colour(double(i) / double(table_.size() - 1)));
    }
    [[nodiscard]] std::uint32_t at(double fraction) const {
        const double clamped = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
        return table_[std::size_t(clamped * double(table_.size() - 1))];
    }

 private:
    std::array<std::uint32_t, 512> table_{};
};

void draw_domain(Canvas& canvas, const Scene& scene, const Camera& camera) {
    if (!scene.domain) return;
    const Vec2 low = camera.to_pixel(scene.domain->box.min);
    const Vec2 high = camera.to_pixel(scene.domain->box.max);
    const auto side = [&](std::size_t axis, const Vec2& from, const Vec2& to) {
        const bool is_wall = scene.domain->boundary[axis] == Boundary::kWall;
        const Colour colour = mix(palette::kPage, palette::kFrame, is_wall ? 1 : 0.4);
        canvas.line(from, to, is_wall ? 2 : 1, pixel_of(colour));
    };
    side(0, low, {low.x(), high.y()});
    side(0, {high.x(), low.y()}, high);
    side(1, low, {high.x(), low.y()});
    side(1, {low.x(), high.y()}, high);
}

void draw_attractors(Canvas& canvas, const std::vector<Attractor>& attractors, const Camera& camera) {
    for (const Attractor& attractor : attractors) {
        const Vec2 centre = camera.to_pixel(attractor.position);
        const double radius = std::max(attractor.softening * camera.scale(), 6.0);
        const Colour& glow = attractor.strength < 0 ? palette::kPushGlow : palette::kPullGlow;
        for (int layer = 8; layer > 0; --layer)
            canvas.disc(centre, radius * (1 + 0.12 * layer),
                        pixel_of(mix(palette::kGround, glow, 0.6 / (1 + layer))));
        canvas.disc(centre, radius, pixel_of({0, 0, 0}));
        canvas.ring(centre, radius, 1.5, pixel_of(glow));
    }
}

void draw_balls(Canvas& canvas, const Simulation& simulation, const ViewControls& controls) {
    static const PixelTable table;
    const std::vector<Ball>& balls = simulation.balls();
    const Camera& camera = controls.camera;
    std::vector<std::uint32_t> numbers;
    if (controls.colour_by == ColourBy::kDomain) numbers = simulation.world().domains_of_balls();
    if (controls.colour_by == ColourBy::kCollisions) numbers = simulation.log().counts();
    const Colouring colouring = colouring_of(balls, controls.colour_by, numbers);
    const std::uint32_t fixed = pixel_of(palette::kStaticBall);
    const std::uint32_t ground = pixel_of(palette::kGround);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const std::uint32_t colour =
            balls[i].is_static ? fixed : table.at(colouring.fraction_of(double(colouring.values[i])));
        const double radius = balls[i].radius * camera.scale();
        for_each_image(simulation.scene().domain, balls[i], [&](const Vec2& place) {
            const Vec2 centre = camera.to_pixel(place);
            // A thin dark rim keeps touching balls of one colour apart.
            if (radius > 3) canvas.disc(centre, radius, ground);
            canvas.disc(centre, radius > 3 ? radius - std::min(0.08 * radius, 1.0) : radius, colour);
        });
    }
}

/// A ring around the ball, its velocity as a line, its anchor and the way from there.
void draw_looked_at(Canvas& canvas, const BallFacts& facts, const Camera& camera) {
    const Vec2 centre = camera.to_pixel(facts.ball.position);
    const double radius = std::max(facts.ball.radius * camera.scale(), 2.0);
    if (facts.anchor) {
        const Vec2 anchor = camera.to_pixel(facts.anchor->position);
        canvas.line(anchor, centre, 1, pixel_of(palette::kPullGlow));
        canvas.ring(anchor, radius, 1.2, pixel_of(palette::kPullGlow));
    }
    canvas.ring(centre, radius + 3, 2, kLookedAt);
    const double speed = facts.ball.velocity.norm();
    if (speed > 0) {
        const Vec2 along = facts.ball.velocity / speed * (radius + 14);
        canvas.line(centre, centre + Vec2{along.x(), -along.y()}, 2, kLookedAt);
    }
}

/// Where it reaches: the sides moved out by the radius, and rings around the corners.
void draw_sensor(Canvas& canvas, const Sensor& sensor, const Camera& camera) {
    const std::uint32_t colour = pixel_of(mix(palette::kGround, palette::kSensor, 0.7));
    const std::size_t n = sensor.corners.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2& from = sensor.corners[k];
        const Vec2& to = sensor.corners[(k + 1) % n];
        if (sensor.radius > 0) canvas.ring(camera.to_pixel(from), sensor.radius * camera.scale(), 1, colour);
        if (n == 1) return;
        const Vec2 along = (to - from).normalized();
        const Vec2 out = sensor.radius * Vec2(along.y(), -along.x());
        canvas.line(camera.to_pixel(from + out), camera.to_pixel(to + out), 1.2, colour);
    }
}

}  // namespace

void draw_view(Canvas& canvas, const Simulation& simulation, const ViewControls& controls,
               const std::optional<BallFacts>& looked_at) {
    const Camera& camera = controls.camera;
    const Scene& scene = simulation.scene();
    canvas.resize(camera.width(), camera.height());
    canvas.clear(pixel_of(palette::kGround));
    draw_domain(canvas, scene, camera);
    draw_attractors(canvas, simulation.world().attractors(), camera);
    for (const Sensor& sensor : scene.sensors) draw_sensor(canvas, sensor, camera);
    draw_balls(canvas, simulation, controls);
    for (const Wall& wall : scene.walls)
        canvas.line(camera.to_pixel(wall.from), camera.to_pixel(wall.to), 2, pixel_of(palette::kWall));
    if (looked_at) draw_looked_at(canvas, *looked_at, camera);
}

}  // namespace carom::app
