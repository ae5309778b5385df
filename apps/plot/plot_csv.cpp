#include "plot_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include <carom/io/atomic_file.hpp>
#include <carom/io/read_file.hpp>

namespace carom::app {
namespace {

std::vector<std::string> cells_of(std::string line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> cells;
    std::size_t start = 0;
    for (std::size_t comma = 0; comma != std::string::npos; start = comma + 1) {
        comma = line.find(',', start);
        cells.push_back(line.substr(start, comma - start));
    }
    return cells;
}

double number_of(const std::string& cell) {
    double number = 0;
    const char* const end = cell.data() + cell.size();
    const auto result = std::from_chars(cell.data(), end, number);
    const bool good = result.ec == std::errc() && result.ptr == end && std::isfinite(number);
    return good ? number : std::numeric_limits<double>::quiet_NaN();
}

Curve curve_of(const Table& table, std::size_t column, std::string label) {
    Curve curve;
    curve.label = std::move(label);
    for (std::size_t row = 0; row < table.columns[0].size(); ++row) {
        const Vec2 point{table.columns[0][row], table.columns[column][row]};
        if (point.allFinite()) curve.points.push_back(point);
    }
    return curve;
}

}  // namespace

Table read_table(const std::string& path) {
    std::istringstream file(read_file(path));
    std::string line;
    if (!std::getline(file, line)) throw FileError(path, "is empty");
    Table table;
    table.names = cells_of(line);
    if (table.names.size() < 2) throw FileError(path, "has no header of two or more column names");
    table.columns.resize(table.names.size());
    for (std::size_t number = 2; std::getline(file, line); ++number) {
        if (line.empty() || line == "\r") continue;
        const std::vector<std::string> cells = cells_of(line);
        if (cells.size() != table.names.size())
            throw FileError(path, fmt::format("line {} has {} cells, the header {}", number, cells.size(),
                                              table.names.size()));
        for (std::size_t i = 0; i < cells.size(); ++i) table.columns[i].push_back(number_of(cells[i]));
    }
    return table;
}

std::vector<PlotPanel> panels_of(const std::vector<std::string>& paths,
                                 const std::vector<std::string>& wanted) {
    std::vector<PlotPanel> panels;
    std::vector<std::string> known;
    for (const std::string& path : paths) {
        const Table table = read_table(path);
        const std::string label = paths.size() > 1 ? std::filesystem::path(path).stem().string() : "";
        for (std::size_t column = 1; column < table.names.size(); ++column) {
            const std::string& name = table.names[column];
            known.push_back(name);
            if (!wanted.empty() && std::ranges::find(wanted, name) == wanted.end()) continue;
            Curve curve = curve_of(table, column, label);
            if (curve.points.empty()) continue;
            auto panel = std::ranges::find(panels, name, &PlotPanel::y_label);
            if (panel == panels.end()) panel = panels.insert(panels.end(), {table.names[0], name, false, {}});
            panel->curves.push_back(std::move(curve));
        }
    }
    for (const std::string& name : wanted)
        if (std::ranges::find(known, name) == known.end())
            throw FileError(paths.front(),
                            fmt::format("has no column '{}' (has: {})", name, fmt::join(known, ", ")));
    if (panels.empty()) throw FileError(paths.front(), "has no numbers to plot");
    return panels;
}

}  // namespace carom::app
