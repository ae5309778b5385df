// Every pair, every event: the engine against the reference engine that knows no grid and no queue. Time,
// bodies and the state at the end must agree to the bit.
#include <gtest/gtest.h>

#include "brute_force_audit.hpp"
#include "sanitized.hpp"
#include "scenes.hpp"

namespace carom::test {
namespace {

constexpr std::size_t kEvents = kIsSanitized ? 2'000 : 10'000;
constexpr std::size_t kFewerEvents = 1'000;

class BruteForceAudit : public testing::TestWithParam<NamedScene> {};

TEST_P(BruteForceAudit, AgreesEventByEvent) {
    audit(GetParam().scene, 0, kEvents);
}
TEST_P(BruteForceAudit, AgreesWithWideCells) {
    audit(GetParam().scene, 3, kFewerEvents);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BruteForceAudit, testing::ValuesIn(feature_scenes()), kNameOfScene);

// The sixteen largest balls are wider than a cell and in no list. A small ball that comes to fly at one of
// them while two cells away must be seen, whichever of the two then brings them into neighbouring cells.
// Where balls seldom meet nothing but the crossings tells them of each other.
TEST(LargeBallsAudit, AgreeThoughBarelyWiderThanACell) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE(seed);
        Scene s = gas(seed, {.count = 120,
                             .packing = 0.35,
                             .boundary_x = Boundary::kWall,
                             .boundary_y = Boundary::kWall,
                             .radius_spread = 0.9});
        for (Ball& b : s.balls) {  // slow, so that they stay in their cells
            b.mass = 100;
            b.radius *= 0.6;
            b.velocity *= 0.1;
        }
        for (std::size_t i = 0; i < 17; ++i) {
            Ball& b = s.balls[7 * i];
            b.radius = i == 0 ? 0.45 : 0.55;  // the cells are made for the first
            b.mass = 1;
            b.velocity *= 20;
        }
        for (Ball& b : s.balls) b.position += Vec2(0.1, 0.1);
        s.domain->box.max += Vec2(0.2, 0.2);
        audit(s, 0.01, 2000);
        if (HasFatalFailure()) return;
    }
}

// Where events share an instant the smallest ids come first, be it a static ball's.
TEST(TiesAudit, KnowAStaticBallsIdAsAnyOther) {
    Scene s;
    s.gravity = {0.9836396545046979, -0.1801472455683922};
    s.balls.resize(4);
    s.balls[0].position = {3.92000291513364, 1.9738017866579318};
    s.balls[0].radius = 0.7581101384317376;
    s.balls[0].is_static = true;
    for (int k = 1; k < 4; ++k) s.balls[k].position = {k - 0.5, 1.5};
    s.until = 0.76;
    audit(s, 0, 100);
}

}  // namespace
}  // namespace carom::test
