// A vector across another.
#pragma once

#include <carom/core/vector.hpp>

namespace carom::accuracy {

/// n turned a quarter counter-clockwise.
inline Vec2 across(const Vec2& n) {
    return {-n.y(), n.x()};
}

}  // namespace carom::accuracy
