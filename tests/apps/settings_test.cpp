// The settings that trade accuracy for speed: an option does what the scene's key does.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program.hpp"

namespace carom::testing_program {
namespace {

// Two lossy balls in a walled corner of the plane with an attractor; `keys` are further keys of the scene.
std::string pulled_scene(const std::string& keys) {
    return R"({"domain": {"min": [0, 0], "max": [8, 8], "boundary": ["wall", "wall"], "restitution": 0.9},
        "balls": [{"position": [2, 2], "velocity": [1, 0.3], "restitution": 0.9},
                  {"position": [6, 3], "velocity": [-1, 0.1], "restitution": 0.9}],
        "attractors": [{"position": [4, 4], "strength": 5, "softening": 1}], )" +
           keys + R"("until": 20})";
}

std::string hash_of(const Folder& folder, std::vector<std::string> options) {
    options.insert(options.begin(), {"run", "s.json", "--quiet"});
    return summary_value(folder.run(options).out, "state_hash");
}

TEST(Settings, OptionsDoWhatTheKeysDo) {
    const Folder folder;
    folder.write("s.json", pulled_scene(""));
    const std::string plain = hash_of(folder, {});
    const std::string renewed = hash_of(folder, {"--field-interval", "0.005"});
    const std::string lasting = hash_of(folder, {"--contact-time", "2"});
    const std::string stepped = hash_of(folder, {"--method", "empirical", "--contact-time", "2"});
    EXPECT_NE(renewed, plain);
    EXPECT_NE(lasting, plain);

    folder.write("s.json", pulled_scene("\"field_interval\": 0.005, "));
    EXPECT_EQ(hash_of(folder, {}), renewed);
    EXPECT_EQ(hash_of(folder, {"--field-interval", "0.02"}), plain);  // the option goes before the key
    folder.write("s.json", pulled_scene("\"contact_time\": 2, "));
    EXPECT_EQ(hash_of(folder, {}), lasting);
    EXPECT_EQ(hash_of(folder, {"--method", "empirical"}), stepped);
}

TEST(Settings, WrongOnesAreOneLine) {
    const Folder folder;
    folder.write("s.json", pulled_scene(""));
    folder.write("free.json", R"({"balls": [{"position": [0, 0]}], "until": 1})");
    expect_one_error(folder.run({"run", "s.json", "--field-interval", "0"}), 2, "--field-interval");
    expect_one_error(folder.run({"run", "s.json", "--contact-time", "-1"}), 2, "--contact-time");
    expect_one_error(folder.run({"run", "free.json", "--field-interval", "1"}), 2, "scenes with attractors");
}

}  // namespace
}  // namespace carom::testing_program
