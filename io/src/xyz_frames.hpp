// Where the frames of an extended XYZ text begin, and what their comments say.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom {

/// Lines of a text one by one, without their ends.
class LineReader {
 public:
    LineReader(std::string_view text, std::string_view name) : text_(text), name_(name) {}

    [[nodiscard]] bool at_end() const { return text_.empty(); }
    /// The number of the line that was taken last, from 1.
    [[nodiscard]] std::uint64_t line_number() const { return line_number_; }
    std::string_view next();
    /// Throws SceneError at the line that was taken last.
    [[noreturn]] void fail(const std::string& rule) const;

 private:
    std::string_view text_;
    std::string_view name_;  ///< of the file
    std::uint64_t line_number_ = 0;
};

/// What a column of numbers means to us.
enum class ColumnUse : std::uint8_t {
    kSkip,
    kPosition,
    kVelocity,
    kAcceleration,
    kRadius,
    kMass,
    kRestitution,
    kStatic,
    kId
};

struct Column {
    ColumnUse use = ColumnUse::kSkip;
    std::size_t width = 1;  ///< words on the line
};

struct XyzComment {
    std::vector<Column> columns;
    std::size_t words = 0;  ///< of all columns
    std::optional<double> time;
    std::optional<Box> box;
};

/// Cuts the first word off the line; empty when there is none.
std::string_view take_word(std::string_view& line);
/// The number that the whole word stands for; none when it is no number or beyond double's range.
std::optional<double> parse_number(std::string_view word);

/// The count on a frame's first line, which was taken last.
std::uint64_t parse_frame_count(std::string_view line, const LineReader& lines);
/// A frame's comment, which was taken last.
XyzComment parse_comment(std::string_view line, const LineReader& lines);

}  // namespace carom
