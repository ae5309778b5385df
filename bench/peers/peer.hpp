// The same discs in Carom and in the engines that a user might pick instead.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::bench {

/// A simulation that goes by frames, on one thread.
class Peer {
 public:
    virtual ~Peer() = default;
    virtual void step(double frame) = 0;
    /// Collisions of two balls so far, as the engine counts them.
    [[nodiscard]] virtual std::uint64_t collisions() const = 0;
    /// Positions, velocities and radii as they are now.
    [[nodiscard]] virtual std::vector<Ball> balls() const = 0;
};

/// What a peer is built from: balls, gravity and a walled domain are taken from the scene. `sleeps` lets what
/// rests be left out of the simulation, where the engine can do that.
using MakePeer = std::unique_ptr<Peer> (*)(const Scene& scene, bool sleeps);

struct NamedPeer {
    std::string name;
    MakePeer make;
};

std::unique_ptr<Peer> make_carom(const Scene& scene, bool sleeps);
std::unique_ptr<Peer> make_box2d(const Scene& scene, bool sleeps);
std::unique_ptr<Peer> make_chipmunk(const Scene& scene, bool sleeps);

/// Walls this thick stand around the domain in engines that a fast ball could else leave.
inline constexpr double kWallThickness = 10;

}  // namespace carom::bench
