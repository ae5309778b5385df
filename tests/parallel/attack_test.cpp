// Adversarial scenes: serial against domains.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <tuple>
#include <unistd.h>
#include <sys/wait.h>

#include <carom/parallel/world.hpp>

#include "scenes.hpp"
using namespace carom;
using namespace carom::test;
struct Outcome {
    std::uint64_t hash = 0, balls = 0, walls = 0;
    double virial = 0;
    std::vector<std::tuple<double, std::uint32_t, std::uint32_t, double>> collisions;
    Counts counts;
    std::string error;
};
static Outcome run(const Scene& scene, const WorldOptions& options, double until, double step) {
    Outcome out;
    try {
        World world(scene, options);
        world.on_collision([&out](const Collision& c) { out.collisions.emplace_back(c.time, c.i, c.j, c.impulse); });
        for (int k = 1; step > 0 && k * step < until; ++k) world.advance_to(k * step);
        world.advance_to(until);
        out.hash = world.state_hash();
        out.counts = world.counts();
        out.balls = out.counts.ball_collisions;
        out.walls = out.counts.wall_collisions;
        out.virial = world.virial();
        auto v = world.validate();
        if (!v.empty()) out.error = "validate " + v.front().what;
    } catch (const std::exception& e) { out.error = e.what(); }
    return out;
}
static int bad = 0;
static void attack(const std::string& name, const Scene& s, double until, std::vector<int> domains = {2, 3, 7, 16},
                   std::vector<int> halos = {0, 1, 3}, double step = 0) {
    const char* only = getenv("ONLY");
    if (only && name.find(only) == std::string::npos) return;
    fflush(stdout);
    if (pid_t pid = fork(); pid != 0) {
        int st = 0;
        waitpid(pid, &st, 0);
        if (st != 0) { printf("%-40s PROCESS DIED/HUNG status %x\n", name.c_str(), st); ++bad; }
        return;
    }
    alarm(getenv("AL") ? atoi(getenv("AL")) : 8);
    const Outcome a = run(s, {.threads = 1, .domains = 1}, until, step);
    printf("%-40s serial %zu collisions %s\n", name.c_str(), a.collisions.size(), a.error.c_str());
    fflush(stdout);
    for (int d : domains)
        for (int h : halos) {
            const auto t0 = std::chrono::steady_clock::now();
            const Outcome b = run(s, {.threads = 1, .domains = d, .halo = h}, until, step);
            if (getenv("V")) printf("   tried d=%d h=%d %.2f s windows %lu retries %lu\n", d, h, std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(), b.counts.windows, b.counts.window_retries), fflush(stdout);
            const bool state = a.hash == b.hash && a.balls == b.balls && a.walls == b.walls && a.virial == b.virial && a.error == b.error;
            if (getenv("SHOW") && a.collisions != b.collisions) {
                std::size_t k = 0;
                while (k < a.collisions.size() && k < b.collisions.size() && a.collisions[k] == b.collisions[k]) ++k;
                for (std::size_t m = k < 40 ? 0 : k - 40; m < k + 6 && m < std::min(a.collisions.size(), b.collisions.size()); ++m) {
                    auto [t, i, j, q] = a.collisions[m]; auto [u, l, n, w] = b.collisions[m];
                    printf("      %zu: %a %u %u %a | %a %u %u %a\n", m, t, i, j, q, u, l, n, w);
                }
            }
            if (!state || a.collisions != b.collisions)
                printf("   d=%d h=%d %s %s | windows %lu retries %lu n %zu | %s\n", d, h, state ? "state ok" : a.hash != b.hash ? "HASH DIFFERS" : a.balls != b.balls || a.walls != b.walls ? "COUNTS DIFFER" : a.virial != b.virial ? "VIRIAL DIFFERS" : "ERROR DIFFERS",
                       a.collisions == b.collisions ? "" : "list differs", b.counts.windows, b.counts.window_retries, b.collisions.size(), b.error.c_str());
        }
    fflush(stdout);
    _exit(0);
}
static Ball ball(double x, double y, double vx, double vy, double r = 0.5) {
    Ball b; b.position = {x, y}; b.velocity = {vx, vy}; b.radius = r; return b;
}
const auto kWall = Boundary::kWall;
const auto kOpen = Boundary::kOpen;
const auto kPer = Boundary::kPeriodic;
static Scene box(double w, double h, Boundary bx, Boundary by) {
    Scene s; s.name = "x"; s.domain = Domain{{{0, 0}, {w, h}}, {bx, by}, 1}; s.until = 100; return s;
}
int main() {
    // A: two fast balls from far away meet in the middle, walled
    for (auto [bx, by, n] : {std::tuple(kWall, kWall, "walled"), std::tuple(kOpen, kOpen, "open"), std::tuple(kPer, kPer, "periodic"), std::tuple(kPer, kWall, "per-wall")}) {
        Scene s = box(200, 20, bx, by);
        for (int i = 0; i < 40; ++i) for (int k = 0; k < 2; ++k) s.balls.push_back(ball(2 + 5 * i, 2 + 16 * k, 0, 0.001 * (i % 3)));
        for (int i = 0; i < 12; ++i) s.balls.push_back(ball(5 + 2 * i, 8 + 0.1 * i, 8 + i % 3, 0.01 * i));
        for (int i = 0; i < 12; ++i) s.balls.push_back(ball(195 - 2 * i, 8.3 + 0.1 * i, -8 - i % 4, 0.01 * i));
        attack(std::string("A head-on ") + n, s, 30);
        attack(std::string("A head-on frames ") + n, s, 30, {2, 7}, {0, 1, 3}, 1.0 / 7);
        Scene g = gas(100, {.count = 400, .packing = 0.02, .boundary_x = bx, .boundary_y = by});
        for (std::size_t i = 0; i < g.balls.size(); i += 7) g.balls[i].velocity *= 40;
        attack(std::string("A dilute fast ") + n, g, 5);
        Scene f = gas(101, {.count = 400, .packing = 0.3, .boundary_x = bx, .boundary_y = by});
        for (std::size_t i = 0; i < f.balls.size(); i += 7) f.balls[i].velocity *= 100;
        attack(std::string("A fast ") + n, f, 1);
    }
    // C: a cloud that leaves an open box as a whole
    for (double dir : {0., 1., 2., 3.}) {
        Scene c = gas(102, {.count = 400, .packing = 0.5, .boundary_x = kOpen, .boundary_y = kOpen});
        const double side = c.domain->box.max.x();
        // held together by walls that run along
        for (auto& b : c.balls) b.velocity = b.velocity * 0.3 + Vec2(dir < 2 ? (dir == 0 ? 12 : -12) : 0.0, dir >= 2 ? (dir == 2 ? 12 : -12) : 0.0);
        (void)side;
        attack("C drifting cloud " + std::to_string(int(dir)), c, 12, {2, 3, 5, 7, 16}, {0, 1, 3, 5});
    }
    for (double x0 : {-300., -60., 90., 400.}) {  // outside the box from the start, in a cage of walls
        Scene c = gas(103, {.count = 120, .packing = 0.4});
        const double side = c.domain->box.max.x();
        for (auto& b : c.balls) b.position.x() += x0;
        c.domain->boundary = {kOpen, kOpen};
        c.domain->box.max = {20, 20};
        for (auto& b : c.balls) b.velocity *= (&b - c.balls.data()) % 5 ? 1 : 30;
        c.walls = {{{x0 - .6, -.6}, {x0 - .6, side + .6}, 1}, {{x0 + side + .6, -.6}, {x0 + side + .6, side + .6}, 1},
                   {{x0 - .6, -.6}, {x0 + side + .6, -.6}, 1}, {{x0 - .6, side + .6}, {x0 + side + .6, side + .6}, 1}};
        attack("C cage outside " + std::to_string(x0), c, 1, {2, 3, 5, 7, 16}, {0, 1, 3, 5});
        attack("C cage outside frames " + std::to_string(x0), c, 1, {2, 7}, {0, 1}, 1.0 / 60);
    }
    // D: one cell thick
    for (auto [bx, n] : {std::tuple(kOpen, "open"), std::tuple(kPer, "per")}) {
        Scene t = box(300, 1.02, bx, kOpen);
        std::mt19937_64 r(5);
        for (int i = 0; i < 150; ++i) {
            const double vx = uniform(r, -1, 1), vy = uniform(r, -1, 1);
            t.balls.push_back(ball(1 + 2 * i, 0.51, vx * (i % 4 ? 1 : 30), vy * .3));
        }
        t.walls = {{{-50, -4}, {350, -4}, 1}, {{-50, 5}, {350, 5}, 1}};
        attack(std::string("D one cell thick ") + n, t, 10);
    }
    // E/F: rows of touching balls, ids both ways
    for (int way : {0, 1, 2})
        for (int n : {4, 30, 200}) {
            Scene row = box(2 * n + 40, 20, kWall, kWall);
            std::vector<int> ids(n);
            for (int i = 0; i < n; ++i) ids[i] = way == 0 ? i : way == 1 ? n - 1 - i : (i * 77) % n;
            for (int i : ids) row.balls.push_back(ball(20 + i, 10, 0, 0));
            row.balls.push_back(ball(5, 10, 1, 0));
            for (int i = 0; i < 20; ++i) row.balls.push_back(ball(3 + i * (2. * n + 30) / 20, 3 + i % 3, 0.1 + 0.01 * i, 0.2));
            attack("EF row way " + std::to_string(way) + " n " + std::to_string(n), row, 40, {2, 3, 7}, {0, 1, 3});
        }
    // ties: lattice gases
    for (auto [bx, by, n] : {std::tuple(kWall, kWall, "walled"), std::tuple(kPer, kPer, "periodic")})
        for (int seed : {1, 2, 3}) {
            Scene l = box(48, 48, bx, by);
            std::mt19937_64 r(seed);
            for (int y = 0; y < 24; ++y) for (int x = 0; x < 24; ++x) {
                if (r() % 4 == 0) continue;
                const int vx = int(r() % 3) - 1, vy = int(r() % 3) - 1;
                l.balls.push_back(ball(1 + 2 * x, 1 + 2 * y, seed == 3 && vx ? 0 : vx, vy));
            }
            attack(std::string("lattice ") + n + std::to_string(seed), l, 6, {2, 3, 7, 16}, {0, 1, 3}, seed == 2 ? 0.5 : 0);
            Scene t = box(26, 26, bx, by);
            for (int y = 0; y < 24; ++y) for (int x = 0; x < 24; ++x) {
                const int vx = int(r() % 3) - 1, vy = int(r() % 3) - 1;
                const bool moves = r() % 8 == 0;
                t.balls.push_back(ball(1 + x, 1 + y, moves ? vx : 0, moves ? vy : 0));
            }
            attack(std::string("touching lattice ") + n + std::to_string(seed), t, 1, {2, 3}, {0, 3});
        }
    for (auto& [name, s] : feature_scenes()) { attack("feature " + name, s, 4); attack("feature frames " + name, s, 2, {2, 7}, {0, 1, 3}, 0.0937); }
    {
        Scene w = box(10, 10, kWall, kWall);
        w.gravity = {0, -1};
        w.balls = {ball(5, 0.5, 1, 0), ball(2, 7, 1, 0)};
        w.walls = {{{0, 1}, {10, 1}, 1}};
        attack("W wedged", w, 1, {2}, {0});
    }
    for (int seed = 0; seed < 12; ++seed) {  // attractors, losses, mixed sizes, gravity; irregular frames
        std::mt19937_64 r(900 + seed);
        const auto b = [&] { return std::array{kWall, kOpen, kPer}[r() % 3]; };
        const Boundary bx = b(), by = b();
        Scene s = gas(500 + seed, {.count = 300, .packing = uniform(r, 0.05, 0.6), .boundary_x = bx, .boundary_y = by, .restitution = seed % 2 ? 0.8 : 1, .radius_spread = seed % 3 ? 0.4 : 0, .speed = 3});
        const double side = s.domain->box.max.x();
        if (seed % 4 != 3) { s.attractors = {{{side * .3, side * .4}, 40, 2}, {{side * .8, side * .7}, -15, 1}}; s.field_interval = uniform(r, 0.01, 0.2); }
        if (seed % 2) s.gravity = {0.2, -2};
        for (std::size_t i = 0; i < s.balls.size(); i += 1 + r() % 30) s.balls[i].velocity *= 20;
        s.until = 10;
        attack("Z mix " + std::to_string(seed), s, 3);
        attack("Z mix frames " + std::to_string(seed), s, 2, {2, 3, 7}, {0, 1, 3}, uniform(r, 0.005, 0.3));
    }
    printf("%d processes bad\n", bad);
}
