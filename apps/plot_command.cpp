// carom plot: curves of a scene, or of tables that were measured before.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <carom/io/atomic_file.hpp>
#include <carom/io/scene_file.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "plot/draw_plot.hpp"
#include "plot/plot_csv.hpp"
#include "plot/plot_scene.hpp"

namespace carom::app {
namespace {

constexpr const char* kPlotFooter =
    R"(A scene (.json) is run to its end and measured: energy, rate of collisions and, in periodic boxes, pressure over time;
the radial distribution g(r) and the distribution of the speeds, beside Maxwell's, over the second half.

Tables (.csv: a header of names, then numbers; the first column is the x axis) give a panel for each further column. Several
tables share the panels of columns of the same name.

Examples:
  carom plot gas.json --out gas.svg
  carom plot observables.csv --out curves.png
  carom plot one.csv two.csv --columns pressure,temperature --out both.svg)";

struct PlotOptions {
    std::vector<std::string> inputs;
    std::string out;
    std::string size;
    std::vector<std::string> columns;
    std::optional<double> until;
    int threads = 0;
    bool quiet = false;
};

std::optional<Plot> plot_scene(const PlotOptions& options) {
    if (!options.columns.empty()) throw CLI::ValidationError("--columns", "belongs to tables (.csv)");
    const Scene scene = read_scene(options.inputs[0]);
    const double until = options.until.value_or(scene.until);
    watch_for_interrupts();
    World world(scene, {.threads = options.threads});
    Progress progress(!options.quiet, 0, until);
    Driver driver(world, progress, until);
    std::optional<Plot> plot = plot_of(world, scene, until, driver);
    progress.finish();
    if (!plot && !options.quiet)
        fmt::print(stderr, "carom: interrupted at t = {:.6g}; nothing is written\n", world.time());
    return plot;
}

Plot plot_tables(const PlotOptions& options) {
    if (options.until) throw CLI::ValidationError("--until", "belongs to scenes (.json)");
    const std::string title = options.inputs.size() == 1 ? options.inputs[0] : "";
    return {title, panels_of(options.inputs, options.columns)};
}

int draw(const PlotOptions& options) {
    for (const std::string& input : options.inputs)
        require_distinct({"an input", input}, {{"--out", options.out}});
    const bool all_tables = std::ranges::all_of(
        options.inputs, [](const std::string& path) { return extension_of(path) == ".csv"; });
    if (!all_tables && options.inputs.size() > 1)
        throw CLI::ValidationError("INPUT", "one scene, or one or more tables (.csv)");
    AtomicFile file(options.out);
    const std::optional<Plot> plot = all_tables ? plot_tables(options) : plot_scene(options);
    if (!plot) return kInterrupted;
    std::optional<PictureSize> size;
    if (!options.size.empty()) size = parse_picture_size(options.size);
    file.write(render_plot(*plot, picture_format(options.out), size));
    file.commit();
    return kGood;
}

}  // namespace

void add_plot_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("plot", "Draw curves of a scene or of tables");
    command->footer(kPlotFooter);
    const auto options = std::make_shared<PlotOptions>();
    command->add_option("INPUT", options->inputs, "A scene (.json), or tables (.csv)")
        ->type_name("")
        ->required()
        ->expected(1, 64);
    command->add_option("--out", options->out, "The picture, PNG or SVG by its extension")
        ->type_name("FILE.png|.svg")
        ->required()
        ->check(picture_path());
    command->add_option("--columns", options->columns, "Of tables: show these, not all")
        ->type_name("NAME,...")
        ->expected(1, 64)
        ->delimiter(',');
    command->add_option("--until", options->until, "Of a scene: simulate to this time instead of the scene's")
        ->type_name("T")
        ->check(positive_number());
    command->add_option("--size", options->size, "Size in pixels")
        ->type_name("WxH")
        ->check(picture_size_text());
    add_threads_option(*command, options->threads);
    command->add_flag("--quiet", options->quiet, "No progress on standard error");
    command->callback([options, &status] { status = draw(*options); });
}

}  // namespace carom::app
