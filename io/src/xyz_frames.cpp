// Extended XYZ: lines, counts and comments.
#include "xyz_frames.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "json_value.hpp"

namespace carom {
namespace {

constexpr std::string_view kBlanks = " \t";

constexpr std::array<std::pair<std::string_view, ColumnUse>, 19> kNames = {{
    {"pos", ColumnUse::kPosition},
    {"position", ColumnUse::kPosition},
    {"positions", ColumnUse::kPosition},
    {"velo", ColumnUse::kVelocity},
    {"vel", ColumnUse::kVelocity},
    {"velocity", ColumnUse::kVelocity},
    {"velocities", ColumnUse::kVelocity},
    {"acceleration", ColumnUse::kAcceleration},
    {"radius", ColumnUse::kRadius},
    {"radii", ColumnUse::kRadius},
    {"mass", ColumnUse::kMass},
    {"masses", ColumnUse::kMass},
    {"restitution", ColumnUse::kRestitution},
    {"static", ColumnUse::kStatic},
    {"id", ColumnUse::kId},
    {"ids", ColumnUse::kId},
    {"identifier", ColumnUse::kId},
    {"particle_identifier", ColumnUse::kId},
    {"is_static", ColumnUse::kStatic},
}};

std::string lower(std::string_view word) {
    std::string text(word);
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

ColumnUse use_of(std::string_view name) {
    const std::string lower_name = lower(name);
    for (const auto& [known, use] : kNames)
        if (known == lower_name) return use;
    return ColumnUse::kSkip;
}

/// Cuts "key=value", "key='a b'" or a bare "key" off the line; the quotes are dropped.
std::pair<std::string_view, std::string_view> take_pair(std::string_view& line, const LineReader& lines) {
    const std::size_t key_end = std::min(line.find_first_of(" \t="), line.size());
    const std::string_view key = line.substr(0, key_end);
    line.remove_prefix(key_end);
    if (line.empty() || line.front() != '=') return {key, {}};
    line.remove_prefix(1);
    const std::string_view quotes = R"(""''{}[])";
    const std::size_t opening = line.empty() ? std::string_view::npos : quotes.find(line.front());
    if (opening == std::string_view::npos || opening % 2 != 0) {
        if (!line.empty() && kBlanks.find(line.front()) != std::string_view::npos) return {key, {}};
        return {key, take_word(line)};
    }
    line.remove_prefix(1);
    const std::size_t end = line.find(quotes[opening + 1]);
    if (end == std::string_view::npos)
        lines.fail(fmt::format("the value of {} has no closing quote", quotable(key)));
    const std::string_view value = line.substr(0, end);
    line.remove_prefix(end + 1);
    return {key, value};
}

/// Name, type and width in turn, as in "species:S:1:pos:R:3".
void parse_properties(std::string_view value, const LineReader& lines, XyzComment& comment) {
    const auto take_part = [&value] {
        const std::size_t end = std::min(value.find(':'), value.size());
        const std::string_view part = value.substr(0, end);
        value.remove_prefix(std::min(end + 1, value.size()));
        return part;
    };
    constexpr std::size_t kWidest = 1000;
    while (!value.empty()) {
        const std::string_view name = take_part();
        const std::string_view type = take_part();
        const std::string_view width_text = take_part();
        std::size_t width = 0;
        const auto [end, error] =
            std::from_chars(width_text.data(), width_text.data() + width_text.size(), width);
        if (name.empty() || type.size() != 1 || error != std::errc() ||
            end != width_text.data() + width_text.size() || width < 1 || width > kWidest)
            lines.fail("Properties must be name:type:columns, again and again, as in species:S:1:pos:R:3");
        const ColumnUse use = use_of(name);
        const bool is_vector =
            use == ColumnUse::kPosition || use == ColumnUse::kVelocity || use == ColumnUse::kAcceleration;
        if (is_vector && width != 2 && width != 3)
            lines.fail(fmt::format("{} must have 2 or 3 columns, has {}", quotable(name), width));
        if (use != ColumnUse::kSkip && !is_vector && width != 1)
            lines.fail(fmt::format("{} must have 1 column, has {}", quotable(name), width));
        for (const Column& column : comment.columns)
            if (use != ColumnUse::kSkip && column.use == use)
                lines.fail(fmt::format("Properties names {} twice", quotable(name)));
        comment.columns.push_back({use, width});
    }
}

/// Up to nine numbers; none when there is something else.
std::vector<double> parse_numbers(std::string_view value) {
    std::vector<double> numbers;
    for (std::string_view word = take_word(value); !word.empty(); word = take_word(value)) {
        const std::optional<double> number = parse_number(word);
        if (!number || numbers.size() == 9) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

}  // namespace

std::string_view LineReader::next() {
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++line_number_;
    constexpr std::size_t kLongest = std::size_t{1} << 20;  // no line of balls comes near it
    if (line.size() > kLongest)
        fail(fmt::format("a line may have {} characters, this one has {}", kLongest, line.size()));
    return line;
}

void LineReader::fail(const std::string& rule) const {
    throw SceneError(fmt::format("{}:{}", name_, line_number_), rule);
}

std::string_view take_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line.remove_prefix(word.size());
    return word;
}

std::optional<double> parse_number(std::string_view word) {
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return number;
}

std::uint64_t parse_frame_count(std::string_view line, const LineReader& lines) {
    const std::string_view whole_line = line;
    const std::string_view word = take_word(line);
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (word.empty() || error != std::errc() || end != word.data() + word.size() || !take_word(line).empty())
        lines.fail(fmt::format("must be the number of balls, is \"{}\"", quotable(whole_line)));
    return count;
}

XyzComment parse_comment(std::string_view line, const LineReader& lines) {
    XyzComment comment;
    std::vector<double> lattice;
    std::vector<double> origin;
    while (true) {
        line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
        if (line.empty()) break;
        if (line.front() == '=') {  // a value without a key; a plain comment may hold anything
            line.remove_prefix(1);
            continue;
        }
        const auto [key, value] = take_pair(line, lines);
        const std::string name = lower(key);
        if (name == "properties") parse_properties(value, lines, comment);
        if (name == "time") comment.time = parse_number(value);
        if (name == "lattice") lattice = parse_numbers(value);
        if (name == "origin") origin = parse_numbers(value);
    }
    if (comment.columns.empty()) comment.columns = {{ColumnUse::kSkip, 1}, {ColumnUse::kPosition, 3}};
    const auto is_position = [](const Column& column) { return column.use == ColumnUse::kPosition; };
    if (std::none_of(comment.columns.begin(), comment.columns.end(), is_position))
        lines.fail("Properties names no pos column");
    for (const Column& column : comment.columns) comment.words += column.width;
    if (lattice.size() == 9 && lattice[1] == 0 && lattice[3] == 0) {
        const Vec2 low = origin.size() == 3 ? Vec2(origin[0], origin[1]) : Vec2::Zero();
        comment.box = Box{low, low + Vec2(lattice[0], lattice[4])};
    }
    return comment;
}

}  // namespace carom
