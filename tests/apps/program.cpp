#include "program.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace carom::testing_program {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

Folder::Folder() {
    std::string pattern = (fs::temp_directory_path() / "carom-test-XXXXXX").string();
    EXPECT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return path(name);
}

std::string Folder::read(const std::string& name) const {
    const std::ifstream file(folder_ / name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<std::string> Folder::names() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

pid_t Folder::start(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {CAROM_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return start_words(words);
}

pid_t Folder::start_words(std::vector<std::string> words) const {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    // Before the child is there, which may be killed before it does anything.
    const auto opened = [this](const char* name) {
        const int file = open(path(name).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        EXPECT_GE(file, 0) << name;
        return file;
    };
    const int out_file = opened("out");
    const int err_file = opened("err");
    const pid_t process = fork();
    if (process != 0) {
        close(out_file);
        close(err_file);
        return process;
    }
    // In the child: nothing but system calls.
    if (dup2(out_file, STDOUT_FILENO) < 0 || dup2(err_file, STDERR_FILENO) < 0 || chdir(folder_.c_str()) != 0)
        _exit(127);
    execv(pointers[0], pointers.data());
    _exit(127);
}

Result Folder::finish(pid_t process) const {
    int status = 0;
    EXPECT_EQ(waitpid(process, &status, 0), process);
    Result result;
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = read("out");
    result.err = read("err");
    fs::remove(path("out"));
    fs::remove(path("err"));
    return result;
}

Result Folder::run(const std::vector<std::string>& arguments) const {
    return finish(start(arguments));
}

Result Folder::run_shell(const std::string& line) const {
    return finish(start_words({"/bin/sh", "-c", line, CAROM_PROGRAM}));
}

void expect_one_error(const Result& result, int status, const std::string& message) {
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, StartsWith("carom: error: "));
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

std::string summary_value(const std::string& summary, const std::string& key) {
    const std::string quoted = std::string("\"").append(key).append("\": ");
    const std::size_t place = summary.find(quoted);
    if (place == std::string::npos) {
        ADD_FAILURE() << "no " << key << " in " << summary;
        return "";
    }
    const std::size_t start = place + quoted.size();
    std::string value = summary.substr(start, summary.find('\n', start) - start);
    if (!value.empty() && value.back() == ',') value.pop_back();
    return value;
}

}  // namespace carom::testing_program
