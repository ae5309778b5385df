// Trajectories in other formats, through the program: read back by other people's readers, gone on with after
// kills, refused where they do not fit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "program.hpp"
#include "scene_texts.hpp"

#ifdef CAROM_TEST_HDF5
#include <hdf5.h>
#endif

namespace carom::testing_program {
namespace {

using Words = std::vector<std::string>;

Words run_words(const std::string& trajectory, const std::string& until = "15") {
    return {"run", "s.json", "--quiet", "--trajectory", trajectory, "--every", "1", "--until", until};
}

#ifdef CAROM_TEST_HDF5
constexpr bool kHasHdf5 = true;
#else
constexpr bool kHasHdf5 = false;
#endif

class ReadBack : public testing::TestWithParam<const char*> {};

// Debian's python, whatever other stands first in the path: it has Debian's h5py and ASE.
TEST_P(ReadBack, ByOtherReaders) {
    const std::string mode = GetParam();
    if (mode == "h5md" && !kHasHdf5) GTEST_SKIP() << "this build has no HDF5";
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    for (const std::string name : {"a.xyz", "a.h5", "a.lammpstrj"}) {
        if (name == "a.h5" && !kHasHdf5) continue;
        const Result result = folder.run(run_words(name));
        ASSERT_EQ(result.status, 0) << result.err;
    }
    const Result read = folder.run_shell(
        "LD_PRELOAD= /usr/bin/python3 " CAROM_SOURCE_DIR "/tests/apps/read_back.py \"$0\" . " + mode);
    if (read.status == 77 || read.status == 127)
        GTEST_SKIP() << "python3-h5py and python3-ase are needed to read it back: " << read.out;
    EXPECT_EQ(read.status, 0) << read.err;
    EXPECT_EQ(read.out, mode == "data" ? "9\n" : "16\n");
}

INSTANTIATE_TEST_SUITE_P(Formats, ReadBack, testing::Values("h5md", "dump", "data"),
                         [](const auto& param) { return std::string(param.param); });

TEST(TrajectoryFormats, LammpsDumpIsGoneOnWith) {
    const Folder folder;
    folder.write("s.json", busy_scene("wall"));
    ASSERT_EQ(folder.run(run_words("a.dump")).status, 0);
    Words first = run_words("b.dump", "6.5");
    first.insert(first.end(), {"--checkpoint", "c"});
    ASSERT_EQ(folder.run(first).status, 0);
    Words second = run_words("b.dump");
    second.insert(second.end(), {"--resume", "c"});
    const Result result = folder.run(second);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(folder.read("a.dump") == folder.read("b.dump"));
}

TEST(TrajectoryFormats, UnknownOnesAreRefused) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    expect_one_error(folder.run(run_words("a.gro")), 2, "unknown format '.gro'");
    expect_one_error(folder.run(run_words("no/a.lammpstrj")), 1, "no/a.lammpstrj");
    if (!kHasHdf5) {
        expect_one_error(folder.run(run_words("a.h5")), 2, "HDF5 was not there");
        return;
    }
    expect_one_error(folder.run(run_words("no/a.h5")), 1, "no/a.h5");
    std::filesystem::create_directory(folder.path("d.h5"));
    expect_one_error(folder.run(run_words("d.h5")), 1, "d.h5");
}

#ifdef CAROM_TEST_HDF5

struct Frames {
    std::vector<double> times;
    std::vector<double> positions;
};

/// As a reader beside a writer, which a killed one seems to be. Empty where there is no file yet.
Frames read_frames(const std::string& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    Frames frames;
    if (!std::filesystem::exists(path)) return frames;
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, H5P_DEFAULT);
    EXPECT_GE(file, 0) << "cannot be read";
    if (file < 0) return frames;
    const auto read = [file](const char* name, std::size_t count, std::vector<double>& out) {
        const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
        const hid_t space = H5Dget_space(set);
        hsize_t size[3] = {0, 0, 0};
        H5Sget_simple_extent_dims(space, size, nullptr);
        const std::size_t whole = size[1] > 0 ? size[1] * size[2] : 1;
        EXPECT_GE(size[0], count);
        out.resize(size[0] * whole);
        EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), 0) << name;
        H5Sclose(space);
        H5Dclose(set);
        return size[0] * whole;
    };
    const std::size_t count = read("/particles/discs/position/time", 0, frames.times);
    (void)read("/particles/discs/position/value", count, frames.positions);
    frames.positions.resize(count * 288);  // more are of a frame that was not ended
    H5Fclose(file);
    return frames;
}

bool begins_with(const std::vector<double>& whole, const std::vector<double>& part) {
    return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

// Killed at any moment, the file can be read up to its last frame and gone on with to the same frames.
TEST(TrajectoryFormats, H5mdSurvivesKills) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const auto words = [](const std::string& name) {
        return Words{"run", "s.json", "--quiet", "--trajectory", name, "--every", "0.25", "--until", "150"};
    };
    ASSERT_EQ(folder.run(words("a.h5")).status, 0);
    const Frames whole = read_frames(folder.path("a.h5"));
    ASSERT_EQ(whole.times.size(), 601U);
    std::mt19937_64 random(8);
    int kills = 0;
    for (int tries = 0; tries < 40 && !HasFailure(); ++tries) {
        Words all = words("b.h5");
        all.insert(all.end(), {"--checkpoint", "c", "--checkpoint-every", "3"});
        if (std::filesystem::exists(folder.path("c"))) all.insert(all.end(), {"--resume", "c"});
        const pid_t process = folder.start(all);
        usleep(static_cast<useconds_t>(10'000 + random() % 150'000));  // once it has begun
        kill(process, SIGKILL);
        const Result result = folder.finish(process);
        ASSERT_TRUE(result.status == 0 || result.status == 128 + SIGKILL) << result.err;
        const Frames left = read_frames(folder.path("b.h5"));
        EXPECT_TRUE(begins_with(whole.times, left.times));
        EXPECT_TRUE(begins_with(whole.positions, left.positions));
        if (result.status != 0) {
            ++kills;
            continue;
        }
        EXPECT_EQ(left.times, whole.times);
        for (const char* const name : {"b.h5", "c"}) std::filesystem::remove(folder.path(name));
    }
    EXPECT_GE(kills, 10);
}

TEST(TrajectoryFormats, H5mdThatDoesNotFitIsNotGoneOnWith) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const auto begin = [&](const std::string& trajectory, const std::string& checkpoint) {
        Words words = run_words(trajectory, "5");
        words.insert(words.end(), {"--checkpoint", checkpoint});
        ASSERT_EQ(folder.run(words).status, 0);
    };
    const auto expect_refused = [&](const std::string& trajectory, const std::string& checkpoint,
                                    const std::string& message) {
        Words words = run_words(trajectory);
        words.insert(words.end(), {"--resume", checkpoint});
        expect_one_error(folder.run(words), 1, message);
    };
    begin("a.h5", "h");
    begin("a.xyz", "x");
    expect_refused("a.h5", "x", "the checkpoint's trajectory is text");
    expect_refused("a.xyz", "h", "cannot be gone on with");
    expect_refused("none.h5", "h", "is not there");
    folder.write("text.h5", "no HDF5");
    expect_refused("text.h5", "h", "no HDF5 file");
    ASSERT_EQ(folder.run(run_words("short.h5", "2")).status, 0);
    expect_refused("short.h5", "h", "fewer frames");
}

#endif

}  // namespace
}  // namespace carom::testing_program
