// Checks of option values that several subcommands share.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <carom/core/precision.hpp>
#include <carom/core/scene.hpp>
#include <carom/io/movie_file.hpp>

#include "world_picture.hpp"

namespace carom::app {

/// Refuses what `parse` throws at, with what it says.
template <class Parse>
[[nodiscard]] CLI::Validator parse_check(Parse parse) {
    return {[parse](std::string& text) {
                try {
                    parse(text);
                } catch (const std::exception& error) {
                    return std::string(error.what());
                }
                return std::string();
            },
            ""};
}

/// A finite number > 0.
[[nodiscard]] CLI::Validator positive_number();
/// A finite number >= 0.
[[nodiscard]] CLI::Validator number_from_zero();
/// A path that ends in one of the known picture formats.
[[nodiscard]] CLI::Validator picture_path();
/// A path that ends in one of the known formats of pictures or movies.
[[nodiscard]] CLI::Validator picture_or_movie_path();
/// The movie's format that the path's extension names; none where it names none.
[[nodiscard]] std::optional<MovieFormat> movie_format(const std::string& path);
/// X0,Y0,X1,Y1: two opposite corners. Throws std::invalid_argument that says what is allowed.
[[nodiscard]] Box parse_view(const std::string& text);
[[nodiscard]] CLI::Validator view_text();
/// WIDTHxHEIGHT.
[[nodiscard]] CLI::Validator picture_size_text();
/// A path that ends in one of the formats of trajectories that this build writes.
[[nodiscard]] CLI::Validator trajectory_path();
/// A path that ends in .xyz.
[[nodiscard]] CLI::Validator xyz_path();

/// `double` or `float`, as options and outputs have it.
[[nodiscard]] const char* name_of(Precision precision);

/// Adds an option that takes `double` or `float`.
CLI::Option* add_precision_option(CLI::App& command, const std::string& name,
                                  std::optional<Precision>& precision, const std::string& description);

/// `event` or `empirical`.
[[nodiscard]] const char* name_of(Method method);

/// Adds an option that takes `event` or `empirical`.
CLI::Option* add_method_option(CLI::App& command, const std::string& name, std::optional<Method>& method,
                               const std::string& description);

/// Adds --colour-by.
void add_colour_by_option(CLI::App& command, ColourBy& colour_by);
/// Adds --colour-by and --colour-top.
void add_colour_options(CLI::App& command, PictureLook& look);

/// Adds --threads to a command; 0 stands for all of the machine's.
void add_threads_option(CLI::App& command, int& threads);

}  // namespace carom::app
