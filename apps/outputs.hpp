// Paths that a command writes to.
#pragma once

#include <string>
#include <vector>

namespace carom::app {

/// A file as the user named it: `--events` and its path.
struct NamedPath {
    std::string option;
    std::string path;
};

/// Throws CLI::ValidationError (wrong usage) when two outputs are one file, or when one is the input (`the
/// scene` and its path), under whatever spelling. Empty paths, "-" and what is no regular file (/dev/null)
/// may be shared.
void require_distinct(const NamedPath& input, const std::vector<NamedPath>& outputs);

/// Writes to standard output. Throws std::runtime_error when it does not take the text (a full disk, a closed
/// pipe).
void print_out(const std::string& text);

}  // namespace carom::app
