#include <carom/io/lammps.hpp>

#include "inputs.hpp"
#include "refusal.hpp"

namespace carom::fuzz {

void take_lammps(std::string_view bytes) {
    XyzFrame frame;
    if (!taken<SceneError>([&] { frame = parse_lammps_data(bytes, "input.data"); })) return;
    expect(frame.balls.size() == frame.lines.size(), "every ball has its line");
    expect(frame.balls.size() <= bytes.size(), "there are no more balls than bytes");
}

}  // namespace carom::fuzz
