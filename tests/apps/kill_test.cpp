// SIGKILL at random times: what a run leaves is whole, and leads to the end that it would have had.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>

#include <carom/io/checkpoint.hpp>
#include <carom/io/xyz.hpp>

#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

int wanted_kills() {
    const char* const text = std::getenv("CAROM_KILLS");
    return text != nullptr ? std::atoi(text) : 30;
}

class KilledRun {
 public:
    KilledRun() {
        folder_.write("s.json", busy_scene("periodic"));
        const auto started = std::chrono::steady_clock::now();
        const Result whole = folder_.run(words("a"));
        EXPECT_EQ(whole.status, 0) << whole.err;
        seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        trajectory_ = folder_.read("a.xyz");
        events_ = folder_.read("a.csv");
        rows_ = folder_.read("a.obs");
        structure_ = folder_.read("a.str");
        hash_ = summary_value(folder_.read("a.json"), "state_hash");
    }

    /// Goes on from what is there and is killed after a random part of the time that a whole run takes. True
    /// where it ended before.
    bool start_and_kill(std::mt19937_64& random) {
        Words all = words("b");
        if (fs::exists(folder_.path("c"))) all.insert(all.end(), {"--resume", "c"});
        // Another number of domains each time: they change no bit.
        all.insert(all.end(), {"--domains", std::to_string(1 + random() % 3)});
        const pid_t process = folder_.start(all);
        usleep(static_cast<useconds_t>(double(random() % 1000) * 1e3 * seconds_ / 2));
        kill(process, SIGKILL);
        const Result result = folder_.finish(process);
        EXPECT_TRUE(result.status == 0 || result.status == 128 + SIGKILL) << result.err;
        return result.status == 0;
    }

    /// What is there is whole as far as it claims to be. Gives the number of whole frames.
    void expect_whole() const {
        // Up to the last whole frame; after it the reader finds the file cut.
        std::size_t frames = 0;
        if (fs::exists(folder_.path("b.xyz"))) {
            try {
                for_each_xyz_frame(folder_.path("b.xyz"), [&frames](const XyzFrame& frame) {
                    EXPECT_EQ(frame.balls.size(), 144U);
                    ++frames;
                    return true;
                });
            } catch (const SceneError&) {
            }
        }
        if (!fs::exists(folder_.path("c"))) return;
        const Checkpoint checkpoint = read_checkpoint(folder_.path("c"));
        const std::optional<RunRecord>& record = checkpoint.run;
        ASSERT_TRUE(record && checkpoint.measures && checkpoint.observer);
        EXPECT_GE(frames, record->next_frame);
        const auto covers = [](const std::string& file, const std::string& whole, std::uint64_t bytes) {
            return file.size() >= bytes && whole.compare(0, bytes, file, 0, bytes) == 0;
        };
        EXPECT_TRUE(covers(folder_.read("b.xyz"), trajectory_, record->trajectory_bytes));
        EXPECT_TRUE(covers(folder_.read("b.csv"), events_, record->events_bytes));
        EXPECT_TRUE(covers(folder_.read("b.obs"), rows_, checkpoint.measures->observables_bytes));
    }

    void expect_end() const {
        EXPECT_EQ(summary_value(folder_.read("b.json"), "state_hash"), hash_);
        EXPECT_TRUE(folder_.read("b.xyz") == trajectory_);
        EXPECT_TRUE(folder_.read("b.csv") == events_);
        EXPECT_TRUE(folder_.read("b.obs") == rows_);
        EXPECT_TRUE(folder_.read("b.str") == structure_);
    }

    void finish() const {
        Words all = words("b");
        if (fs::exists(folder_.path("c"))) all.insert(all.end(), {"--resume", "c"});
        const Result result = folder_.run(all);
        EXPECT_EQ(result.status, 0) << result.err;
        expect_end();
    }

    /// Files that a killed run was writing beside their targets go; nothing else is there that should not be.
    void tidy() const {
        for (const std::string& name : folder_.names()) {
            const bool is_part = name.ends_with(".part");
            const bool is_known = name == "s.json" || name == "c" || name.starts_with("a.") ||
                                  name == "b.xyz" || name == "b.csv" || name == "b.obs" || name == "b.str" ||
                                  name == "b.json";
            EXPECT_TRUE(is_part || is_known) << name;
            if (is_part) fs::remove(folder_.path(name));
        }
    }
    void start_over() const {
        for (const char* const name : {"b.xyz", "b.csv", "b.obs", "b.str", "b.json", "c"})
            fs::remove(folder_.path(name));
    }

 private:
    static Words words(const std::string& name) {
        Words all = {
            "run",          "s.json",        "--quiet",     "--until",     "400",         "--trajectory",
            name + ".xyz",  "--every",       "5",           "--events",    name + ".csv", "--summary",
            name + ".json", "--observables", name + ".obs", "--structure", name + ".str"};
        if (name == "b") all.insert(all.end(), {"--checkpoint", "c", "--checkpoint-every", "1.7"});
        return all;
    }

    Folder folder_;
    double seconds_ = 0;
    std::string trajectory_, events_, rows_, structure_, hash_;
};

TEST(Kill, WhatIsLeftIsWholeAndLeadsToTheSameEnd) {
    constexpr std::uint64_t kSeed = 3;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed);
    std::mt19937_64 random(kSeed);
    KilledRun run;
    int ends = 0;
    for (int kills = 0; kills < wanted_kills() && !testing::Test::HasFailure();) {
        const bool ended = run.start_and_kill(random);
        run.tidy();
        run.expect_whole();
        if (!ended) {
            ++kills;
            continue;
        }
        run.expect_end();
        run.start_over();
        ++ends;
    }
    run.finish();
    RecordProperty("ends", ends);
}

}  // namespace
}  // namespace carom::testing_program
