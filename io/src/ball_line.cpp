#include "ball_line.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "json_value.hpp"

namespace carom {

std::string_view BallLine::word() {
    const std::string_view word = take_word(rest_);
    if (!word.empty()) ++words_;
    return word;
}

double BallLine::number() {
    const std::string_view text = word();
    const std::optional<double> number = parse_number(text);
    if (!number) lines_.fail(fmt::format("column {} must be a number, is \"{}\"", words_, quotable(text)));
    return *number;
}

void BallLine::vector(Vec2& target, std::size_t width) {
    target.x() = number();
    target.y() = number();
    if (width == 3) word();
}

std::uint64_t BallLine::id() {
    const std::string_view text = word();
    std::uint64_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size())
        lines_.fail(fmt::format("column {} must be a whole number, the ball's id, is \"{}\"", words_,
                                quotable(text)));
    return id;
}

bool BallLine::flag() {
    const std::string_view text = word();
    if (text == "T" || text == "1" || text == "True" || text == "true") return true;
    if (text != "F" && text != "0" && text != "False" && text != "false")
        lines_.fail(fmt::format("column {} must be T or F, is \"{}\"", words_, quotable(text)));
    return false;
}

std::size_t count_words(std::string_view line) {
    std::size_t words = 0;
    while (!take_word(line).empty()) ++words;
    return words;
}

void sort_by_id(XyzFrame& frame, const std::vector<std::uint64_t>& ids, const std::string& name) {
    if (ids.empty() || std::is_sorted(ids.begin(), ids.end(), std::less_equal<>())) return;
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Equal ids in the order of the lines, so that the later one is refused.
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return ids[a] != ids[b] ? ids[a] < ids[b] : a < b; });
    XyzFrame sorted{frame.time, frame.box, {}, {}};
    sorted.balls.reserve(order.size());
    sorted.lines.reserve(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && ids[order[i]] == ids[order[i - 1]])
            throw SceneError(
                fmt::format("{}:{}", name, frame.lines[order[i]]),
                fmt::format("has the id {} of line {}", ids[order[i]], frame.lines[order[i - 1]]));
        sorted.balls.push_back(frame.balls[order[i]]);
        sorted.lines.push_back(frame.lines[order[i]]);
    }
    frame = std::move(sorted);
}

}  // namespace carom
