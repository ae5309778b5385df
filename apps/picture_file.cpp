// One drawing routine, two kinds of surface.
#include "picture_file.hpp"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
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

void draw_on(cairo_surface_t* surface, const std::function<void(cairo_t*)>& draw) {
    require(cairo_surface_status(surface));
    const CairoContext context(cairo_create(surface));
    draw(context.get());
    require(cairo_status(context.get()));
}

CairoSurface image_of(const PictureContent& content, const PictureLayout& layout) {
    CairoSurface surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, layout.size.width, layout.size.height));
    draw_on(surface.get(), [&](cairo_t* context) { draw_picture(context, content, layout, 1); });
    return surface;
}

std::string png_of(cairo_surface_t* surface) {
    std::string bytes;
    require(cairo_surface_write_to_png_stream(surface, append_bytes, &bytes));
    return bytes;
}

}  // namespace

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? char(letter - 'A' + 'a') : letter;
    });
    return extension;
}

PictureFormat picture_format(const std::string& path) {
    const std::string extension = extension_of(path);
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

PictureLayout picture_layout(const PictureContent& content, const std::optional<PictureSize>& size) {
    const Box view = view_of(content);
    return {view, size ? *size : default_size(view)};
}

std::string picture_pixels(const PictureContent& content, const PictureLayout& layout) {
    const CairoSurface surface = image_of(content, layout);
    cairo_surface_flush(surface.get());
    // Rows of RGB24 have no gaps: four bytes a pixel are what cairo aligns them to.
    const auto* const data = reinterpret_cast<const char*>(cairo_image_surface_get_data(surface.get()));
    return {data, 4 * std::size_t(layout.size.width) * std::size_t(layout.size.height)};
}

std::string png_of_pixels(const std::uint32_t* pixels, int width, int height) {
    const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
    require(cairo_surface_status(surface.get()));
    const std::size_t size = 4 * std::size_t(width) * std::size_t(height);
    std::memcpy(cairo_image_surface_get_data(surface.get()), pixels, size);
    cairo_surface_mark_dirty(surface.get());
    return png_of(surface.get());
}

std::string render_with_cairo(PictureFormat format, PictureSize size,
                              const std::function<void(cairo_t*)>& draw) {
    if (format == PictureFormat::kPng) {
        const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height));
        draw_on(surface.get(), draw);
        return png_of(surface.get());
    }
    std::string bytes;
    const CairoSurface surface(
        cairo_svg_surface_create_for_stream(append_bytes, &bytes, size.width, size.height));
    draw_on(surface.get(), draw);
    cairo_surface_finish(surface.get());
    require(cairo_surface_status(surface.get()));
    return bytes;
}

std::string render_picture(const PictureContent& content, PictureFormat format,
                           const std::optional<PictureSize>& size) {
    const PictureLayout layout = picture_layout(content, size);
    const double pixels_per_unit = format == PictureFormat::kPng ? 1 : kSvgPixelsPerUnit;
    return render_with_cairo(format, layout.size, [&](cairo_t* context) {
        draw_picture(context, content, layout, pixels_per_unit);
    });
}

}  // namespace carom::app
