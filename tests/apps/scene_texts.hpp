// Scenes for the tests of the program, as the text of their files.
#pragma once

#include <cmath>
#include <random>
#include <sstream>
#include <string>

namespace carom::testing_program {

// One ball between two walls: from x = 5 at speed 3, hits at 1.5, 4.5, 7.5.
inline constexpr const char* kOneBall = R"({
    "name": "one ball",
    "domain": {"min": [0, 0], "max": [10, 10], "boundary": ["wall", "wall"]},
    "balls": [{"position": [5, 5], "velocity": [3, 0], "radius": 0.5, "mass": 2}],
    "until": 9 })";

// A scene's text with more keys, each ending in a comma.
inline std::string with_keys(std::string scene, const std::string& keys) {
    return scene.insert(scene.find("\"until\""), keys);
}

// Balls on a lattice with random velocities, a static one, a slanted wall, gravity.
inline std::string busy_scene(const std::string& boundary) {
    std::mt19937_64 random(5);
    const auto uniform = [&] { return std::ldexp(double(random() >> 11U), -52) - 1; };
    std::ostringstream text;
    text.precision(17);
    text
        << R"({"name": "busy", "gravity": [0, -0.5], "domain": {"min": [0, 0], "max": [24, 24], "boundary": [")"
        << boundary << R"(", "wall"]}, "walls": [{"from": [8.2, 8.2], "to": [9.8, 8.3]}], "balls": [)";
    for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 12; ++j) {
            text << (i + j > 0 ? ",\n" : "") << "{\"position\": [" << 2 * i + 1 << ", " << 2 * j + 1
                 << "], \"radius\": 0.6, ";
            if (i == 6 && j == 6) {
                text << "\"static\": true}";
            } else {
                text << "\"velocity\": [" << uniform() << ", " << uniform() << "]}";
            }
        }
    }
    text << R"(], "until": 15})";
    return text.str();
}

}  // namespace carom::testing_program
