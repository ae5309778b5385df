// Extended XYZ, writing.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <carom/io/atomic_file.hpp>
#include <carom/io/xyz.hpp>

namespace carom {
namespace {

/// Which of the columns that most scenes do without are needed.
struct ExtraColumns {
    bool acceleration = false;
    bool restitution = false;
    bool is_static = false;
};

ExtraColumns extra_columns(std::span<const Ball> balls) {
    ExtraColumns extra;
    for (const Ball& ball : balls) {
        for (const double a : {ball.acceleration.x(), ball.acceleration.y()})
            extra.acceleration =
                extra.acceleration || a != 0 || std::signbit(a);  // the bits of -0 count, too
        extra.restitution = extra.restitution || ball.restitution != 1;
        extra.is_static = extra.is_static || ball.is_static;
    }
    return extra;
}

void append_comment(std::string& text, double time, const std::optional<Domain>& domain,
                    const ExtraColumns& extra) {
    const auto out = std::back_inserter(text);
    if (domain) {
        const auto periodic = [&](int axis) {
            return domain->boundary[axis] == Boundary::kPeriodic ? 'T' : 'F';
        };
        const Vec2 size = domain->box.max - domain->box.min;
        fmt::format_to(out, "Lattice=\"{} 0 0 0 {} 0 0 0 1\" Origin=\"{} {} 0\" pbc=\"{} {} F\" ", size.x(),
                       size.y(), domain->box.min.x(), domain->box.min.y(), periodic(0), periodic(1));
    }
    fmt::format_to(out, "Properties=id:I:1:species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1{}{}{} Time={}\n",
                   extra.acceleration ? ":acceleration:R:3" : "", extra.restitution ? ":restitution:R:1" : "",
                   extra.is_static ? ":static:L:1" : "", time);
}

}  // namespace

void append_xyz(std::string& text, double time, std::span<const Ball> balls,
                const std::optional<Domain>& domain, Precision precision) {
    const ExtraColumns extra = extra_columns(balls);
    fmt::memory_buffer buffer;
    const auto out = std::back_inserter(buffer);
    fmt::format_to(std::back_inserter(text), "{}\n", balls.size());
    append_comment(text, time, domain, extra);
    constexpr std::size_t kPieceSize = std::size_t{1} << 16;
    for (std::size_t id = 0; id < balls.size(); ++id) {
        const Ball& ball = balls[id];
        const auto put_state = [&](const auto& x, const auto& v) {
            fmt::format_to(out, "{} X {} {} 0 {} {} 0", id, x.x(), x.y(), v.x(), v.y());
        };
        if (precision == Precision::kFloat)
            put_state(Vector2<float>(ball.position.cast<float>()),
                      Vector2<float>(ball.velocity.cast<float>()));
        else
            put_state(ball.position, ball.velocity);
        fmt::format_to(out, " {} {}", ball.radius, ball.mass);
        if (extra.acceleration) fmt::format_to(out, " {} {} 0", ball.acceleration.x(), ball.acceleration.y());
        if (extra.restitution) fmt::format_to(out, " {}", ball.restitution);
        if (extra.is_static) fmt::format_to(out, " {}", ball.is_static ? 'T' : 'F');
        buffer.push_back('\n');
        if (buffer.size() < kPieceSize) continue;
        text.append(buffer.data(), buffer.size());
        buffer.clear();
    }
    text.append(buffer.data(), buffer.size());
}

void write_xyz(const std::filesystem::path& path, double time, std::span<const Ball> balls,
               const std::optional<Domain>& domain) {
    AtomicFile file(path);
    std::string text;
    append_xyz(text, time, balls, domain);
    file.write(text);
    file.commit();
}

}  // namespace carom
