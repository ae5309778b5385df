// Scene files from a program of one's own: read, run, stopped and gone on from, to the same bits.
#include <carom/carom.hpp>
#include <carom/io/scene_file.hpp>

#include <cstdio>
#include <fstream>

int main() {
    std::ofstream("example-scene.json") << R"({
        "domain": {"min": [0, 0], "max": [20, 20], "boundary": ["wall", "wall"]},
        "fill": [{"count": 100, "radius": 0.4, "temperature": 1, "seed": 3}],
        "until": 5 })";
    const carom::Scene scene = carom::read_scene("example-scene.json");

    carom::World whole(scene);
    whole.advance_to(scene.until);

    carom::World first(scene);
    first.advance_to(2);
    const carom::Snapshot half_way = first.snapshot();
    carom::World second(scene, {.threads = 1}, half_way);
    second.advance_to(scene.until);

    std::printf("%zu balls, hash %016llx, gone on from half way %016llx\n", whole.ball_count(),
                static_cast<unsigned long long>(whole.state_hash()),
                static_cast<unsigned long long>(second.state_hash()));
    return whole.state_hash() == second.state_hash() ? 0 : 1;
}
