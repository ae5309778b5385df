// One run as the study sees it, and how far two of them are apart.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <carom/parallel/world.hpp>

#include "matching.hpp"

namespace carom::bench {

/// How long a scene runs and when it is looked at. A stretch is the time in which a ball has two collisions
/// on the mean.
struct Course {
    double stretch = 0;
    int stretches = 1;
    static constexpr int kSamples = 16;  ///< of all places in a stretch
    [[nodiscard]] double duration() const { return stretch * stretches; }
    [[nodiscard]] double time_of(std::size_t sample) const { return stretch * double(sample) / kSamples; }
};

struct Trace {
    std::vector<PlaneVectors> places;  ///< one a sample, from time 0 on
    std::vector<Meeting> meetings;     ///< of the first three stretches
    Counts counts;
    double energy_0 = 0, energy_1 = 0;
    Vec2 momentum_0 = Vec2::Zero(), momentum_1 = Vec2::Zero();
    double speeds = 0;               ///< sum of mass times speed at the start: what momentum is small against
    double max_overlap = 0;          ///< at the ends of the stretches, the deepest of them
    std::optional<double> pressure;  ///< PA / NkT
    std::uint64_t hash = 0;
};

[[nodiscard]] Trace trace(const Scene& scene, const Course& course, int domains = 1);

/// The distance of each ball's places in two samples, across periodic sides where that is shorter.
[[nodiscard]] std::vector<double> distances(const PlaneVectors& x, const PlaneVectors& y, const Scene& scene);

/// Mean of the distances, each at most the ball's radius, in radii: 0 for the same places, 1 for unrelated
/// ones. Static balls are left out.
[[nodiscard]] double place_error(const std::vector<double>& distances, const Scene& scene);

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

}  // namespace carom::bench
