// Two outputs in one file would each lose the other.
#include "outputs.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace carom::app {
namespace {

namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
    std::error_code ignored;
    const fs::path real_a = fs::weakly_canonical(fs::absolute(a), ignored);
    const fs::path real_b = fs::weakly_canonical(fs::absolute(b), ignored);
    if (real_a != real_b && !fs::equivalent(real_a, real_b, ignored)) return false;
    return !fs::exists(real_a, ignored) || fs::is_regular_file(real_a, ignored);
}

bool is_file(const std::string& path) {
    return !path.empty() && path != "-";
}

}  // namespace

void require_distinct(const NamedPath& input, const std::vector<NamedPath>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (!is_file(outputs[i].path)) continue;
        if (same_file(outputs[i].path, input.path)) {
            throw CLI::ValidationError(outputs[i].option,
                                       fmt::format("would overwrite {} '{}'", input.option, input.path));
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (is_file(outputs[j].path) && same_file(outputs[i].path, outputs[j].path)) {
                throw CLI::ValidationError(
                    outputs[i].option,
                    fmt::format("names the same file as {}: '{}'", outputs[j].option, outputs[i].path));
            }
        }
    }
}

void print_out(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw std::runtime_error(fmt::format("standard output: {}", std::generic_category().message(errno)));
    }
}

}  // namespace carom::app
