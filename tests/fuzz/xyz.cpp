#include <string>

#include <carom/io/xyz.hpp>

#include "inputs.hpp"
#include "refusal.hpp"

namespace carom::fuzz {

void take_xyz(std::string_view bytes) {
    XyzFrame frame;
    if (!taken<SceneError>([&] { frame = parse_xyz(bytes, "input.xyz"); })) return;
    expect(frame.balls.size() == frame.lines.size(), "every ball has its line");
    expect(frame.balls.size() <= bytes.size(), "there are no more balls than bytes");
    std::string written;
    append_xyz(written, frame.time.value_or(0), frame.balls, std::nullopt);
    XyzFrame again;
    if (!taken<SceneError>([&] { again = parse_xyz(written, "again.xyz"); }))
        broken("what is written is read", written);
    std::string twice;
    append_xyz(twice, again.time.value_or(0), again.balls, std::nullopt);
    expect(twice == written, "what is read is what was written", written);
}

}  // namespace carom::fuzz
