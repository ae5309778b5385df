// One run as the trade sees it: what happened, and where the balls were at times that all runs share.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <carom/parallel/world.hpp>
#include <carom/trade/matching.hpp>

namespace carom::trade {

/// How long a scene runs and when it is looked at. A stretch is the time in which a ball has two collisions
/// on the mean.
struct Course {
    double stretch = 0;
    int stretches = 1;
    bool is_detailed = true;             ///< whether places are kept, and overlaps looked for between samples
    static constexpr int kSamples = 16;  ///< in a stretch
    [[nodiscard]] double duration() const { return stretch * stretches; }
    [[nodiscard]] double time_of(std::size_t sample) const { return stretch * double(sample) / kSamples; }
};

struct Trace {
    bool is_whole = false;             ///< it came to its end; else all but what is in the lists is void
    std::vector<PlaneVectors> places;  ///< one a sample, from time 0 on, where the course is detailed
    PlaneVectors after_stretch;        ///< places at the end of the first
    std::vector<Meeting> meetings;
    Counts counts;
    double energy_0 = 0, energy_after_stretch = 0, energy_1 = 0;  ///< the attractors' potential among it
    double most_kinetic_energy = 0;                               ///< at any sample
    Vec2 momentum_0 = Vec2::Zero(), momentum_1 = Vec2::Zero();
    double speeds = 0;               ///< sum of mass times speed at the start: what momentum is small against
    double max_overlap = 0;          ///< at the samples, which are ends of steps, in radii's sums
    double overlap_between = 0;      ///< at times between the samples
    std::optional<double> pressure;  ///< PA / NkT
    std::uint64_t hash = 0;
};

struct TraceOptions {
    int threads = 1;
    int domains = 0;                                      ///< as World has it
    std::function<bool()> goes_on = [] { return true; };  ///< asked at each sample; false ends the run
};

[[nodiscard]] Trace trace(const Scene& scene, const Course& course, const TraceOptions& options = {});

}  // namespace carom::trade
