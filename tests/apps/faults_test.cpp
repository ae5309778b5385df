// What carom stress is for: faults put into the engine on purpose are found within a few scenes, shrunk to
// few balls, and what is written shows the fault again. Linked with a library that has the faults.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <carom/io/scene_file.hpp>
#include <carom/parallel/world.hpp>

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
                                         NamedFault{Fault::kOldForecasts, "OldForecasts", 300},
                                         NamedFault{Fault::kForgottenHit, "ForgottenHit", 150},
                                         NamedFault{Fault::kOneMask, "OneMask", 60},
                                         NamedFault{Fault::kOldFlights, "OldFlights", 60}),
                         [](const auto& param) { return std::string(param.param.name); });

/// Two balls fly at each other from `way` on either side of the middle, where a cut lies; all others rest.
Scene head_on(double way) {
    Scene s;
    s.domain = Domain{{{0, 0}, {120, 40}}, {Boundary::kWall, Boundary::kWall}, 1};
    for (const double side : {-1.0, 1.0}) {
        const auto add = [&s, side](double distance, double y, double speed) {
            Ball b;
            b.position = {60 + side * distance, y};
            b.velocity = {-side * speed, 0};
            s.balls.push_back(b);
        };
        add(1.5, 20, 0);
        for (int k = 0; k < 10; ++k) add(50, 2 + 3 * k, 0);
        add(way, 35, 1);
    }
    return s;
}

// Neither ball is in the other domain's halo when a window begins, and they may meet just before it ends:
// then nothing else tells that both domains have missed it. No scene drawn at random is likely to show that.
TEST(FaultsOfBlindDomains, MissACollisionThatNeitherSees) {
    int missed = 0;
    for (const int halo : {1, 2}) {
        for (double way = 3; way < 33; way += 0.5) {
            SCOPED_TRACE(way);
            const auto hash = [&](int domains, Fault fault) {
                active_fault = fault;
                World world(head_on(way), {.threads = 1, .cell_size = 1.5, .domains = domains, .halo = halo});
                world.advance_to(60);
                active_fault = Fault::kNone;
                return world.state_hash();
            };
            const std::uint64_t serial = hash(1, Fault::kNone);
            EXPECT_EQ(hash(2, Fault::kNone), serial);
            missed += hash(2, Fault::kBlindDomains) != serial ? 1 : 0;
        }
    }
    EXPECT_GT(missed, 0);
}

}  // namespace
}  // namespace carom::test
