// Every file in broken_scenes/ is refused with the one line that stands here for it.
#include <carom/io/scene_file.hpp>

#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace carom {
namespace {

namespace fs = std::filesystem;

const fs::path broken_scenes_folder = fs::path(CAROM_SOURCE_DIR) / "tests/io/broken_scenes";

// "{folder}" stands for the folder's path.
const std::map<std::string, std::string> messages = {
    {"attractor_softening", R"(attractors[0].softening: must be >= 0, is -1)"},
    {"attractor_strenght", R"(attractors[0].strenght: unknown key, did you mean "strength"?)"},
    {"ball_mass_overflows", R"(line 2, column 46: number overflow parsing '1e999')"},
    {"ball_misses_position", R"(balls[0].position: is required)"},
    {"ball_misspelt_radius", R"(balls[1].raduis: unknown key, did you mean "radius"?)"},
    {"ball_negative_radius", R"(balls[0].radius: must be > 0, is -1)"},
    {"ball_not_an_object", R"(balls[0]: must be an object, is an array)"},
    {"ball_outside_walls",
     R"(balls[0].position: must lie a radius (0.5) or more inside the walled sides, x from 0 to 10, is [9.75, 5])"},
    {"ball_position_of_three", R"(balls[0].position: must be an array of two numbers, has 3)"},
    {"ball_position_of_words", R"(balls[0].position[1]: must be a number, is a string)"},
    {"ball_restitution_above_one", R"(balls[0].restitution: must lie in [0, 1], is 1.5)"},
    {"ball_static_and_moving", R"(balls[0].velocity: must be [0, 0] for a static ball, is [1, 0])"},
    {"ball_static_is_a_number", R"(balls[0].static: must be true or false, is a number)"},
    {"ball_twice_mass", R"(balls[0].mass: is given twice)"},
    {"balls_are_a_number", R"(balls: must be an array of objects, is a number)"},
    {"boundary_of_one",
     R"(domain.boundary: must be an array of two words, one for x and one for y, is an array of 1)"},
    {"boundary_unknown", R"(domain.boundary[1]: must be one of "wall", "periodic", "open", is "mirror")"},
    {"comma_missing",
     R"(line 3, column 9: syntax error while parsing object - unexpected string literal; expected '}' (is a comma missing before it?))"},
    {"comma_too_many",
     R"(line 5, column 5: syntax error while parsing value - unexpected ']'; expected '[', '{', or a literal (is there a comma too many before it?))"},
    {"comment",
     R"(line 2, column 14: syntax error while parsing value - invalid literal; last read: '"balls": [ /' (JSON has no comments))"},
    {"deep", R"(balls[0][0][0][0][0][0][0][0][0]: is nested too deeply)"},
    {"domain_inside_out",
     R"(domain.max: must be greater than min on both axes, is [0, 10] with min [10, 0])"},
    {"empty", R"(the scene is empty)"},
    {"ends_early",
     R"(line 2, column 1: syntax error while parsing array - unexpected end of input; expected ']')"},
    {"fill_count_fractional", R"(fill[0].count: must be a whole number, is 10.5)"},
    {"fill_count_huge",
     R"(fill[0].count: must be at most 100000000 (a ball takes some hundred bytes), is 1000000000000)"},
    {"fill_count_negative", R"(fill[0].count: must be >= 0, is -10)"},
    {"fill_count_zero", R"(fill[0].count: must be at least 1, is 0)"},
    {"fill_mass_and_density", R"(fill[0].density: must not stand beside mass: give one of the two)"},
    {"fill_nowhere", R"(fill[0].region: is required where the scene has no domain)"},
    {"fill_of_nothing", R"(fill[0]: must have a count or a packing_fraction)"},
    {"fill_radius_backwards", R"(fill[0].radius.min: must be at most max (1), is 2)"},
    {"fill_radius_word", R"(fill[0].radius: must be a number or an object with min and max, is a string)"},
    {"fill_region_without_max", R"(fill[0].region.max: is required)"},
    {"fill_too_dense",
     R"(fill[0].packing_fraction: must be > 0 and at most 0.9069 (pi / (2 sqrt 3), the limit for equal discs), is 0.95)"},
    {"fill_too_many",
     R"(fill[0].count: is too many: the balls would cover 1.5707963267948966 of the region's area, the limit for equal discs is 0.9069)"},
    {"gravity_a_word", R"(gravity: must be an array of two numbers, is a string)"},
    {"gravity_nan",
     R"(line 1, column 17: syntax error while parsing value - invalid literal; last read: '0, N')"},
    {"gravity_null", R"(gravity: must be an array of two numbers, is null)"},
    {"interval_zero", R"(field_interval: must be > 0, is 0)"},
    {"key_cut_within_a_letter",
     "attractors[0].aééééééééééééééééééééééééééééé...: unknown key, known are position, strength, softening"},
    {"key_over_two_lines",
     R"(bad?key: unknown key, known are name, domain, gravity, restitution_rule, contact_time, speed_factor, balls, fill, balls_file, walls, attractors, field_interval, sensors, precision, allow_overlap, method, step, tolerance, max_travel, until, description, $schema)"},
    {"key_unlike_all",
     R"(temperature_of_the_sun: unknown key, known are name, domain, gravity, restitution_rule, contact_time, speed_factor, balls, fill, balls_file, walls, attractors, field_interval, sensors, precision, allow_overlap, method, step, tolerance, max_travel, until, description, $schema)"},
    {"list", R"(a scene must be a JSON object, is an array)"},
    {"mask_too_large", R"(balls[0].mask: must be below 2^32, is 4294967296)"},
    {"no_balls", R"(balls: some balls are required: give balls, fill or balls_file)"},
    {"no_until", R"(until: is required: the time at which the simulation ends)"},
    {"rule_unknown",
     R"(restitution_rule: must be one of "min", "max", "product", "mean", "geometric", is "median")"},
    {"seed_negative", R"(fill[0].seed: must be >= 0, is -1)"},
    {"sensor_corners_a_number", R"(sensors[0].corners: must be an array of points, is a number)"},
    {"sensor_not_convex",
     R"(sensors[0].corners: must go once around a convex polygon, no three of them on one line)"},
    {"speed_factor_zero", R"(speed_factor: must be > 0 and at most 1, is 0)"},
    {"trailing_text",
     R"(line 1, column 47: syntax error while parsing value - invalid literal; last read: '1} x'; expected end of input)"},
    {"until_negative", R"(until: must be >= 0, is -1)"},
    {"until_twice", R"(until: is given twice)"},
    {"wall_of_no_length", R"(walls[0]: must have a length, from and to are both [1, 1])"},
    {"balls_file_is_a_folder", "balls_file: {folder}/..: cannot be read: Is a directory"},
    {"balls_file_missing", "balls_file: {folder}/nowhere.xyz: cannot be read: No such file or directory"},
};

TEST(BrokenScenes, AreEachRefusedWithTheirLine) {
    std::size_t seen = 0;
    for (const auto& [name, pattern] : messages) {
        SCOPED_TRACE(name);
        std::string expected = pattern;
        if (const auto mark = expected.find("{folder}"); mark != std::string::npos)
            expected.replace(mark, 8, broken_scenes_folder.string());
        try {
            (void)read_scene(broken_scenes_folder / (name + ".json"));
            ADD_FAILURE() << "accepted";
        } catch (const SceneError& error) {
            EXPECT_EQ(error.what(), expected);
            EXPECT_TRUE(expected.starts_with(error.place()));
        }
        ++seen;
    }
    EXPECT_GE(seen, 24U);
}

TEST(BrokenScenes, AllHaveALine) {
    for (const fs::directory_entry& entry : fs::directory_iterator(broken_scenes_folder)) {
        if (entry.path().extension() != ".json") continue;
        EXPECT_TRUE(messages.contains(entry.path().stem().string())) << entry.path();
    }
}

TEST(BrokenScenes, MissingFileAndFolderAreNamedWithTheReason) {
    const auto message = [](const fs::path& path) -> std::string {
        try {
            (void)read_scene(path);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "accepted";
    };
    const fs::path missing = broken_scenes_folder / "missing.json";
    EXPECT_EQ(message(missing), missing.string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(message(broken_scenes_folder),
              broken_scenes_folder.string() + ": cannot be read: Is a directory");
}

}  // namespace
}  // namespace carom
