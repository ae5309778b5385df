// Ten million collisions: as right late as early.
#include <gtest/gtest.h>

#include "accuracy/systems.hpp"
#include "system_test.hpp"

namespace carom::accuracy {
namespace {

TEST_P(ExactSystem, StaysWithinItsBound) {
    expect_within_bound(GetParam());
}

INSTANTIATE_TEST_SUITE_P(LongRun, ExactSystem, testing::ValuesIn(long_systems()), name_of_system);

}  // namespace
}  // namespace carom::accuracy
