// How wrong a run is, against a reference that it is compared with before chaos parts the two.
#pragma once

#include <optional>

#include <carom/core/scene.hpp>
#include <carom/trade/matching.hpp>
#include <carom/trade/trace.hpp>

namespace carom::trade {

/// The distance of each ball's places in two samples, across periodic sides where that is shorter.
[[nodiscard]] std::vector<double> distances(const PlaneVectors& x, const PlaneVectors& y, const Scene& scene);

/// Mean of the distances, each at most the ball's radius, in radii: 0 for the same places, 1 for unrelated
/// ones. Static balls are left out.
[[nodiscard]] double place_error(const std::vector<double>& distances, const Scene& scene);

/// Missed and invented collisions among the first two of each ball, in the first two stretches; a time may
/// differ by a tenth of the mean time between two collisions of a ball.
[[nodiscard]] Matching matching_of(const Scene& scene, const Course& course, const Trace& reference,
                                   const Trace& other);

/// When the first collision happens that only one of the two runs has, however late; none where they agree.
[[nodiscard]] std::optional<double> divergence_time(const Scene& scene, const Course& course,
                                                    const Trace& reference, const Trace& other);

/// What the first stretch shows of a run: the largest of the four is its error.
struct Errors {
    double energy = 0;      ///< difference from the reference, over the most kinetic energy
    double collisions = 0;  ///< missed and invented ones over those that were compared
    double overlap = 0;     ///< the deepest at the samples, in radii's sums
    double places = 0;      ///< mean distance from the reference's places at the end, in radii
    [[nodiscard]] double largest() const;
};
[[nodiscard]] Errors errors_of(const Scene& scene, const Course& course, const Trace& reference,
                               const Trace& other);

/// When half of the moving balls have once been a radius from their places in the reference; none where that
/// does not happen.
[[nodiscard]] std::optional<double> separation_time(const Trace& reference, const Trace& other,
                                                    const Scene& scene, const Course& course);

/// Growth of the distance of all places, per time: the slope of its logarithm, by least squares, from where
/// it first exceeds `low` to where it first exceeds `high`; none where fewer than three samples lie there.
[[nodiscard]] std::optional<double> growth_of(const std::vector<double>& times,
                                              const std::vector<double>& norms, double low, double high);

/// The largest Lyapunov exponent, as two runs of the event method show it that differ by 1e-12 radii in one
/// ball's place: between 1e-10 and 1e-2 radii.
[[nodiscard]] std::optional<double> lyapunov_exponent(const Trace& reference, const Trace& moved,
                                                      const Scene& scene, const Course& course);

/// The scene with the place of its first moving ball changed by 1e-12 of the radius.
[[nodiscard]] Scene moved_a_little(Scene scene);

}  // namespace carom::trade
