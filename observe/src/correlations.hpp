// Mean square displacement and velocity autocorrelation over the lag, from all samples as origins.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <carom/observe/observer.hpp>

#include "words.hpp"

namespace carom::observe {

class Correlations {
 public:
    /// For balls of these ids, and so many lags of one sample each.
    Correlations(std::vector<std::uint32_t> ids, std::size_t lags) : ids_(std::move(ids)), lags_(lags) {}

    /// A sample at a time that no other has taken. Where it does not follow the one before by the usual
    /// interval, that of the first two, nothing before it is an origin any more.
    void add(double time, const PlaneVectors& unwrapped, const PlaneVectors& velocities);
    void give(Curve& displacement, Curve& velocity) const;
    void save(WordSink& words);
    void restore(WordSource& words);

 private:
    struct Moment {
        double time = 0;
        std::vector<Vec2> position, velocity;
    };
    struct Sums {
        double lag = 0;
        double displacement = 0;
        double velocity = 0;
        std::uint64_t origins = 0;
    };

    template <class Words>
    void visit(Words& words) {
        words(interval_);
        // NOLINTBEGIN(misc-const-correctness): not where they are read
        for (Moment& m : moments_) words(m.time, m.position, m.velocity);
        for (Sums& s : sums_) words(s.lag, s.displacement, s.velocity, s.origins);
        // NOLINTEND(misc-const-correctness)
    }
    [[nodiscard]] bool follows(double time) const;
    void correlate(const Moment& now);

    std::vector<std::uint32_t> ids_;
    std::size_t lags_;
    double interval_ = 0;
    std::deque<Moment> moments_;  // newest first
    std::vector<Sums> sums_;      // by lag
};

}  // namespace carom::observe
