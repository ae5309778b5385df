// Chipmunk 7: its 10 iterations, the spatial hash that its manual suggests for many bodies of one size, no
// friction and no rotation; an allowed overlap of 1 % of a radius instead of its 0.1 for screens.
#include <chipmunk/chipmunk.h>

#include <cmath>
#include <limits>

#include "peer.hpp"

namespace carom::bench {
namespace {

constexpr cpCollisionType kBall = 1;

cpVect cp(const Vec2& v) {
    return cpv(v.x(), v.y());
}

cpBool count_collision(cpArbiter*, cpSpace*, cpDataPointer count) {
    ++*static_cast<std::uint64_t*>(count);
    return cpTrue;
}

class ChipmunkPeer final : public Peer {
 public:
    ChipmunkPeer(const Scene& scene, bool sleeps) : space_(cpSpaceNew()), balls_(scene.balls) {
        double largest = 0;
        for (const Ball& ball : balls_) largest = std::max(largest, ball.radius);
        cpSpaceUseSpatialHash(space_, 2 * largest, static_cast<int>(10 * balls_.size()));
        cpSpaceSetGravity(space_, cp(scene.gravity));
        cpSpaceSetCollisionSlop(space_, 0.01 * largest);
        if (sleeps) cpSpaceSetSleepTimeThreshold(space_, 0.5);
        add_walls(*scene.domain);
        for (const Ball& ball : balls_) add(ball);
        cpCollisionHandler* const handler = cpSpaceAddCollisionHandler(space_, kBall, kBall);
        handler->beginFunc = count_collision;
        handler->userData = &collisions_;
    }
    ~ChipmunkPeer() override {
        for (cpShape* const shape : shapes_) {
            cpSpaceRemoveShape(space_, shape);
            cpShapeFree(shape);
        }
        for (cpBody* const body : bodies_) {
            cpSpaceRemoveBody(space_, body);
            cpBodyFree(body);
        }
        cpSpaceFree(space_);
    }
    ChipmunkPeer(const ChipmunkPeer&) = delete;
    ChipmunkPeer& operator=(const ChipmunkPeer&) = delete;

    void step(double frame) override { cpSpaceStep(space_, frame); }
    [[nodiscard]] std::uint64_t collisions() const override { return collisions_; }
    [[nodiscard]] std::vector<Ball> balls() const override {
        std::vector<Ball> now = balls_;
        for (std::size_t i = 0; i < now.size(); ++i) {
            const cpVect x = cpBodyGetPosition(bodies_[i]);
            const cpVect v = cpBodyGetVelocity(bodies_[i]);
            now[i].position = {x.x, x.y};
            now[i].velocity = {v.x, v.y};
        }
        return now;
    }

 private:
    void keep(cpShape* shape, double restitution) {
        cpShapeSetElasticity(shape, restitution);
        cpShapeSetFriction(shape, 0);
        shapes_.push_back(cpSpaceAddShape(space_, shape));
    }

    // The elasticity of a pair is the product of both.
    void add(const Ball& ball) {
        cpBody* const body =
            cpSpaceAddBody(space_, cpBodyNew(ball.mass, std::numeric_limits<double>::infinity()));
        bodies_.push_back(body);
        cpBodySetPosition(body, cp(ball.position));
        cpBodySetVelocity(body, cp(ball.velocity));
        cpShape* const shape = cpCircleShapeNew(body, ball.radius, cpvzero);
        cpShapeSetCollisionType(shape, kBall);
        keep(shape, std::sqrt(ball.restitution));
    }

    void add_walls(const Domain& domain) {
        const Vec2 a = domain.box.min - Vec2::Constant(kWallThickness / 2);
        const Vec2 b = domain.box.max + Vec2::Constant(kWallThickness / 2);
        const Vec2 corners[] = {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
        for (int k = 0; k < 4; ++k)
            keep(cpSegmentShapeNew(cpSpaceGetStaticBody(space_), cp(corners[k]), cp(corners[(k + 1) % 4]),
                                   kWallThickness / 2),
                 std::sqrt(domain.restitution));
    }

    cpSpace* space_;
    std::vector<Ball> balls_;
    std::vector<cpBody*> bodies_;
    std::vector<cpShape*> shapes_;
    std::uint64_t collisions_ = 0;
};

}  // namespace

std::unique_ptr<Peer> make_chipmunk(const Scene& scene, bool sleeps) {
    return std::make_unique<ChipmunkPeer>(scene, sleeps);
}

}  // namespace carom::bench
