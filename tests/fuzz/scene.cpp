#include <string>

#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

#include "inputs.hpp"
#include "refusal.hpp"

namespace carom::fuzz {
namespace {

constexpr std::uint64_t kMostBalls = 100;

// Placing and predicting take time with the number of balls, which is no fault.
bool is_small(const Scene& scene) {
    std::uint64_t balls = scene.balls.size() + 10 * scene.walls.size();
    for (const Fill& fill : scene.fills) {
        if (!fill.count || *fill.count > kMostBalls) return false;
        balls += *fill.count;
    }
    return balls <= kMostBalls;
}

}  // namespace

void take_scene(std::string_view bytes) {
    // A file that the scene names is another input; what is no file, like /dev/zero, may have no end.
    if (bytes.find("balls_file") != std::string_view::npos) return;
    Scene scene;
    if (!taken<SceneError>([&] { scene = parse_scene(bytes); })) return;
    const std::string written = write_scene(scene);
    if (!taken<SceneError>([&] { scene = parse_scene(written); })) broken("what is written is read", written);
    expect(write_scene(scene) == written, "what is read is what was written", written);
    if (!is_small(scene)) return;
    (void)taken<SceneError>([&] { const World world(scene, {.threads = 1}); });
}

}  // namespace carom::fuzz
