// A ball's line in a file of balls, and their order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <carom/io/xyz.hpp>

#include "xyz_frames.hpp"

namespace carom {

/// One ball's line, word by word. What is no such thing throws SceneError with the line and the column.
class BallLine {
 public:
    BallLine(std::string_view line, const LineReader& lines) : rest_(line), lines_(lines) {}

    std::string_view word();
    double number();
    void vector(Vec2& target, std::size_t width);
    std::uint64_t id();
    bool flag();

 private:
    std::string_view rest_;
    const LineReader& lines_;
    std::size_t words_ = 0;
};

[[nodiscard]] std::size_t count_words(std::string_view line);

/// Orders the balls by their ids, where there are any. Throws SceneError where two are equal; `name` stands
/// for the file.
void sort_by_id(XyzFrame& frame, const std::vector<std::uint64_t>& ids, const std::string& name);

}  // namespace carom
