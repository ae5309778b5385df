// Extended XYZ, reading.
#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include <carom/io/read_file.hpp>
#include <carom/io/xyz.hpp>

#include "ball_line.hpp"
#include "json_value.hpp"
#include "xyz_frames.hpp"

namespace carom {
namespace {

/// The ball, and its id where there is a column for it.
Ball parse_ball(std::string_view line, const XyzComment& comment, const LineReader& lines,
                std::vector<std::uint64_t>& ids) {
    if (const std::size_t words = count_words(line); words != comment.words)
        lines.fail(fmt::format("must have {} columns, has {}", comment.words, words));
    Ball ball;
    BallLine words(line, lines);
    for (const Column& column : comment.columns) {
        switch (column.use) {
            case ColumnUse::kSkip:
                for (std::size_t i = 0; i < column.width; ++i) words.word();
                break;
            case ColumnUse::kPosition:
                words.vector(ball.position, column.width);
                break;
            case ColumnUse::kVelocity:
                words.vector(ball.velocity, column.width);
                break;
            case ColumnUse::kAcceleration:
                words.vector(ball.acceleration, column.width);
                break;
            case ColumnUse::kRadius:
                ball.radius = words.number();
                break;
            case ColumnUse::kMass:
                ball.mass = words.number();
                break;
            case ColumnUse::kRestitution:
                ball.restitution = words.number();
                break;
            case ColumnUse::kStatic:
                ball.is_static = words.flag();
                break;
            case ColumnUse::kId:
                ids.push_back(words.id());
                break;
        }
    }
    return ball;
}

/// Skips blank lines between and after frames.
bool find_frame(LineReader& lines, std::string_view& first_line) {
    while (!lines.at_end()) {
        first_line = lines.next();
        if (first_line.find_first_not_of(" \t") != std::string_view::npos) return true;
    }
    return false;
}

XyzFrame parse_frame(std::string_view first_line, LineReader& lines, std::size_t text_size,
                     const std::string& name) {
    const std::uint64_t count = parse_frame_count(first_line, lines);
    if (lines.at_end()) lines.fail("the file ends before the frame's comment line");
    const XyzComment comment = parse_comment(lines.next(), lines);
    XyzFrame frame{comment.time, comment.box, {}, {}};
    // A ball takes two words at least, so a count beyond the file's size is a lie not worth the memory.
    frame.balls.reserve(std::min<std::uint64_t>(count, text_size / 4));
    frame.lines.reserve(frame.balls.capacity());
    std::vector<std::uint64_t> ids;
    for (std::uint64_t i = 0; i < count; ++i) {
        if (lines.at_end())
            lines.fail(fmt::format("the file ends after {} of the frame's {} balls", i, count));
        const std::string_view line = lines.next();
        frame.balls.push_back(parse_ball(line, comment, lines, ids));
        frame.lines.push_back(lines.line_number());
    }
    sort_by_id(frame, ids, name);
    return frame;
}

/// Passes over a frame without reading its balls; false when the file ends within it.
bool skip_frame(std::string_view first_line, LineReader& lines) {
    const std::uint64_t count = parse_frame_count(first_line, lines);
    if (lines.at_end()) return false;
    lines.next();
    for (std::uint64_t i = 0; i < count; ++i) {
        if (lines.at_end()) return false;
        lines.next();
    }
    return true;
}

}  // namespace

XyzFrame parse_xyz(std::string_view text, const std::string& name) {
    LineReader lines(text, name);
    std::string_view first_line;
    if (!find_frame(lines, first_line)) throw SceneError(name, "is empty");
    while (true) {
        LineReader ahead = lines;
        std::string_view next_line;
        if (!skip_frame(first_line, ahead) || !find_frame(ahead, next_line))
            return parse_frame(first_line, lines, text.size(), name);
        lines = ahead;
        first_line = next_line;
    }
}

XyzFrame read_xyz(const std::filesystem::path& path) {
    return parse_xyz(read_file(path), path.filename().string());
}

void for_each_xyz_frame(const std::filesystem::path& path, const std::function<bool(const XyzFrame&)>& take) {
    const std::string text = read_file(path);
    const std::string name = path.filename().string();
    LineReader lines(text, name);
    std::string_view first_line;
    while (find_frame(lines, first_line))
        if (!take(parse_frame(first_line, lines, text.size(), name))) return;
}

}  // namespace carom
