// Checks of option values that several subcommands share.
#pragma once

#include <CLI/CLI.hpp>

namespace carom::app {

/// A finite number > 0.
[[nodiscard]] CLI::Validator positive_number();
/// A finite number >= 0.
[[nodiscard]] CLI::Validator number_from_zero();
/// A path that ends in one of the known picture formats.
[[nodiscard]] CLI::Validator picture_path();
/// WIDTHxHEIGHT.
[[nodiscard]] CLI::Validator picture_size_text();
/// A path that ends in .xyz.
[[nodiscard]] CLI::Validator xyz_path();

/// Adds --threads to a command; 0 stands for all of the machine's.
void add_threads_option(CLI::App& command, int& threads);

}  // namespace carom::app
