// carom_accuracy: the tables of docs/accuracy.md. bench/accuracy-tables builds it and puts them there.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "accuracy/wall_accuracy.hpp"

namespace carom::accuracy {
namespace {

void print(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

void print_discs(const Effort& effort) {
    std::uint64_t seed = 1000;
    print("<!-- table: straight -->\n" + tally_header());
    for (const DiscKind& kind : straight_kinds()) print(tally_line(measure(kind, ++seed, effort)));
    print("<!-- table: curved -->\n" + tally_header());
    for (const DiscKind& kind : curved_kinds()) print(tally_line(measure(kind, ++seed, effort)));
    print("<!-- table: walls -->\n" + tally_header());
    for (const WallKind& kind : wall_kinds()) print(tally_line(measure(kind, ++seed, effort)));
}
}  // namespace
}  // namespace carom::accuracy

int main(int argc, char** argv) {
    carom::accuracy::Effort effort{argc > 1 ? std::atoll(argv[1]) : 100000, 1000};
    carom::accuracy::print_discs(effort);
}
