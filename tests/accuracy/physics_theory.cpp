#include "accuracy/physics_theory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom::accuracy {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStep = 1e-4;  // of the differences: cut off and rounded to 1e-6 of what they give

// B_k / B_2^(k-1), k = 1 to 10, in powers of B_2 n = 2 eta.
constexpr std::array<double, 10> kVirial = {1,         1,         0.782004,  0.53223180, 0.33355604,
                                            0.1988425, 0.1148728, 0.0649930, 0.0362193,  0.0199537};

/// Area common to two circles whose centres are so far apart.
double lens(double a, double b, double distance) {
    if (distance >= a + b) return 0;
    if (distance <= std::abs(a - b)) return kPi * std::min(a, b) * std::min(a, b);
    const double x = (distance * distance + a * a - b * b) / (2 * distance);
    const double y = std::sqrt(std::max(0.0, a * a - x * x));
    return a * a * std::acos(std::clamp(x / a, -1.0, 1.0)) +
           b * b * std::acos(std::clamp((distance - x) / b, -1.0, 1.0)) - distance * y;
}

/// A third of the integral over places of discs 2 and 3 where all three overlap, disc 1 at the origin. The
/// midpoint rule with so many points is right to 1e-7.
double cluster_integral(double s12, double s13, double s23) {
    constexpr int kPoints = 4000;
    double sum = 0;
    for (int k = 0; k < kPoints; ++k) {
        const double distance = (k + 0.5) * s12 / kPoints;
        sum += 2 * kPi * distance * lens(s13, s23, distance);
    }
    return sum * s12 / kPoints / 3;
}

double xi_of(const Mixture& m) {
    return m.mean_diameter() * m.mean_diameter() / m.mean_diameter_squared();
}

}  // namespace

double compressibility(double packing) {
    const double x = 2 * packing;
    const double ratio = kVirial[9] / kVirial[8] * x;
    double sum = kVirial[9] / (1 - ratio);
    for (int k = 8; k >= 0; --k) sum = kVirial[static_cast<std::size_t>(k)] + x * sum;
    return sum;
}

double compressibility_slope(double packing) {
    return (compressibility(packing + kStep) - compressibility(packing - kStep)) / (2 * kStep);
}

double compressibility_curvature(double packing) {
    return (compressibility(packing + kStep) - 2 * compressibility(packing) +
            compressibility(packing - kStep)) /
           (kStep * kStep);
}

double finite_size_shift(double packing, double discs) {
    const double slope = compressibility_slope(packing);
    return -packing / (2 * discs) * (2 * slope + packing * compressibility_curvature(packing)) /
           (compressibility(packing) + packing * slope);
}

double collision_rate(double packing) {
    return 4 * (compressibility(packing) - 1) / std::sqrt(kPi);
}

double sphere_factor(double dimensions) {
    const double half = dimensions / 2;
    return std::sqrt(half) * std::exp(std::lgamma(half) - std::lgamma(half + 0.5));
}

double Mixture::mean_diameter() const {
    return share[0] * diameter[0] + share[1] * diameter[1];
}

double Mixture::mean_diameter_squared() const {
    return share[0] * diameter[0] * diameter[0] + share[1] * diameter[1] * diameter[1];
}

double mixture_compressibility(const Mixture& mixture, double packing) {
    const double xi = xi_of(mixture);
    return (1 - xi) / (1 - packing) + xi * compressibility(packing);
}

double mixture_third_by_santos(const Mixture& mixture) {
    const double xi = xi_of(mixture);
    return (1 - xi) + xi * 4 * kVirial[2];
}

double mixture_third(const Mixture& m) {
    double third = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k)
                third += m.share[i] * m.share[j] * m.share[k] *
                         cluster_integral(m.contact(i, j), m.contact(i, k), m.contact(j, k));
    const double disc = kPi / 4 * m.mean_diameter_squared();
    return third / (disc * disc);
}

ContactValue contact_value(const Mixture& m, double packing, int i, int j) {
    const double density = packing / (kPi / 4 * m.mean_diameter_squared());
    double first = 0;
    for (int k = 0; k < 2; ++k)
        first += m.share[k] * density * lens(m.contact(i, k), m.contact(j, k), m.contact(i, j));
    const double size =
        m.diameter[i] * m.diameter[j] / m.contact(i, j) * m.mean_diameter() / m.mean_diameter_squared();
    const double all = 1 / (1 - packing) + 9.0 / 16 * packing / ((1 - packing) * (1 - packing)) * size;
    const double beyond = all - 1 - packing * (1 + 9.0 / 16 * size);
    return {1 + first + beyond, beyond};
}

}  // namespace carom::accuracy
