// One drawing routine, two kinds of surface.
#include "picture_file.hpp"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "cairo_handles.hpp"

namespace carom::app {
namespace {

// An SVG is scaled by its viewer: the image of many balls in it is finer than its points.
constexpr double kSvgPixelsPerUnit = 1.5;

cairo_status_t append_bytes(void* closure, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

void require(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) {
        throw std::runtime_error(fmt::format("cannot draw the picture: {}", cairo_status_to_string(status)));
    }
}

void draw_on(cairo_surface_t* surface, const PictureContent& content, const PictureLayout& layout,
             double pixels_per_unit) {
    require(cairo_surface_status(surface));
    const CairoContext context(cairo_create(surface));
    draw_picture(context.get(), content, layout, pixels_per_unit);
    require(cairo_status(context.get()));
}

}  // namespace

PictureFormat picture_format(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? char(letter - 'A' + 'a') : letter;
    });
    if (extension == ".png") return PictureFormat::kPng;
    if (extension == ".svg") return PictureFormat::kSvg;
    throw std::invalid_argument(fmt::format("unknown picture format '{}' (known: .png, .svg)", extension));
}

PictureSize parse_picture_size(const std::string& text) {
    PictureSize size;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    bool good = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    if (good) {
        const auto height = std::from_chars(width.ptr + 1, end, size.height);
        good = height.ec == std::errc() && height.ptr == end;
    }
    const auto allowed = [](int side) { return side >= kSmallestSide && side <= kLargestSide; };
    if (good && allowed(size.width) && allowed(size.height)) return size;
    throw std::invalid_argument(fmt::format("'{}' is no picture size: WIDTHxHEIGHT with sides from {} to {}",
                                            text, kSmallestSide, kLargestSide));
}

std::string render_picture(const PictureContent& content, PictureFormat format,
                           const std::optional<PictureSize>& size) {
    const Box view = view_of(content);
    const PictureLayout layout(view, size ? *size : default_size(view));
    std::string bytes;
    if (format == PictureFormat::kPng) {
        const CairoSurface surface(
            cairo_image_surface_create(CAIRO_FORMAT_RGB24, layout.size.width, layout.size.height));
        draw_on(surface.get(), content, layout, 1);
        require(cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes));
    } else {
        const CairoSurface surface(
            cairo_svg_surface_create_for_stream(append_bytes, &bytes, layout.size.width, layout.size.height));
        draw_on(surface.get(), content, layout, kSvgPixelsPerUnit);
        cairo_surface_finish(surface.get());
        require(cairo_surface_status(surface.get()));
    }
    return bytes;
}

}  // namespace carom::app
