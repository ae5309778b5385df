// EventsCsv: rows are formatted into a buffer that is written when it is full.
#include <carom/io/events_csv.hpp>

#include <iterator>

#include <fmt/format.h>

namespace carom {
namespace {
constexpr std::size_t kBufferSize = std::size_t{1} << 20;
}

EventsCsv::EventsCsv(const std::filesystem::path& path) : file_(path) {
    buffer_.reserve(kBufferSize + 512);
    buffer_ = "time,kind,i,j,x,y,nx,ny,impulse\n";
}

void EventsCsv::write(const Row& row) {
    fmt::format_to(std::back_inserter(buffer_), "{},{},{},{},{},{},{},{},{}\n", row.time,
                   row.kind == Kind::kBall ? "ball" : "wall", row.i, row.j, row.point.x(), row.point.y(),
                   row.normal.x(), row.normal.y(), row.impulse);
    if (buffer_.size() < kBufferSize) return;
    file_.write(buffer_);
    buffer_.clear();
}

void EventsCsv::commit() {
    file_.write(buffer_);
    buffer_.clear();
    file_.commit();
}

}  // namespace carom
