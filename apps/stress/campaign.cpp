#include "campaign.hpp"

#include <fmt/format.h>

#include "edits.hpp"
#include "hash.hpp"
#include "scenes.hpp"

namespace carom::stress {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::uint64_t seed_of_scene(std::uint64_t seed, std::uint64_t number) {
    return mix(mix(seed + 1) + number) >> 32;  // short enough to be typed
}

Tally run_campaign(const CampaignOptions& options, const CampaignWatch& watch) {
    const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    Tally tally;
    const auto goes_on = [&] {
        if (watch.is_interrupted() || tally.failures >= options.most_failures) return false;
        return options.scenes ? tally.scenes < *options.scenes : seconds_since(start) < options.seconds;
    };
    while (goes_on()) {
        const std::uint64_t seed = seed_of_scene(options.seed, tally.scenes);
        Trial trial{draw_scene(seed, options.most_balls), seed, options.threads, drawn_edits(seed)};
        trial.scene.name = fmt::format("stress seed {}, scene {}", options.seed, tally.scenes);
        watch.drawn(trial);
        Verdict verdict = examine(trial);
        ++tally.scenes;
        tally.collisions += verdict.collisions;
        tally.cut += verdict.is_cut;
        tally.refused += verdict.is_refused;
        if (verdict.failed()) {
            ++tally.failures;
            const std::chrono::steady_clock::time_point found = std::chrono::steady_clock::now();
            trial = shrink(std::move(trial), verdict, [&] {
                return seconds_since(found) < options.shrink_seconds && !watch.is_interrupted();
            });
            watch.failed(trial, verdict);
        }
        watch.progress(tally);
    }
    return tally;
}

}  // namespace carom::stress
