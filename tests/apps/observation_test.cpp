// Measures of a run from outside: the program's files and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.hpp"
#include "scene_texts.hpp"

namespace carom::testing_program {
namespace {

std::vector<std::vector<std::string>> rows_of(const std::string& text) {
    std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
    for (const char c : text) {
        if (c == '\n')
            rows.emplace_back(1);
        else if (c == ',')
            rows.back().emplace_back();
        else
            rows.back().back() += c;
    }
    rows.pop_back();
    return rows;
}

// One ball to and fro between two walls 9 apart for its centre: hits on the right at 1.5 and 7.5, on the left
// at 4.5, of 2 m v = 12 on sides of length 10.
TEST(Observation, RowsAreWhatOneBallDoes) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const Result result = folder.run({"run", "s.json", "--quiet", "--observables", "o.csv", "--every", "4"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto rows = rows_of(folder.read("o.csv"));
    ASSERT_EQ(rows.size(), 5U);  // the header, 0, 4, 8, 9
    const auto value = [&](std::size_t row, const std::string& name) {
        const auto column = std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
        return rows[row].at(static_cast<std::size_t>(column));
    };
    EXPECT_EQ(value(1, "time"), "0");
    EXPECT_EQ(value(4, "time"), "9");
    EXPECT_EQ(value(1, "pressure_right"), "");
    EXPECT_EQ(value(2, "pressure_right"), "0.3");  // 12 / (10 * 4)
    EXPECT_EQ(value(2, "pressure_left"), "0");
    EXPECT_EQ(value(3, "pressure_left"), "0.3");
    EXPECT_EQ(value(3, "pressure_right"), "0.3");
    EXPECT_EQ(value(3, "pressure"), "");
    EXPECT_EQ(value(3, "wall_collision_rate"), "0.5");
    EXPECT_EQ(value(3, "kinetic_energy"), "9");
    EXPECT_EQ(value(3, "temperature"), "9");
}

TEST(Observation, ChangesNoBitOfTheRun) {
    const Folder folder;
    folder.write("s.json", busy_scene("periodic"));
    const Result plain = folder.run({"run", "s.json", "--quiet"});
    const Result watched = folder.run({"run", "s.json", "--quiet", "--observables", "o.csv", "--structure",
                                       "s.out", "--every", "0.3", "--events", "e.csv"});
    ASSERT_EQ(watched.status, 0) << watched.err;
    for (const char* const key : {"state_hash", "ball_collisions", "energy_final"})
        EXPECT_EQ(summary_value(plain.out, key), summary_value(watched.out, key));
    const auto json = nlohmann::json::parse(folder.read("s.out"));
    EXPECT_EQ(json["samples"], 51);
    EXPECT_EQ(json["last_time"], 15);
    EXPECT_EQ(json["density_x"]["x"].size(), json["density_x"]["density"].size());
    EXPECT_EQ(json["mean_square_displacement"]["value"][0], 0);
}

TEST(Observation, WhatDoesNotFitIsOneLine) {
    const Folder folder;
    folder.write("s.json", kOneBall);
    const auto expect_refused = [&](std::vector<std::string> words, int status, const std::string& message) {
        words.insert(words.begin(), {"run", "s.json"});
        expect_one_error(folder.run(words), status, message);
    };
    expect_refused({"--every", "1"}, 2, "--every requires --trajectory, --observables or --structure");
    expect_refused({"--observables", "o.csv"}, 2, "--observables requires --every");
    expect_refused({"--structure", "o.json"}, 2, "--structure requires --every");
    expect_refused({"--observables", "o.csv", "--every", "1", "--average-from", "1"}, 2,
                   "--average-from requires --structure");
    expect_refused({"--observables", "o", "--structure", "o", "--every", "1"}, 2, "the same file");
    expect_refused({"--observables", "no/o.csv", "--every", "1"}, 1, "no/o.csv");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"s.json"});
}

}  // namespace
}  // namespace carom::testing_program
