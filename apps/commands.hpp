// The program's subcommands. Each add_ function describes one to CLI11; the command itself runs while the
// command line is parsed and leaves the program's exit status in `status`.
#pragma once

#include <CLI/CLI.hpp>

namespace carom::app {

/// Exit statuses; the manual and the tests rely on them.
inline constexpr int kGood = 0;
inline constexpr int kFailed = 1;      ///< a scene, an input or an output is wrong
inline constexpr int kWrongUsage = 2;  ///< the command line is wrong
inline constexpr int kInterrupted =
    130;  ///< stopped by a signal; what was asked for is written, up to the time reached

void add_run_command(CLI::App& app, int& status);
void add_validate_command(CLI::App& app, int& status);
void add_render_command(CLI::App& app, int& status);
void add_stress_command(CLI::App& app, int& status);
void add_advise_command(CLI::App& app, int& status);
void add_plot_command(CLI::App& app, int& status);
void add_view_command(CLI::App& app, int& status);

}  // namespace carom::app
