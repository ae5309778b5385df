// Collisions as CSV, one a line in time order.
#pragma once

#include <cstdint>
#include <filesystem>

#include <carom/core/vector.hpp>
#include <carom/io/row_file.hpp>

namespace carom {

/// Writes `time,kind,i,j,x,y,nx,ny,impulse`. Throws FileError. One thread at a time.
class EventsCsv {
 public:
    enum class Kind : std::uint8_t { kBall, kWall };

    struct Row {
        double time;
        Kind kind;
        std::uint32_t i;
        std::uint32_t j;  ///< the other ball's id, or the wall's index
        Vec2 point;       ///< of contact
        Vec2 normal;      ///< towards ball i
        double impulse;
    };

    /// A file that appears under its name with commit().
    explicit EventsCsv(const std::filesystem::path& path);
    /// A file that grows: see RowFile.
    EventsCsv(const std::filesystem::path& path, std::uint64_t kept);
    /// Numbers have as many digits as it takes to read back the same bits. Rows are buffered.
    void write(const Row& row);
    void commit() { rows_.commit(); }
    /// Of a file that grows: forces the rows to the disk and gives the bytes that they take.
    std::uint64_t sync() { return rows_.sync(); }

 private:
    RowFile rows_;
};

}  // namespace carom
