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
#include <vector>

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
    const std::string what = first.empty() ? "no command is given" : fmt::format("'{}' is no command", first);
    throw CLI::ValidationError(fmt::format("{} (known: {}); see carom --help", what, fmt::join(known, ", ")));
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
        print_error(error.what());
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
