// Option values are checked while the command line is parsed, so that a wrong one costs nothing.
#include "options.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <string>

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

template <class Parse>
CLI::Validator parse_check(Parse parse) {
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
