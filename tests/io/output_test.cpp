// What a run leaves behind: the summary, the list of events, and files that are whole or absent.
#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <carom/io/atomic_file.hpp>
#include <carom/io/events_csv.hpp>
#include <carom/io/summary.hpp>

#include "random_values.hpp"
#include "temporary_folder.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

std::string reason_of(const fs::path& path) {
    try {
        write_file(path, "text");
    } catch (const FileError& error) {
        return error.what();
    }
    return "written";
}

TEST(Summary, HasItsKeysInOrder) {
    const auto json = nlohmann::ordered_json::parse(to_json(Summary{}));
    std::vector<std::string> keys;
    for (auto member = json.begin(); member != json.end(); ++member) keys.push_back(member.key());
    EXPECT_THAT(keys,
                testing::ElementsAre("scene", "method", "precision", "threads", "balls", "walls", "time",
                                     "ball_collisions", "wall_collisions", "events", "wall_seconds",
                                     "collisions_per_second", "energy_initial", "energy_final",
                                     "energy_relative_change", "momentum_initial", "momentum_final",
                                     "max_overlap", "compressibility_factor", "windows", "window_retries",
                                     "steps", "missed_collisions", "peak_memory_bytes", "state_hash"));
}

TEST(Summary, NumbersReadBackBitForBit) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        testing_values::Generator generator(seed);
        Summary summary;
        summary.energy_final = testing_values::any_finite(generator);
        summary.momentum_final = {testing_values::any_finite(generator),
                                  testing_values::any_finite(generator)};
        summary.compressibility_factor = testing_values::any_finite(generator);
        summary.events = generator();
        summary.state_hash = generator();
        const auto json = nlohmann::json::parse(to_json(summary));
        EXPECT_TRUE(testing_values::same_bits(json["energy_final"].get<double>(), summary.energy_final));
        EXPECT_TRUE(
            testing_values::same_bits(json["momentum_final"][0].get<double>(), summary.momentum_final.x()));
        EXPECT_TRUE(
            testing_values::same_bits(json["momentum_final"][1].get<double>(), summary.momentum_final.y()));
        EXPECT_TRUE(testing_values::same_bits(json["compressibility_factor"].get<double>(),
                                              *summary.compressibility_factor));
        EXPECT_EQ(json["events"].get<std::uint64_t>(), summary.events);
        const std::string hash = json["state_hash"];
        EXPECT_EQ(hash.size(), 16U);
        EXPECT_EQ(std::stoull(hash, nullptr, 16), summary.state_hash);
    }
}

TEST(Summary, WhatIsNoNumberIsNull) {
    Summary summary;
    summary.collisions_per_second = std::numeric_limits<double>::infinity();
    summary.energy_relative_change = std::numeric_limits<double>::quiet_NaN();
    summary.scene = "quote \" and broken UTF-8 \xff";
    summary.state_hash = 0xab;
    const auto json = nlohmann::json::parse(to_json(summary));
    EXPECT_TRUE(json["collisions_per_second"].is_null());
    EXPECT_TRUE(json["energy_relative_change"].is_null());
    EXPECT_TRUE(json["compressibility_factor"].is_null());
    EXPECT_EQ(json["state_hash"], "00000000000000ab");
    EXPECT_EQ(json["scene"].get<std::string>().substr(0, 24), "quote \" and broken UTF-8");
}

TEST(EventsCsv, HasItsHeaderAndLines) {
    const TemporaryFolder folder;
    const fs::path path = folder / "events.csv";
    EventsCsv events(path);
    events.write({0.5, EventsCsv::Kind::kBall, 3, 7, {1, 2}, {0.6, 0.8}, 1.25});
    events.write({0.1 + 0.2, EventsCsv::Kind::kWall, 4, 0, {-1, 0}, {-1, 0}, 1e-300});
    EXPECT_FALSE(fs::exists(path));
    events.commit();
    EXPECT_EQ(content_of(path),
              "time,kind,i,j,x,y,nx,ny,impulse\n"
              "0.5,ball,3,7,1,2,0.6,0.8,1.25\n"
              "0.30000000000000004,wall,4,0,-1,0,-1,0,1e-300\n");
}

TEST(EventsCsv, ManyRowsReadBackBitForBit) {
    const TemporaryFolder folder;
    constexpr std::size_t kRows = 30000;  // more than the buffer holds
    testing_values::Generator generator(1);
    EventsCsv events(folder / "events.csv");
    std::vector<double> times;
    for (std::size_t i = 0; i < kRows; ++i) {
        times.push_back(testing_values::any_finite(generator));
        events.write({times.back(),
                      EventsCsv::Kind::kBall,
                      static_cast<std::uint32_t>(i),
                      0,
                      {1, 2},
                      {1, 0},
                      1.0 / 3});
    }
    events.commit();
    std::istringstream lines(content_of(folder / "events.csv"));
    std::string line;
    std::getline(lines, line);
    for (std::size_t i = 0; i < kRows; ++i) {
        ASSERT_TRUE(std::getline(lines, line));
        ASSERT_TRUE(testing_values::same_bits(std::strtod(line.c_str(), nullptr), times[i])) << line;
        ASSERT_NE(line.find(fmt::format(",ball,{},0,1,2,1,0,0.3333333333333333", i)), std::string::npos)
            << line;
    }
    EXPECT_FALSE(std::getline(lines, line));
}

TEST(AtomicFile, AppearsWithCommitAndReplacesTheOldOne) {
    const TemporaryFolder folder;
    const fs::path path = folder / "out.txt";
    put_file(path, "old");
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
    AtomicFile file(path);
    file.write("new ");
    file.write("text");
    EXPECT_EQ(content_of(path), "old");
    file.commit();
    EXPECT_EQ(content_of(path), "new text");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(folder.file_count(), 1U);
    EXPECT_THROW(file.write("more"), FileError);
}

TEST(AtomicFile, LeavesNothingBehindWithoutACommit) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder / "out.txt");
        file.write("half");
        const AtomicFile moved = std::move(file);
        EXPECT_EQ(folder.file_count(), 1U);
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

TEST(AtomicFile, NamesPathAndReason) {
    const TemporaryFolder folder;
    const fs::path lost = folder / "no/such/out.txt";
    EXPECT_EQ(reason_of(lost), lost.string() + ": cannot be written: No such file or directory");
    EXPECT_EQ(reason_of(folder.path()), folder.path().string() + ": cannot be written: is a directory");
    // A full disk is found out by write; nothing was renamed and the device is still there.
    EXPECT_EQ(reason_of("/dev/full"), "/dev/full: cannot be written: No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(AtomicFile, WritesThroughALinkAndIntoADevice) {
    const TemporaryFolder folder;
    put_file(folder / "real.txt", "old");
    fs::create_symlink("real.txt", folder / "link.txt");
    write_file(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(content_of(folder / "real.txt"), "new");
    EXPECT_EQ(reason_of("/dev/null"), "written");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

// With the folder gone between opening and renaming, commit must fail and say so.
TEST(AtomicFile, ReportsAFailedRename) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    AtomicFile file(folder / "sub/out.txt");
    file.write("text");
    fs::remove_all(folder / "sub");
    EXPECT_THROW(file.commit(), FileError);
    EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace carom
