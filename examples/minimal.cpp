// Carom as the physics step of somebody's program: two balls, a floor, gravity, frames.
#include <carom/parallel/world.hpp>

#include <iostream>

int main() {
    carom::Scene scene;
    scene.gravity = {0, -9.81};
    scene.domain = carom::Domain{{{0, 0}, {10, 10}}, {carom::Boundary::kWall, carom::Boundary::kWall}, 1};
    scene.balls.resize(2);
    scene.balls[0].position = {4, 6};
    scene.balls[1].position = {4.3, 3};

    carom::World world(scene);
    for (int frame = 0; frame < 60; ++frame) world.step(1.0 / 60);
    std::cout << world.counts().ball_collisions << " collision(s), then\n";
    for (const carom::Vec2& p : world.positions()) std::cout << p.transpose() << '\n';
    return world.counts().ball_collisions == 0 ? 1 : 0;
}
