// Tables of numbers, as --observables writes them, to panels.
#pragma once

#include <string>
#include <vector>

#include "curves.hpp"

namespace carom::app {

/// A CSV file with a header of names; a cell that is empty or no number is a gap (NaN).
struct Table {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;
};

/// Throws FileError that names the line: a row with another number of cells than the header.
[[nodiscard]] Table read_table(const std::string& path);

/// A panel for each column but the first, which is the x axis; tables that have a column of one name share
/// its panel. `wanted` are the columns to show, all where it is empty. Columns without a number are left
/// out. Throws FileError where nothing is left.
[[nodiscard]] std::vector<PlotPanel> panels_of(const std::vector<std::string>& paths,
                                               const std::vector<std::string>& wanted);

}  // namespace carom::app
