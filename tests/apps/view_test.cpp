// What a window does, without the window: where things are, what is painted, what keys and the mouse change,
// how the simulation behind it moves on.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "draw_view.hpp"
#include "parallel/scenes.hpp"
#include "picture_palette.hpp"

namespace carom::app {
namespace {

constexpr WorldOptions kOneThread{.threads = 1};

Scene one_ball() {
    Scene s;
    s.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kWall, Boundary::kWall}, 1};
    s.balls.resize(1);
    s.balls[0].position = {5, 5};
    s.balls[0].velocity = {3, 0};
    s.until = 9;
    return s;
}

// Binary fractions throughout: nothing is rounded.
TEST(Camera, PanMovesByPixelsAndZoomKeepsThePlaceUnderTheMouse) {
    Camera camera;
    camera.resize(848, 448);
    camera.fit({{0, 0}, {100, 50}});  // 800 x 400 within the margins: 8 pixels a length
    EXPECT_EQ(camera.scale(), 8);
    EXPECT_EQ(camera.to_pixel({0, 0}), (Vec2{24, 424}));
    EXPECT_EQ(camera.to_pixel({100, 50}), (Vec2{824, 24}));
    const Vec2 mouse{124, 324};
    const Vec2 place = camera.to_place(mouse);
    EXPECT_EQ(place, (Vec2{12.5, 12.5}));
    camera.zoom(4, mouse);
    EXPECT_EQ(camera.scale(), 32);
    EXPECT_EQ(camera.to_pixel(place), mouse);
    camera.pan({64, -32});
    EXPECT_EQ(camera.to_pixel(place), (Vec2{188, 292}));
    for (int i = 0; i < 4000; ++i) camera.zoom(0.5, mouse);
    EXPECT_GT(camera.scale(), 0.1);  // never lost
}

TEST(Canvas, DiscsHaveTheirAreaAndStayOnTheCanvas) {
    Canvas canvas;
    canvas.resize(100, 80);
    for (const double radius : {0.7, 1.5, 4.0, 20.3}) {
        canvas.clear(0xff000000U);
        canvas.disc({50.3, 39.6}, radius, 0xff0000ffU);
        double covered = 0;
        for (const std::uint32_t pixel : canvas.pixels()) covered += double(pixel & 255U) / 255;
        // The soft edge is a pixel wide, of a slope that leaves the area but for its curvature.
        const double area = std::numbers::pi * radius * radius;
        EXPECT_NEAR(covered, area, 0.5 + 0.02 * area) << radius;
    }
    canvas.clear(0xff000000U);
    for (const Vec2& away :
         {Vec2{-500, 40}, Vec2{1e300, 40}, Vec2{50, -1e300}, Vec2{NAN, 40}, Vec2{50, 1e18}})
        for (const double radius : {0.1, 30.0}) canvas.disc(away, radius, 0xffffffffU);
    for (const std::uint32_t pixel : canvas.pixels()) ASSERT_EQ(pixel, 0xff000000U);
    canvas.disc({50, 40}, 1e12, 0xffffffffU);  // all of it
    for (const std::uint32_t pixel : canvas.pixels()) ASSERT_EQ(pixel, 0xffffffffU);
}

// A line's pixels are those whose distance from it is at most half its width: asked of every pixel.
TEST(Canvas, LinesAreWhereTheyShould) {
    Canvas canvas;
    canvas.resize(90, 70);
    std::mt19937_64 random(8);
    for (int i = 0; i < 200; ++i) {
        const auto place = [&] {
            const double x = test::uniform(random, -30, 120);
            return Vec2{x, test::uniform(random, -30, 100)};
        };
        const Vec2 from = place();
        const Vec2 to = i % 10 == 0 ? Vec2(from.x(), place().y()) : place();
        const double width = test::uniform(random, 1, 6);
        canvas.clear(0xff000000U);
        canvas.line(from, to, width, 0xffffffffU);
        const Vec2 along = to - from;
        for (int y = 0; y < 70; ++y) {
            for (int x = 0; x < 90; ++x) {
                const Vec2 pixel{x + 0.5, y + 0.5};
                const double share =
                    std::min(std::max((pixel - from).dot(along) / along.squaredNorm(), 0.0), 1.0);
                const double distance = (pixel - from - share * along).norm();
                const std::uint32_t seen = canvas.at(x, y) & 255U;
                if (distance < width / 2 - 0.51) {
                    ASSERT_EQ(seen, 255U) << x << ' ' << y << ' ' << i;
                }
                if (distance > width / 2 + 0.51) {
                    ASSERT_EQ(seen, 0U) << x << ' ' << y << ' ' << i;
                }
            }
        }
    }
}

// Whom a ball meets next, against the engine that finds it out: the first collision of all is of two balls
// that see each other as the next.
TEST(NextMeeting, IsTheEnginesFirstCollision) {
    for (const Boundary side : {Boundary::kWall, Boundary::kPeriodic}) {
        Scene scene = test::gas(7, {.count = 60, .packing = 0.2, .boundary_x = side});
        scene.gravity = {0, -0.25};
        Simulation simulation(scene, kOneThread);
        for (int event = 0; event < 200; ++event) {
            const std::vector<Ball> before = simulation.balls();
            const double time = simulation.world().time();
            ASSERT_TRUE(simulation.play_one_event());
            const EventLog& log = simulation.log();
            std::vector<Collision> latest;
            for (std::uint32_t id = 0; id < before.size() && latest.empty(); ++id)
                for (const Collision& c : log.history_of(id, 1))
                    if (c.time > time) latest.push_back(c);
            ASSERT_EQ(latest.size(), 1U);
            const auto met = next_meeting(before, latest[0].i, scene);
            ASSERT_TRUE(met);
            EXPECT_EQ(met->other, latest[0].j);
            EXPECT_EQ(met->kind, latest[0].kind);
            EXPECT_NEAR(met->delay, latest[0].time - time, 1e-12 * (1 + time));
        }
    }
}

TEST(Simulation, OneEventStopsAtEachCollisionInTurn) {
    const Scene scene = test::gas(3, {.count = 100, .packing = 0.4});
    std::vector<double> times;
    World world(scene, kOneThread);
    world.on_collision([&times](const Collision& c) { times.push_back(c.time); });
    world.advance_to(0.5);
    ASSERT_GT(times.size(), 20U);
    Simulation simulation(scene, kOneThread);
    for (std::size_t k = 0; k < 20; ++k) {
        ASSERT_TRUE(simulation.play_one_event());
        EXPECT_EQ(simulation.log().total(), k + 1);  // each counted once, none skipped
        EXPECT_NEAR(simulation.world().time(), times[k], 1e-15);
    }
}

TEST(Simulation, PlayReachesTheTimeAndABudgetIsKept) {
    Simulation simulation(one_ball(), kOneThread);
    simulation.play(0.5, 2, std::nullopt);
    EXPECT_EQ(simulation.world().time(), 1);
    simulation.play(100, 1, 10);  // a hiccup of 100 s is not made up for
    EXPECT_NEAR(simulation.world().time(), 1.1, 1e-12);
    simulation.play(0.1, 1e9, 0.02);  // far more than can be reached: it comes back all the same
    EXPECT_GT(simulation.world().time(), 1.1);
    EXPECT_LT(simulation.world().time(), 1e8);
}

TEST(Simulation, KnowsTheBallThatIsLookedAt) {
    Simulation simulation(one_ball(), kOneThread);
    EXPECT_EQ(simulation.ball_at({5.3, 5.3}, 0), 0U);
    EXPECT_FALSE(simulation.ball_at({5.4, 5.4}, 0));
    EXPECT_EQ(simulation.ball_at({5.4, 5.4}, 0.1), 0U);
    EXPECT_FALSE(simulation.facts());
    simulation.look_at(0U);
    simulation.play(2, 1, std::nullopt);  // met the right side at 1.5 with the centre at 9.5
    const std::optional<BallFacts> facts = simulation.facts();
    ASSERT_TRUE(facts && facts->anchor && facts->next);
    EXPECT_DOUBLE_EQ(facts->ball.position.x(), 8);
    EXPECT_DOUBLE_EQ(facts->anchor->position.x(), 9.5);
    EXPECT_DOUBLE_EQ(facts->anchor_age, 0.5);
    EXPECT_EQ(facts->collisions, 1U);
    EXPECT_EQ(facts->next->kind, CollisionKind::kWall);
    EXPECT_EQ(facts->next->other, 0U);  // the left side
    EXPECT_DOUBLE_EQ(facts->next->delay, 2.5);
    ASSERT_EQ(facts->history.size(), 1U);
    EXPECT_EQ(facts->history[0].j, 1U);  // the right side
}

TEST(Simulation, RestartsWithOtherSeeds) {
    Scene scene = one_ball();
    scene.fills.resize(1);
    scene.fills[0].count = 20;
    scene.fills[0].radius_min = scene.fills[0].radius_max = 0.2;
    Simulation simulation(scene, kOneThread);
    const Vec2 first = simulation.balls()[5].position;
    simulation.play(1, 1, std::nullopt);
    simulation.restart(1);
    EXPECT_EQ(simulation.world().time(), 0);
    EXPECT_NE(simulation.balls()[5].position, first);
    simulation.restart(0);
    EXPECT_EQ(simulation.balls()[5].position, first);
}

TEST(EventLog, KeepsTheLatestAndCountsAll) {
    EventLog log(4, 3);
    for (std::uint32_t k = 0; k < 5; ++k)
        log.note(
            {double(k), k == 4 ? CollisionKind::kWall : CollisionKind::kBall, 0, k % 3 + 1, {}, {}, 0, 0});
    EXPECT_EQ(log.total(), 5U);
    EXPECT_EQ(log.counts(), (std::vector<std::uint32_t>{5, 2, 1, 1}));  // the wall 2 is no ball 2
    const std::vector<Collision> history = log.history_of(0, 10);
    ASSERT_EQ(history.size(), 3U);  // that many are kept
    EXPECT_EQ(history[0].time, 4);
    EXPECT_EQ(history[2].time, 2);
    EXPECT_EQ(log.history_of(0, 2).size(), 2U);
    EXPECT_EQ(log.history_of(2, 9).size(), 0U);
}

TEST(ViewControls, KeysAndMouse) {
    Simulation simulation(one_ball(), kOneThread);
    ViewControls controls(simulation);
    controls.resize(400, 400);
    const auto key = [&](int k) { controls.act(action_of_key(k).value()); };
    key(' ');
    EXPECT_TRUE(controls.is_paused);
    key(' ');
    key('+');
    key('+');
    key('-');
    EXPECT_EQ(controls.speed, 2);
    key('.');
    EXPECT_TRUE(controls.is_paused);
    EXPECT_DOUBLE_EQ(simulation.world().time(), 1.5);
    for (std::size_t k = 0; k < kAllColourBy.size(); ++k) key('c');
    EXPECT_EQ(controls.colour_by, ColourBy::kSpeed);
    EXPECT_FALSE(action_of_key('x'));

    const Vec2 ball = controls.camera.to_pixel(simulation.balls()[0].position);
    controls.press(ball);
    controls.move(ball + Vec2{2, 1});  // a click, for all that the hand shook
    controls.release(ball + Vec2{2, 1});
    EXPECT_EQ(simulation.looked_at(), 0U);
    const Vec2 ground = ball + Vec2{-100, 80};
    controls.press(ground);
    controls.move(ground + Vec2{-50, 30});
    controls.release(ground + Vec2{-50, 30});
    EXPECT_EQ(simulation.looked_at(), 0U);  // a drag picks nothing
    EXPECT_NEAR((controls.camera.to_pixel(simulation.balls()[0].position) - ball - Vec2{-50, 30}).norm(), 0,
                1e-9);
    controls.press({5, 5});
    controls.release({5, 5});
    EXPECT_FALSE(simulation.looked_at());
    key('q');
    EXPECT_TRUE(controls.has_quit);
}

TEST(ViewControls, BallsAreDrawnAndThrown) {
    Simulation simulation(one_ball(), kOneThread);
    ViewControls controls(simulation);
    controls.resize(400, 400);
    const Vec2 target{7, 3};
    controls.press(controls.camera.to_pixel({5, 5}));
    EXPECT_FALSE(controls.held());
    controls.move(controls.camera.to_pixel(target));
    ASSERT_TRUE(controls.held());
    // Each frame takes a sixtieth of a second of a way that has a tenth of a second left: 5/6 remain.
    for (int frame = 1; frame <= 30; ++frame) {
        controls.pull();
        simulation.play(1.0 / 60, controls.speed, std::nullopt);
        const double left = std::pow(5.0 / 6, frame) * std::sqrt(8.0);
        EXPECT_NEAR((simulation.balls()[0].position - target).norm(), left, 1e-9);
    }
    controls.release(controls.camera.to_pixel(target));
    EXPECT_FALSE(controls.held());
    const Vec2 velocity = simulation.balls()[0].velocity;
    EXPECT_GT(velocity.norm(), 0);
    simulation.play(0.01, 1, std::nullopt);
    EXPECT_EQ(simulation.balls()[0].velocity, velocity);  // it flies on

    controls.is_paused = true;
    controls.speed = 0.5;
    const Vec2 from = simulation.balls()[0].position;
    controls.press(controls.camera.to_pixel(from));
    controls.move(controls.camera.to_pixel({8, 8}));
    controls.release(controls.camera.to_pixel({8, 8}));
    simulation.play(1, controls.speed, std::nullopt);
    EXPECT_LT((simulation.balls()[0].position - Vec2(8, 8)).norm(), 1e-9);
    EXPECT_TRUE(simulation.world().validate().empty());
}

TEST(ViewControls, AddsBallsAndBlackHolesUnderTheMouse) {
    Simulation simulation(one_ball(), kOneThread);
    ViewControls controls(simulation);
    controls.resize(400, 400);
    const auto add = [&](char key, const Vec2& place) {
        controls.move(controls.camera.to_pixel(place));
        controls.act(action_of_key(key).value());
    };
    add('a', {2, 2});
    ASSERT_EQ(simulation.balls().size(), 2U);
    EXPECT_LT((simulation.balls()[1].position - Vec2(2, 2)).norm(), 1e-12);
    EXPECT_EQ(simulation.balls()[1].velocity, Vec2(0, 0));
    EXPECT_EQ(simulation.log().counts().size(), 2U);
    add('a', {2.5, 2});  // no room
    EXPECT_EQ(simulation.balls().size(), 2U);
    EXPECT_EQ(simulation.refusal().rfind("balls[1]: overlaps balls[2]", 0), 0U) << simulation.refusal();
    add('b', {8, 2});
    ASSERT_EQ(simulation.world().attractors().size(), 1U);
    EXPECT_EQ(simulation.refusal(), "");
    simulation.play(1, 1, std::nullopt);
    EXPECT_GT(simulation.balls()[1].velocity.x(), 0);  // it is drawn there
    controls.act(Action::kRestart);
    EXPECT_EQ(simulation.balls().size(), 1U);
    EXPECT_TRUE(simulation.world().attractors().empty());
}

TEST(DrawView, BallsAreInTheirPlacesInTheirColours) {
    Scene scene = one_ball();
    scene.balls.push_back(scene.balls[0]);
    scene.balls[1].position = {2, 8};
    scene.balls[1].velocity = {0, 1.5};
    scene.balls.push_back(scene.balls[0]);
    scene.balls[2].position = {2, 2};
    scene.balls[2].velocity = {0, 0};
    scene.balls[2].is_static = true;
    Simulation simulation(scene, kOneThread);
    ViewControls controls(simulation);
    controls.resize(448, 448);  // 40 pixels a length
    Canvas canvas;
    draw_view(canvas, simulation, controls, std::nullopt);
    const auto at = [&](double x, double y) {
        const Vec2 pixel = controls.camera.to_pixel({x, y});
        return canvas.at(int(pixel.x()), int(pixel.y()));
    };
    EXPECT_EQ(at(5, 5), pixel_of(map_colour(1)));
    EXPECT_EQ(at(5.3, 5.3), at(5, 5));
    EXPECT_EQ(at(2, 8), pixel_of(map_colour(255.0 / 511)));  // half, of a table of 512
    EXPECT_EQ(at(2, 2), pixel_of(palette::kStaticBall));
    EXPECT_EQ(at(5.6, 5), pixel_of(palette::kGround));
    EXPECT_EQ(at(2, 8.6), pixel_of(palette::kGround));
}

}  // namespace
}  // namespace carom::app
