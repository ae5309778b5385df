// Seeds, normal numbers and the logarithm that they need.
#include "placement_random.hpp"

#include <cmath>
#include <numbers>

namespace carom::detail {
namespace {

std::uint64_t mixed(
    std::uint64_t x) {  // splitmix64 (Steele, Lea and Flood 2014): its increment and finaliser
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t fill, Stream stream)
    : engine_(mixed(mixed(mixed(seed) + fill) + static_cast<std::uint64_t>(stream))) {}

std::array<double, 2> Random::normal_pair() {
    // Marsaglia and Bray's polar method: of libm only the square root, which is exact everywhere.
    for (;;) {
        const double u = 2 * uniform() - 1;
        const double v = 2 * uniform() - 1;
        const double s = u * u + v * v;
        if (s >= 1 || s < 0x1p-1000) continue;
        const double factor = std::sqrt(-2 * portable_log(s) / s);
        return {u * factor, v * factor};
    }
}

double portable_log(double x) {
    int exponent = 0;
    double m = std::frexp(x, &exponent);
    if (m < std::numbers::sqrt2 / 2) {
        m *= 2;
        --exponent;
    }
    // ln m = 2 artanh z with |z| <= 0.1716; the first term left out is below 1e-18.
    const double z = (m - 1) / (m + 1);
    const double z_squared = z * z;
    double sum = 0;
    for (int k = 23; k >= 1; k -= 2) sum = sum * z_squared + 1.0 / k;
    return static_cast<double>(exponent) * std::numbers::ln2 + 2 * z * sum;
}

}  // namespace carom::detail
