// Typed reading of JSON values.
#include "json_value.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <carom/core/scene.hpp>
#include <carom/io/nearest_word.hpp>

namespace carom {
namespace {

[[noreturn]] void fail_type(const Json& value, const Place& place, std::string_view wanted) {
    throw SceneError(place.text(), fmt::format("must be {}, is {}", wanted, kind_of(value)));
}

}  // namespace

std::string Place::text() const {
    std::string text = parent != nullptr ? parent->text() : std::string();
    if (!key.empty() && !text.empty()) text += '.';
    text += quotable(key);
    if (index) text += fmt::format("[{}]", *index);
    return text;
}

std::string_view kind_of(const Json& value) {
    switch (value.type()) {
        case Json::value_t::null:
            return "null";
        case Json::value_t::boolean:
            return "true or false";
        case Json::value_t::string:
            return "a string";
        case Json::value_t::array:
            return "an array";
        case Json::value_t::object:
            return "an object";
        default:
            return "a number";
    }
}

std::string quotable(std::string_view text) {
    constexpr std::size_t kLongest = 60;
    std::string quoted;
    for (const char c : text.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        quoted += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    if (text.size() <= kLongest) return quoted;
    // Not in the middle of a UTF-8 character.
    while (!quoted.empty() && (static_cast<unsigned char>(text[quoted.size()]) & 0xc0U) == 0x80U)
        quoted.pop_back();
    return quoted + "...";
}

void fail_unknown_key(const Place& place, std::span<const std::string_view> known) {
    const std::string_view nearest = nearest_word(place.key, known);
    if (!nearest.empty())
        throw SceneError(place.text(), fmt::format("unknown key, did you mean \"{}\"?", nearest));
    throw SceneError(place.text(), fmt::format("unknown key, known are {}", fmt::join(known, ", ")));
}

double read_number(const Json& value, const Place& place) {
    if (!value.is_number()) fail_type(value, place, "a number");
    return value.get<double>();
}

Vec2 read_pair(const Json& value, const Place& place) {
    if (!value.is_array()) fail_type(value, place, "an array of two numbers");
    if (value.size() != 2)
        throw SceneError(place.text(), fmt::format("must be an array of two numbers, has {}", value.size()));
    return {read_number(value[0], {&place, {}, 0}), read_number(value[1], {&place, {}, 1})};
}

bool read_flag(const Json& value, const Place& place) {
    if (!value.is_boolean()) fail_type(value, place, "true or false");
    return value.get<bool>();
}

std::string read_string(const Json& value, const Place& place) {
    if (!value.is_string()) fail_type(value, place, "a string");
    return value.get<std::string>();
}

std::uint64_t read_count(const Json& value, const Place& place) {
    if (!value.is_number()) fail_type(value, place, "a whole number");
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    const double number = value.get<double>();
    if (number < 0) throw SceneError(place.text(), fmt::format("must be >= 0, is {}", number));
    if (number != std::floor(number))
        throw SceneError(place.text(), fmt::format("must be a whole number, is {}", number));
    if (number >= 0x1p64) throw SceneError(place.text(), fmt::format("must be below 2^64, is {}", number));
    return static_cast<std::uint64_t>(number);
}

Members::Members(const Json& value, const Place& place, std::span<const std::string_view> known)
    : object_(value), place_(place) {
    if (!value.is_object()) fail_type(value, place, "an object");
    for (auto member = value.begin(); member != value.end(); ++member) {
        if (std::find(known.begin(), known.end(), member.key()) == known.end())
            fail_unknown_key({&place, member.key(), {}}, known);
    }
}

void Members::require(std::initializer_list<std::string_view> keys) const {
    for (const std::string_view key : keys) {
        if (!object_.contains(key)) throw SceneError(Place{&place_, key, {}}.text(), "is required");
    }
}

}  // namespace carom
