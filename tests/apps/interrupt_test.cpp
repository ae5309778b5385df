// Ctrl-C: a run ends early and whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "program.hpp"

namespace carom::testing_program {
namespace {

// It would take years.
constexpr const char* kEndless = R"({
    "domain": {"min": [0, 0], "max": [10, 10], "boundary": ["wall", "wall"]},
    "balls": [{"position": [3, 5], "velocity": [3, 1]}, {"position": [7, 5], "velocity": [1, 2]}],
    "until": 1e12 })";

// Waits until the program has written its first frame, which it does once it listens to signals. No time
// limit here: the test's own ends a program that never starts.
void wait_for_frame(const Folder& folder, const std::string& name, pid_t process) {
    std::error_code error;
    while (std::filesystem::file_size(folder.path(name), error) == 0 || error) {
        ASSERT_EQ(waitpid(process, nullptr, WNOHANG), 0) << "the program has ended";
        usleep(2000);
    }
}

class Interrupt : public testing::TestWithParam<int> {};

TEST_P(Interrupt, LeavesEveryOutputWhole) {
    const Folder folder;
    folder.write("s.json", kEndless);
    const pid_t process =
        folder.start({"run", "s.json", "--trajectory", "t.xyz", "--every", "1e11", "--events", "e.csv",
                      "--final", "f.xyz", "--picture", "p.svg", "--summary", "sum.json"});
    wait_for_frame(folder, "t.xyz", process);
    ASSERT_EQ(kill(process, GetParam()), 0);
    const Result result = folder.finish(process);
    EXPECT_EQ(result.status, 130);
    EXPECT_THAT(result.err, testing::StartsWith("carom: interrupted at t = "));
    EXPECT_EQ(folder.names(),
              (std::vector<std::string>{"e.csv", "f.xyz", "p.svg", "s.json", "sum.json", "t.xyz"}));

    const std::string summary = folder.read("sum.json");
    const double time = std::stod(summary_value(summary, "time"));
    EXPECT_LT(time, 1e12);
    // One line an event and the header; none is missing and none is cut.
    const std::string events = folder.read("e.csv");
    const auto collisions = std::stoll(summary_value(summary, "ball_collisions")) +
                            std::stoll(summary_value(summary, "wall_collisions"));
    EXPECT_EQ(std::count(events.begin(), events.end(), '\n'), collisions + 1);
    EXPECT_EQ(events.back(), '\n');
    // What was reached is what a run to that time gives.
    const Result again = folder.run({"run", "s.json", "--until", summary_value(summary, "time")});
    EXPECT_EQ(summary_value(again.out, "state_hash"), summary_value(summary, "state_hash"));
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM));

TEST(InterruptedRender, DrawsNothing) {
    const Folder folder;
    folder.write("s.json", kEndless);
    const pid_t process = folder.start({"render", "s.json", "--out", "p.png", "--time", "1e12", "--quiet"});
    // The picture's temporary file stands before the handler does by a hair; a signal in between ends the
    // program just as well.
    while (folder.names().size() < 4) usleep(2000);
    usleep(100'000);
    ASSERT_EQ(kill(process, SIGINT), 0);
    const Result result = folder.finish(process);
    EXPECT_EQ(result.status, 130);
    EXPECT_EQ(result.err, "");
    EXPECT_FALSE(std::filesystem::exists(folder.path("p.png")));
}

}  // namespace
}  // namespace carom::testing_program
