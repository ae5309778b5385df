// carom: the program. Parses the command line, runs a subcommand, turns every failure into one line and a
// status.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <carom/io/nearest_word.hpp>

#include "commands.hpp"

namespace carom::app {
namespace {

constexpr const char* kFooter = R"(Examples:
  carom validate box.json                      Is the scene sound, and what is in it?
  carom run box.json                           Simulate it; the summary goes to standard output
  carom run box.json --picture end.png         ... and draw the end
  carom render box.json --out start.svg        Draw it as it starts
  carom advise box.json --error 1e-3           Which setting is the fastest that keeps this error?
  carom render box.json --out box.mp4          A movie of it
  carom plot box.json --out box.svg            Energy, pressure, g(r), speeds
  carom view box.json                          Watch it in a window

'carom COMMAND --help' says more of each command.
Exit status: 0 good, 1 a scene, an input or an output is wrong, 2 wrong usage, 130 interrupted.)";

// One line, whatever the message held.
void print_error(const std::string& message) {
    std::string line = message;
    while (!line.empty() && line.back() == '\n') line.pop_back();
    std::replace(line.begin(), line.end(), '\n', ' ');
    fmt::print(stderr, "carom: error: {}\n", line);
}

// CLI11 says only that a command is required, even where one was given that is none.
void require_command(const CLI::App& app, int argc, char** argv) {
    const std::string first = argc > 1 ? argv[1] : "";
    if (first.starts_with('-')) return;
    std::vector<std::string> known;
    for (const CLI::App* const command : app.get_subcommands({})) {
        known.push_back(command->get_name());
        if (known.back() == first) return;
    }
    std::string what = first.empty() ? "no command is given" : fmt::format("'{}' is no command", first);
    const std::vector<std::string_view> words(known.begin(), known.end());
    if (first.ends_with(".json"))
        what += fmt::format(", did you mean carom run {}?", first);
    else if (const std::string_view nearest = nearest_word(first, words); !nearest.empty())
        what += fmt::format(", did you mean {}?", nearest);
    throw CLI::ValidationError(fmt::format("{} (known: {}); see carom --help", what, fmt::join(known, ", ")));
}

// CLI11 names arguments that fit nowhere, the last first, and no more than that.
std::string unexpected(const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    if (commands.empty()) return fmt::format("not expected: {}", fmt::join(app.remaining(), " "));
    const CLI::App& command = *commands.front();
    std::vector<std::string> options;
    for (const CLI::Option* const option : command.get_options())
        for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    const std::vector<std::string_view> known(options.begin(), options.end());
    const std::vector<std::string> rest = command.remaining();
    const auto wrong =
        std::ranges::find_if(rest, [](const std::string& word) { return word.starts_with('-'); });
    if (wrong == rest.end()) return fmt::format("not expected: {}", fmt::join(rest, " "));
    const std::string_view nearest = nearest_word(wrong->substr(0, wrong->find('=')), known);
    if (nearest.empty())
        return fmt::format("{}: no option of carom {}; see its --help", *wrong, command.get_name());
    return fmt::format("{}: no option of carom {}, did you mean {}?", *wrong, command.get_name(), nearest);
}

int run_program(int argc, char** argv) {
    CLI::App app("Exact, event-driven collisions of many balls in two dimensions.", "carom");
    int status = kGood;
    app.footer(kFooter);
    app.set_version_flag("--version", "carom " CAROM_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    add_run_command(app, status);
    add_validate_command(app, status);
    add_render_command(app, status);
    add_stress_command(app, status);
    add_advise_command(app, status);
    add_view_command(app, status);
    add_plot_command(app, status);
    try {
        require_command(app, argc, argv);
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == int(CLI::ExitCodes::Success))
            return app.exit(error);  // --help, --version
        const bool is_extra = error.get_exit_code() == int(CLI::ExitCodes::ExtrasError);
        print_error(is_extra ? unexpected(app) : error.what());
        return kWrongUsage;
    }
    return status;
}

}  // namespace
}  // namespace carom::app

int main(int argc, char** argv) {
    using namespace carom::app;
    // A file larger than the user's limit is an error of writing like a full disk, not the program's end.
    (void)std::signal(SIGXFSZ, SIG_IGN);
    try {
        return run_program(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("carom: error: out of memory\n", stderr);
    } catch (const std::length_error&) {  // more than any memory could hold
        std::fputs("carom: error: out of memory\n", stderr);
    } catch (const std::exception& error) {
        try {
            print_error(error.what());
        } catch (...) {
            std::fputs("carom: error: out of memory\n", stderr);
        }
    }
    return kFailed;
}
