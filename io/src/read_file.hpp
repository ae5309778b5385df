// Whole files as text.
#pragma once

#include <filesystem>
#include <string>

namespace carom {

/// Everything in the file. Throws FileError when it is missing, a directory or cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace carom
