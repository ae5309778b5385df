// carom_peers: one table of Carom and other engines on the same scenes at frames of 1/60 s, on one thread:
// the time for a simulated second, and how wrong the result is.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <carom/broadphase/overlap.hpp>
#include <carom/broadphase/placement.hpp>

#include "../gas_scene.hpp"
#include "peer.hpp"

namespace carom::bench {
namespace {

constexpr double kFrame = 1.0 / 60;
constexpr int kFramesOfSecond = 60;

std::vector<NamedPeer> peers() {
    std::vector<NamedPeer> all = {{"Carom", make_carom}};
#ifdef CAROM_HAS_BOX2D
    all.push_back({"Box2D", make_box2d});
#endif
#ifdef CAROM_HAS_CHIPMUNK
    all.push_back({"Chipmunk", make_chipmunk});
#endif
    return all;
}

double energy_of(const std::vector<Ball>& balls, const Vec2& gravity) {
    double energy = 0;
    for (const Ball& b : balls)
        energy += b.mass * (length_squared(b.velocity) / 2 - dot<double>(gravity, b.position));
    return energy;
}

/// How many of the balls are more than 1 % of their radius inside another, as a share.
double share_overlapping(const std::vector<Ball>& balls) {
    std::set<std::size_t> inside;
    for (const Overlap& o : find_overlaps(balls, {})) {
        if (o.depth > 0.01 * balls[o.i].radius) inside.insert(o.i);
        if (o.depth > 0.01 * balls[o.j].radius) inside.insert(o.j);
    }
    return static_cast<double>(inside.size()) / static_cast<double>(balls.size());
}

/// Seconds that one simulated second takes.
double time_second(Peer& peer) {
    const auto start = std::chrono::steady_clock::now();
    for (int frame = 0; frame < kFramesOfSecond; ++frame) peer.step(kFrame);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The scene with its fill placed.
Scene placed(Scene s, const Fill& fill) {
    s.until = 1;
    s.fills = {fill};
    s.balls = place_balls(s);
    s.fills.clear();
    return s;
}

/// Elastic discs of radius 0.5 and rms speed 10 in a closed box.
Scene gas(std::uint64_t count, double packing) {
    Scene s;
    s.domain = square(static_cast<double>(count), packing, Boundary::kWall);
    Fill fill;
    fill.count = count;
    fill.temperature = 50;
    return placed(s, fill);
}

void compare_gas(std::uint64_t count, double packing, int seconds) {
    const Scene scene = gas(count, packing);
    double carom_time = 0;
    double exact = 0;
    for (const NamedPeer& named : peers()) {
        const std::unique_ptr<Peer> peer = named.make(scene, false);
        std::vector<double> times;
        for (int k = 0; k < seconds; ++k) times.push_back(time_second(*peer));
        std::nth_element(times.begin(), times.begin() + seconds / 2, times.end());
        const double time = times[static_cast<std::size_t>(seconds) / 2];
        const auto collisions = static_cast<double>(peer->collisions());
        if (named.name == "Carom") {
            carom_time = time;
            exact = collisions;
        }
        const std::vector<Ball> end = peer->balls();
        const double energy = energy_of(scene.balls, scene.gravity);
        std::printf("| gas of %llu, packing %.1f | %s | %.3g | %.3g | %+.2g %% | %+.1e | %.2g %% | %.1e |\n",
                    static_cast<unsigned long long>(count), packing, named.name.c_str(), 1000 * time,
                    time / carom_time, 100 * (collisions / exact - 1),
                    energy_of(end, scene.gravity) / energy - 1, 100 * share_overlapping(end),
                    max_overlap(end, scene));
        std::fflush(stdout);
    }
}

constexpr double kGravity = 9.81;
constexpr double kAtRest = kGravity * 0.1;  // kinetic energy a ball: of a fall by a tenth of a diameter

/// Balls of restitution 0.5 that fall into a box. Without a contact time it gets the one of scenes that name
/// none.
Scene pour(std::uint64_t count, std::optional<double> contact_time) {
    Scene s;
    s.gravity = {0, -kGravity};
    s.contact_time = contact_time;
    s.domain = Domain{{{0, 0}, {160, 200}}, {Boundary::kWall, Boundary::kWall}, 0.5};
    Fill fill;
    fill.count = count;
    fill.restitution = 0.5;
    fill.temperature = 0.01;
    fill.seed = 6;
    fill.region = Box{{4, 20}, {156, 140}};
    return placed(s, fill);
}

/// Until the mean kinetic energy is below kAtRest.
void compare_pour(std::uint64_t count, std::optional<double> contact_time, int most_seconds) {
    const Scene scene = pour(count, contact_time);
    double carom_time = 0;
    for (const NamedPeer& named : peers()) {
        const std::unique_ptr<Peer> peer = named.make(scene, true);
        double time = 0;
        int seconds = 0;
        double kinetic = 0;
        do {
            time += time_second(*peer);
            ++seconds;
            kinetic = energy_of(peer->balls(), Vec2::Zero()) / static_cast<double>(count);
        } while (seconds < most_seconds && kinetic > kAtRest);
        if (named.name == "Carom") carom_time = time;
        const std::vector<Ball> end = peer->balls();
        std::printf("| pour of %llu | %s | %.3g s for %d s%s | %.3g | %.2g | %.2g %% | %.1e |\n",
                    static_cast<unsigned long long>(count), named.name.c_str(), time, seconds,
                    kinetic > kAtRest ? ", not at rest" : "", time / carom_time, kinetic,
                    100 * share_overlapping(end), max_overlap(end, scene));
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace carom::bench

int main(int argc, char** argv) {
    using namespace carom::bench;
    const std::string only = argc > 1 ? argv[1] : "";
    std::optional<double> contact_time;
    if (argc == 3) contact_time = std::strtod(argv[2], nullptr);
    if (argc > 3 || (contact_time && (only != "pour" || !(*contact_time > 0))) ||
        (!only.empty() && only != "gas" && only != "pour")) {
        std::fputs("usage: carom_peers [gas|pour [CONTACT_TIME]]\n", stderr);
        return 2;
    }
    if (only != "pour") {
        std::puts(
            "| scene | engine | ms for a simulated second | over Carom's | collisions against the exact "
            "count | change of "
            "energy | balls more than 1 % of a radius in another | deepest overlap |\n"
            "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
        for (const std::uint64_t count : {10000U, 100000U})
            for (const double packing : {0.2, 0.5}) compare_gas(count, packing, count > 10000 ? 1 : 3);
    }
    if (only != "gas") {
        std::puts(
            "| scene | engine | time to rest | over Carom's | kinetic energy a ball at the end | balls more "
            "than 1 % of a radius in "
            "another | deepest overlap |\n| --- | --- | ---: | ---: | ---: | ---: | ---: |");
        compare_pour(10000, contact_time, 60);
    }
    return 0;
}
