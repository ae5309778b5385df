// Every pair, every event: the engine against the reference engine that knows no grid and no queue. Time,
// bodies and the state at the end must agree to the bit.
#include <gtest/gtest.h>

#include "brute_force_audit.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

constexpr std::size_t kEvents = 10'000;
constexpr std::size_t kFewerEvents = 1'000;

class BruteForceAudit : public testing::TestWithParam<NamedScene> {};

TEST_P(BruteForceAudit, AgreesEventByEvent) {
    audit(GetParam().scene, 0, kEvents);
}
TEST_P(BruteForceAudit, AgreesWithWideCells) {
    audit(GetParam().scene, 3, kFewerEvents);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BruteForceAudit, testing::ValuesIn(feature_scenes()), kNameOfScene);

}  // namespace
}  // namespace carom::test
