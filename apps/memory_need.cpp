// Figures measured with `carom run` (peak_memory_bytes), 100,000 to 10^6 balls: 500 bytes a ball for a gas of
// equal discs, 600 for mixed sizes between walls under gravity, 370 by the empirical method.
#include "memory_need.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace carom::app {
namespace {

constexpr double kBytesOfBall = 700;
constexpr double kBytesOfWall = 400;
// Threads, tables of the library, the grid of a scene with few balls.
constexpr double kBytesOfProgram = 32e6;
// What the summary, a frame or a picture of the balls takes at the end is part of the margin.

double balls_of(const Fill& fill, const Scene& scene) {
    if (fill.count) return static_cast<double>(*fill.count);
    if (!fill.packing_fraction || (!fill.region && !scene.domain)) return 0;
    const Box& box = fill.region ? *fill.region : scene.domain->box;
    const double a = fill.radius_min;
    const double b = fill.radius_max;
    const double mean_square = (a * a + a * b + b * b) / 3;
    return *fill.packing_fraction * (box.max - box.min).prod() / (std::numbers::pi * mean_square);
}

/// A line `NAME:  number kB` of a file under /proc, in bytes.
std::optional<double> kilobytes(const char* path, const std::string& name) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        double number = 0;
        if (words >> word >> number && word == name + ":") return 1024 * number;
    }
    return std::nullopt;
}

std::optional<double> number_in(const std::filesystem::path& path) {
    std::ifstream file(path);
    double number = 0;
    if (file >> number) return number;  // "max" is no number and no limit
    return std::nullopt;
}

/// The process's own group, from the line `0::/path` of version 2.
std::string own_group() {
    std::ifstream file("/proc/self/cgroup");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("0::")) return line.substr(3);
    return "/";
}

std::optional<double> room_of_limit(int resource, const std::string& used) {
    rlimit limit = {};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::nullopt;
    return static_cast<double>(limit.rlim_cur) - kilobytes("/proc/self/status", used).value_or(0);
}

std::string gigabytes(double bytes) {
    return bytes < 1e9 ? fmt::format("{:.0f} MB", std::max(bytes, 0.0) / 1e6)
                       : fmt::format("{:.1f} GB", bytes / 1e9);
}

}  // namespace

double count_of_balls(const Scene& scene) {
    double count = static_cast<double>(scene.balls.size());
    for (const Fill& fill : scene.fills) count += balls_of(fill, scene);
    return count;
}

double memory_need(const Scene& scene) {
    return kBytesOfProgram + kBytesOfBall * count_of_balls(scene) +
           kBytesOfWall * static_cast<double>(scene.walls.size());
}

std::optional<double> room_of_groups(const std::filesystem::path& root, const std::string& group) {
    std::optional<double> least;
    std::filesystem::path relative = std::filesystem::path(group).relative_path();
    for (;; relative = relative.parent_path()) {
        const std::optional<double> most = number_in(root / relative / "memory.max");
        if (most) {
            const double left = *most - number_in(root / relative / "memory.current").value_or(0);
            least = std::min(left, least.value_or(std::numeric_limits<double>::infinity()));
        }
        if (relative.empty()) return least;
    }
}

std::optional<MemoryRoom> memory_room() {
    std::optional<MemoryRoom> least;
    const auto consider = [&least](const std::optional<double>& bytes, const char* limit) {
        if (bytes && (!least || *bytes < least->bytes)) least = MemoryRoom{*bytes, limit};
    };
    consider(kilobytes("/proc/meminfo", "MemAvailable"), "the machine's free memory");
    consider(room_of_limit(RLIMIT_AS, "VmSize"), "the limit of the address space (ulimit -v)");
    consider(room_of_limit(RLIMIT_DATA, "VmData"), "the limit of data (ulimit -d)");
    consider(room_of_groups("/sys/fs/cgroup", own_group()), "the control group's limit (memory.max)");
    return least;
}

void require_memory(const Scene& scene) {
    const double need = memory_need(scene);
    const std::optional<MemoryRoom> room = memory_room();
    if (!room || need <= room->bytes) return;
    throw std::runtime_error(fmt::format(
        "{:.0f} balls need about {} of memory, and {} leaves {}; --no-memory-check tries all the same",
        count_of_balls(scene), gigabytes(need), room->limit, gigabytes(room->bytes)));
}

}  // namespace carom::app
