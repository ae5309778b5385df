#include <carom/io/events_csv.hpp>

#include <iterator>

#include <fmt/format.h>

namespace carom {
namespace {
constexpr std::string_view kEventsHeader = "time,kind,i,j,x,y,nx,ny,impulse\n";
}

EventsCsv::EventsCsv(const std::filesystem::path& path) : rows_(path, kEventsHeader) {}

EventsCsv::EventsCsv(const std::filesystem::path& path, std::uint64_t kept)
    : rows_(path, kEventsHeader, kept) {}

void EventsCsv::write(const Row& row) {
    fmt::format_to(std::back_inserter(rows_.row()), "{},{},{},{},{},{},{},{},{}\n", row.time,
                   row.kind == Kind::kBall ? "ball" : "wall", row.i, row.j, row.point.x(), row.point.y(),
                   row.normal.x(), row.normal.y(), row.impulse);
    rows_.end_row();
}

}  // namespace carom
