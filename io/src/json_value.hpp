// Typed reading of JSON values, with errors that name their place.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <carom/core/vector.hpp>

namespace carom {

using Json = nlohmann::json;

/// Where a value stands, as a chain towards the root; it becomes `fill[0].region.min` only when something is
/// wrong there.
struct Place {
    const Place* parent = nullptr;
    std::string_view key;
    std::optional<std::size_t> index;

    [[nodiscard]] std::string text() const;
};

/// "a number", "an object" ...
[[nodiscard]] std::string_view kind_of(const Json& value);

/// A piece of the user's text for a message of one line: control characters replaced, long pieces cut.
[[nodiscard]] std::string quotable(std::string_view text);

/// Throws SceneError: the key is unknown, did you mean ...? With nothing near, lists what is known.
[[noreturn]] void fail_unknown_key(const Place& place, std::span<const std::string_view> known);

// Each throws SceneError when the value is of another type.
[[nodiscard]] double read_number(const Json& value, const Place& place);
[[nodiscard]] Vec2 read_pair(const Json& value, const Place& place);
[[nodiscard]] bool read_flag(const Json& value, const Place& place);
[[nodiscard]] std::string read_string(const Json& value, const Place& place);
/// A whole number from 0 up to 2^64 - 1; 1e5 is one, too.
[[nodiscard]] std::uint64_t read_count(const Json& value, const Place& place);

/// An object whose keys are all known.
class Members {
 public:
    Members(const Json& value, const Place& place, std::span<const std::string_view> known);

    /// Calls use(value, place) when the key is there.
    template <class Use>
    void with(std::string_view key, Use use) const {
        if (const auto found = object_.find(key); found != object_.end())
            use(*found, Place{&place_, key, {}});
    }
    void number(std::string_view key, double& target) const {
        with(key, [&](const Json& value, const Place& place) { target = read_number(value, place); });
    }
    void number(std::string_view key, std::optional<double>& target) const {
        with(key, [&](const Json& value, const Place& place) { target = read_number(value, place); });
    }
    void pair(std::string_view key, Vec2& target) const {
        with(key, [&](const Json& value, const Place& place) { target = read_pair(value, place); });
    }
    /// Throws SceneError where one of the keys is missing.
    void require(std::initializer_list<std::string_view> keys) const;

 private:
    const Json& object_;
    const Place& place_;
};

}  // namespace carom
