// Typed reading of JSON values.
#include "json_value.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <carom/core/scene.hpp>

namespace carom {
namespace {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        std::swap(before_last, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

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
    const std::string_view key = place.key;
    constexpr std::size_t kLongestWord = 40;
    std::string_view nearest;
    std::size_t shortest = std::max<std::size_t>(2, key.size() / 3) + 1;
    for (const std::string_view word : known) {
        if (key.size() > kLongestWord) break;
        const std::size_t distance = edit_distance(key, word);
        if (distance < shortest) {
            shortest = distance;
            nearest = word;
        }
    }
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
