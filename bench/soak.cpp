// carom_soak: runs scenes for long and looks whether they stay sound: memory, invariants, pace. Paces are by
// CPU time, so that a busy machine does not matter. bench/soak builds and starts it.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <string_view>
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

/// What a player would do to a world between two steps: a ball comes, goes or is kicked.
class Player {
 public:
    explicit Player(const World& world) : first_count_(world.ball_count()) {
        const std::vector<Ball> balls = world.balls();
        for (const Ball& b : balls)
            if (!b.is_static) model_ = b;
    }

    void act(World& world) {
        const std::vector<std::uint32_t> ids = world.ball_ids();
        const std::uint32_t id = ids[random_() % ids.size()];
        switch (random_() % 3) {
            case 0:
                if (ids.size() < 2 * first_count_) add(world);
                break;
            case 1:
                if (ids.size() > first_count_ / 2) world.remove_ball(id);
                break;
            default:
                if (!world.ball(id).is_static) world.apply_impulse(id, model_.mass * Vec2(draw(), draw()));
        }
        ++acts_;
    }
    [[nodiscard]] std::uint64_t acts() const { return acts_; }

 private:
    double draw() { return double(random_() >> 11U) * 0x1p-53 - 0.5; }
    void add(World& world) {
        const Box& box = world.domain().box;
        Ball b = model_;
        b.position = (box.min + box.max) / 2 +
                     Vec2(draw(), draw()).cwiseProduct(box.max - box.min - Vec2(2, 2) * b.radius);
        try {
            world.add_ball(b);
        } catch (const SceneError&) {  // no room there
        }
    }

    std::mt19937_64 random_{1};
    std::size_t first_count_;
    Ball model_;
    std::uint64_t acts_ = 0;
};

class Soak {
 public:
    Soak(const std::string& path, double seconds, bool is_played)
        : scene_(read_scene(path)), world_(scene_), seconds_per_sample_(seconds / kSamples) {
        if (is_played) {
            player_.emplace(world_);
            step_ = 1.0 / 60;
        }
        is_elastic_ = !is_played && scene_.gravity.isZero(0) && scene_.attractors.empty() && loses_nothing();
        energy_ = world_.energy();
    }

    /// False where the world did not stay sound.
    bool run() {
        fmt::print("\n{}: {} balls{}\n{:>10} {:>14} {:>14} {:>10} {:>12}  {}\n", scene_.name,
                   world_.ball_count(), player_ ? ", edited" : "", "time", "collisions", "a CPU-second",
                   "RSS MB", "energy", "found");
        double settled = 0;
        bool is_sound = true;
        for (int k = 0; k < kSamples; ++k) {
            const double pace = advance_for(seconds_per_sample_);
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
        if (player_) fmt::print("{} edits, {} balls\n", player_->acts(), world_.ball_count());
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
            if (player_) player_->act(world_);
            const double took = cpu_seconds() - now;
            now += took;
            if (!player_) step_ *= took < seconds / 20 ? 2 : took > seconds / 5 ? 0.5 : 1;
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
    std::optional<Player> player_;
    double seconds_per_sample_;
    double step_ = 1e-4;
    bool is_elastic_ = false;
    double energy_ = 0;
};

}  // namespace
}  // namespace carom::bench

// carom_soak SECONDS SCENE...: CPU seconds for each scene; a scene written edited:FILE is edited while it
// runs.
int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: carom_soak CPU-SECONDS [edited:]SCENE...\n");
        return 2;
    }
    bool all_sound = true;
    try {
        for (int k = 2; k < argc; ++k) {
            std::string scene = argv[k];
            constexpr std::string_view kEdited = "edited:";
            const bool is_played = scene.starts_with(kEdited);
            if (is_played) scene.erase(0, kEdited.size());
            all_sound = carom::bench::Soak(scene, std::atof(argv[1]), is_played).run() && all_sound;
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "carom_soak: error: {}\n", error.what());
        return 1;
    }
    fmt::print("\nsoak: {}\n", all_sound ? "sound" : "FAILED");
    return all_sound ? 0 : 1;
}
