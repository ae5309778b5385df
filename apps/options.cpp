// Option values are checked while the command line is parsed, so that a wrong one costs nothing.
#include "options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <carom/io/trajectory.hpp>

#include "picture_file.hpp"

namespace carom::app {
namespace {

// A validator's answer: empty where all is well, else what is wrong.
template <class IsGood>
CLI::Validator number_check(const std::string& rule, IsGood is_good) {
    return {[rule, is_good](std::string& text) {
                double number = 0;
                const bool good =
                    CLI::detail::lexical_cast(text, number) && std::isfinite(number) && is_good(number);
                return good ? std::string() : fmt::format("must be {}, is '{}'", rule, text);
            },
            ""};
}

constexpr int kMostThreads = 4096;

// An option that takes one of two words, the enumerators' names.
template <class Enumerator>
CLI::Option* add_word_option(CLI::App& command, const std::string& name, std::optional<Enumerator>& chosen,
                             const std::array<Enumerator, 2>& all, const std::string& description) {
    std::map<std::string, Enumerator> words;
    for (const Enumerator e : all) words[name_of(e)] = e;
    return command
        .add_option_function<std::string>(
            name, [&chosen, words](const std::string& word) { chosen = words.at(word); }, description)
        ->option_text(std::string(name_of(all[0])) + "|" + name_of(all[1]))
        ->check(CLI::IsMember(words));
}

}  // namespace

CLI::Validator positive_number() {
    return number_check("a number > 0", [](double number) { return number > 0; });
}

CLI::Validator number_from_zero() {
    return number_check("a number >= 0", [](double number) { return number >= 0; });
}

CLI::Validator picture_path() {
    return parse_check([](const std::string& text) { (void)picture_format(text); });
}

CLI::Validator picture_or_movie_path() {
    return parse_check([](const std::string& text) {
        if (movie_format(text)) return;
        try {
            (void)picture_format(text);
        } catch (const std::invalid_argument&) {
            throw std::invalid_argument(
                fmt::format("unknown format '{}' (known: .png, .svg, .mp4, .gif)", extension_of(text)));
        }
    });
}

std::optional<MovieFormat> movie_format(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == ".mp4") return MovieFormat::kMp4;
    if (extension == ".gif") return MovieFormat::kGif;
    return std::nullopt;
}

Box parse_view(const std::string& text) {
    std::array<double, 4> corners{};
    std::vector<std::string> parts = CLI::detail::split(text, ',');
    bool good = parts.size() == corners.size();
    for (std::size_t i = 0; good && i < corners.size(); ++i)
        good = CLI::detail::lexical_cast(parts[i], corners[i]) && std::isfinite(corners[i]);
    const Box view{{std::min(corners[0], corners[2]), std::min(corners[1], corners[3])},
                   {std::max(corners[0], corners[2]), std::max(corners[1], corners[3])}};
    if (good && (view.max - view.min).minCoeff() > 0) return view;
    throw std::invalid_argument(
        fmt::format("'{}' is no view: X0,Y0,X1,Y1, two opposite corners of a rectangle", text));
}

CLI::Validator view_text() {
    return parse_check([](const std::string& text) { (void)parse_view(text); });
}

CLI::Validator picture_size_text() {
    return parse_check([](const std::string& text) { (void)parse_picture_size(text); });
}

CLI::Validator trajectory_path() {
    return {[](std::string& text) { return fault_of_trajectory_path(text); }, ""};
}

CLI::Validator xyz_path() {
    return {[](std::string& text) {
                const std::string extension = std::filesystem::path(text).extension().string();
                const bool good = extension == ".xyz";
                return good ? std::string() : fmt::format("unknown format '{}' (known: .xyz)", extension);
            },
            ""};
}

const char* name_of(Precision precision) {
    return precision == Precision::kFloat ? "float" : "double";
}

const char* name_of(Method method) {
    return method == Method::kEmpirical ? "empirical" : "event";
}

CLI::Option* add_precision_option(CLI::App& command, const std::string& name,
                                  std::optional<Precision>& precision, const std::string& description) {
    return add_word_option(command, name, precision, {Precision::kDouble, Precision::kFloat}, description);
}

CLI::Option* add_method_option(CLI::App& command, const std::string& name, std::optional<Method>& method,
                               const std::string& description) {
    return add_word_option(command, name, method, {Method::kEvent, Method::kEmpirical}, description);
}

void add_colour_by_option(CLI::App& command, ColourBy& colour_by) {
    std::map<std::string, ColourBy> words;
    std::string all;
    for (const ColourBy by : kAllColourBy) {
        words[name_of(by)] = by;
        all += (all.empty() ? "" : "|") + std::string(name_of(by));
    }
    command
        .add_option_function<std::string>(
            "--colour-by", [&colour_by, words](const std::string& word) { colour_by = words.at(word); },
            "What the balls' colours show (default: speed); domain: how the work is cut")
        ->option_text(all)
        ->check(CLI::IsMember(words));
}

void add_colour_options(CLI::App& command, PictureLook& look) {
    add_colour_by_option(command, look.colour_by);
    command
        .add_option("--colour-top", look.colour_top,
                    "Speed, radius or count at the colours' upper end; without it the 99th percentile")
        ->option_text("V")
        ->check(positive_number());
}

void add_threads_option(CLI::App& command, int& threads) {
    const auto is_count = [](double number) {
        return number >= 1 && number <= kMostThreads && number == std::floor(number);
    };
    command
        .add_option("--threads", threads,
                    "Without it all of the machine's. Never changes a bit of the result")
        ->type_name("N")
        ->check(number_check(fmt::format("a whole number from 1 to {}", kMostThreads), is_count));
}

}  // namespace carom::app
