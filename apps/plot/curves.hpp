// What a plot shows: panels, each with curves over one axis.
#pragma once

#include <string>
#include <vector>

#include <carom/core/vector.hpp>

namespace carom::app {

struct Curve {
    std::string label;         ///< empty: none
    std::vector<Vec2> points;  ///< in the order of x
    bool is_theory = false;    ///< thin and white: what the others should be
    bool is_bars = false;      ///< a histogram: each point the middle of a bar
};

struct PlotPanel {
    std::string x_label;
    std::string y_label;
    bool from_zero = false;  ///< y = 0 is shown
    std::vector<Curve> curves;
};

struct Plot {
    std::string title;
    std::vector<PlotPanel> panels;
};

}  // namespace carom::app
