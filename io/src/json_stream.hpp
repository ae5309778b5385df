// A JSON object taken member by member, so that a million balls never stand in memory as JSON.
#pragma once

#include <functional>
#include <string_view>

#include "json_value.hpp"

namespace carom {

struct JsonHandlers {
    /// Told of each key of the outermost object before its value, and of repeated ones each time; says
    /// whether the value, when it is an array, is taken element by element.
    std::function<bool(std::string_view key)> key;
    /// A whole value; its place is `gravity`, or `balls[17]` for an element.
    std::function<void(const Json& value, const Place& place)> value;
};

/// Throws SceneError for text that is no JSON object (with line and column), repeated keys in inner objects
/// and deep nesting; what the handlers throw passes through.
void stream_object(std::string_view text, const JsonHandlers& handlers);

}  // namespace carom
