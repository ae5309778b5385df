// carom render: a still or a movie of a scene.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <carom/io/atomic_file.hpp>
#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

#include "commands.hpp"
#include "driver.hpp"
#include "interrupt.hpp"
#include "movie.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "picture_file.hpp"
#include "world_picture.hpp"

namespace carom::app {
namespace {

constexpr const char* kRenderFooter =
    R"(Draws the scene's balls, coloured by speed or as --colour-by says, with its walls (white), static balls (hatched grey) and
attractors. The sides of the domain are full lines where they are walls, dashed where periodic, dotted where open.

A still (.png, .svg) shows the scene as it starts, or with --time as it is then. A movie (.mp4, .gif) shows it from --from to
--until; frame k is the exact state at from + k S / F, whatever the speed S and the rate F: a millionth of normal speed is as
exact. Movies need the program ffmpeg. The file appears whole, at the end.

Examples:
  carom render box.json --out start.png
  carom render box.json --out later.svg --time 2.5
  carom render box.json --out poster.png --size 4000x3000
  carom render box.json --out all.mp4
  carom render box.json --out hit.gif --from 1.499 --until 1.501 --speed 0.001 --view 8,4,10,6
  carom render gas.json --out domains.mp4 --colour-by domain --threads 8 --fps 60)";

struct RenderOptions {
    std::string scene;
    std::string out;
    std::string size;
    std::string view;
    std::optional<double> time;
    std::optional<double> from;
    std::optional<double> until;
    std::optional<double> frames_per_second;
    std::optional<double> speed;
    PictureLook look;
    int threads = 0;
    bool quiet = false;
};

void require_fitting(const RenderOptions& options, bool is_movie) {
    const auto refuse = [](const char* name, const char* what) {
        throw CLI::ValidationError(name, fmt::format("belongs to {}", what));
    };
    if (is_movie && options.time) refuse("--time", "stills; of a movie say --from and --until");
    for (const auto& [name, is_given] :
         {std::pair("--from", options.from.has_value()), std::pair("--until", options.until.has_value()),
          std::pair("--fps", options.frames_per_second.has_value()),
          std::pair("--speed", options.speed.has_value())})
        if (!is_movie && is_given) refuse(name, "movies (.mp4, .gif)");
}

MovieTimes times_of(const RenderOptions& options, const Scene& scene) {
    const MovieTimes times{options.from.value_or(0), options.until.value_or(scene.until),
                           options.frames_per_second.value_or(30), options.speed.value_or(1)};
    if (!(times.until > times.from))
        throw CLI::ValidationError(
            "--until", fmt::format("must be after --from, {} is not after {}", times.until, times.from));
    return times;
}

bool draw_still(World& world, const Scene& scene, const RenderOptions& options, const PictureLook& look,
                const std::optional<PictureSize>& size, Driver& driver) {
    AtomicFile file(options.out);
    std::optional<CollisionTally> tally;
    if (look.colour_by == ColourBy::kCollisions) tally.emplace(world);
    if (!driver.advance_to(options.time.value_or(0))) return false;
    file.write(render_picture(picture_of(scene, world, look, tally), picture_format(options.out), size));
    file.commit();
    return true;
}

int render(const RenderOptions& options) {
    const std::optional<MovieFormat> movie = movie_format(options.out);
    require_fitting(options, movie.has_value());
    require_distinct({"the scene", options.scene}, {{"--out", options.out}});
    const Scene scene = read_scene(options.scene);
    PictureLook look = options.look;
    if (!options.view.empty()) look.view = parse_view(options.view);
    std::optional<PictureSize> size;
    if (!options.size.empty()) size = parse_picture_size(options.size);
    const double until = movie ? times_of(options, scene).until : options.time.value_or(0);
    watch_for_interrupts();
    World world(scene, {.threads = options.threads});
    Progress progress(!options.quiet, 0, until);
    Driver driver(world, progress, until);
    const bool finished =
        movie ? write_movie(world, scene, times_of(options, scene), look, size, options.out, *movie, driver)
              : draw_still(world, scene, options, look, size, driver);
    progress.finish();
    if (finished) return kGood;
    // Half a simulation is no picture of the time asked for, and half a movie none of the whole.
    if (!options.quiet)
        fmt::print(stderr, "carom: interrupted at t = {:.6g}; nothing is written\n", world.time());
    return kInterrupted;
}

void add_movie_options(CLI::App& command, RenderOptions& options) {
    const char* const group = "Movies";
    command.add_option("--from", options.from, "Simulated time of the first frame (default: 0)")
        ->type_name("T")
        ->check(number_from_zero())
        ->group(group);
    command.add_option("--until", options.until, "Simulated time of the end (default: the scene's)")
        ->type_name("T")
        ->check(positive_number())
        ->group(group);
    command.add_option("--fps", options.frames_per_second, "Frames in a second (default: 30)")
        ->type_name("F")
        ->check(positive_number())
        ->group(group);
    command.add_option("--speed", options.speed, "Simulated time in a second of the movie (default: 1)")
        ->type_name("S")
        ->check(positive_number())
        ->group(group);
}

}  // namespace

void add_render_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("render", "Draw a still or a movie of a scene");
    command->footer(kRenderFooter);
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("SCENE", options->scene, "The scene file, JSON")->type_name("")->required();
    command->add_option("--out", options->out, "The picture or movie, by its extension")
        ->type_name("FILE.png|.svg|.mp4|.gif")
        ->required()
        ->check(picture_or_movie_path());
    command->add_option("--time", options->time, "Simulate to this time before drawing a still (default: 0)")
        ->type_name("T")
        ->check(number_from_zero());
    command
        ->add_option("--size", options->size, "Size in pixels; without it the frame's longer side has 1,000")
        ->type_name("WxH")
        ->check(picture_size_text());
    command->add_option("--view", options->view, "Show this rectangle instead of the whole domain")
        ->type_name("X0,Y0,X1,Y1")
        ->check(view_text());
    add_colour_options(*command, options->look);
    add_movie_options(*command, *options);
    add_threads_option(*command, options->threads);
    command->add_flag("--quiet", options->quiet, "No progress on standard error");
    command->callback([options, &status] { status = render(*options); });
}

}  // namespace carom::app
