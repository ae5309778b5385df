// The loop of a run and its summary.
#include "run.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include <carom/io/summary.hpp>
#include <carom/io/xyz.hpp>

#include "checkpointer.hpp"
#include "driver.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "picture_file.hpp"
#include "world_picture.hpp"

namespace carom::app {
namespace {

template <class File, class... Kept>
void open_if_named(std::optional<File>& file, const std::string& path, Kept... kept) {
    if (!path.empty()) file.emplace(path, kept...);
}

/// Throws FileError where a file could not be made or changed; leaves what is there alone.
void require_writable(const std::string& path) {
    std::error_code ignored;
    if (path.empty()) return;
    if (!std::filesystem::exists(path, ignored))
        const AtomicFile can_be_made(path);
    else if (::access(path.c_str(), W_OK) != 0)
        throw FileError(path, "cannot be written: " + std::generic_category().message(errno));
}

std::uint64_t peak_memory_bytes() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

void write_event(EventsCsv& events, const Collision& collision) {
    const auto kind =
        collision.kind == CollisionKind::kBall ? EventsCsv::Kind::kBall : EventsCsv::Kind::kWall;
    events.write({collision.time, kind, collision.i, collision.j, collision.point, collision.normal,
                  collision.impulse});
}

/// A listener whose failure ends the run, after the engine has returned.
template <class Write>
auto guarded(Driver& driver, Write write) {
    return [&driver, write](const auto& what) {
        if (driver.failure) return;
        try {
            write(what);
        } catch (...) {
            driver.failure = std::current_exception();
        }
    };
}

void listen(World& world, Driver& driver, RunOutputs& outputs, bool observes) {
    if (outputs.sensings)
        world.on_sensing(
            guarded(driver, [&outputs](const Sensing& sensing) { outputs.sensings->write(sensing); }));
    if (!outputs.events && !observes) return;
    world.on_collision(guarded(driver, [&outputs, observes](const Collision& collision) {
        if (outputs.events) write_event(*outputs.events, collision);
        if (observes) outputs.observation->record(collision);
    }));
}

Precision output_precision(const Scene& scene, const RunOptions& options) {
    return options.output_precision.value_or(scene.precision);
}

// Moves the world from stop to stop: frames, steps, checkpoints, the end. False when interrupted.
bool move_to_end(World& world, Driver& driver, const Scene& scene, double until, const RunOptions& options,
                 Checkpointer& checkpointer, RunOutputs& outputs) {
    RunRecord& record = checkpointer.record;
    Multiples frames(record.frame_interval, outputs.trajectory ? until : 0, double(record.next_frame));
    MeasuresRecord& measures = checkpointer.measures;
    Multiples samples(measures.interval, outputs.observation ? until : 0, double(measures.next_sample));
    const auto sample = [&] {
        outputs.observation->sample(world);
        measures.last_sample = world.time();
    };
    const bool stops = options.step && scene.method == Method::kEvent;
    Multiples steps = Multiples::after(world.time(), options.step.value_or(1), stops ? until : 0);
    Multiples checkpoints =
        Multiples::after(world.time(), checkpointer.interval(until), checkpointer.is_wanted() ? until : 0);
    double last_frame =
        record.trajectory_bytes > 0 ? double(record.next_frame - 1) * record.frame_interval : -1;
    const auto write_frame = [&] {
        outputs.trajectory->write(world.time(), world.balls(), scene.domain,
                                  output_precision(scene, options));
        last_frame = world.time();
    };
    bool going = true;
    while (going) {
        const std::optional<double> frame = frames.next();
        const std::optional<double> step = steps.next();
        const std::optional<double> checkpoint = checkpoints.next();
        const std::optional<double> next_sample = samples.next();
        if (!frame && !step && !checkpoint && !next_sample) break;
        const double stop = std::min({frame.value_or(until), step.value_or(until), checkpoint.value_or(until),
                                      next_sample.value_or(until)});
        going = driver.advance_to(stop);
        if (going && frame && *frame <= stop) {
            write_frame();
            frames.advance();
            ++record.next_frame;
        }
        if (going && next_sample && *next_sample <= stop) {
            sample();
            samples.advance();
            ++measures.next_sample;
        }
        if (step && *step <= stop) steps.advance();
        if (going && checkpoint && *checkpoint <= stop) {
            checkpointer.save(world, outputs);
            checkpoints.advance();
        }
    }
    if (checkpointer.is_wanted()) {
        // What this end has swallowed, being due a rounding before it, is due in a longer run.
        going = going && driver.advance_to(
                             std::min(frames.left_out().value_or(until), samples.left_out().value_or(until)));
        checkpointer.save(world, outputs);
    }
    going = going && driver.advance_to(until);
    // Of this run's end, not of the one that a checkpoint may lead to.
    if (outputs.trajectory && last_frame < world.time()) write_frame();
    if (outputs.observation && measures.last_sample < world.time()) sample();
    return going;
}

double relative_change(double from, double to) {
    return from == to ? 0 : (to - from) / std::abs(from);
}

Summary summary_of(const World& world, const Scene& scene, const RunRecord& record, double wall_seconds) {
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
    summary.energy_initial = record.energy_initial;
    summary.energy_final = world.energy();
    summary.energy_relative_change = relative_change(record.energy_initial, summary.energy_final);
    summary.momentum_initial = record.momentum_initial;
    summary.momentum_final = world.momentum();
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
    if (outputs.sensings) outputs.sensings->commit();
    if (outputs.observation) outputs.observation->commit();
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

RunOutputs::RunOutputs(const RunOptions& options, const Checkpoint& done) {
    if (!options.checkpoint.empty()) const AtomicFile can_be_written(options.checkpoint);
    open_if_named(final_state, options.final_state);
    open_if_named(picture, options.picture);
    if (options.summary != "-") summary.emplace(options.summary);
    // These last: they may empty their files, which is not to happen when another output fails. A list that a
    // checkpoint is to cover has to be there when the run is killed.
    for (const std::string& path :
         {options.events, options.sensings, options.observation.observables, options.trajectory})
        require_writable(path);
    const RunRecord run = done.run.value_or(RunRecord{});
    const auto open_list = [&options](auto& list, const std::string& path, std::uint64_t kept) {
        if (!options.checkpoint.empty() || kept > 0)
            open_if_named(list, path, kept);
        else
            open_if_named(list, path);
    };
    open_list(events, options.events, run.events_bytes);
    open_list(sensings, options.sensings, done.sensings_bytes.value_or(0));
    if (options.observation.is_wanted())
        observation.emplace(options.observation, done.measures ? done.measures->observables_bytes : 0);
    if (options.trajectory.empty()) return;
    const bool goes_on = run.trajectory_bytes > 0;
    trajectory = open_trajectory(options.trajectory,
                                 goes_on ? KeptFrames{run.trajectory_bytes, run.next_frame} : KeptFrames{});
}

bool run_world(World& world, const Scene& scene, double until, const RunOptions& options,
               const Checkpoint& before, RunOutputs& outputs) {
    Checkpointer checkpointer(world, options, before);
    const Counts counts = world.counts();
    Progress progress(!options.quiet, world.time(), until, counts.ball_collisions + counts.wall_collisions);
    Driver driver(world, progress, until);
    listen(world, driver, outputs, outputs.observation && outputs.observation->begin(world, before.observer));

    checkpointer.start_clock();
    const bool finished = move_to_end(world, driver, scene, until, options, checkpointer, outputs);
    const double wall_seconds = checkpointer.wall_seconds();
    progress.finish();

    write_end(world, scene, options, outputs);
    Summary summary = summary_of(world, scene, checkpointer.record, wall_seconds);
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
