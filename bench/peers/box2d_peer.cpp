// Box2D 2.4: 8 velocity and 3 position iterations, as its manual suggests; no friction and no rotation, which
// spares it work; thick walls, so that it needs no continuous collision; restitution at all speeds.
#include <box2d/box2d.h>

#include <numbers>

#include "peer.hpp"

namespace carom::bench {
namespace {

b2Vec2 b2(const Vec2& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}
Vec2 from_b2(const b2Vec2& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

class Box2dPeer final : public Peer, private b2ContactListener {
 public:
    Box2dPeer(const Scene& scene, bool sleeps) : world_(b2(scene.gravity)), balls_(scene.balls) {
        world_.SetAllowSleeping(sleeps);
        world_.SetContinuousPhysics(false);
        world_.SetContactListener(this);
        add_walls(*scene.domain);
        for (const Ball& ball : balls_) add(ball);
    }

    void step(double frame) override {
        constexpr int kVelocityIterations = 8;
        constexpr int kPositionIterations = 3;
        world_.Step(static_cast<float>(frame), kVelocityIterations, kPositionIterations);
    }
    [[nodiscard]] std::uint64_t collisions() const override { return collisions_; }
    [[nodiscard]] std::vector<Ball> balls() const override {
        std::vector<Ball> now = balls_;
        for (std::size_t i = 0; i < now.size(); ++i) {
            now[i].position = from_b2(bodies_[i]->GetPosition());
            now[i].velocity = from_b2(bodies_[i]->GetLinearVelocity());
        }
        return now;
    }

 private:
    void BeginContact(b2Contact* contact) override {
        const bool of_balls = contact->GetFixtureA()->GetBody()->GetType() == b2_dynamicBody &&
                              contact->GetFixtureB()->GetBody()->GetType() == b2_dynamicBody;
        collisions_ += of_balls ? 1 : 0;
    }

    static b2FixtureDef fixture(const b2Shape& shape, double restitution, double density) {
        b2FixtureDef definition;
        definition.shape = &shape;
        definition.restitution = static_cast<float>(restitution);
        definition.restitutionThreshold = 0;
        definition.friction = 0;
        definition.density = static_cast<float>(density);
        return definition;
    }

    void add(const Ball& ball) {
        b2BodyDef definition;
        definition.type = b2_dynamicBody;
        definition.fixedRotation = true;
        definition.position = b2(ball.position);
        definition.linearVelocity = b2(ball.velocity);
        b2CircleShape circle;
        circle.m_radius = static_cast<float>(ball.radius);
        b2Body* const body = world_.CreateBody(&definition);
        const b2FixtureDef shape =
            fixture(circle, ball.restitution, ball.mass / (std::numbers::pi * ball.radius * ball.radius));
        body->CreateFixture(&shape);
        bodies_.push_back(body);
    }

    void add_walls(const Domain& domain) {
        const Vec2 centre = (domain.box.min + domain.box.max) / 2;
        const Vec2 half = (domain.box.max - domain.box.min) / 2;
        constexpr double kHalf = kWallThickness / 2;
        for (const double side : {-1.0, 1.0}) {
            add_block(centre + Vec2(side * (half.x() + kHalf), 0), {kHalf, half.y() + kWallThickness},
                      domain.restitution);
            add_block(centre + Vec2(0, side * (half.y() + kHalf)), {half.x() + kWallThickness, kHalf},
                      domain.restitution);
        }
    }

    void add_block(const Vec2& centre, const Vec2& half, double restitution) {
        b2BodyDef definition;
        definition.position = b2(centre);
        b2PolygonShape block;
        block.SetAsBox(static_cast<float>(half.x()), static_cast<float>(half.y()));
        const b2FixtureDef shape = fixture(block, restitution, 0);
        world_.CreateBody(&definition)->CreateFixture(&shape);
    }

    b2World world_;
    std::vector<Ball> balls_;
    std::vector<b2Body*> bodies_;
    std::uint64_t collisions_ = 0;
};

}  // namespace

std::unique_ptr<Peer> make_box2d(const Scene& scene, bool sleeps) {
    return std::make_unique<Box2dPeer>(scene, sleeps);
}

}  // namespace carom::bench
