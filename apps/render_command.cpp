// carom render: a still of a scene.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <carom/io/atomic_file.hpp>
#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

#include "commands.hpp"
#include "driver.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "picture_file.hpp"
#include "world_picture.hpp"

namespace carom::app {
namespace {

constexpr const char* kFooter =
    R"(Draws the scene's balls, coloured by speed, with its walls (white), static balls (hatched grey) and attractors. The sides of
the domain are full lines where they are walls, dashed where periodic, dotted where open. Without --time the scene
is drawn as it starts; with it, it is simulated that far first.

Examples:
  carom render box.json --out start.png
  carom render box.json --out later.svg --time 2.5
  carom render box.json --out poster.png --size 4000x3000)";

struct RenderOptions {
    std::string scene;
    std::string out;
    std::string size;
    double time = 0;
    int threads = 0;
    bool quiet = false;
};

int render(const RenderOptions& options) {
    require_distinct({"the scene", options.scene}, {{"--out", options.out}});
    const Scene scene = read_scene(options.scene);
    AtomicFile file(options.out);
    watch_for_interrupts();
    World world(scene, {.threads = options.threads});
    {
        Progress progress(!options.quiet, 0, options.time);
        Driver driver(world, progress, options.time);
        const bool finished = driver.advance_to(options.time);
        progress.finish();
        if (!finished) {
            // Half a simulation is no picture of the time asked for.
            if (!options.quiet) {
                fmt::print(stderr, "carom: interrupted at t = {:.6g}; nothing is written\n", world.time());
            }
            return kInterrupted;
        }
    }
    std::optional<PictureSize> size;
    if (!options.size.empty()) size = parse_picture_size(options.size);
    file.write(render_picture(picture_of(scene, world), picture_format(options.out), size));
    file.commit();
    return kGood;
}

}  // namespace

void add_render_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("render", "Draw a still of a scene");
    command->footer(kFooter);
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("SCENE", options->scene, "The scene file, JSON")->type_name("")->required();
    command->add_option("--out", options->out, "The picture, PNG or SVG by its extension")
        ->type_name("FILE.png|.svg")
        ->required()
        ->check(picture_path());
    command
        ->add_option("--time", options->time,
                     "Simulate to this time before drawing; 0, the start, without it")
        ->type_name("T")
        ->check(number_from_zero());
    command
        ->add_option("--size", options->size, "Size in pixels; without it the frame's longer side has 1,000")
        ->type_name("WxH")
        ->check(picture_size_text());
    add_threads_option(*command, options->threads);
    command->add_flag("--quiet", options->quiet, "No progress on standard error");
    command->callback([options, &status] { status = render(*options); });
}

}  // namespace carom::app
