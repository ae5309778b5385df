// carom stress as a user runs it, and what it is for: a fault put into the engine on purpose is found, shrunk
// and written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "program.hpp"

namespace carom::testing_program {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;

TEST(StressCommand, FindsNothingInASoundProgram) {
    const Folder folder;
    const Result result =
        folder.run({"stress", "--scenes", "6", "--balls", "60", "--seed", "7", "--threads", "2"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const std::string last = result.out.substr(result.out.rfind("stress:"));
    EXPECT_THAT(last, MatchesRegex("stress: 6 scenes, [0-9.e+]+ collisions, seed 7, 0 failures\n"));
    EXPECT_TRUE(folder.names().empty());
}

TEST(StressCommand, DoesTheSameWorkForTheSameSeed) {
    const Folder folder;
    const auto run = [&folder](const std::string& seed) {
        return folder.run({"stress", "--scenes", "4", "--balls", "40", "--seed", seed}).out;
    };
    EXPECT_EQ(run("5"), run("5"));
    EXPECT_NE(run("5").substr(0, 40), run("6").substr(0, 40));
}

TEST(StressCommand, EndsAfterItsTime) {
    const Folder folder;
    const Result result = folder.run({"stress", "--seconds", "0.2", "--balls", "10"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("seed 1, 0 failures"));
}

TEST(StressCommand, ExaminesAGivenScene) {
    const Folder folder;
    const std::string scene = folder.write(
        "rain.json",
        R"({"domain": {"min": [0, 0], "max": [10, 10], "boundary": ["wall", "wall"]}, "gravity": [0, -1],
            "fill": [{"count": 12, "packing_fraction": 0.2, "temperature": 1}], "until": 4})");
    const Result result = folder.run({"stress", scene, "--threads", "3"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("stress: 1 scene, "));
}

// Edits are drawn from the seed: what a failure prints as --edits repeats it.
TEST(StressCommand, EditsAGivenScene) {
    const Folder folder;
    const std::string scene =
        folder.write("gas.json",
                     R"({"domain": {"min": [0, 0], "max": [12, 12], "boundary": ["periodic", "wall"]},
            "fill": [{"count": 40, "packing_fraction": 0.2, "temperature": 1}], "until": 6})");
    const auto run = [&](const std::string& edits) {
        const Result result = folder.run({"stress", scene, "--seed", "4", "--edits", edits});
        EXPECT_EQ(result.status, 0) << result.err;
        return result.out;
    };
    EXPECT_EQ(run("all"), run("0,1,2,3,4,5,6,7,8,9,10,11"));
    EXPECT_NE(run("all"), run("none"));
    EXPECT_EQ(run("none"), folder.run({"stress", scene, "--seed", "4"}).out);
}

TEST(StressCommand, NamesWhatIsWrong) {
    const Folder folder;
    expect_one_error(folder.run({"stress", "--balls", "1"}), 2, "--balls");
    expect_one_error(folder.run({"stress", "--minutes", "0"}), 2, "--minutes");
    expect_one_error(folder.run({"stress", "--seconds", "1", "--scenes", "2"}), 2, "--seconds");
    expect_one_error(folder.run({"stress", "x.json", "--edits", "1,12"}), 2, "some of 0 to 11");
    expect_one_error(folder.run({"stress", "--edits", "all"}), 2, "--edits");
    expect_one_error(folder.run({"stress", "missing.json"}), 1, "missing.json");
    expect_one_error(folder.run({"stress", "--scenes", "1", "--out", "/dev/null/x"}), 1, "/dev/null/x");
}

}  // namespace
}  // namespace carom::testing_program
