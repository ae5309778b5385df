// LAMMPS dump files.
#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <carom/io/lammps.hpp>

namespace carom {
namespace {

const char* bounds_of(Boundary boundary) {
    switch (boundary) {
        case Boundary::kPeriodic:
            return "pp";
        case Boundary::kWall:
            return "ff";
        case Boundary::kOpen:
            break;
    }
    return "ss";
}

Domain around(std::span<const Ball> balls) {
    Domain domain;
    if (balls.empty()) return domain;
    domain.box = {balls[0].position, balls[0].position};
    for (const Ball& ball : balls) {
        domain.box.min = domain.box.min.cwiseMin(ball.position - Vec2::Constant(ball.radius));
        domain.box.max = domain.box.max.cwiseMax(ball.position + Vec2::Constant(ball.radius));
    }
    return domain;
}

}  // namespace

void append_lammps_dump(std::string& text, std::uint64_t step, double time, std::span<const Ball> balls,
                        const std::optional<Domain>& domain, Precision precision) {
    const Domain box = domain ? *domain : around(balls);
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "ITEM: TIME\n{}\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n", time, step,
                   balls.size());
    fmt::format_to(out, "ITEM: BOX BOUNDS {} {} pp\n", bounds_of(box.boundary[0]),
                   bounds_of(box.boundary[1]));
    for (int axis = 0; axis < 2; ++axis) fmt::format_to(out, "{} {}\n", box.box.min[axis], box.box.max[axis]);
    fmt::format_to(out, "-0.5 0.5\nITEM: ATOMS id type x y z vx vy vz radius mass\n");
    for (std::size_t id = 0; id < balls.size(); ++id) {
        const Ball& ball = balls[id];
        const auto put = [&](const auto& x, const auto& v) {
            fmt::format_to(out, "{} {} {} {} 0 {} {} 0 {} {}\n", id + 1, ball.is_static ? 2 : 1, x.x(), x.y(),
                           v.x(), v.y(), ball.radius, ball.mass);
        };
        if (precision == Precision::kFloat)
            put(Vector2<float>(ball.position.cast<float>()), Vector2<float>(ball.velocity.cast<float>()));
        else
            put(ball.position, ball.velocity);
    }
}

}  // namespace carom
