// carom stress: random adverse scenes, every promise checked on each. For a machine's CI.
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <carom/broadphase/placement.hpp>
#include <carom/io/atomic_file.hpp>
#include <carom/io/scene_file.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "stress/campaign.hpp"
#include "stress/edits.hpp"

namespace carom::app {
namespace {

constexpr const char* kStressFooter =
    R"(Draws scene after scene from all that a scene can have: gases and piles in periodic, walled and open boxes, walls that meet,
static and large balls, masses from 1e-3 to 1e6, gravity, own accelerations, attractors, losses, touching and overlapping
starts, fast balls, float, other units, categories and masks, sensors; half of them are edited as they run: balls, walls and forces come,
change and go. Each is run by several worlds with other threads, domains, cells and frames, and one
that goes on from a snapshot. After each stretch of time all must show the same bits, and it is checked that no bodies overlap, that
the list of collisions goes forward, obeys the law of impact and leads to the velocities and the energy shown, and, in small
scenes, that each event is the one that a look at all pairs finds.

A scene that fails is made smaller while it still fails, and written to --out with the command that repeats it.
With SCENE files it is those that are examined: any scene can be put to the same test.

The last line of standard output is for scripts:
  stress: 412 scenes, 3.1e+06 collisions, seed 7, 0 failures
Exit status: 0 where nothing failed, 1 where something did.

Examples:
  carom stress                              For a minute
  carom stress --minutes 30 --seed 7
  carom stress --scenes 200 --seed 1        The same work wherever it runs
  carom stress my-scene.json --edits all    With balls, walls and forces that come, change and go)";

struct StressOptions {
    std::vector<std::string> files;
    std::uint64_t seed = 1;
    std::size_t most_balls = 300;
    int threads = 0;
    std::optional<std::uint64_t> scenes;
    std::optional<double> minutes;
    std::optional<double> seconds;
    std::string edits = "none";
    std::string folder = ".";
};

/// `all`, `none`, or numbers. Throws std::invalid_argument.
std::vector<std::uint32_t> parse_edits(const std::string& text) {
    if (text == "all") return stress::all_edits();
    std::vector<std::uint32_t> numbers;
    if (text == "none") return numbers;
    for (const std::string& word : CLI::detail::split(text, ',')) {
        std::uint32_t number = 0;
        if (!CLI::detail::lexical_cast(word, number) || number >= stress::kMostEdits)
            throw std::invalid_argument(
                fmt::format("must be all, none, or some of 0 to {} with commas between them, is '{}'",
                            stress::kMostEdits - 1, text));
        numbers.push_back(number);
    }
    return numbers;
}

/// On a terminal, one line that is written over and over.
class ProgressLine {
 public:
    explicit ProgressLine(double seconds) : seconds_(seconds), shown_(isatty(STDERR_FILENO) != 0) {}
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const stress::Tally& tally) {
        const auto now = std::chrono::steady_clock::now();
        if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
        last_ = now;
        const double passed = std::chrono::duration<double>(now - start_).count();
        const std::string of = seconds_ > 0 ? fmt::format(" of {:.0f}", seconds_) : "";
        fmt::print(stderr, "\r\x1b[K{} scenes, {:.3g} collisions, {} failures, {:.0f}{} s", tally.scenes,
                   double(tally.collisions), tally.failures, passed, of);
        std::fflush(stderr);
    }
    void clear() const {
        if (shown_ && last_ != std::chrono::steady_clock::time_point{}) fmt::print(stderr, "\r\x1b[K");
    }

 private:
    double seconds_;
    bool shown_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_;
};

/// What failed, the file, and how to see it again.
void report_failure(const stress::Trial& trial, const stress::Verdict& verdict, const std::string& path) {
    const std::string edits =
        trial.edits.empty() ? "" : fmt::format(" --edits {}", fmt::join(trial.edits, ","));
    fmt::print(stderr, "carom: {} fails: {}: {}\n  repeat: carom stress '{}' --seed {} --threads {}{}\n",
               trial.scene.name, verdict.check, verdict.detail, path, trial.seed, trial.threads, edits);
}

void write_failure(const stress::Trial& trial, const stress::Verdict& verdict, const std::string& folder) {
    const std::string path =
        (std::filesystem::path(folder) / fmt::format("stress-{}.json", trial.seed)).string();
    write_file(path, write_scene(trial.scene));
    report_failure(trial, verdict, path);
}

stress::Tally examine_files(const StressOptions& options, int threads) {
    stress::Tally tally;
    for (const std::string& path : options.files) {
        if (interrupt_requested()) break;
        stress::Trial trial{read_scene(path), options.seed, threads, parse_edits(options.edits)};
        trial.scene.balls = place_balls(trial.scene);
        trial.scene.fills.clear();
        const stress::Verdict verdict = stress::examine(trial);
        ++tally.scenes;
        tally.collisions += verdict.collisions;
        tally.cut += verdict.is_cut;
        tally.refused += verdict.is_refused;
        if (!verdict.failed()) continue;
        ++tally.failures;
        report_failure(trial, verdict, path);
    }
    return tally;
}

stress::Tally draw_and_examine(const StressOptions& options, int threads) {
    stress::CampaignOptions campaign;
    campaign.seed = options.seed;
    campaign.most_balls = options.most_balls;
    campaign.threads = threads;
    campaign.scenes = options.scenes;
    if (options.minutes) campaign.seconds = 60 * *options.minutes;
    if (options.seconds) campaign.seconds = *options.seconds;
    ProgressLine line(options.scenes ? 0 : campaign.seconds);
    stress::CampaignWatch watch;
    watch.is_interrupted = interrupt_requested;
    watch.progress = [&line](const stress::Tally& tally) { line.show(tally); };
    watch.failed = [&](const stress::Trial& trial, const stress::Verdict& verdict) {
        line.clear();
        write_failure(trial, verdict, options.folder);
    };
    return run_campaign(campaign, watch);
}

std::string counted(std::uint64_t count, const std::string& what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

int stress_scenes(const StressOptions& options) {
    std::error_code error;
    std::filesystem::create_directories(options.folder, error);
    if (!std::filesystem::is_directory(options.folder))
        throw FileError(options.folder, "cannot be made a folder");
    const int machine = std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
    const int threads = options.threads > 0 ? options.threads : machine;
    watch_for_interrupts();
    const stress::Tally tally =
        options.files.empty() ? draw_and_examine(options, threads) : examine_files(options, threads);
    std::string text;
    if (tally.cut > 0)
        text += fmt::format("{} left early, for so many collisions\n", counted(tally.cut, "scene"));
    if (tally.refused > 0)
        text += fmt::format("{} left where a ball was wedged or lost\n", counted(tally.refused, "scene"));
    text += fmt::format("stress: {}, {:.2g} collisions, seed {}, {}\n", counted(tally.scenes, "scene"),
                        double(tally.collisions), options.seed, counted(tally.failures, "failure"));
    print_out(text);
    if (tally.failures > 0) return kFailed;
    return interrupt_requested() ? kInterrupted : kGood;
}

}  // namespace

void add_stress_command(CLI::App& app, int& status) {
    CLI::App* const command = app.add_subcommand("stress", "Check every promise on random adverse scenes");
    command->footer(kStressFooter);
    const auto options = std::make_shared<StressOptions>();
    CLI::Option* const files =
        command->add_option("SCENE", options->files, "Scene files to be examined instead of random ones")
            ->type_name("");
    command->add_option("--balls", options->most_balls, "Most balls of a scene (default: 300)")
        ->type_name("N")
        ->check(CLI::Range(2, 1'000'000));
    CLI::Option* const minutes =
        command->add_option("--minutes", options->minutes, "Go on for so long (default: 1)");
    minutes->type_name("M")->check(positive_number());
    CLI::Option* const seconds = command->add_option("--seconds", options->seconds, "The same in seconds");
    seconds->type_name("S")->check(positive_number())->excludes(minutes);
    command->add_option("--scenes", options->scenes, "So many scenes, however long they take")
        ->type_name("K")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
        ->excludes(minutes)
        ->excludes(seconds);
    command->add_option("--seed", options->seed, "Of the scenes; each has others (default: 1)")
        ->type_name("S")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62));
    command
        ->add_option(
            "--edits", options->edits,
            "Edits that SCENE files get, drawn from the seed: all, or some of 0 to 11 (default: none)")
        ->type_name("LIST")
        ->needs(files)
        ->check(parse_check([](const std::string& text) { (void)parse_edits(text); }));
    add_threads_option(*command, options->threads);
    command->add_option("--out", options->folder, "Folder for scenes that fail (default: .)")
        ->type_name("DIR");
    command->callback([options, &status] { status = stress_scenes(*options); });
}

}  // namespace carom::app
