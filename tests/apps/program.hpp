// Runs the built program as a user would, in a folder of the test's own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace carom::testing_program {

struct Result {
    int status = -1;  ///< exit status; 128 + signal where a signal ended it
    std::string out;
    std::string err;
};

/// A folder that lives as long as the object.
class Folder {
 public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    /// Writes a file and gives its path.
    std::string write(const std::string& name, const std::string& text) const;
    [[nodiscard]] std::string read(const std::string& name) const;
    [[nodiscard]] std::vector<std::string> names() const;

    /// Runs `carom ARGUMENTS...` to its end. Paths are the caller's business; the working directory is the
    /// folder.
    [[nodiscard]] Result run(const std::vector<std::string>& arguments) const;
    /// Runs a line of shell, in which "$0" is the program, to its end.
    [[nodiscard]] Result run_shell(const std::string& line) const;
    /// Starts the program; its outputs go to the files "out" and "err".
    [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const;
    /// Waits for what start() gave.
    [[nodiscard]] Result finish(pid_t process) const;

 private:
    [[nodiscard]] pid_t start_words(std::vector<std::string> words) const;

    std::filesystem::path folder_;
};

/// One line on standard error, nothing on standard output, and the status.
void expect_one_error(const Result& result, int status, const std::string& message);

/// The value of a key in the program's summary, as its JSON text; fails the test where there is none.
[[nodiscard]] std::string summary_value(const std::string& summary, const std::string& key);

}  // namespace carom::testing_program
