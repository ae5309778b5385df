// What theory says of hard discs and their mixtures: equations of state, sizes that are finite, rates of
// collisions. Diameters, masses and packings as given; the area of all discs over that of the box is the
// packing.
#pragma once

#include <array>

namespace carom::accuracy {

/// Z = P A / (N k T) of the infinite fluid of equal discs: the virial series to the tenth coefficient (Clisby
/// and McCoy 2006), the rest as the geometric series that the last two begin. Against Kolafa and Rottner 2006
/// it is right to 1e-7, 2e-6, 8e-4 and 8e-2 at packings 0.1, 0.3, 0.5 and 0.65.
double compressibility(double packing);
/// Its first and second derivative after the packing, by central differences.
double compressibility_slope(double packing);
double compressibility_curvature(double packing);

/// Z of so many discs in a periodic box less Z of the infinite fluid, to first order in 1 / N: the pressure
/// of the box is that of the open system of the same density less what the open system's fluctuations of N
/// add through the pressure's curvature, -(eta / 2N) (2 Z' + eta Z'') / (Z + eta Z').
double finite_size_shift(double packing, double discs);

/// Collisions that a disc of diameter 1 and mass 1 has in a unit of time at k T = 1 (Enskog):
/// 2 n sigma chi sqrt(pi k T / m) with chi = (Z - 1) / (2 eta), which is 4 (Z - 1) / sqrt(pi).
double collision_rate(double packing);

/// The mean of |x|, x a component of a vector that is uniform on a sphere in so many dimensions, over that of
/// a normal x of the same variance: sqrt(D / 2) Gamma(D / 2) / Gamma((D + 1) / 2), or 1 + 1 / (4 D) + ...
/// Speeds of a gas of given energy and momentum are such components.
double sphere_factor(double dimensions);

/// Two species of discs.
struct Mixture {
    const char* name;
    std::array<double, 2> share;  ///< of the number of discs; they add up to 1
    std::array<double, 2> diameter;
    std::array<double, 2> mass;

    [[nodiscard]] double mean_diameter() const;
    [[nodiscard]] double mean_diameter_squared() const;  ///< mean of the squares
    [[nodiscard]] double contact(int i, int j) const { return (diameter[i] + diameter[j]) / 2; }
};

inline constexpr Mixture kEqualDiscs{"discs", {1, 0}, {1, 1}, {1, 1}};
/// The small discs are the heavier ones, so that nothing follows from mass going with size.
inline constexpr Mixture kTwoSorts{"discs of two sorts", {0.5, 0.5}, {1, 0.5}, {1, 3}};
inline constexpr Mixture kUnevenSorts{"discs of two uneven sorts", {0.25, 0.75}, {1, 0.4}, {2, 1}};

/// Z of an infinite mixture from that of equal discs (Santos, Yuste and Lopez de Haro 1999):
/// (1 - xi) / (1 - eta) + xi Z(eta), xi = <sigma>^2 / <sigma^2>. Exact to the second virial coefficient.
double mixture_compressibility(const Mixture& mixture, double packing);

/// Third coefficient of Z in powers of the packing, exact: three discs' cluster integral is that of the lens
/// common to two circles, over their distance. By the formula above, and by the integral.
double mixture_third_by_santos(const Mixture& mixture);
double mixture_third(const Mixture& mixture);

/// Density of pairs i, j in contact over that of an ideal gas: exact to first order in the packing, where the
/// third disc lies in the lens of the two circles around a pair in contact; what lies beyond as Jenkins and
/// Mancini 1987 have it, chi = 1 / (1 - eta) + 9/16 eta / (1 - eta)^2 s, s = sigma_i sigma_j <sigma> /
/// (sigma_ij <sigma^2>), and `beyond` says how much that is.
struct ContactValue {
    double value, beyond;
};
ContactValue contact_value(const Mixture& mixture, double packing, int i, int j);

}  // namespace carom::accuracy
