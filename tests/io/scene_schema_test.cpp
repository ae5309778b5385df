// The schema and the reader agree: on every scene of scenes/, and on small cases wherever a schema can say
// the rule.
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include <carom/io/scene_file.hpp>

#include "temporary_folder.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class SceneSchema : public testing::Test {
 protected:
    SceneSchema() {
        const fs::path path = fs::path(CAROM_SOURCE_DIR) / "schemas/scene.schema.json";
        const Json text = Json::parse(content_of(path));
        valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
        parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(text), schema_);
    }

    [[nodiscard]] bool schema_accepts(const std::string& scene) const {
        const Json json = Json::parse(scene);
        valijson::Validator validator;
        return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(json), nullptr);
    }

 private:
    valijson::Schema schema_;
};

bool reader_accepts(const std::string& scene) {
    try {
        (void)parse_scene(scene);
        return true;
    } catch (const SceneError&) {
        return false;
    }
}

TEST_F(SceneSchema, AcceptsEveryShippedScene) {
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(CAROM_SOURCE_DIR) / "scenes")) {
        if (entry.path().extension() != ".json") continue;
        EXPECT_TRUE(schema_accepts(content_of(entry.path()))) << entry.path();
    }
}

using Cases = std::vector<std::pair<bool, std::string>>;  // is it right? and the members

const Cases whole = {
    {true, R"("balls": [{"position": [0, 0]}], "until": 1)"},
    {false, R"("balls": [{"position": [0, 0]}])"},
    {false, R"("until": 1)"},
    {false, R"("until": "soon", "balls": [{"position": [0, 0]}])"},
    {false, R"("until": -1, "balls": [{"position": [0, 0]}])"},
    {true, R"("until": 0, "balls": [{"position": [0, 0]}])"},
};
const Cases beside_balls_and_until = {
    {true, R"("name": "x", "description": "y", "$schema": "z")"},
    {false, R"("name": 1)"},
    {false, R"("colour": "red")"},
    {true, R"("gravity": [0, -9.81])"},
    {false, R"("gravity": -9.81)"},
    {false, R"("gravity": [0, -9.81, 0])"},
    {false, R"("gravity": [0, null])"},
    {true, R"("restitution_rule": "mean")"},
    {false, R"("restitution_rule": "Mean")"},
    {true, R"("contact_time": 0)"},
    {false, R"("contact_time": -1)"},
    {false, R"("contact_time": null)"},
    {true, R"("speed_factor": 1)"},
    {false, R"("speed_factor": 0)"},
    {false, R"("speed_factor": 1.5)"},
    {true, R"("precision": "float")"},
    {false, R"("precision": "half")"},
    {true, R"("method": "empirical")"},
    {false, R"("method": "euler")"},
    {true, R"("step": 0.01)"},
    {false, R"("step": 0)"},
    {true, R"("tolerance": 1e-9)"},
    {false, R"("tolerance": 0)"},
    {true, R"("step": 1, "max_travel": 0)"},
    {false, R"("max_travel": -0.1)"},
    {true, R"("allow_overlap": true)"},
    {false, R"("allow_overlap": 1)"},
    {true, R"("field_interval": 0.5)"},
    {false, R"("field_interval": 0)"},
    {true, R"("domain": {"min": [-9, -9], "max": [9, 9]})"},
    {true,
     R"("domain": {"min": [-9, -9], "max": [9, 9], "boundary": ["open", "periodic"], "restitution": 0})"},
    {false, R"("domain": {"min": [-9, -9]})"},
    {false, R"("domain": {"min": [-9, -9], "max": [9, 9], "boundary": "wall"})"},
    {false, R"("domain": {"min": [-9, -9], "max": [9, 9], "boundary": ["wall", "glass"]})"},
    {false, R"("domain": {"min": [-9, -9], "max": [9, 9], "restitution": 2})"},
    {false, R"("domain": null)"},
    {true, R"("walls": [{"from": [3, 3], "to": [4, 4], "restitution": 0.5}])"},
    {true,
     R"("sensors": [{"corners": [[3, 3]], "radius": 1}, {"corners": [[1, 1], [2, 1], [2, 2]], "mask": 2}])"},
    {false, R"("sensors": [{"corners": []}])"},
    {false, R"("sensors": [{"corners": [3, 3]}])"},
    {false, R"("sensors": [{"corners": [[3, 3]], "radius": -1}])"},
    {false, R"("sensors": [{"corners": [[3, 3]], "restitution": 1}])"},
    {false, R"("sensors": [{"radius": 1}])"},
    {false, R"("walls": [{"from": [3, 3]}])"},
    {false, R"("walls": [{"from": [3, 3], "to": [4, 4], "thickness": 1}])"},
    {false, R"("walls": [{"from": [3, 3], "to": 4}])"},
    {true, R"("attractors": [{"position": [3, 3], "strength": -1}])"},
    {false, R"("attractors": [{"position": [3, 3]}])"},
    {false, R"("attractors": [{"position": [3, 3], "strength": 1, "softening": -1}])"},
};
const Cases beside_until = {
    {false, R"("balls": [])"},
    {false, R"("fill": [])"},
    {true, R"("balls": [], "fill": [{"count": 1, "region": {"min": [0, 0], "max": [9, 9]}}])"},
    {true,
     R"("balls": [{"position": [0, 0], "velocity": [1, 2], "acceleration": [0, 1], "radius": 1, "mass": 2,
                   "restitution": 0, "static": false}])"},
    {false, R"("balls": [{}])"},
    {false, R"("balls": [{"position": [0, 0], "radius": 0}])"},
    {false, R"("balls": [{"position": [0, 0], "radius": "1"}])"},
    {false, R"("balls": [{"position": [0, 0], "mass": -1}])"},
    {false, R"("balls": [{"position": [0, 0], "restitution": 1.1}])"},
    {false, R"("balls": [{"position": [0, 0], "static": 0}])"},
    {false, R"("balls": [{"position": [0, 0], "color": "red"}])"},
    {false, R"("balls": {"position": [0, 0]})"},
    {false, R"("balls_file": "")"},
    {false, R"("balls_file": 7)"},
};
const Cases fills = {
    {true, R"("count": 3)"},
    {true, R"("count": 3.0)"},
    {true, R"("count": 1e2)"},
    {true, R"("packing_fraction": 0.5)"},
    {true, R"("count": 3, "packing_fraction": 0.5)"},
    {true, R"("count": 3, "radius": 0.25)"},
    {true, R"("count": 3, "radius": {"min": 0.25, "max": 0.5})"},
    {true, R"("count": 3, "mass": 2, "restitution": 0.5, "temperature": 4, "seed": 0)"},
    {true, R"("count": 3, "density": 2)"},
    {true, R"("count": 3, "seed": 12345678901234567)"},
    {false, R"("radius": 1)"},
    {false, R"("count": 0)"},
    {false, R"("count": -3)"},
    {false, R"("count": 3.5)"},
    {false, R"("count": "3")"},
    {false, R"("count": 100000001)"},
    {false, R"("packing_fraction": 0)"},
    {false, R"("packing_fraction": 0.907)"},
    {false, R"("count": 3, "radius": 0)"},
    {false, R"("count": 3, "radius": [1, 2])"},
    {false, R"("count": 3, "radius": {"min": 0.25})"},
    {false, R"("count": 3, "radius": {"min": 0.25, "max": 0.5, "mean": 0.3})"},
    {false, R"("count": 3, "radius": {"min": 0, "max": 0.5})"},
    {false, R"("count": 3, "mass": 2, "density": 2)"},
    {false, R"("count": 3, "mass": 0)"},
    {false, R"("count": 3, "temperature": -1)"},
    {false, R"("count": 3, "seed": -1)"},
    {false, R"("count": 3, "seed": 0.5)"},
    {false, R"("count": 3, "velocity": [1, 0])"},
};

TEST_F(SceneSchema, AgreesWithTheReader) {
    const auto compare = [&](const Cases& cases, std::string_view frame) {
        for (const auto& [sound, members] : cases) {
            const std::string scene = fmt::format(fmt::runtime(frame), members);
            EXPECT_EQ(schema_accepts(scene), sound) << scene;
            EXPECT_EQ(reader_accepts(scene), sound) << scene;
        }
    };
    compare(whole, "{{{}}}");
    compare(beside_balls_and_until, R"({{{}, "balls": [{{"position": [0, 0]}}], "until": 1}})");
    compare(beside_until, R"({{{}, "until": 1}})");
    compare(fills, R"({{"until": 1, "fill": [{{"region": {{"min": [0, 0], "max": [50, 50]}}, {}}}]}})");
}

}  // namespace
}  // namespace carom
