// carom run: options, and the order of a run's parts.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

#include <carom/io/scene_file.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "run.hpp"

namespace carom::app {
namespace {

constexpr const char* kFooter =
    R"(Every collision is found at its true time and resolved in time order. The result does not depend on --threads, --step
or --cell-size, to the last bit: 'state_hash' in the summary says so.

--method empirical is the other way: move all balls by a step, look who overlaps, trace each pair back to the contact, go on. Its
result depends on --step, --max-travel and --tolerance, and not on --threads or --cell-size. What it misses is counted:
'missed_collisions'.

Files ending in .xyz are extended XYZ, one frame after the other, with enough digits to read back the same bits.
--events writes CSV, one collision a line: time,kind,i,j,x,y,nx,ny,impulse. The summary is one JSON object. All outputs
but the trajectory appear whole, at the end; the trajectory grows as the run goes.

Ctrl-C ends a run early and writes what was asked for, up to the time reached; a second one ends it at once.

Examples:
  carom run gas.json                                 Summary to standard output
  carom run gas.json --until 100 --summary gas.out   Go on longer; summary to a file
  carom run gas.json --method empirical --step 0.001
  carom run gas.json --trajectory gas.xyz --every 0.5
  carom run gas.json --events hits.csv --picture end.png --final end.xyz
  carom run gas.json --quiet | jq .collisions_per_second)";

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

int run(const RunOptions& options) {
    require_distinct(options.scene, {{"--trajectory", options.trajectory},
                                     {"--events", options.events},
                                     {"--final", options.final_state},
                                     {"--picture", options.picture},
                                     {"--summary", options.summary}});
    Scene scene = read_scene(options.scene);
    scene.precision = options.precision.value_or(scene.precision);
    take_method(scene, options);
    const double until = options.until.value_or(scene.until);
    RunOutputs outputs(options);
    watch_for_interrupts();
    World world(scene, {.threads = options.threads,
                        .cell_size = options.cell_size,
                        .domains = options.domains,
                        .halo = options.halo,
                        .count_missed = options.count_missed});
    const bool finished = run_world(world, scene, until, options, outputs);
    if (finished) return kGood;
    if (!options.quiet) {
        fmt::print(stderr, "carom: interrupted at t = {:.6g} of {:.6g}; the outputs end there\n",
                   world.time(), until);
    }
    return kInterrupted;
}

void add_output_options(CLI::App& command, RunOptions& options) {
    const char* const group = "Outputs";
    CLI::Option* const trajectory = command.add_option("--trajectory", options.trajectory,
                                                       "All balls at times 0, DT, 2 DT, ... and at the end");
    trajectory->option_text("FILE.xyz")->check(xyz_path())->group(group);
    CLI::Option* const every =
        command.add_option("--every", options.every, "Simulated time between the trajectory's frames");
    every->option_text("DT")->check(positive_number())->group(group);
    trajectory->needs(every);
    every->needs(trajectory);
    add_precision_option(command, "--output-precision", options.output_precision,
                         "Of positions and velocities in .xyz files (default: as simulated)")
        ->group(group);
    command.add_option("--events", options.events, "Every collision, in time order")
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
        .add_flag("!--no-missed", options.count_missed,
                  "Empirical: do not count the collisions that the steps miss, which is faster")
        ->group(group);
}

}  // namespace

void add_run_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("run", "Simulate a scene");
    command->footer(kFooter);
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
    add_output_options(*command, *options);
    command->callback([options, &status] { status = run(*options); });
}

}  // namespace carom::app
