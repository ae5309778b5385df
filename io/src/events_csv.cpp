// EventsCsv: rows are formatted into a buffer that is written when it is full.
#include <carom/io/events_csv.hpp>

#include <iterator>

#include <fmt/format.h>

namespace carom {
namespace {
constexpr std::size_t kBufferSize = std::size_t{1} << 20;
}

EventsCsv::EventsCsv(const std::filesystem::path& path) {
    whole_.emplace(path);
    put_header();
}

EventsCsv::EventsCsv(const std::filesystem::path& path, std::uint64_t kept) {
    if (kept > 0) {
        growing_ = std::make_unique<GrowingFile>(path, kept);
        return;
    }
    growing_ = std::make_unique<GrowingFile>(path);
    put_header();
}

void EventsCsv::put_header() {
    buffer_.reserve(kBufferSize + 512);
    buffer_ = "time,kind,i,j,x,y,nx,ny,impulse\n";
}

void EventsCsv::flush() {
    if (whole_)
        whole_->write(buffer_);
    else
        growing_->write(buffer_);
    buffer_.clear();
}

void EventsCsv::write(const Row& row) {
    fmt::format_to(std::back_inserter(buffer_), "{},{},{},{},{},{},{},{},{}\n", row.time,
                   row.kind == Kind::kBall ? "ball" : "wall", row.i, row.j, row.point.x(), row.point.y(),
                   row.normal.x(), row.normal.y(), row.impulse);
    if (buffer_.size() >= kBufferSize) flush();
}

void EventsCsv::commit() {
    flush();
    if (whole_)
        whole_->commit();
    else
        growing_->sync();
}

std::uint64_t EventsCsv::sync() {
    flush();
    growing_->sync();
    return growing_->size();
}

}  // namespace carom
