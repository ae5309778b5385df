// The table of systems.
#include "accuracy/systems.hpp"

#include <fmt/format.h>

#include "accuracy/tally.hpp"

namespace carom::accuracy {

std::string systems_header() {
    return "| system | collisions | counted without the engine | figure | worst error | its bound |\n"
           "| --- | ---: | ---: | --- | ---: | ---: |\n";
}

std::string system_line(const System& system, const Deviation& d) {
    return fmt::format(
        "| {} | {} | {} | {} | {} | {} |\n", system.name, grouped(static_cast<std::int64_t>(d.collisions)),
        grouped(static_cast<std::int64_t>(d.expected)), system.figure, brief(d.error), brief(d.bound));
}

}  // namespace carom::accuracy
