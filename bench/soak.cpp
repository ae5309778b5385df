// carom_soak: runs scenes for long and looks whether they stay sound: memory, invariants, pace. Paces are by
// CPU time, so that a busy machine does not matter. bench/soak builds and starts it.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

namespace carom::bench {
namespace {

constexpr int kSamples = 20;
// Tables grow while a scene finds its pace; what grows after a quarter of the time goes on growing.
constexpr int kSettled = kSamples / 4;
constexpr double kMostGrowth = 1.05;

double cpu_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

double resident_megabytes() {
    std::ifstream file("/proc/self/statm");
    double all = 0;
    double resident = 0;
    file >> all >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// What is done to a world between two samples besides advancing it, such as edits of its balls. None so far.
using Disturbance = std::function<void(World&)>;

class Soak {
 public:
    Soak(const std::string& path, double seconds)
        : scene_(read_scene(path)), world_(scene_), seconds_per_sample_(seconds / kSamples) {
        is_elastic_ = scene_.gravity.isZero(0) && scene_.attractors.empty() && loses_nothing();
        energy_ = world_.energy();
    }

    /// False where the world did not stay sound.
    bool run(const Disturbance& disturb) {
        fmt::print("\n{}: {} balls\n{:>10} {:>14} {:>14} {:>10} {:>12}  {}\n", scene_.name,
                   world_.ball_count(), "time", "collisions", "a CPU-second", "RSS MB", "energy", "found");
        double settled = 0;
        bool is_sound = true;
        for (int k = 0; k < kSamples; ++k) {
            const double pace = advance_for(seconds_per_sample_);
            if (disturb) disturb(world_);
            const double megabytes = resident_megabytes();
            if (k <= kSettled) settled = std::max(settled, megabytes);
            std::string found = fault();
            if (found.empty() && megabytes > kMostGrowth * settled)
                found = fmt::format("memory has grown from {:.1f} MB", settled);
            is_sound = is_sound && found.empty();
            fmt::print("{:>10.4g} {:>14} {:>14.4g} {:>10.1f} {:>12.6g}  {}\n", world_.time(), collisions(),
                       pace, megabytes, world_.energy(), found.empty() ? "sound" : found);
            std::fflush(stdout);
        }
        return is_sound;
    }

 private:
    [[nodiscard]] bool loses_nothing() const {
        const auto is_elastic = [](const auto& body) { return body.restitution == 1; };
        return scene_.speed_factor == 1 && (!scene_.domain || scene_.domain->restitution == 1) &&
               std::ranges::all_of(scene_.balls, is_elastic) &&
               std::ranges::all_of(scene_.fills, is_elastic) && std::ranges::all_of(scene_.walls, is_elastic);
    }
    [[nodiscard]] std::uint64_t collisions() const {
        const Counts counts = world_.counts();
        return counts.ball_collisions + counts.wall_collisions;
    }

    /// In steps that find their own length; gives collisions a CPU-second.
    double advance_for(double seconds) {
        const double start = cpu_seconds();
        const std::uint64_t before = collisions();
        double now = start;
        while (now - start < seconds) {
            world_.step(step_);
            const double took = cpu_seconds() - now;
            now += took;
            step_ *= took < seconds / 20 ? 2 : took > seconds / 5 ? 0.5 : 1;
        }
        return double(collisions() - before) / (now - start);
    }

    [[nodiscard]] std::string fault() const {
        if (const std::vector<Violation> found = world_.validate(); !found.empty()) return found.front().what;
        // Each collision rounds a few numbers of the two balls' energy by half an ulp, all one way at worst.
        const double bound = 16 * 0x1p-53 * std::max(double(collisions()), 1e4) * energy_;
        if (is_elastic_ && scene_.precision == Precision::kDouble &&
            !(std::abs(world_.energy() - energy_) <= bound))
            return fmt::format("energy was {:.17g}", energy_);
        return {};
    }

    Scene scene_;
    World world_;
    double seconds_per_sample_;
    double step_ = 1e-4;
    bool is_elastic_ = false;
    double energy_ = 0;
};

}  // namespace
}  // namespace carom::bench

// carom_soak SECONDS SCENE...: CPU seconds for each scene.
int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: carom_soak CPU-SECONDS SCENE...\n");
        return 2;
    }
    bool all_sound = true;
    try {
        for (int k = 2; k < argc; ++k)
            all_sound = carom::bench::Soak(argv[k], std::atof(argv[1])).run(nullptr) && all_sound;
    } catch (const std::exception& error) {
        fmt::print(stderr, "carom_soak: error: {}\n", error.what());
        return 1;
    }
    fmt::print("\nsoak: {}\n", all_sound ? "sound" : "FAILED");
    return all_sound ? 0 : 1;
}
