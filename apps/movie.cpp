// Frame by frame: advance, draw, hand over.
#include "movie.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>

#include "picture_file.hpp"

namespace carom::app {
namespace {

/// The same view in all frames: the start's, whatever leaves it.
PictureLook fixed_look(const Scene& scene, const World& world, PictureLook look) {
    if (!look.view && !scene.domain) look.view = view_of(picture_of(scene, world, look));
    return look;
}

}  // namespace

int time_digits(const MovieTimes& times) {
    constexpr int kUsual = 6;
    return std::clamp(int(std::ceil(std::log10(times.until / times.step()))) + 1, kUsual, 17);
}

double ColourTop::next(double top) {
    top_ = top_ < 0 ? top : top_ + share_ * (top - top_);
    return top_;
}

bool write_movie(World& world, const Scene& scene, const MovieTimes& times, const PictureLook& asked,
                 const std::optional<PictureSize>& size, const std::filesystem::path& out, MovieFormat format,
                 Driver& driver) {
    (void)std::signal(SIGPIPE, SIG_IGN);  // an encoder that ends early is an error of the file's
    std::optional<CollisionTally> tally;
    if (asked.colour_by == ColourBy::kCollisions) tally.emplace(world);
    // Before anything is simulated: what cannot be written is known at once.
    const PictureLook look = fixed_look(scene, world, asked);
    const PictureContent first = picture_of(scene, world, look);
    const PictureLayout layout = picture_layout(first, size);
    MovieFile movie(out, {format, layout.size.width, layout.size.height, times.frames_per_second});
    if (!driver.advance_to(times.from)) return false;
    ColourTop top(times.frames_per_second);
    Multiples frames(times.step(), times.until - times.from);
    for (; const std::optional<double> since = frames.next(); frames.advance()) {
        if (!driver.advance_to(times.from + *since)) return false;
        PictureContent content = picture_of(scene, world, look, tally);
        content.time_digits = time_digits(times);
        if (!look.colour_top) {
            const Colouring own = colouring_of(content.balls, content.colour_by, content.numbers);
            content.colour_top = top.next(own.high);
        }
        movie.write_frame(picture_pixels(content, layout));
    }
    movie.finish();
    return true;
}

}  // namespace carom::app
