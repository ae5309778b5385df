// Values, ranges and their ends.
#include "colouring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace carom::app {
namespace {

float value_of(const std::vector<Ball>& balls, std::size_t i, ColourBy by,
               const std::vector<std::uint32_t>& numbers) {
    const Ball& ball = balls[i];
    if (by == ColourBy::kSpeed) return float(std::hypot(ball.velocity.x(), ball.velocity.y()));
    if (by == ColourBy::kSize) return float(ball.radius);
    return i < numbers.size() ? float(numbers[i]) : 0.0F;
}

std::vector<float> moving_values(const std::vector<Ball>& balls, const std::vector<float>& values) {
    std::vector<float> moving;
    moving.reserve(values.size());
    for (std::size_t i = 0; i < balls.size(); ++i)
        if (!balls[i].is_static) moving.push_back(values[i]);
    return moving;
}

}  // namespace

const char* name_of(ColourBy by) {
    constexpr std::array kNames = {"speed", "size", "collisions", "domain"};
    return kNames[std::size_t(by)];
}

double Colouring::fraction_of(double value) const {
    if (by != ColourBy::kDomain) return (value - low) / (high - low);
    // Numbers in a row land far apart on the colours, and never on one place.
    constexpr double kGolden = 0.6180339887498949;
    return value * kGolden - std::floor(value * kGolden);
}

double quantile(std::vector<float> values, double share) {
    if (values.empty()) return 0;
    const auto rank =
        std::max<std::ptrdiff_t>(std::ptrdiff_t(std::ceil(share * double(values.size()))) - 1, 0);
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[std::size_t(rank)];
}

double top_speed(const std::vector<Ball>& balls) {
    std::vector<float> speeds;
    speeds.reserve(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) speeds.push_back(value_of(balls, i, ColourBy::kSpeed, {}));
    return quantile(moving_values(balls, speeds), 0.99);
}

Colouring colouring_of(const std::vector<Ball>& balls, ColourBy by, const std::vector<std::uint32_t>& numbers,
                       std::optional<double> top) {
    Colouring c;
    c.by = by;
    c.values.reserve(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) c.values.push_back(value_of(balls, i, by, numbers));
    if (by == ColourBy::kDomain) return c;
    const std::vector<float> moving = moving_values(balls, c.values);
    const bool spans_all = by == ColourBy::kSize;
    c.high = top ? *top : quantile(moving, spans_all ? 1 : 0.99);
    // Speeds begin at rest. Balls of one size, or with counts all alike, would leave no range.
    if (by != ColourBy::kSpeed) c.low = quantile(moving, spans_all ? 0 : 0.01);
    if (by == ColourBy::kCollisions) c.high = top ? *top : std::max(c.high, c.low + 1);
    if (!(c.high > c.low)) c.low = 0;
    if (!(c.high > c.low)) c.high = 1;
    c.has_more = std::ranges::any_of(moving, [&](float value) { return value > c.high; });
    return c;
}

}  // namespace carom::app
