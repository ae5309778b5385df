#include "accuracy/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace carom::accuracy {

double quantile(std::vector<float>& values, double q) {
    if (values.empty()) return 0;
    const auto place = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

std::string grouped(std::int64_t n) {
    if (n < 1000) return fmt::format("{}", n);
    return fmt::format("{},{:03}", grouped(n / 1000), n % 1000);
}

std::string brief(double x) {
    if (x == 0) return "0";
    return std::abs(x) >= 0.01 && std::abs(x) < 1000 ? fmt::format("{:.2f}", x) : fmt::format("{:.1e}", x);
}

std::string tally_header() {
    return "| kind | queries | hits | in the band (missed, invented) | elsewhere (missed, invented) "
           "| error in units, median | worst | relative error, median | worst |\n"
           "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
}

std::string tally_line(Tally& t) {
    constexpr double kHalfUlp = 0x1p-53;
    return fmt::format("| {} | {} | {} | {} ({}, {}) | {}, {} | {} | {} | {} | {} |\n", t.kind,
                       grouped(t.queries), grouped(t.hits), grouped(t.band), t.missed_in_band,
                       t.invented_in_band, t.missed, t.invented, brief(quantile(t.in_units, 0.5)),
                       brief(quantile(t.in_units, 1)), brief(kHalfUlp * quantile(t.relative, 0.5)),
                       brief(kHalfUlp * quantile(t.relative, 1)));
}

std::string oracle_line(const std::vector<Tally>& tallies) {
    std::int64_t queries = 0, open = 0, checked = 0, unconfirmed = 0;
    for (const Tally& t : tallies) {
        queries += t.queries;
        open += t.open;
        checked += t.checked;
        unconfirmed += t.unconfirmed;
    }
    return fmt::format(
        "\nOf {} queries 113 bits left {} open; {} others were put to the slow oracles as well, which "
        "contradicted {}.\n",
        grouped(queries), grouped(open), grouped(checked), grouped(unconfirmed));
}

}  // namespace carom::accuracy
