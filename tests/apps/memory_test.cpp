// A scene too large for the memory there is: refused before the work, in one line with both figures; and one
// line too where memory ends all the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "memory_need.hpp"
#include "program.hpp"

namespace carom::testing_program {
namespace {

using testing::HasSubstr;

std::string scene_of(const std::string& count) {
    return R"({"domain": {"min": [0, 0], "max": [1e5, 1e5], "boundary": ["periodic", "periodic"]},
        "fill": [{"count": )" +
           count + R"(, "packing_fraction": 0.1, "temperature": 1}], "until": 0})";
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__  // as g++ says it
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasLimits = false;  // the sanitizer takes terabytes of addresses for itself
#else
constexpr bool kHasLimits = true;
#endif

TEST(Memory, TooLargeASceneIsRefusedBeforeTheWork) {
    if (!kHasLimits) GTEST_SKIP();
    const Folder folder;
    (void)folder.write("scene.json", scene_of("5000000"));
    for (const std::string limit : {"-v", "-d"})
        expect_one_error(folder.run_shell("ulimit " + limit + R"( 1000000; "$0" run scene.json)"), 1,
                         "5000000 balls need about 3.5 GB of memory, and the limit of ");
}

TEST(Memory, WhatFitsIsRunUnderTheLimit) {
    if (!kHasLimits) GTEST_SKIP();
    const Folder folder;
    (void)folder.write("scene.json", scene_of("20000"));
    // What is estimated, and the program itself with its libraries and threads, of which each wants a stack.
    const Result result = folder.run_shell(R"(ulimit -v 600000; "$0" run scene.json --quiet --threads 2)");
    EXPECT_EQ(result.status, 0) << result.err;
}

TEST(Memory, OneLineWhereItEndsAllTheSame) {
    if (!kHasLimits) GTEST_SKIP();
    const Folder folder;
    (void)folder.write("scene.json", scene_of("1000000"));
    for (const std::string command : {"run --no-memory-check --threads 1", "validate"})
        expect_one_error(folder.run_shell(R"(ulimit -v 200000; "$0" )" + command + " scene.json"), 1,
                         "out of memory");
}

TEST(Memory, AFewBytesDoNotAskForGigabytes) {
    const Folder folder;
    (void)folder.write("scene.json", scene_of("1000000000000"));
    expect_one_error(folder.run_shell(R"("$0" validate scene.json)"), 1, "must be at most 100000000");
}

TEST(Memory, TheTightestControlGroupCounts) {
    const Folder folder;
    const std::filesystem::path root = folder.path("groups");
    std::filesystem::create_directories(root / "a/b");
    const auto write = [&root](const std::string& name, const std::string& text) {
        std::ofstream(root / name) << text;
    };
    EXPECT_EQ(app::room_of_groups(root, "/a/b"), std::nullopt);
    write("a/b/memory.max", "max\n");
    EXPECT_EQ(app::room_of_groups(root, "/a/b"), std::nullopt);
    write("a/memory.max", "1000\n");
    write("a/memory.current", "400\n");
    EXPECT_EQ(app::room_of_groups(root, "/a/b"), 600);
    write("a/b/memory.max", "700\n");
    write("a/b/memory.current", "300\n");
    EXPECT_EQ(app::room_of_groups(root, "/a/b"), 400);
    EXPECT_EQ(app::room_of_groups(root, "/"), std::nullopt);
}

// Counted by hand: 400 balls, and 0.1 of an area of 100 in discs of radius 1/2, 12.7.
TEST(Memory, BallsOfFillsAreCounted) {
    Scene scene;
    scene.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kOpen, Boundary::kOpen}, 1};
    scene.balls.resize(300);
    scene.fills.resize(2);
    scene.fills[0].count = 100;
    scene.fills[1].packing_fraction = 0.1;
    EXPECT_NEAR(app::count_of_balls(scene), 412.73, 0.01);
    EXPECT_GT(app::memory_need(scene), 500.0 * 412);
}

}  // namespace
}  // namespace carom::testing_program
