// A world, and what its collisions and sensors until now come to.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <carom/parallel/world.hpp>

#include "hash.hpp"

namespace carom::stress {

struct Seen {
    Hash events;
    Hash sensings;
    std::vector<std::uint32_t> by_ball;  ///< how many of them each ball had, by id
};

class Watched {
 public:
    Watched(const std::string& name, World world) : name_(name), world_(std::move(world)) {
        seen_ = std::make_unique<Seen>();
        listen(nullptr);
        if (world_.sensors().empty()) return;
        world_.on_sensing([seen = seen_.get()](const Sensing& s) {
            seen->sensings << s.time << std::uint64_t{s.sensor} << std::uint64_t{s.ball}
                           << std::uint64_t{s.enters} << s.position << s.velocity;
        });
    }
    /// Hands each collision to `listener` besides.
    void listen(std::function<void(const Collision&)> listener) {
        world_.on_collision([seen = seen_.get(), listener = std::move(listener)](const Collision& c) {
            const auto count = [seen](std::uint32_t ball) {
                if (ball >= seen->by_ball.size()) seen->by_ball.resize(ball + std::size_t{1});
                ++seen->by_ball[ball];
            };
            seen->events << c.time << std::uint64_t(c.kind) << std::uint64_t{c.i} << std::uint64_t{c.j}
                         << c.point << c.normal << c.impulse;
            count(c.i);
            if (c.kind == CollisionKind::kBall) count(c.j);
            if (listener) listener(c);
        });
    }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] World& world() { return world_; }
    [[nodiscard]] const World& world() const { return world_; }
    [[nodiscard]] const Seen& seen() const { return *seen_; }
    void set_seen(const Seen& seen) { *seen_ = seen; }

 private:
    std::string name_;
    World world_;
    std::unique_ptr<Seen> seen_;  // its address stays when this is moved
};

}  // namespace carom::stress
