// What no engine could simulate in doubles is refused, with the place and a reason; nothing hangs.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <carom/parallel/world.hpp>

#include "accuracy/systems.hpp"

namespace carom::test {
namespace {

using accuracy::ball_at;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Scene sound() {
    Scene s;
    s.domain = Domain{{{-10, -10}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls = {ball_at(0, 0, 1, 0), ball_at(3, 0, 0, 0)};
    s.walls = {{{-5, 5}, {5, 5}, 1}};
    s.attractors = {{{0, -9}, 1, 1}};
    return s;
}

TEST(RefusedScenes, NumbersThatAreNoneOrOutOfRange) {
    struct Field {
        std::string place;
        std::function<double&(Scene&)> of;
    };
    const std::vector<Field> fields = {
        {"balls[1].position", [](Scene& s) -> double& { return s.balls[1].position.y(); }},
        {"balls[1].velocity", [](Scene& s) -> double& { return s.balls[1].velocity.x(); }},
        {"balls[1].acceleration", [](Scene& s) -> double& { return s.balls[1].acceleration.x(); }},
        {"balls[1].radius", [](Scene& s) -> double& { return s.balls[1].radius; }},
        {"balls[1].mass", [](Scene& s) -> double& { return s.balls[1].mass; }},
        {"balls[1].restitution", [](Scene& s) -> double& { return s.balls[1].restitution; }},
        {"walls[0].from", [](Scene& s) -> double& { return s.walls[0].from.x(); }},
        {"walls[0].to", [](Scene& s) -> double& { return s.walls[0].to.y(); }},
        {"walls[0].restitution", [](Scene& s) -> double& { return s.walls[0].restitution; }},
        {"attractors[0].position", [](Scene& s) -> double& { return s.attractors[0].position.x(); }},
        {"attractors[0].strength", [](Scene& s) -> double& { return s.attractors[0].strength; }},
        {"attractors[0].softening", [](Scene& s) -> double& { return s.attractors[0].softening; }},
        {"domain.max", [](Scene& s) -> double& { return s.domain->box.max.x(); }},
        {"domain.restitution", [](Scene& s) -> double& { return s.domain->restitution; }},
        {"gravity", [](Scene& s) -> double& { return s.gravity.y(); }},
        {"speed_factor", [](Scene& s) -> double& { return s.speed_factor; }},
        {"contact_time", [](Scene& s) -> double& { return s.contact_time.emplace(); }},
        {"field_interval", [](Scene& s) -> double& { return s.field_interval; }},
        {"until", [](Scene& s) -> double& { return s.until; }},
    };
    EXPECT_NO_THROW(World{sound()});
    for (const Field& field : fields)
        for (const double value : {kNan, kInfinity, -kInfinity, 1e101, -1e101}) {
            Scene s = sound();
            field.of(s) = value;
            try {
                World world(s);
                ADD_FAILURE() << field.place << " may be " << value;
            } catch (const SceneError& error) {
                EXPECT_EQ(error.place(), field.place) << value;
            }
        }
}

/// Scenes in range whose motion soon leaves what doubles can tell.
TEST(RefusedScenes, MotionBeyondTheClock) {
    struct Case {
        std::string name;
        std::function<void(Scene&)> make;
        double end;
    };
    const std::vector<Case> cases = {
        {"a speed of 1e90 radii", [](Scene& s) { s.balls[0].velocity = {1e90, 0}; }, 1},
        {"gravity of 1e100", [](Scene& s) { s.gravity = {0, -1e100}; }, 1},
        {"an acceleration of 1e70", [](Scene& s) { s.balls[0].acceleration = {1e70, 0}; }, 1},
        {"a radius of 1e-100", [](Scene& s) { s.balls[0].radius = s.balls[1].radius = 1e-100; }, 1},
        {"a time of 1e300", [](Scene&) {}, 1e300},
    };
    for (const Case& c : cases) {
        Scene s = sound();
        s.attractors.clear();
        c.make(s);
        World world(s, {.threads = 1});
        try {
            world.advance_to(c.end);
            ADD_FAILURE() << c.name << " went on";
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find("beyond what this scene's clock can tell"),
                      std::string::npos)
                << c.name << ": " << error.what();
            EXPECT_EQ(world.time(), 0) << c.name;
        }
    }
}

// The field would have to be renewed 10^100 times.
TEST(RefusedScenes, MoreFieldUpdatesThanAnyRunSurvives) {
    Scene s = sound();
    s.field_interval = 1e-100;
    s.until = 1;
    EXPECT_THROW(World{s}, SceneError);
    s.until = 0;  // the caller may go on for longer than the scene says
    World world(s, {.threads = 1});
    EXPECT_THROW(world.advance_to(1), std::invalid_argument);
    EXPECT_EQ(world.time(), 0);
}

// A light ball stands still while one of all but its own size flies off at a thousand million radii a second:
// empty space costs nothing.
TEST(RefusedScenes, EmptySpaceIsNoHang) {
    Scene s;
    s.balls = {ball_at(0, 0, 1e9, 0), ball_at(3, 5, 0, 0)};
    World world(s, {.threads = 1});
    world.advance_to(1e3);
    EXPECT_EQ(world.positions()[0].x(), 1e12);
    EXPECT_LT(world.counts().events, 1000U);
}

}  // namespace
}  // namespace carom::test
