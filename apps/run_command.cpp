// carom run: options, and the order of a run's parts.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <carom/io/checkpoint.hpp>
#include <carom/io/scene_file.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "memory_need.hpp"
#include "observation_options.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "run.hpp"

namespace carom::app {
namespace {

constexpr const char* kRunFooter =
    R"(Every collision is found at its true time and resolved in time order. The result does not depend on --threads, --step
or --cell-size, to the last bit: 'state_hash' in the summary says so.

--method empirical is the other way: move all balls by a step, look who overlaps, trace each pair back to the contact, go on. Its
result depends on --step, --max-travel and --tolerance, and not on --threads or --cell-size. What it misses is counted:
'missed_collisions'.

Files ending in .xyz are extended XYZ, one frame after the other, with enough digits to read back the same bits. --trajectory
writes H5MD (compressed, needs HDF5) where its name ends in .h5, a LAMMPS dump where it ends in .lammpstrj or .dump.
--events writes CSV, one collision a line: time,kind,i,j,x,y,nx,ny,impulse. --sensings does so for balls that come into the
scene's sensors or leave them: time,sensor,ball,enters,x,y,vx,vy. The summary is one JSON object. All outputs
but these appear whole, at the end: the trajectory and --observables grow as the run goes, and so do --events and --sensings
with --checkpoint. A rate or pressure of --observables is the mean since the row before.

Ctrl-C ends a run early and writes what was asked for, up to the time reached; a second one ends it at once.

--checkpoint keeps the run's state in a file: every --checkpoint-every, at the end, and at Ctrl-C. --resume goes on from there
and ends with the same bits, counts, trajectory, lists and measures as a run that was never stopped, with any other --threads,
--domains, --step or a later --until. --trajectory, --events, --sensings and --observables then name the files that the run
has left; what they hold beyond the checkpoint is cut off and written anew.

Examples:
  carom run gas.json                                 Summary to standard output
  carom run gas.json --until 100 --summary gas.out   Go on longer; summary to a file
  carom run gas.json --method empirical --step 0.001
  carom run gas.json --trajectory gas.xyz --every 0.5
  carom run gas.json --observables gas.csv --structure gas-structure.json --every 0.5 --average-from 20
  carom run gas.json --events hits.csv --picture end.png --final end.xyz
  carom run gas.json --checkpoint gas.ckpt --checkpoint-every 10
  carom run gas.json --resume gas.ckpt --checkpoint gas.ckpt
  carom run gas.json --quiet | jq .collisions_per_second)";

void require_distinct_files(const RunOptions& options) {
    std::vector<NamedPath> files = {{"--trajectory", options.trajectory},
                                    {"--events", options.events},
                                    {"--sensings", options.sensings},
                                    {"--final", options.final_state},
                                    {"--picture", options.picture},
                                    {"--observables", options.observation.observables},
                                    {"--structure", options.observation.structure},
                                    {"--summary", options.summary},
                                    {"--checkpoint", options.checkpoint}};
    require_distinct({"the scene", options.scene}, files);
    files.pop_back();  // a checkpoint may take the place of the one that was gone on from
    if (!options.resume.empty()) require_distinct({"the checkpoint", options.resume}, files);
}

/// The checkpoint to go on from, none without --resume. Throws FileError.
std::optional<Checkpoint> checkpoint_of(const RunOptions& options, double until) {
    if (options.resume.empty()) return std::nullopt;
    Checkpoint checkpoint = read_checkpoint(options.resume);
    const auto refuse = [&options](const std::string& why) { throw FileError(options.resume, why); };
    if (checkpoint.snapshot.time > until)
        refuse(fmt::format("is at time {}, after the end at {}", checkpoint.snapshot.time, until));
    const double every = options.every.value_or(0);  // is given where there is a trajectory, or measures
    if (const std::optional<RunRecord>& run = checkpoint.run;
        run && run->trajectory_bytes > 0 && !options.trajectory.empty() && every != run->frame_interval)
        refuse(fmt::format("covers a trajectory with --every {}, not {}", run->frame_interval, every));
    if (const std::optional<MeasuresRecord>& measures = checkpoint.measures;
        measures && options.observation.is_wanted() && every != measures->interval)
        refuse(fmt::format("covers measures with --every {}, not {}", measures->interval, every));
    return checkpoint;
}

World make_world(const Scene& scene, const RunOptions& options, const std::optional<Checkpoint>& from) {
    const WorldOptions wanted{.threads = options.threads,
                              .cell_size = options.cell_size,
                              .domains = options.domains,
                              .halo = options.halo,
                              .count_missed = options.count_missed};
    if (!from) return World(scene, wanted);
    try {
        return {scene, wanted, from->snapshot};
    } catch (const SnapshotError& error) {
        throw FileError(options.resume, error.what());
    }
}

// What the command line says of the method goes before the scene.
void take_method(Scene& scene, const RunOptions& options) {
    scene.method = options.method.value_or(scene.method);
    if (scene.method == Method::kEvent) {
        for (const auto& [name, is_given] : {std::pair("--tolerance", options.tolerance.has_value()),
                                             std::pair("--max-travel", options.max_travel.has_value()),
                                             std::pair("--no-missed", !options.count_missed)})
            if (is_given)
                throw CLI::ValidationError(name, "belongs to --method empirical, the method is event");
        return;
    }
    if (options.step) scene.step = options.step;
    if (options.tolerance) scene.tolerance = options.tolerance;
    if (options.max_travel) scene.max_travel = options.max_travel;
}

void require_sensors(const Scene& scene, const RunOptions& options) {
    if (options.sensings.empty()) return;
    if (scene.sensors.empty())
        throw CLI::ValidationError("--sensings", "belongs to scenes with sensors, this has none");
}

// So do the settings that both methods have.
void take_settings(Scene& scene, const RunOptions& options) {
    scene.precision = options.precision.value_or(scene.precision);
    if (options.contact_time) scene.contact_time = options.contact_time;
    if (!options.field_interval) return;
    if (scene.attractors.empty())
        throw CLI::ValidationError("--field-interval", "belongs to scenes with attractors, this has none");
    scene.field_interval = *options.field_interval;
}

// What was measured up to the checkpoint can only be gone on with as it was begun.
void require_same_measures(const RunOptions& options, const World& world, const Checkpoint& before) {
    if (!before.observer || !options.observation.is_wanted()) return;
    try {
        require_same_measures(options.observation, world, *before.observer);
    } catch (const std::invalid_argument&) {
        throw FileError(options.resume,
                        "covers measures with other --observables, --structure or --average-from");
    }
}

int run(const RunOptions& options) {
    require_fitting(options);
    require_distinct_files(options);
    Scene scene = read_scene(options.scene);
    take_settings(scene, options);
    take_method(scene, options);
    require_sensors(scene, options);
    if (options.check_memory) require_memory(scene);
    const double until = options.until.value_or(scene.until);
    std::optional<Checkpoint> checkpoint = checkpoint_of(options, until);
    std::optional<RunOutputs> outputs;
    if (!checkpoint) outputs.emplace(options, Checkpoint{});
    watch_for_interrupts();
    World world = make_world(scene, options, checkpoint);
    Checkpoint before;
    if (checkpoint) {  // the files that it left are not touched before the scene proves to be its own
        before = std::move(*checkpoint);
        before.snapshot = {};
        checkpoint.reset();
        require_same_measures(options, world, before);
        outputs.emplace(options, before);
    }
    const bool finished = run_world(world, scene, until, options, before, *outputs);
    if (finished) return kGood;
    if (!options.quiet) {
        fmt::print(stderr, "carom: interrupted at t = {:.6g} of {:.6g}; the outputs end there\n",
                   world.time(), until);
    }
    return kInterrupted;
}

void add_output_options(CLI::App& command, RunOptions& options) {
    const char* const group = "Outputs";
    command
        .add_option("--trajectory", options.trajectory, "All balls at times 0, DT, 2 DT, ... and at the end")
        ->option_text("FILE.xyz|.h5|.lammpstrj")
        ->check(trajectory_path())
        ->group(group);
    command
        .add_option("--every", options.every,
                    "Simulated time between the trajectory's frames, and between samples")
        ->option_text("DT")
        ->check(positive_number())
        ->group(group);
    add_precision_option(command, "--output-precision", options.output_precision,
                         "Of positions and velocities in .xyz files (default: as simulated)")
        ->group(group);
    command.add_option("--events", options.events, "Every collision, in time order")
        ->type_name("FILE.csv")
        ->group(group);
    command.add_option("--sensings", options.sensings, "Who comes into the scene's sensors and leaves them")
        ->type_name("FILE.csv")
        ->group(group);
    command.add_option("--final", options.final_state, "All balls at the end")
        ->type_name("FILE.xyz")
        ->check(xyz_path())
        ->group(group);
    command.add_option("--picture", options.picture, "A drawing of the end")
        ->type_name("FILE.png|.svg")
        ->check(picture_path())
        ->group(group);
    command
        .add_option("--summary", options.summary,
                    "What the run came to; '-', the default, is standard output")
        ->type_name("FILE|-")
        ->group(group);
    command.add_flag("--quiet", options.quiet, "No progress on standard error")->group(group);
}

void add_checkpoint_options(CLI::App& command, RunOptions& options) {
    const char* const group = "Checkpoints";
    CLI::Option* const checkpoint =
        command.add_option("--checkpoint", options.checkpoint, "Keep the state here, to go on from later");
    checkpoint->option_text("FILE")->group(group);
    command
        .add_option("--checkpoint-every", options.checkpoint_every,
                    "Simulated time between two checkpoints (default: a tenth of the run)")
        ->option_text("DT")
        ->check(positive_number())
        ->needs(checkpoint)
        ->group(group);
    command.add_option("--resume", options.resume, "Go on from a checkpoint of this scene")
        ->type_name("FILE")
        ->group(group);
}

void add_method_options(CLI::App& command, RunOptions& options) {
    const char* const group = "Method";
    add_method_option(
        command, "--method", options.method,
        "Find collisions at their true times, or by the overlaps at the end of each step, instead "
        "of as the scene says")
        ->group(group);
    command
        .add_option("--tolerance", options.tolerance,
                    "Empirical: a contact is found with the surfaces apart by at most this length (default: "
                    "1e-6 of the smallest moving radius)")
        ->type_name("EPS")
        ->check(positive_number())
        ->group(group);
    command
        .add_option(
            "--max-travel", options.max_travel,
            "Empirical: steps so short that no moving ball travels more than X times the smallest radius "
            "(default: 0.2 where no step is given; 0: no limit)")
        ->type_name("X")
        ->check(number_from_zero())
        ->group(group);
    command
        .add_option(
            "--contact-time", options.contact_time,
            "A ball that collides again within this time loses nothing (default: the scene's; 0: off)")
        ->type_name("T")
        ->check(number_from_zero())
        ->group(group);
    command
        .add_option("--field-interval", options.field_interval,
                    "Attractors' pulls are held constant for so long: shorter is more accurate and slower "
                    "(default: the scene's)")
        ->type_name("DT")
        ->check(positive_number())
        ->group(group);
    command
        .add_flag("!--no-missed", options.count_missed,
                  "Empirical: do not count the collisions that the steps miss, which is faster")
        ->group(group);
}

}  // namespace

void add_run_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("run", "Simulate a scene");
    command->footer(kRunFooter);
    const auto options = std::make_shared<RunOptions>();
    command->add_option("SCENE", options->scene, "The scene file, JSON")->type_name("")->required();
    command->add_option("--until", options->until, "Simulate to this time instead of the scene's")
        ->type_name("T")
        ->check(number_from_zero());
    add_threads_option(*command, options->threads);
    add_precision_option(
        *command, "--precision", options->precision,
        "Hold balls' states in this type instead of the scene's; float rounds at each event");
    command
        ->add_option("--step", options->step,
                     "Advance in steps of this length. Never changes a bit of the result, but with --method "
                     "empirical, whose steps these are (with --max-travel the longest)")
        ->type_name("DT")
        ->check(positive_number());
    add_method_options(*command, *options);
    command
        ->add_option("--domains", options->domains,
                     "parts that the plane is cut in, to be simulated side by side; speed only (default: "
                     "chosen from the scene and the threads)")
        ->check(CLI::Range(1, 1 << 20));
    command
        ->add_option("--halo", options->halo,
                     "cells around a part that are simulated with it; speed only (default: chosen)")
        ->check(CLI::Range(1, 1 << 20));
    command
        ->add_option("--cell-size", options->cell_size,
                     "Side of the grid's cells. Never changes a bit of the result")
        ->type_name("H")
        ->check(positive_number());
    command->add_flag("!--no-memory-check", options->check_memory,
                      "Do not refuse a scene that needs more memory than there is");
    add_output_options(*command, *options);
    add_observation_options(*command, options->observation);
    add_checkpoint_options(*command, *options);
    command->callback([options, &status] { status = run(*options); });
}

}  // namespace carom::app
