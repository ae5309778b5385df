// carom view: its options, which are there in every build. view/view_loop.cpp has the window, where it is
// built in.
#include <memory>
#include <string>

#include "commands.hpp"
#include "options.hpp"
#include "view/view_loop.hpp"

namespace carom::app {
namespace {

constexpr const char* kViewFooter =
    R"(Keys: space pauses, '.' goes on by one event, '+' and '-' change the speed, 'c' the colours, 'f' shows all,
'h' hides the panel, 'r' begins anew, 'q' ends. Drag to move, wheel to zoom, click a ball to see its last event (anchor),
its next one and its history.

--screensaver fills the screen without a panel, ends on any key, and begins anew with other random balls when the scene's
end is reached.

Examples:
  carom view box.json
  carom view gas.json --speed 0.001 --paused
  carom view gas.json --colour-by domain --threads 8
  carom view scenes/screensaver.json --screensaver)";

}  // namespace

void add_view_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("view", "Watch a scene in a window");
    command->footer(kViewFooter);
    const auto options = std::make_shared<ViewOptions>();
    command->add_option("SCENE", options->scene, "The scene file, JSON")->type_name("")->required();
    command->add_option("--speed", options->speed, "Simulated time in a second (default: 1)")
        ->type_name("S")
        ->check(positive_number());
    command->add_option("--from", options->from, "Simulate to this time first")
        ->type_name("T")
        ->check(number_from_zero());
    command->add_flag("--paused", options->is_paused, "Begin paused");
    command->add_option("--pick", options->pick, "Look at this ball from the start")
        ->type_name("ID")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--size", options->size, "Of the window (default: 1280x800)")
        ->type_name("WxH")
        ->check(picture_size_text());
    add_colour_by_option(*command, options->colour_by);
    CLI::Option* const saver =
        command->add_flag("--screensaver", options->is_screensaver, "Fill the screen, end on any key");
    CLI::Option* const frames =
        command
            ->add_option("--frames", options->frames,
                         "End after N frames, each a sixtieth of a second at --speed, however long it takes")
            ->type_name("N")
            ->check(CLI::Range(1, 1 << 24));
    command->add_option("--screenshot", options->screenshot, "Write the last frame here")
        ->type_name("FILE.png")
        ->needs(frames);
    saver->excludes(command->get_option("--paused"));
    add_threads_option(*command, options->threads);
    command->callback([options, &status] { status = view(*options); });
}

}  // namespace carom::app
