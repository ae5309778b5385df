// LAMMPS data files: a header of counts, then sections of lines under their names.
#include <algorithm>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <carom/io/lammps.hpp>
#include <carom/io/read_file.hpp>

#include "ball_line.hpp"
#include "json_value.hpp"
#include "xyz_frames.hpp"

namespace carom {
namespace {

enum class AtomStyle : std::uint8_t { kUnknown, kAtomic, kSphere };

constexpr std::size_t kImageColumns = 3;  // may follow the atom's own: how often it has passed a period

std::size_t columns_of(AtomStyle style) {
    return style == AtomStyle::kSphere ? 7 : 5;
}

/// The line without its comment, and the comment's first word.
struct DataLine {
    std::string_view content;
    std::string_view comment;
    bool is_blank = false;
};

DataLine data_line(std::string_view line) {
    const std::size_t mark = std::min(line.find('#'), line.size());
    DataLine parts{line.substr(0, mark), {}, false};
    if (mark < line.size()) {
        std::string_view rest = line.substr(mark + 1);
        parts.comment = take_word(rest);
    }
    std::string_view rest = parts.content;
    parts.is_blank = take_word(rest).empty();
    return parts;
}

class DataReader {
 public:
    DataReader(std::string_view text, const std::string& name)
        : lines_(text, name), name_(name), text_size_(text.size()) {}

    XyzFrame read() {
        if (lines_.at_end()) throw SceneError(name_, "is empty");
        lines_.next();  // a title
        while (!lines_.at_end()) {
            const DataLine line = data_line(lines_.next());
            if (line.is_blank) continue;
            if (!take_header(line.content)) take_section(line);
        }
        if (!count_) throw SceneError(name_, "is no LAMMPS data file: no line says how many atoms there are");
        if (!atoms_at_) throw SceneError(name_, "has no section Atoms");
        give_masses();
        give_velocities();
        sort_by_id(frame_, ids_, name_);
        return std::move(frame_);
    }

 private:
    /// "100 atoms", "0 20 xlo xhi"; false where the line begins with no number.
    bool take_header(std::string_view line) {
        std::string_view rest = line;
        const std::string_view first = take_word(rest);
        if (!parse_number(first)) return false;
        if (in_body_) lines_.fail(fmt::format("belongs to no section: \"{}\"", quotable(line)));
        const std::string_view second = take_word(rest);
        if (second == "atoms") count_ = parse_frame_count(first, lines_);
        const std::string_view third = take_word(rest);
        if (third == "xlo" || third == "ylo") take_bounds(first, second, third == "xlo" ? 0 : 1);
        return true;
    }

    void take_bounds(std::string_view low, std::string_view high, int axis) {
        const std::optional<double> from = parse_number(low);
        const std::optional<double> to = parse_number(high);
        if (!from || !to) lines_.fail("bounds must be two numbers");
        if (!frame_.box) frame_.box = Box{};
        frame_.box->min[axis] = *from;
        frame_.box->max[axis] = *to;
    }

    void take_section(const DataLine& title) {
        in_body_ = true;
        std::string_view rest = title.content;
        const std::string_view name = take_word(rest);
        if (name == "Masses" || name == "Atoms" || name == "Velocities") {
            if (!take_word(rest).empty()) lines_.fail("a section's name stands alone on its line");
            if (name == "Atoms") take_atoms(title.comment);
            if (name == "Masses") take_masses();
            if (name == "Velocities") take_velocities();
            return;
        }
        if (name.front() < 'A' || name.front() > 'Z')
            lines_.fail(
                fmt::format("must be a header line or a section's name, is \"{}\"", quotable(title.content)));
        for_each_line([](std::string_view) {});
    }

    /// The lines of a section: after a blank one, up to the next or the end.
    template <class Take>
    void for_each_line(Take&& take) {
        bool has_begun = false;
        while (!lines_.at_end()) {
            const DataLine line = data_line(lines_.next());
            if (line.is_blank && has_begun) return;
            if (line.is_blank) continue;
            has_begun = true;
            take(line.content);
        }
    }

    void take_masses() {
        for_each_line([this](std::string_view line) {
            BallLine words(line, lines_);
            const std::uint64_t type = words.id();
            masses_.insert_or_assign(type, words.number());
        });
    }

    AtomStyle style_of(std::string_view name) const {
        if (name.empty()) return AtomStyle::kUnknown;
        if (name == "atomic") return AtomStyle::kAtomic;
        if (name == "sphere") return AtomStyle::kSphere;
        lines_.fail(fmt::format("atom style \"{}\" is not read (known: atomic, sphere)", quotable(name)));
    }

    void take_atoms(std::string_view style_name) {
        if (!count_) lines_.fail("the header must say how many atoms there are");
        if (atoms_at_)
            lines_.fail(fmt::format("a second section Atoms; the first is at line {}", *atoms_at_));
        atoms_at_ = lines_.line_number();
        style_ = style_of(style_name);
        // An atom takes ten bytes at least, so a count beyond the file's size is a lie not worth the memory.
        const std::size_t room = std::min<std::uint64_t>(*count_, text_size_ / 10);
        frame_.balls.reserve(room);
        frame_.lines.reserve(room);
        for_each_line([this](std::string_view line) { take_atom(line); });
        if (frame_.balls.size() != *count_)
            lines_.fail(
                fmt::format("section Atoms has {} lines, the header says {}", frame_.balls.size(), *count_));
    }

    void take_atom(std::string_view line) {
        if (const std::uint64_t count = count_.value_or(0); frame_.balls.size() == count)
            lines_.fail(fmt::format("the header says that there are {} atoms", count));
        const std::size_t words = count_words(line);
        if (style_ == AtomStyle::kUnknown) style_ = style_by(words);
        const std::size_t own = columns_of(style_);
        if (words != own && words != own + kImageColumns)
            lines_.fail(fmt::format("must have {} columns, or {} with image flags, has {}", own,
                                    own + kImageColumns, words));
        BallLine parts(line, lines_);
        Ball ball;
        ids_.push_back(parts.id());
        types_.push_back(parts.id());
        if (style_ == AtomStyle::kSphere) {
            ball.radius = parts.number() / 2;
            ball.mass = parts.number() * 4 / 3 * std::numbers::pi * ball.radius * ball.radius * ball.radius;
        }
        parts.vector(ball.position, 3);
        frame_.balls.push_back(ball);
        frame_.lines.push_back(lines_.line_number());
    }

    AtomStyle style_by(std::size_t words) const {
        for (const AtomStyle style : {AtomStyle::kAtomic, AtomStyle::kSphere})
            if (words == columns_of(style) || words == columns_of(style) + kImageColumns) return style;
        lines_.fail(fmt::format(
            "{} columns are those of no known atom style (atomic: 5, sphere: 7, 3 more with image flags)",
            words));
    }

    void take_velocities() {
        for_each_line([this](std::string_view line) {
            BallLine words(line, lines_);
            const std::uint64_t id = words.id();
            Vec2 velocity;
            words.vector(velocity, 3);
            if (!velocities_.emplace(id, velocity).second)
                lines_.fail(fmt::format("a second velocity of atom {}", id));
        });
    }

    void give_masses() {
        if (style_ == AtomStyle::kSphere || masses_.empty()) return;
        for (std::size_t i = 0; i < types_.size(); ++i) {
            const auto mass = masses_.find(types_[i]);
            if (mass == masses_.end())
                throw SceneError(fmt::format("{}:{}", name_, frame_.lines[i]),
                                 fmt::format("type {} has no line in the section Masses", types_[i]));
            frame_.balls[i].mass = mass->second;
        }
    }

    void give_velocities() {
        std::size_t given = 0;
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            const auto velocity = velocities_.find(ids_[i]);
            if (velocity == velocities_.end()) continue;
            frame_.balls[i].velocity = velocity->second;
            ++given;
        }
        if (given < velocities_.size())
            throw SceneError(name_, "has velocities of atoms that are not in the section Atoms");
    }

    LineReader lines_;
    const std::string& name_;
    std::size_t text_size_;
    bool in_body_ = false;
    std::optional<std::uint64_t> count_;
    std::optional<std::uint64_t> atoms_at_;  // line
    AtomStyle style_ = AtomStyle::kUnknown;
    std::map<std::uint64_t, double> masses_;    // by type
    std::map<std::uint64_t, Vec2> velocities_;  // by id
    std::vector<std::uint64_t> ids_, types_;
    XyzFrame frame_;
};

}  // namespace

XyzFrame parse_lammps_data(std::string_view text, const std::string& name) {
    return DataReader(text, name).read();
}

XyzFrame read_lammps_data(const std::filesystem::path& path) {
    return parse_lammps_data(read_file(path), path.filename().string());
}

XyzFrame read_balls(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    for (const char* const known : {".data", ".lmp", ".lammps"})
        if (extension == known) return read_lammps_data(path);
    return read_xyz(path);
}

}  // namespace carom
