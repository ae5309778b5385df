// Collisions as CSV, one a line in time order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <carom/core/vector.hpp>
#include <carom/io/atomic_file.hpp>

namespace carom {

/// Writes `time,kind,i,j,x,y,nx,ny,impulse`. The file appears under its name with commit(). Throws FileError.
/// One thread at a time.
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

    explicit EventsCsv(const std::filesystem::path& path);
    /// Numbers have as many digits as it takes to read back the same bits. Rows are buffered.
    void write(const Row& row);
    void commit();

 private:
    AtomicFile file_;
    std::string buffer_;
};

}  // namespace carom
