#include "correlations.hpp"

#include <cmath>

namespace carom::observe {

bool Correlations::follows(double time) const {
    constexpr double kRounding = 1e-6;  // of an interval; multiples of it as doubles are never as far off
    const double step = time - moments_.front().time;
    return interval_ == 0 || std::abs(step - interval_) <= kRounding * interval_;
}

void Correlations::add(double time, const PlaneVectors& unwrapped, const PlaneVectors& velocities) {
    if (lags_ == 0 || ids_.empty()) return;
    if (!moments_.empty() && !follows(time)) moments_.clear();
    if (!moments_.empty() && interval_ == 0) interval_ = time - moments_.front().time;
    Moment now;
    if (moments_.size() > lags_) {  // its memory serves again
        now = std::move(moments_.back());
        moments_.pop_back();
    }
    now.time = time;
    now.position.resize(ids_.size());
    now.velocity.resize(ids_.size());
    for (std::size_t k = 0; k < ids_.size(); ++k) {
        now.position[k] = unwrapped[ids_[k]];
        now.velocity[k] = velocities[ids_[k]];
    }
    moments_.push_front(std::move(now));
    correlate(moments_.front());
}

void Correlations::correlate(const Moment& now) {
    if (sums_.size() < moments_.size()) sums_.resize(moments_.size());
    for (std::size_t lag = 0; lag < moments_.size(); ++lag) {
        const Moment& then = moments_[lag];
        double displacement = 0;
        double velocity = 0;
        for (std::size_t k = 0; k < ids_.size(); ++k) {
            displacement += length_squared<double>(now.position[k] - then.position[k]);
            velocity += dot(now.velocity[k], then.velocity[k]);
        }
        Sums& s = sums_[lag];
        s.lag += now.time - then.time;
        s.displacement += displacement / double(ids_.size());
        s.velocity += velocity / double(ids_.size());
        ++s.origins;
    }
}

void Correlations::give(Curve& displacement, Curve& velocity) const {
    for (const Sums& s : sums_) {
        const auto origins = double(s.origins);
        displacement.at.push_back(s.lag / origins);
        displacement.value.push_back(s.displacement / origins);
        velocity.at.push_back(s.lag / origins);
        velocity.value.push_back(s.velocity / origins);
    }
}

void Correlations::save(WordSink& words) {
    words(std::uint64_t{moments_.size()}, std::uint64_t{sums_.size()});
    visit(words);
}

void Correlations::restore(WordSource& words) {
    std::uint64_t moments = 0;
    std::uint64_t sums = 0;
    words(moments, sums);
    const std::uint64_t words_of_moment = 1 + 4 * std::uint64_t{ids_.size()};
    if (moments > lags_ + 1 || sums > lags_ + 1 || sums < moments || moments > words.most(words_of_moment))
        WordSource::fail();
    moments_.resize(moments);
    for (Moment& m : moments_) {
        m.position.resize(ids_.size());
        m.velocity.resize(ids_.size());
    }
    sums_.resize(sums);
    visit(words);
}

}  // namespace carom::observe
