// A system of known course as the parameter of a test.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <ostream>
#include <string>

#include "accuracy/systems.hpp"

namespace carom::accuracy {

// GoogleTest's name for a system where a test fails.
inline void PrintTo(const System& system, std::ostream* out) {
    *out << system.name;
}

inline std::string name_of_system(const testing::TestParamInfo<System>& info) {
    std::string name;
    for (const char c : info.param.name + "_" + info.param.figure)
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

class ExactSystem : public testing::TestWithParam<System> {};

inline void expect_within_bound(const System& system) {
    const Deviation d = system.measure();
    EXPECT_EQ(d.collisions, d.expected);
    EXPECT_GT(d.expected, 0U);
    EXPECT_LE(d.error, d.bound);
}

}  // namespace carom::accuracy
