// A figure's verdict, and its line in the table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/physics.hpp"

namespace carom::accuracy {

double Figure::deviation() const {
    return (measured.value - expected) / measured.error;
}

bool Figure::agrees() const {
    return std::abs(measured.value - expected) <= 3 * measured.error + systematic;
}

std::string physics_header() {
    return "| quantity | system | measured | standard error | expected | its bound "
           "| deviation in standard errors |\n| --- | --- | ---: | ---: | ---: | ---: | ---: |\n";
}

std::string physics_line(const Figure& f) {
    // Two digits of the error decide how many the rest gets.
    const int places = std::clamp(1 - static_cast<int>(std::floor(std::log10(f.measured.error))), 0, 15);
    return fmt::format("| {} | {} | {:.{}f} | {:.1e} | {:.{}f} | {} | {:+.2f} |\n", f.quantity, f.system,
                       f.measured.value, places, f.measured.error, f.expected, places,
                       f.systematic > 0 ? fmt::format("{:.1e}", f.systematic) : "", f.deviation());
}

}  // namespace carom::accuracy
