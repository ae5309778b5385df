#include <algorithm>
#include <string>

#include <carom/io/atomic_file.hpp>
#include <carom/io/checkpoint.hpp>
#include <carom/parallel/world.hpp>

#include "checkpoint_layout.hpp"
#include "crc64.hpp"
#include "inputs.hpp"
#include "little_endian.hpp"
#include "refusal.hpp"

namespace carom::fuzz {
namespace {

using namespace checkpoint_layout;

/// Three balls under gravity that lose energy, so that a state has every section but the accelerations, and
/// those of the empirical method.
World& small_world(Method method) {
    const auto make = [](Method of_world) {
        Scene scene;
        scene.method = of_world;
        if (of_world == Method::kEmpirical) scene.step = 0.25;
        scene.gravity = {0, -1};
        scene.domain = Domain{{{0, 0}, {10, 10}}, {Boundary::kPeriodic, Boundary::kWall}, 0.9};
        scene.balls.resize(3);
        for (int k = 0; k < 3; ++k) {
            scene.balls[k].position = {2.0 + 3 * k, 5};
            scene.balls[k].velocity = {1.0 - k, 0.5 * k};
            scene.balls[k].restitution = 0.9;
        }
        scene.until = 10;
        return World(scene, {.threads = 1});
    };
    static World by_events = make(Method::kEvent);
    static World by_steps = make(Method::kEmpirical);
    return method == Method::kEvent ? by_events : by_steps;
}

Method method_in(std::string_view bytes) {
    constexpr std::string_view kEmpirical = "empirical";
    return bytes.size() > 40 && bytes.substr(40, kEmpirical.size()) == kEmpirical ? Method::kEmpirical
                                                                                  : Method::kEvent;
}

/// What a fuzzer cannot guess: the magic, the version, the file's size, the scene, the balls, the checksum.
std::string put_right(std::string_view bytes) {
    std::string right(bytes);
    right.resize(std::max(right.size(), kHeaderSize + kChecksumSize));
    const auto put = [&right](std::size_t offset, auto number) {
        std::string text;
        append_little_endian(text, number);
        right.replace(offset, text.size(), text);
    };
    right.replace(0, kMagic.size(), kMagic);
    put(8, kVersion);
    put(16, std::uint64_t{right.size()});
    const Method method = method_in(bytes);
    put(24, small_world(method).scene_hash());
    put(32, std::uint64_t{3});
    std::string name = method == Method::kEvent ? "event" : "empirical";
    name.resize(kNameSize, '\0');
    right.replace(40, kNameSize, name);
    Crc64 checksum;
    checksum.add(std::string_view(right).substr(0, right.size() - kChecksumSize));
    put(right.size() - kChecksumSize, checksum.value());
    return right;
}

}  // namespace

void take_checkpoint(std::string_view bytes) {
    (void)taken<FileError>([&] { (void)parse_checkpoint(bytes, "input"); });
    const std::string right = put_right(bytes);
    Checkpoint checkpoint;
    if (!taken<FileError>([&] { checkpoint = parse_checkpoint(right, "input"); })) return;
    World& world = small_world(method_in(right));
    if (!taken<SnapshotError>([&] { world.restore(checkpoint.snapshot); })) return;
    (void)world.positions();
    (void)world.state_hash();
    (void)world.snapshot();
}

}  // namespace carom::fuzz
