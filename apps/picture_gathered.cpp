// Many balls in a picture: each adds its area to the pixels under it, and a pixel shows the mean value of
// what covers it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "cairo_handles.hpp"
#include "colour_map.hpp"
#include "picture_palette.hpp"
#include "picture_parts.hpp"

namespace carom::app {
namespace {

struct Pixel {
    float covered = 0;         // area under moving balls, of 1
    float covered_static = 0;  // area under static balls
    float value = 0;           // what the colour stands for, times area
};

class Canvas {
 public:
    Canvas(int width, int height)
        : width_(width), height_(height), pixels_(std::size_t(width) * std::size_t(height)) {}

    // A disc at (x, y) of the canvas, y down, in pixels. The edge is one pixel soft, and the whole is scaled
    // to the disc's true area, so that discs smaller than a pixel weigh what they should.
    void add_disc(double x, double y, double radius, bool is_static, float value) {
        const double soft = std::max(radius, 0.5) + 0.5;
        const int first_x = std::max(0, int(std::floor(x - soft))),
                  last_x = std::min(width_ - 1, int(std::floor(x + soft)));
        const int first_y = std::max(0, int(std::floor(y - soft))),
                  last_y = std::min(height_ - 1, int(std::floor(y + soft)));
        const double scale = area_scale(x, y, radius, soft);
        for (int row = first_y; row <= last_y; ++row) {
            for (int column = first_x; column <= last_x; ++column) {
                const double weight = weight_at(column + 0.5 - x, row + 0.5 - y, soft) * scale;
                if (weight > 0) add(column, row, float(weight), is_static, value);
            }
        }
    }

    [[nodiscard]] const Pixel& at(int column, int row) const { return pixels_[index(column, row)]; }

 private:
    static double weight_at(double dx, double dy, double soft) {
        const double distance = std::sqrt(dx * dx + dy * dy);
        return std::clamp(soft - distance, 0.0, 1.0);
    }

    // Large discs have their area already; for small ones the sum over the pixels, even those beyond the
    // canvas, says what is missing.
    static double area_scale(double x, double y, double radius, double soft) {
        if (radius > 4) return 1;
        double sum = 0;
        for (int row = int(std::floor(y - soft)); row <= int(std::floor(y + soft)); ++row) {
            for (int column = int(std::floor(x - soft)); column <= int(std::floor(x + soft)); ++column) {
                sum += weight_at(column + 0.5 - x, row + 0.5 - y, soft);
            }
        }
        return sum > 0 ? std::numbers::pi * radius * radius / sum : 0;
    }

    void add(int column, int row, float weight, bool is_static, float value) {
        Pixel& pixel = pixels_[index(column, row)];
        if (is_static) {
            pixel.covered_static += weight;
        } else {
            pixel.covered += weight;
            pixel.value += weight * value;
        }
    }

    [[nodiscard]] std::size_t index(int column, int row) const {
        return std::size_t(row) * std::size_t(width_) + std::size_t(column);
    }

    int width_;
    int height_;
    std::vector<Pixel> pixels_;
};

std::uint32_t pixel_colour(const Pixel& pixel, const Colouring& colouring) {
    const double total = double(pixel.covered) + double(pixel.covered_static);
    if (!(total > 0)) return 0;
    Colour colour = palette::kStaticBall;
    if (pixel.covered > 0) {
        const Colour moving = map_colour(colouring.fraction_of(double(pixel.value) / double(pixel.covered)));
        colour = mix(moving, colour, double(pixel.covered_static) / total);
    }
    // Thin clouds of small balls would sink into the ground: the strength grows a little faster than the
    // area.
    constexpr double kStrengthPower = 0.75;
    return pixel_of(colour, std::pow(std::min(total, 1.0), kStrengthPower));
}

void copy_to_surface(const Canvas& canvas, cairo_surface_t* surface, const Colouring& colouring) {
    cairo_surface_flush(surface);
    unsigned char* bytes = cairo_image_surface_get_data(surface);
    const auto stride = std::size_t(cairo_image_surface_get_stride(surface));
    const int width = cairo_image_surface_get_width(surface);
    for (int row = 0; row < cairo_image_surface_get_height(surface); ++row) {
        auto* line = reinterpret_cast<std::uint32_t*>(bytes + std::size_t(row) * stride);
        for (int column = 0; column < width; ++column)
            line[column] = pixel_colour(canvas.at(column, row), colouring);
    }
    cairo_surface_mark_dirty(surface);
}

}  // namespace

void draw_balls_gathered(cairo_t* context, const PictureContent& content, const PictureLayout& layout,
                         const Colouring& colouring, double pixels_per_unit) {
    // The image starts on the frame's corner, which lies on a whole pixel, so that nothing is resampled.
    const int width = int(std::ceil((layout.right - layout.left) * pixels_per_unit));
    const int height = int(std::ceil((layout.bottom - layout.top) * pixels_per_unit));
    Canvas canvas(width, height);
    for (std::size_t i = 0; i < content.balls.size(); ++i) {
        const Ball& ball = content.balls[i];
        for_each_image(content.domain, ball, [&](const Vec2& position) {
            if (!position.allFinite()) return;
            const Vec2 place = (layout.to_pixel(position) - Vec2{layout.left, layout.top}) * pixels_per_unit;
            const double radius = ball.radius * layout.scale * pixels_per_unit;
            // Compared as numbers: a place far outside does not fit an int.
            if (!(place.x() + radius > -1 && place.x() - radius < width + 1)) return;
            if (!(place.y() + radius > -1 && place.y() - radius < height + 1)) return;
            canvas.add_disc(place.x(), place.y(), radius, ball.is_static, colouring.values[i]);
        });
    }
    const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return;
    copy_to_surface(canvas, surface.get(), colouring);
    cairo_save(context);
    cairo_translate(context, layout.left, layout.top);
    cairo_scale(context, 1 / pixels_per_unit, 1 / pixels_per_unit);
    cairo_set_source_surface(context, surface.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(context),
                             pixels_per_unit == 1 ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
    cairo_paint(context);
    cairo_restore(context);
}

}  // namespace carom::app
