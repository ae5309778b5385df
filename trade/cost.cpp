#include <carom/trade/cost.hpp>

#include <algorithm>
#include <vector>

#include <carom/parallel/world.hpp>
#include <carom/trade/clock.hpp>

namespace carom::trade {
namespace {

constexpr int kMostRounds = 101;

double seconds_of(const Scene& scene, double duration, int threads) {
    World world(scene, {.threads = threads, .count_missed = false});
    const auto start = std::chrono::steady_clock::now();
    world.advance_to(duration);
    return seconds_since(start);
}

/// Sorts them.
double median_of(std::vector<double>& values) {
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

}  // namespace

TimeRatio time_ratio(const Scene& setting, const Scene& reference, double duration, const Timing& timing) {
    std::vector<double> ratios;
    std::vector<double> seconds;
    const auto start = std::chrono::steady_clock::now();
    const auto is_enough = [&](int rounds) {
        if (rounds == 0) return false;
        return (rounds >= timing.least_rounds && seconds_since(start) >= timing.enough_seconds) ||
               rounds == kMostRounds || !timing.goes_on();
    };
    for (int round = 0; !is_enough(round); ++round) {
        double of_reference = 0;
        if (round % 2 == 0) of_reference = seconds_of(reference, duration, timing.threads);
        const double of_setting = seconds_of(setting, duration, timing.threads);
        if (round % 2 != 0) of_reference = seconds_of(reference, duration, timing.threads);
        ratios.push_back(of_setting / of_reference);
        seconds.push_back(of_reference);
    }
    const double median = median_of(ratios);
    return {median, ratios.front(), ratios.back(), static_cast<int>(ratios.size()), median_of(seconds)};
}

}  // namespace carom::trade
