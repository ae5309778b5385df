// Scene after scene, drawn and examined, until the time or the number is reached; what fails is shrunk and
// written.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shrink.hpp"

namespace carom::stress {

struct CampaignOptions {
    std::uint64_t seed = 1;
    std::size_t most_balls = 300;
    int threads = 2;
    std::optional<std::uint64_t> scenes;  ///< none: as many as the time allows
    double seconds = 60;                  ///< of the clock on the wall
    double shrink_seconds = 60;           ///< at most, for one failure
    std::uint64_t most_failures = 5;      ///< more would tell nothing
};

struct Tally {
    std::uint64_t scenes = 0;
    std::uint64_t collisions = 0;
    std::uint64_t failures = 0;
    std::uint64_t cut = 0;      ///< left early, see Verdict
    std::uint64_t refused = 0;  ///< by the engine, as documented
};

/// The seed of the scene with that number, and of its trial.
[[nodiscard]] std::uint64_t seed_of_scene(std::uint64_t seed, std::uint64_t number);

/// What is told on the way.
struct CampaignWatch {
    std::function<void(const Trial&)> drawn = [](const Trial&) {};
    std::function<void(const Tally&)> progress = [](const Tally&) {};  ///< after each scene
    std::function<void(const Trial&, const Verdict&)> failed;          ///< shrunk already
    std::function<bool()> is_interrupted = [] { return false; };
};

/// Runs until the time is over, an interrupt comes or so much has failed that more would tell nothing.
Tally run_campaign(const CampaignOptions& options, const CampaignWatch& watch);

}  // namespace carom::stress
