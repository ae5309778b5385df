#include "sensings_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace carom::app {
namespace {
constexpr std::string_view kSensingsHeader = "time,sensor,ball,enters,x,y,vx,vy\n";
}

SensingsCsv::SensingsCsv(const std::string& path) : rows_(path, kSensingsHeader) {}

SensingsCsv::SensingsCsv(const std::string& path, std::uint64_t kept) : rows_(path, kSensingsHeader, kept) {}

void SensingsCsv::write(const Sensing& s) {
    fmt::format_to(std::back_inserter(rows_.row()), "{},{},{},{},{},{},{},{}\n", s.time, s.sensor, s.ball,
                   s.enters ? 1 : 0, s.position.x(), s.position.y(), s.velocity.x(), s.velocity.y());
    rows_.end_row();
}

}  // namespace carom::app
