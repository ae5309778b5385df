// carom_gas: the engine's speed on the baseline's gas, in one line of the baseline's form; or on a scene.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
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
    explicit Slices(const World& world) : world_(&world) {}

    /// Seconds since the start, without pauses.
    [[nodiscard]] double elapsed() const { return since(start_); }
    void pause() { paused_ = Clock::now(); }
    void go_on() {
        const Clock::duration pause = Clock::now() - paused_;
        start_ += pause;
        begun_ += pause;
    }
    /// To be called often. Where there are windows a slice is some of them and ends with the first look into
    /// one, so that it has the time and, but for one window more or less, the collisions of whole ones.
    void look() {
        const Counts counts = world_->counts();
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

    const World* world_;
    Clock::time_point start_ = Clock::now(), begun_ = start_, paused_ = start_;
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

/// So many threads for each of so many worlds side by side, each cut in so many domains.
struct Team {
    int threads = 0;
    int worlds = 1;
    int domains = 0;
};

/// THREADS, THREADSxWORLDS, THREADS/DOMAINS or all of it.
Team read_team(const std::string& text, int domains) {
    Team team{.threads = std::atoi(text.c_str()), .domains = domains};
    const auto read = [&text](char mark, int& value) {
        if (const std::size_t at = text.find(mark); at != std::string::npos)
            value = std::atoi(text.c_str() + at + 1);
    };
    read('x', team.worlds);
    read('/', team.domains);
    return team;
}

// A turn has so many collisions at least, for some percent of it go to fetching what a cache has lost.
constexpr double kCollisionsOfTurn = 80000;

/// A world and what its turns have come to; or more of the same side by side, which share nothing.
class Runner {
 public:
    Runner(const plain::Gas& gas, const Team& team)
        : world_(scene_of(gas), options_of(team)), slices_(world_) {
        for (int k = 1; k < team.worlds; ++k) others_.emplace_back(scene_of(gas), options_of(team));
    }

    void warm_up(double stretch) {
        while (static_cast<double>(world_.counts().ball_collisions) < 3.0 * balls()) {
            world_.step(stretch);
            for (World& other : others_) other.step(stretch);
        }
        counts_ = world_.counts();
        worked_ = world_.working_seconds();
        energy_ = world_.energy();
        time_ = world_.time();
        virial_ = world_.virial();
        slices_ = Slices(world_);
        slices_.pause();
    }
    void take_turn(double stretch, int stretches) {
        constexpr int kLooks = 8;  // at the clock, in a stretch
        slices_.go_on();
        {
            std::vector<std::jthread> threads;
            for (World& other : others_)
                threads.emplace_back([&other, stretch, stretches] {
                    for (int k = 0; k < kLooks * stretches; ++k) other.step(stretch / kLooks);
                });
            for (int k = 0; k < kLooks * stretches; ++k) {
                world_.step(stretch / kLooks);
                slices_.look();
            }
        }
        slices_.pause();
        elapsed_ = slices_.elapsed();
    }
    [[nodiscard]] double elapsed() const { return elapsed_; }
    [[nodiscard]] std::uint64_t state_hash() const { return world_.state_hash(); }

    void print(double packing) {
        Price price = price_since(world_, counts_, worked_, elapsed_);
        price.speed *= 1.0 + static_cast<double>(others_.size());
        const double kinetic = energy_ / (balls() - 1) * balls();  // N kT: the momentum is fixed at zero
        std::printf(
            "discs=%.0f packing=%.2f collisions_per_second=%.4g events=%.2f Z=%.4f energy_change=%.1e "
            "worlds=%zu ",
            balls(), packing, price.speed, price.events,
            1 + (world_.virial() - virial_) / (2 * kinetic * (world_.time() - time_)),
            world_.energy() / energy_ - 1, 1 + others_.size());
        bench::print(world_, price, slices_.undisturbed());
    }

 private:
    static WorldOptions options_of(const Team& team) {
        return {.threads = team.threads, .domains = team.domains};
    }
    [[nodiscard]] double balls() const { return static_cast<double>(world_.ball_count()); }

    World world_;
    std::deque<World> others_;
    Slices slices_;
    Counts counts_;
    double worked_ = 0, energy_ = 0, time_ = 0, virial_ = 0, elapsed_ = 0;
};

/// Teams in turns that are the same stretches of the same gas, until the first has taken `seconds`: what
/// disturbs the machine for longer than a turn disturbs all.
void measure(double count, double packing, double seconds, const std::vector<Team>& teams) {
    const plain::Gas gas = plain::make_gas(count, packing);
    const auto balls = static_cast<double>(gas.positions.size());
    // One collision a ball, and at least 20,000 collisions.
    const double collisions = std::max(balls / 2, 20000.0);
    const double stretch = mean_free_time(packing) * collisions / (balls / 2);
    std::deque<Runner> runners;  // which do not move
    std::vector<Runner*> order;
    for (const Team& team : teams) {
        order.push_back(&runners.emplace_back(gas, team));
        order.back()->warm_up(stretch);
    }
    const int stretches = teams.size() == 1 ? 1 : static_cast<int>(std::ceil(kCollisionsOfTurn / collisions));
    do {
        for (Runner* runner : order) runner->take_turn(stretch, stretches);
        std::ranges::reverse(order);
    } while (runners.front().elapsed() < seconds);
    for (Runner& runner : runners) {
        if (runner.state_hash() != runners.front().state_hash())
            throw std::runtime_error("the state depends on the threads");
        runner.print(packing);
    }
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
            "usage: carom_gas COUNT PACKING [SECONDS [THREADS[xWORLDS][/DOMAINS],... [DOMAINS]]]\n"
            "       carom_gas SCENE.json UNTIL [THREADS [DOMAINS]]\n",
            stderr);
        return 2;
    }
    const auto number = [argc, argv](int k, double otherwise) {
        return argc > k ? std::atof(argv[k]) : otherwise;
    };
    const bool is_scene = std::string_view(argv[1]).ends_with(".json");
    std::vector<carom::bench::Team> teams;
    std::istringstream list(argc > 4 ? argv[4] : "0");
    for (std::string part; std::getline(list, part, ',');)
        teams.push_back(carom::bench::read_team(part, static_cast<int>(number(5, 0))));
    try {
        if (is_scene)
            carom::bench::measure_scene(argv[1], number(2, 0), static_cast<int>(number(3, 0)),
                                        static_cast<int>(number(4, 0)));
        else
            carom::bench::measure(number(1, 0), number(2, 0), number(3, 3), teams);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "carom_gas: %s\n", error.what());
        return 1;
    }
    return 0;
}
