// Who came into sensors and left them, as CSV: one a line in time order.
#pragma once

#include <cstdint>
#include <string>

#include <carom/io/row_file.hpp>
#include <carom/parallel/world.hpp>

namespace carom::app {

/// Writes `time,sensor,ball,enters,x,y,vx,vy`, enters being 1 or 0. Throws FileError.
class SensingsCsv {
 public:
    /// A file that appears under its name with commit().
    explicit SensingsCsv(const std::string& path);
    /// A file that grows: see RowFile.
    SensingsCsv(const std::string& path, std::uint64_t kept);
    /// Numbers have as many digits as it takes to read back the same bits. Rows are buffered.
    void write(const Sensing& sensing);
    void commit() { rows_.commit(); }
    /// Of a file that grows: forces the rows to the disk and gives the bytes that they take.
    std::uint64_t sync() { return rows_.sync(); }

 private:
    RowFile rows_;
};

}  // namespace carom::app
