#include "sensings_csv.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>

namespace carom::app {

SensingsCsv::SensingsCsv(const std::string& path) : file_(path) {}

void SensingsCsv::write(const Sensing& s) {
    fmt::format_to(std::back_inserter(buffer_), "{},{},{},{},{},{},{},{}\n", s.time, s.sensor, s.ball,
                   s.enters ? 1 : 0, s.position.x(), s.position.y(), s.velocity.x(), s.velocity.y());
    constexpr std::size_t kBufferSize = std::size_t{1} << 20;
    if (buffer_.size() >= kBufferSize) flush();
}

void SensingsCsv::flush() {
    file_.write(buffer_);
    buffer_.clear();
}

void SensingsCsv::commit() {
    flush();
    file_.commit();
}

}  // namespace carom::app
