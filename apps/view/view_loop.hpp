// The window's loop.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "colouring.hpp"

namespace carom::app {

struct ViewOptions {
    std::string scene;
    double speed = 1;
    double from = 0;
    bool is_paused = false;
    std::optional<std::uint32_t> pick;
    std::string size;
    ColourBy colour_by = ColourBy::kSpeed;
    bool is_screensaver = false;
    std::optional<int> frames;
    std::string screenshot;
    int threads = 0;
};

/// Gives the program's exit status. Throws std::runtime_error where there is no display, or no window is
/// built in.
int view(const ViewOptions& options);

}  // namespace carom::app
