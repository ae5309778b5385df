#include <carom/parallel/world.hpp>

#include "peer.hpp"

namespace carom::bench {
namespace {

class CaromPeer final : public Peer {
 public:
    explicit CaromPeer(const Scene& scene) : world_(scene, {.threads = 1}) {}

    void step(double frame) override {
        world_.step(frame);
        (void)world_.positions();  // as whoever draws does
    }
    [[nodiscard]] std::uint64_t collisions() const override { return world_.counts().ball_collisions; }
    [[nodiscard]] std::vector<Ball> balls() const override { return world_.balls(); }

 private:
    World world_;
};

}  // namespace

std::unique_ptr<Peer> make_carom(const Scene& scene, bool) {
    return std::make_unique<CaromPeer>(scene);
}

}  // namespace carom::bench
