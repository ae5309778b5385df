// Pictures as bytes of a PNG or SVG file.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "picture.hpp"

namespace carom::app {

enum class PictureFormat : std::uint8_t { kPng, kSvg };

/// The path's extension with its dot, in small letters.
[[nodiscard]] std::string extension_of(const std::string& path);

/// The format that the path's extension names, in any case of letters. Throws std::invalid_argument that
/// names the extension and the known ones.
[[nodiscard]] PictureFormat picture_format(const std::string& path);

/// "1200x900". Throws std::invalid_argument that says what is allowed.
[[nodiscard]] PictureSize parse_picture_size(const std::string& text);

/// Where things go in a picture of the size, or where there is none of default_size of the view.
[[nodiscard]] PictureLayout picture_layout(const PictureContent& content,
                                           const std::optional<PictureSize>& size);

/// The picture's pixels, rows from the top, each a native 32-bit number 0x??RRGGBB, no gaps. Throws
/// std::runtime_error when cairo cannot.
[[nodiscard]] std::string picture_pixels(const PictureContent& content, const PictureLayout& layout);

/// The bytes of a PNG file of such pixels.
[[nodiscard]] std::string png_of_pixels(const std::uint32_t* pixels, int width, int height);

/// The bytes of a file of what `draw` draws. Throws std::runtime_error when cairo cannot.
[[nodiscard]] std::string render_with_cairo(PictureFormat format, PictureSize size,
                                            const std::function<void(cairo_t*)>& draw);

/// The file's bytes; where no size is given, default_size of the view. Throws std::runtime_error when cairo
/// cannot (out of memory).
[[nodiscard]] std::string render_picture(const PictureContent& content, PictureFormat format,
                                         const std::optional<PictureSize>& size = std::nullopt);

}  // namespace carom::app
