// The loop of a run and its summary.
#include "run.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include <carom/io/summary.hpp>

#include "driver.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "picture_file.hpp"
#include "world_picture.hpp"

namespace carom::app {
namespace {

template <class File>
void open_if_named(std::optional<File>& file, const std::string& path) {
    if (!path.empty()) file.emplace(path);
}

std::uint64_t peak_memory_bytes() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

void listen(World& world, Driver& driver, EventsCsv& events) {
    world.on_collision([&driver, &events](const Collision& collision) {
        if (driver.failure) return;
        try {
            const auto kind =
                collision.kind == CollisionKind::kBall ? EventsCsv::Kind::kBall : EventsCsv::Kind::kWall;
            events.write({collision.time, kind, collision.i, collision.j, collision.point, collision.normal,
                          collision.impulse});
        } catch (...) {
            driver.failure = std::current_exception();
        }
    });
}

Precision output_precision(const Scene& scene, const RunOptions& options) {
    return options.output_precision.value_or(scene.precision);
}

// Moves the world from stop to stop: frames, steps, the end. False when interrupted.
bool move_to_end(World& world, Driver& driver, const Scene& scene, double until, const RunOptions& options,
                 RunOutputs& outputs) {
    Multiples frames(options.every.value_or(1), outputs.trajectory ? until : 0);
    const bool stops = options.step && scene.method == Method::kEvent;
    Multiples steps(options.step.value_or(1), stops ? until : 0);
    double last_frame = -1;
    const auto write_frame = [&] {
        outputs.trajectory->write(world.time(), world.balls(), scene.domain,
                                  output_precision(scene, options));
        last_frame = world.time();
    };
    bool going = true;
    while (going) {
        const std::optional<double> frame = frames.next();
        const std::optional<double> step = steps.next();
        if (!frame && !step) break;
        const double stop = std::min(frame.value_or(until), step.value_or(until));
        going = driver.advance_to(stop);
        if (going && frame && *frame <= stop) {
            write_frame();
            frames.advance();
        }
        if (step && *step <= stop) steps.advance();
    }
    going = going && driver.advance_to(until);
    if (outputs.trajectory && last_frame < world.time()) write_frame();
    return going;
}

// What the world is like at one moment, as far as the summary compares two.
struct Balance {
    double energy;
    Vec2 momentum;

    explicit Balance(const World& world) : energy(world.energy()), momentum(world.momentum()) {}
};

double relative_change(double from, double to) {
    return from == to ? 0 : (to - from) / std::abs(from);
}

Summary summary_of(const World& world, const Scene& scene, const Balance& start, double wall_seconds) {
    const Balance end(world);
    const Counts counts = world.counts();
    Summary summary;
    summary.scene = scene.name;
    summary.method = name_of(scene.method);
    summary.precision = name_of(scene.precision);
    summary.threads = world.threads();
    summary.balls = world.ball_count();
    summary.walls = world.wall_count();
    summary.time = world.time();
    summary.ball_collisions = counts.ball_collisions;
    summary.wall_collisions = counts.wall_collisions;
    summary.events = counts.events;
    summary.wall_seconds = wall_seconds;
    const double collisions = double(counts.ball_collisions + counts.wall_collisions);
    summary.collisions_per_second = wall_seconds > 0 ? collisions / wall_seconds : 0;
    summary.energy_initial = start.energy;
    summary.energy_final = end.energy;
    summary.energy_relative_change = relative_change(start.energy, end.energy);
    summary.momentum_initial = start.momentum;
    summary.momentum_final = end.momentum;
    summary.windows = counts.windows;
    summary.window_retries = counts.window_retries;
    summary.steps = counts.steps;
    summary.missed_collisions = counts.missed_collisions;
    summary.max_overlap = world.max_overlap();
    summary.compressibility_factor = world.compressibility_factor();
    summary.state_hash = world.state_hash();
    return summary;
}

void write_end(const World& world, const Scene& scene, const RunOptions& options, RunOutputs& outputs) {
    if (outputs.events) outputs.events->commit();
    if (outputs.final_state) {
        std::string text;
        append_xyz(text, world.time(), world.balls(), scene.domain, output_precision(scene, options));
        outputs.final_state->write(text);
        outputs.final_state->commit();
    }
    if (outputs.picture) {
        outputs.picture->write(render_picture(picture_of(scene, world), picture_format(options.picture)));
        outputs.picture->commit();
    }
}

}  // namespace

RunOutputs::RunOutputs(const RunOptions& options) {
    // The trajectory last: it empties its file, which is not to happen when another output fails.
    open_if_named(events, options.events);
    open_if_named(final_state, options.final_state);
    open_if_named(picture, options.picture);
    if (options.summary != "-") summary.emplace(options.summary);
    open_if_named(trajectory, options.trajectory);
}

bool run_world(World& world, const Scene& scene, double until, const RunOptions& options,
               RunOutputs& outputs) {
    const Balance start(world);
    Progress progress(!options.quiet, 0, until);
    Driver driver(world, progress, until);
    if (outputs.events) listen(world, driver, *outputs.events);

    const auto started = std::chrono::steady_clock::now();
    const bool finished = move_to_end(world, driver, scene, until, options, outputs);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
    progress.finish();

    write_end(world, scene, options, outputs);
    Summary summary = summary_of(world, scene, start, elapsed.count());
    summary.peak_memory_bytes = peak_memory_bytes();
    if (outputs.summary) {
        outputs.summary->write(to_json(summary));
        outputs.summary->commit();
    } else {
        print_out(to_json(summary));
    }
    return finished;
}

}  // namespace carom::app
