// carom_gas: the engine's speed on the baseline's gas, in one line of the baseline's form; or on a scene.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

#include "gas_scene.hpp"
#include "plain/gas.hpp"

namespace carom::bench {
namespace {

// The very discs that the baseline starts from.
Scene scene_of(const plain::Gas& gas) {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {gas.side, gas.side}}, {Boundary::kPeriodic, Boundary::kPeriodic}, 1};
    scene.balls.reserve(gas.positions.size());
    for (std::size_t i = 0; i < gas.positions.size(); ++i) {
        Ball ball;
        ball.position = {gas.positions[i][0], gas.positions[i][1]};
        ball.velocity = {gas.velocities[i][0], gas.velocities[i][1]};
        scene.balls.push_back(ball);
    }
    return scene;
}

/// The speed in slices of time, of which some go undisturbed where a machine has other guests.
class Slices {
 public:
    explicit Slices(const World& world) : world_(world) {}

    [[nodiscard]] double elapsed() const { return since(start_); }
    /// To be called often. Where there are windows a slice is some of them and ends with the first look into
    /// one, so that it has the time and, but for one window more or less, the collisions of whole ones.
    void look() {
        const Counts counts = world_.counts();
        const bool is_new = std::exchange(windows_, counts.windows) != counts.windows;
        if (counts.windows != 0 && (!is_new || ++windows_of_slice_ < kFewestWindows)) return;
        if (since(begun_) < kSlice) return;
        const std::uint64_t collisions = counts.ball_collisions;
        if (is_begun_) speeds_.push_back(static_cast<double>(collisions - collisions_) / since(begun_));
        is_begun_ = true;
        windows_of_slice_ = 0;
        collisions_ = collisions;
        begun_ = Clock::now();
    }
    /// Collisions a second that one slice in ten has exceeded; 0 without slices.
    [[nodiscard]] double undisturbed() {
        std::ranges::sort(speeds_);
        return speeds_.empty() ? 0 : speeds_[speeds_.size() * 9 / 10];
    }

 private:
    using Clock = std::chrono::steady_clock;
    static constexpr double kSlice = 0.02;  // seconds
    static constexpr int kFewestWindows = 8;
    static double since(const Clock::time_point& t) {
        return std::chrono::duration<double>(Clock::now() - t).count();
    }

    const World& world_;
    Clock::time_point start_ = Clock::now(), begun_ = start_;
    std::uint64_t windows_ = 0, collisions_ = 0;
    int windows_of_slice_ = 0;
    bool is_begun_ = false;
    std::vector<double> speeds_;
};

/// What collisions have cost.
struct Price {
    double speed = 0;                 ///< collisions a second
    double events = 0;                ///< a collision
    double copied = 0;                ///< collisions of copies, a collision
    double collisions_of_window = 0;  ///< of one domain's
    double retried = 0;               ///< windows that were gone through again, a window
    double worked = 0;                ///< of the threads' time
};
Price price_since(const World& world, const Counts& before, double worked, double elapsed) {
    const Counts after = world.counts();
    const auto collisions = static_cast<double>(after.ball_collisions - before.ball_collisions);
    const double each = std::max(1.0, collisions);
    const double windows = std::max(1.0, static_cast<double>(after.windows - before.windows));
    return {
        .speed = collisions / elapsed,
        .events = static_cast<double>(after.events - before.events) / each,
        .copied = static_cast<double>(after.copied_collisions - before.copied_collisions) / each,
        .collisions_of_window = collisions / windows,
        .retried = static_cast<double>(after.window_retries - before.window_retries) / windows,
        .worked = (world.working_seconds() - worked) / (elapsed * world.threads()),
    };
}
void print(const World& world, const Price& price, double undisturbed) {
    std::printf("threads=%d copied=%.1f%% windows=%.2f retried=%.1f%% worked=%.1f%% undisturbed=%.4g\n",
                world.threads(), 100 * price.copied, price.collisions_of_window, 100 * price.retried,
                100 * price.worked, undisturbed);
}

void measure(double count, double packing, double seconds, int threads, int domains) {
    World world(scene_of(plain::make_gas(count, packing)), {.threads = threads, .domains = domains});
    const auto balls = static_cast<double>(world.ball_count());
    // One collision a ball, and at least 20,000 collisions; and so many looks at the clock meanwhile.
    constexpr int kLooks = 64;
    const double stretch = mean_free_time(packing) * std::max(1.0, 40000 / balls);
    while (static_cast<double>(world.counts().ball_collisions) < 3 * balls) world.step(stretch);

    const Counts counts_0 = world.counts();
    const double worked_0 = world.working_seconds();
    const double energy = world.energy(), time_0 = world.time(), virial_0 = world.virial();
    Slices slices(world);
    do {
        for (int k = 0; k < kLooks; ++k) {
            world.step(stretch / kLooks);
            slices.look();
        }
    } while (slices.elapsed() < seconds);

    const Price price = price_since(world, counts_0, worked_0, slices.elapsed());
    const double kinetic = energy / (balls - 1) * balls;  // N kT: the momentum is fixed at zero
    std::printf("discs=%.0f packing=%.2f collisions_per_second=%.4g events=%.2f Z=%.4f energy_change=%.1e ",
                balls, packing, price.speed, price.events,
                1 + (world.virial() - virial_0) / (2 * kinetic * (world.time() - time_0)),
                world.energy() / energy - 1);
    print(world, price, slices.undisturbed());
}

/// A scene from its start to `until`.
void measure_scene(const char* path, double until, int threads, int domains) {
    if (!(until > 0)) throw std::invalid_argument("UNTIL is a time above 0");
    World world(read_scene(path), {.threads = threads, .domains = domains});
    const double worked = world.working_seconds();
    Slices slices(world);
    world.advance_to(until);
    const Price price = price_since(world, {}, worked, slices.elapsed());
    std::printf("balls=%zu collisions_per_second=%.4g events=%.2f hash=%016llx ", world.ball_count(),
                price.speed, price.events, static_cast<unsigned long long>(world.state_hash()));
    print(world, price, slices.undisturbed());
}

}  // namespace
}  // namespace carom::bench

int main(int argc, char** argv) {
    if (argc < 3 || argc > 6) {
        std::fputs(
            "usage: carom_gas COUNT PACKING [SECONDS [THREADS [DOMAINS]]]\n"
            "       carom_gas SCENE.json UNTIL [THREADS [DOMAINS]]\n",
            stderr);
        return 2;
    }
    const auto number = [argc, argv](int k, double otherwise) {
        return argc > k ? std::atof(argv[k]) : otherwise;
    };
    const bool is_scene = std::string_view(argv[1]).ends_with(".json");
    try {
        if (is_scene)
            carom::bench::measure_scene(argv[1], number(2, 0), static_cast<int>(number(3, 0)),
                                        static_cast<int>(number(4, 0)));
        else
            carom::bench::measure(number(1, 0), number(2, 0), number(3, 3), static_cast<int>(number(4, 0)),
                                  static_cast<int>(number(5, 0)));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "carom_gas: %s\n", error.what());
        return 1;
    }
    return 0;
}
