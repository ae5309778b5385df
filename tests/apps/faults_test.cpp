// What carom stress is for: faults put into the engine on purpose are found within a few scenes, shrunk to
// few balls, and what is written shows the fault again. Linked with a library that has the faults.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <carom/io/scene_file.hpp>

#include "fault.hpp"
#include "stress/campaign.hpp"

namespace carom::test {
namespace {

struct NamedFault {
    Fault fault;
    const char* name;
    std::size_t most_balls;  ///< of the scenes drawn: some faults need many
};

void PrintTo(const NamedFault& f, std::ostream* out) {
    *out << f.name;
}

class Faults : public testing::TestWithParam<NamedFault> {
 protected:
    void TearDown() override { active_fault = Fault::kNone; }
};

// A user's CI runs some hundred scenes a minute on one core.
constexpr std::uint64_t kScenes = 150;

TEST_P(Faults, AreFoundAndShrunk) {
    active_fault = GetParam().fault;
    stress::CampaignOptions options;
    options.seed = 1;
    options.most_balls = GetParam().most_balls;
    options.scenes = kScenes;
    options.most_failures = 1;
    options.shrink_seconds = 1;
    std::vector<stress::Trial> found;
    stress::CampaignWatch watch;
    std::size_t balls_before = 0;
    watch.drawn = [&](const stress::Trial& trial) { balls_before = trial.scene.balls.size(); };
    watch.failed = [&](const stress::Trial& trial, const stress::Verdict& verdict) {
        found.push_back(trial);
        EXPECT_FALSE(verdict.detail.empty());
    };
    const stress::Tally tally = run_campaign(options, watch);
    ASSERT_EQ(found.size(), 1U) << "not found in " << tally.scenes << " scenes";
    RecordProperty("scenes", std::to_string(tally.scenes));
    EXPECT_LE(found[0].scene.balls.size(), balls_before);

    stress::Trial read = found[0];
    read.scene = parse_scene(write_scene(found[0].scene));
    EXPECT_TRUE(stress::examine(read).failed()) << "the scene as written does not show the fault";
    active_fault = Fault::kNone;
    EXPECT_FALSE(stress::examine(read).failed()) << "fails without the fault";
}

INSTANTIATE_TEST_SUITE_P(Each, Faults,
                         testing::Values(NamedFault{Fault::kLateBound, "LateBound", 60},
                                         NamedFault{Fault::kStalePartner, "StalePartner", 60},
                                         NamedFault{Fault::kEnergyGain, "EnergyGain", 60},
                                         NamedFault{Fault::kSwappedMasses, "SwappedMasses", 60},
                                         NamedFault{Fault::kUnseenLarge, "UnseenLarge", 300},
                                         NamedFault{Fault::kUnlikeCopies, "UnlikeCopies", 300},
                                         NamedFault{Fault::kForgottenHit, "ForgottenHit", 150},
                                         NamedFault{Fault::kOneMask, "OneMask", 60},
                                         NamedFault{Fault::kOldFlights, "OldFlights", 60}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace carom::test
