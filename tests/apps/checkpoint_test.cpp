// carom run --checkpoint and --resume: a run that was stopped ends as one that was not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// A run with every output; the files' names begin with `name`.
Words run_of(const std::string& name, const std::string& until, const std::string& every) {
    return {"run",
            "s.json",
            "--until",
            until,
            "--trajectory",
            name + ".xyz",
            "--every",
            every,
            "--events",
            name + ".csv",
            "--final",
            name + "-end.xyz",
            "--picture",
            name + ".svg",
            "--summary",
            name + ".json",
            "--quiet",
            "--structure",
            name + ".str",
            "--observables",
            name + ".obs",
            "--average-from",
            "1"};
}

// All that does not tell how the work was done.
void expect_same_end(const Folder& folder, const std::string& a, const std::string& b) {
    for (const char* const kind : {".xyz", ".csv", "-end.xyz", ".svg", ".obs", ".str"})
        EXPECT_TRUE(folder.read(a + kind) == folder.read(b + kind)) << kind << " differs";
    for (const char* const key :
         {"scene", "method", "precision", "balls", "walls", "time", "ball_collisions", "wall_collisions",
          "steps", "missed_collisions", "energy_initial", "energy_final", "energy_relative_change",
          "momentum_initial", "momentum_final", "max_overlap", "compressibility_factor", "state_hash"})
        EXPECT_EQ(summary_value(folder.read(a + ".json"), key), summary_value(folder.read(b + ".json"), key))
            << key;
}

/// A boundary, and a method.
class ResumedRun : public testing::TestWithParam<std::pair<std::string, std::string>> {
 protected:
    static bool is_stepped() { return GetParam().second == "empirical"; }
    static std::string scene() {
        const std::string busy = busy_scene(GetParam().first);
        return with_keys(busy, is_stepped() ? R"("method": "empirical", "step": 0.03, )"
                                            : R"("sensors": [{"corners": [[0, 3], [9, 4]]}], )");
    }
    /// With the list of sensings, which the event method has.
    static Words run_of(const std::string& name, const std::string& until, const std::string& every) {
        Words words = testing_program::run_of(name, until, every);
        return is_stepped() ? words : words + Words{"--sensings", name + ".sen"};
    }
    static void expect_same_end(const Folder& folder, const std::string& a, const std::string& b) {
        testing_program::expect_same_end(folder, a, b);
        if (is_stepped()) return;
        EXPECT_TRUE(folder.read(a + ".sen") == folder.read(b + ".sen"));
        EXPECT_GT(folder.read(a + ".sen").size(), 1000);
    }
};

// The three stops: at a frame, between two, and where 3 * 0.7 lies a rounding before the end at 2.1.
TEST_P(ResumedRun, LeavesTheSameFiles) {
    const Folder folder;
    folder.write("s.json", scene());
    for (const auto& [stop, every] : {std::pair("3.5", "0.7"), {"4.123", "0.7"}, {"2.1", "0.7"}}) {
        SCOPED_TRACE(stop);
        ASSERT_EQ(folder.run(run_of("a", "7", every)).status, 0);
        ASSERT_EQ(folder.run(run_of("b", stop, every) + Words{"--checkpoint", "c"}).status, 0);
        const Result resumed =
            folder.run(run_of("b", "7", every) + Words{"--resume", "c", "--threads", "2", "--domains", "3"});
        ASSERT_EQ(resumed.status, 0) << resumed.err;
        expect_same_end(folder, "a", "b");
    }
}

// The first checkpoint of three is gone on from, with the files as the whole run has left them; then the last
// one, which covers all but the end itself.
TEST_P(ResumedRun, GoesOnFromAnyCheckpointAnyNumberOfTimes) {
    const Folder folder;
    folder.write("s.json", scene());
    const Words options = {"--precision", "float"};
    ASSERT_EQ(folder.run(run_of("a", "6", "0.5") + options).status, 0);
    ASSERT_EQ(folder.run(run_of("b", "2", "0.5") + options + Words{"--checkpoint", "first"}).status, 0);
    Words further = run_of("b", "6", "0.5") + options +
                    Words{"--resume", "first", "--checkpoint", "c", "--checkpoint-every", "1.3"};
    if (!is_stepped()) further = further + Words{"--step", "0.17"};  // else the steps are the scene's
    ASSERT_EQ(folder.run(further).status, 0);
    expect_same_end(folder, "a", "b");
    for (const std::string from : {"first", "c", "c", "first"}) {
        SCOPED_TRACE(from);
        const Result resumed = folder.run(run_of("b", "6", "0.5") + options + Words{"--resume", from});
        ASSERT_EQ(resumed.status, 0) << resumed.err;
        expect_same_end(folder, "a", "b");
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ResumedRun,
                         testing::Values(std::pair("wall", "event"), std::pair("periodic", "event"),
                                         std::pair("open", "event"), std::pair("wall", "empirical"),
                                         std::pair("periodic", "empirical")));

class InterruptedRun : public testing::TestWithParam<int> {};

// A signal comes when it likes; what it leaves leads to the end that the run would have had.
TEST_P(InterruptedRun, LeavesACheckpoint) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const pid_t process = folder.start(run_of("b", "1e9", "0.5") + Words{"--checkpoint", "c"});
    while (!fs::exists(folder.path("b.xyz")) || fs::file_size(folder.path("b.xyz")) == 0) usleep(1000);
    usleep(100'000);
    ASSERT_EQ(kill(process, GetParam()), 0);
    ASSERT_EQ(folder.finish(process).status, 130);
    const double stopped = std::stod(summary_value(folder.read("b.json"), "time"));
    const std::string until = std::to_string(stopped + 2);
    ASSERT_EQ(folder.run(run_of("a", until, "0.5")).status, 0);
    const Result resumed = folder.run(run_of("b", until, "0.5") + Words{"--resume", "c"});
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    expect_same_end(folder, "a", "b");
}

INSTANTIATE_TEST_SUITE_P(Signals, InterruptedRun, testing::Values(SIGINT, SIGTERM));

TEST(Checkpoints, WhatCannotBeGoneOnFromIsRefusedAndLeftAlone) {
    const Folder folder;
    folder.write("s.json", busy_scene("wall"));
    folder.write("other.json", busy_scene("open"));
    ASSERT_EQ(folder.run(run_of("b", "3", "0.5") + Words{"--checkpoint", "c"}).status, 0);
    const std::string trajectory = folder.read("b.xyz");
    const std::string events = folder.read("b.csv");
    const std::string checkpoint = folder.read("c");
    folder.write("cut", checkpoint.substr(0, 1000));
    const auto refused = [&](const Words& options, const std::string& message) {
        expect_one_error(folder.run(options), 1, message);
        EXPECT_TRUE(folder.read("b.xyz") == trajectory) << message;
        EXPECT_TRUE(folder.read("b.csv") == events) << message;
        EXPECT_TRUE(folder.read("c") == checkpoint) << message;
    };
    const Words outputs = {"--trajectory", "b.xyz", "--every",      "0.5",
                           "--events",     "b.csv", "--checkpoint", "c"};
    refused(Words{"run", "s.json", "--resume", "none"} + outputs, "none: cannot be read: No such file");
    refused(Words{"run", "s.json", "--resume", "s.json"} + Words{"--events", "b.csv"},
            "s.json: is no checkpoint");
    refused(Words{"run", "s.json", "--resume", "cut"} + outputs,
            "cut: is no whole checkpoint: it has 1000 bytes");
    refused(Words{"run", "other.json", "--resume", "c"} + outputs, "c: is of another scene");
    refused(Words{"run", "s.json", "--precision", "float", "--resume", "c"} + outputs,
            "c: is of another scene");
    refused(Words{"run", "s.json", "--method", "empirical", "--resume", "c"} + outputs,
            "c: is of the method 'event'");
    refused(Words{"run", "s.json", "--until", "2", "--resume", "c"} + outputs,
            "c: is at time 3, after the end at 2");
    refused({"run", "s.json", "--resume", "c", "--trajectory", "b.xyz", "--every", "0.25"},
            "c: covers a trajectory with --every 0.5, not 0.25");
    refused({"run", "s.json", "--resume", "c", "--observables", "b.obs", "--every", "0.25"},
            "c: covers measures with --every 0.5, not 0.25");
    const std::string rows = folder.read("b.obs");
    refused({"run", "s.json", "--resume", "c", "--observables", "b.obs", "--every", "0.5"},
            "c: covers measures with other --observables, --structure or --average-from");
    EXPECT_EQ(folder.read("b.obs"), rows);
    refused({"run", "s.json", "--resume", "c", "--events", "none.csv"},
            "none.csv: cannot be written: No such file");
    folder.write("short.csv", events.substr(0, 100));
    refused({"run", "s.json", "--resume", "c", "--events", "short.csv"},
            "short.csv: cannot be gone on with: has 100");
    EXPECT_EQ(folder.read("short.csv"), events.substr(0, 100));
}

// What lists held before is lost only to a run that begins.
TEST(Checkpoints, AnOutputThatCannotBeLeavesTheOthers) {
    const Folder folder;
    folder.write("s.json", busy_scene("wall"));
    folder.write("e.csv", "of another run\n");
    expect_one_error(folder.run({"run", "s.json", "--checkpoint", "c", "--events", "e.csv", "--observables",
                                 "none/o.csv", "--every", "1"}),
                     1, "none/o.csv");
    EXPECT_EQ(folder.read("e.csv"), "of another run\n");
    EXPECT_EQ(folder.names(), (Words{"e.csv", "s.json"}));
}

TEST(Checkpoints, WrongUsage) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    expect_one_error(folder.run({"run", "s.json", "--checkpoint-every", "1"}), 2, "--checkpoint");
    expect_one_error(folder.run({"run", "s.json", "--checkpoint", "c", "--checkpoint-every", "0"}), 2,
                     "--checkpoint-every");
    expect_one_error(folder.run({"run", "s.json", "--checkpoint", "./s.json"}), 2, "overwrite the scene");
    expect_one_error(folder.run({"run", "s.json", "--checkpoint", "c", "--events", "./c"}), 2, "same file");
    expect_one_error(folder.run({"run", "s.json", "--resume", "c", "--events", "./c"}), 2,
                     "would overwrite the checkpoint");
    EXPECT_EQ(folder.names(), Words{"s.json"});
}

// Whatever the disk does not take: one line, status 1, the checkpoint that was there stays whole, and nothing
// half-written is left beside it.
TEST(Checkpoints, ADiskThatIsFull) {
    const Folder folder;
    folder.write("s.json", busy_scene("wall"));
    ASSERT_EQ(folder.run({"run", "s.json", "--until", "1", "--checkpoint", "c"}).status, 0);
    const std::string before = folder.read("c");
    // A limit of 8 blocks of 512 bytes: less than 143 moving balls at 56 bytes.
    expect_one_error(
        folder.run_shell("ulimit -f 8; exec \"$0\" run s.json --quiet --resume c --checkpoint c"), 1,
        "c: cannot be written: File too large");
    EXPECT_TRUE(folder.read("c") == before);
    expect_one_error(folder.run({"run", "s.json", "--quiet", "--checkpoint", "/dev/full"}), 1,
                     "/dev/full: cannot be written: No space left on device");
    fs::create_symlink("/dev/full", folder.path("full.xyz"));
    for (const Words& output :
         {Words{"--trajectory", "full.xyz", "--every", "1"}, Words{"--events", "/dev/full"}})
        expect_one_error(folder.run(Words{"run", "s.json", "--quiet", "--checkpoint", "c"} + output), 1,
                         "cannot be written: No space left on device");
    EXPECT_TRUE(folder.read("c") == before) << "an output that fails is no reason to lose the checkpoint";
    EXPECT_EQ(folder.names(), (Words{"c", "full.xyz", "s.json"}));
}

TEST(Checkpoints, AFolderThatTakesNoFiles) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    // Known before the run, not after an hour: it would never end.
    expect_one_error(folder.run({"run", "s.json", "--until", "1e300", "--checkpoint", "none/c"}), 1,
                     "none/c: cannot be written: No such file or directory");
    expect_one_error(folder.run({"run", "s.json", "--until", "1e300", "--checkpoint", "/proc/c"}), 1,
                     "/proc/c: cannot be written: ");
    if (geteuid() == 0) return;  // to whom no folder is closed
    fs::create_directory(folder.path("closed"));
    fs::permissions(folder.path("closed"), fs::perms::owner_read | fs::perms::owner_exec);
    expect_one_error(folder.run({"run", "s.json", "--until", "1e300", "--checkpoint", "closed/c"}), 1,
                     "closed/c: cannot be written: Permission denied");
}

// The default is a tenth of the run; checkpoints go by simulated time, so their number does not depend on the
// machine. Through a pipe come all of them, one after the other.
TEST(Checkpoints, ComeEveryTenthOfTheRun) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    ASSERT_EQ(folder.run({"run", "s.json", "--checkpoint", "c"}).status, 0);
    const Result piped = folder.run_shell(
        "mkfifo p; exec 3<>p 4<p; \"$0\" run s.json --checkpoint p 3>&- 4<&-; exec 3>&-; cat <&4 >all");
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(folder.read("all").size(), 10 * folder.read("c").size());
}

}  // namespace
}  // namespace carom::testing_program
