// carom advise: which setting is the fastest that keeps an error, on the scene at hand.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include <carom/broadphase/placement.hpp>
#include <carom/io/scene_file.hpp>
#include <carom/trade/advice.hpp>

#include "advice_text.hpp"
#include "commands.hpp"
#include "driver.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "progress.hpp"

namespace carom::app {
namespace {

constexpr const char* kAdviseFooter =
    R"(The error is the largest of four, on the stretch from the start, or --from, in which a ball has two collisions on the mean: the
energy's difference from the reference over the most kinetic energy; missed and invented collisions over those compared; the
deepest overlap at the ends of steps over the radii's sum; the balls' mean distance from their places in the reference, in
radii. The reference is the event method in double; where attractors pull, with their field renewed as often as it takes.
Later than that chaos parts any two runs. The scene may change, too: balls that only fall are easier than the pile they make,
for which --from is made.

Tried are the event method in double and float, the empirical one from long steps to short ones, and intervals of the
attractors' field. 'time' is over that of the event method as the scene has it. The scene's own method, step and tolerance
are not looked at; contact_time is part of what the scene asks for.

Exit status 1 where no setting keeps the error.

Examples:
  carom advise box.json                        The fastest setting for an error of 1e-3
  carom advise rain.json --from 5 --error 1e-2 --seconds 10
  carom advise box.json --json | jq -r .command)";

struct AdviseOptions {
    AdviceRequest request;
    bool as_json = false;
    bool quiet = false;
};

/// A line on a terminal that says what is being tried; nothing elsewhere.
class TrialLine {
 public:
    explicit TrialLine(bool enabled) : enabled_(enabled && can_draw_bar()) {}
    ~TrialLine() { clear(); }
    TrialLine(const TrialLine&) = delete;
    TrialLine& operator=(const TrialLine&) = delete;

    void show(const std::string& name) const {
        if (!enabled_) return;
        fmt::print(stderr, "\rtrying {}\x1b[K", name);
        std::fflush(stderr);
    }
    void clear() const {
        if (enabled_) fmt::print(stderr, "\r\x1b[K");
    }

 private:
    bool enabled_;
};

void require_motion(const Scene& scene) {
    if (!(scene.until > 0)) throw SceneError("until", "must be > 0 to try settings, is 0");
    if (std::ranges::all_of(scene.balls, &Ball::is_static))
        throw SceneError("balls", "none can move: there are no settings to choose from");
}

std::string why_none(const trade::Advice& advice, double error) {
    if (advice.trials.empty()) return "no time to run the scene once (--seconds)";
    if (advice.reference_error > error)
        return fmt::format(
            "the reference itself could be found to {:.2g} only, so that an error of {:g} cannot be told "
            "(--seconds, --error)",
            advice.reference_error, error);
    double least = HUGE_VAL;
    for (const trade::Trial& t : advice.trials)
        if (t.errors) least = std::min(least, t.error);
    return fmt::format("no setting that was tried keeps an error of {:g}; the least is {:.2g}", error, least);
}

/// The scene as it stands at a time, by its event method.
Scene scene_at(Scene scene, double time, int threads) {
    if (time >= scene.until)
        throw CLI::ValidationError("--from",
                                   fmt::format("is at {} or after the scene's end at {}", time, scene.until));
    scene.method = Method::kEvent;
    World world(scene, {.threads = threads});
    Progress progress(false, 0, time);
    if (!Driver(world, progress, time).advance_to(time)) return scene;  // interrupted
    scene.balls = world.balls();
    scene.until -= time;
    return scene;
}

int advise(AdviseOptions options) {
    AdviceRequest& request = options.request;
    request.scene = read_scene(request.path);
    request.scene.balls = place_balls(request.scene);
    request.scene.fills.clear();
    require_motion(request.scene);
    watch_for_interrupts();
    const TrialLine line(!options.quiet);
    const Scene scene =
        request.from > 0 ? scene_at(request.scene, request.from, request.threads) : request.scene;
    const trade::Advice advice =
        trade::advise(scene, {.error = request.error,
                              .seconds = request.seconds,
                              .threads = request.threads,
                              .on_trial = [&line](const std::string& name) { line.show(name); },
                              .goes_on = [] { return !interrupt_requested(); }});
    line.clear();
    if (interrupt_requested() && advice.trials.empty()) return kInterrupted;
    print_out(options.as_json ? json_of(request, advice) : table_of(request, advice));
    if (interrupt_requested()) return kInterrupted;
    if (advice.choice) return kGood;
    throw std::runtime_error(why_none(advice, request.error));
}

}  // namespace

void add_advise_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("advise", "Find the fastest setting that keeps an error");
    command->footer(kAdviseFooter);
    const auto options = std::make_shared<AdviseOptions>();
    AdviceRequest& request = options->request;
    command->add_option("SCENE", request.path, "The scene file, JSON")->type_name("")->required();
    command->add_option("--error", request.error, "To be kept (default: 0.001)")
        ->type_name("E")
        ->check(positive_number());
    command->add_option("--seconds", request.seconds, "To try settings for, about (default: 30)")
        ->type_name("S")
        ->check(positive_number());
    command->add_option("--from", request.from, "Look at the scene from this time on, instead of its start")
        ->type_name("T")
        ->check(number_from_zero());
    add_threads_option(*command, request.threads);
    command->add_flag("--json", options->as_json, "One JSON object instead of the table");
    command->add_flag("--quiet", options->quiet, "No progress on standard error");
    command->callback([options, &status] { status = advise(*options); });
}

}  // namespace carom::app
