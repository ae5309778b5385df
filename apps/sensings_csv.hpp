// Who came into sensors and left them, as CSV: one a line in time order.
#pragma once

#include <string>

#include <carom/io/atomic_file.hpp>
#include <carom/parallel/world.hpp>

namespace carom::app {

/// Writes `time,sensor,ball,enters,x,y,vx,vy`, enters being 1 or 0, into a file that appears under its name
/// with commit(). Throws FileError.
class SensingsCsv {
 public:
    explicit SensingsCsv(const std::string& path);
    /// Numbers have as many digits as it takes to read back the same bits. Rows are buffered.
    void write(const Sensing& sensing);
    void commit();

 private:
    void flush();

    AtomicFile file_;
    std::string buffer_ = "time,sensor,ball,enters,x,y,vx,vy\n";
};

}  // namespace carom::app
