// Carom in a game's loop: balls are added, kicked, asked for and removed while the world runs.
#include <carom/carom.hpp>

#include <cstdio>
#include <vector>

int main() {
    using carom::Boundary;
    using carom::Vec2;
    carom::Scene scene;
    scene.gravity = {0, -9.81};
    scene.domain = carom::Domain{{{0, 0}, {16, 9}}, {Boundary::kWall, Boundary::kWall}, 0.8};
    scene.walls = {{.from = {4, 4}, .to = {12, 5}}};
    scene.balls = {{.position = {8, 8}, .velocity = {1, 0}, .restitution = 0.9}};
    carom::World world(scene);

    // What a frame has to draw or to sound: hard hits of this frame, in the order in which they happened.
    std::vector<carom::Collision> hits;
    world.on_collision([&hits](const carom::Collision& c) {
        if (c.impulse > 0.5) hits.push_back(c);
    });

    // A goal at the bottom on the left: who comes in, at the true time.
    world.set_sensors({{.corners = {{0, 0}, {3, 0}, {3, 1}, {0, 1}}}});
    int goals = 0;
    world.on_sensing([&goals](const carom::Sensing& s) { goals += s.enters; });

    const std::uint32_t player = 0;
    std::size_t heard = 0;
    for (int frame = 0; frame < 300; ++frame) {
        if (frame % 30 == 0 && world.balls_at({2, 8}, 0.5).empty())  // room for one more?
            world.add_ball({.position = {2, 8}, .velocity = {3, 0}, .radius = 0.3, .restitution = 0.7});
        if (frame == 120) world.apply_impulse(player, {-4, 6});
        if (frame == 200) {
            carom::Edits clearing;  // many edits at once cost as much as one
            for (const std::uint32_t id : world.balls_in({{0, 0}, {8, 1}}))
                if (id != player) clearing.removed_balls.push_back(id);
            world.apply(clearing);
        }
        world.step(1.0 / 60);
        heard += hits.size();
        hits.clear();
    }

    const carom::Ball ball = world.ball(player);
    std::printf("%zu balls, %zu hard hits, %d goals; the player is at %.3f %.3f\n", world.ball_count(), heard,
                goals, ball.position.x(), ball.position.y());
    if (const auto hit = world.cast_ray({8, 9}, {0, -1}, 20))
        std::printf("from above the middle one sees a %s at distance %.3f\n",
                    hit->kind == carom::CollisionKind::kBall ? "ball" : "wall", hit->distance);
    return world.validate().empty() && heard > 0 && goals > 0 ? 0 : 1;
}
