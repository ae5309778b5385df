// LAMMPS files: dumps as written, data files as read.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <carom/io/lammps.hpp>

namespace carom {
namespace {

TEST(LammpsDump, HasBoundsColumnsAndTime) {
    std::vector<Ball> balls(2);
    balls[0].position = {0.1, 2};
    balls[0].velocity = {-1e-300, 1.0 / 3};
    balls[1].radius = 0.25;
    balls[1].mass = 4;
    balls[1].is_static = true;
    const Domain domain{{{-1, 0}, {9, 5}}, {Boundary::kPeriodic, Boundary::kWall}, 1};
    std::string text;
    append_lammps_dump(text, 7, 0.7, balls, domain);
    EXPECT_EQ(text,
              "ITEM: TIME\n0.7\nITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff pp\n"
              "-1 9\n0 5\n-0.5 0.5\nITEM: ATOMS id type x y z vx vy vz radius mass\n"
              "1 1 0.1 2 0 -1e-300 0.3333333333333333 0 0.5 1\n2 2 0 0 0 0 0 0 0.25 4\n");
    text.clear();
    append_lammps_dump(text, 0, 0, balls, std::nullopt);  // bounds around what is there
    EXPECT_NE(text.find("ITEM: BOX BOUNDS ss ss pp\n-0.4 0.6\n-0.25 2.5\n"), std::string::npos) << text;
}

constexpr const char* kSpheres = R"(A title

3 atoms   # and a remark
2 atom types
-1 9 xlo xhi
0 5 ylo yhi
-0.5 0.5 zlo zhi

Atoms # sphere

3 2 2.0 0.5 4 3 0
1 1 1.0 1.0 1 1 0 0 0 0
2 1 1.0 1.0 2.5 1.5 0

Velocities

1 0.5 -0.5 0 0 0 0
3 -2 1e-3 0 0 0 0
)";

TEST(LammpsData, SpheresInTheOrderOfTheirIds) {
    const XyzFrame frame = parse_lammps_data(kSpheres, "s.data");
    ASSERT_EQ(frame.balls.size(), 3U);
    EXPECT_EQ(frame.balls[0].position, Vec2(1, 1));
    EXPECT_EQ(frame.balls[0].velocity, Vec2(0.5, -0.5));
    EXPECT_EQ(frame.balls[0].radius, 0.5);
    EXPECT_EQ(frame.balls[1].position, Vec2(2.5, 1.5));
    EXPECT_EQ(frame.balls[1].velocity, Vec2(0, 0));
    EXPECT_EQ(frame.balls[2].radius, 1);
    EXPECT_NEAR(frame.balls[2].mass, 0.5 * 4 / 3 * std::numbers::pi, 1e-15);
    EXPECT_EQ(frame.balls[2].velocity, Vec2(-2, 1e-3));
    EXPECT_EQ(frame.lines, (std::vector<std::uint64_t>{12, 13, 11}));
    ASSERT_TRUE(frame.box);
    EXPECT_EQ(frame.box->min, Vec2(-1, 0));
    EXPECT_EQ(frame.box->max, Vec2(9, 5));
}

TEST(LammpsData, AtomsHaveTheMassOfTheirType) {
    const XyzFrame frame = parse_lammps_data(
        "t\n2 atoms\nMasses\n\n1 3\n2 0.5 # light\n\nAtoms\n\n1 2 0 0 0\n2 1 5 0 0 -1 0 0\n\n"
        "Bond Coeffs\n\n1 2 3\n",
        "a.data");
    ASSERT_EQ(frame.balls.size(), 2U);
    EXPECT_EQ(frame.balls[0].mass, 0.5);
    EXPECT_EQ(frame.balls[1].mass, 3);
    EXPECT_EQ(frame.balls[1].radius, 0.5);
}

struct Fault {
    const char* text;
    const char* message;
};

class BrokenLammpsData : public testing::TestWithParam<Fault> {};

TEST_P(BrokenLammpsData, IsRefusedWithItsPlace) {
    try {
        (void)parse_lammps_data(GetParam().text, "b.data");
        FAIL() << "was accepted";
    } catch (const SceneError& error) {
        EXPECT_EQ(std::string(error.what()), GetParam().message);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenLammpsData,
    testing::Values(
        Fault{"", "b.data: is empty"},
        Fault{"t\n", "b.data: is no LAMMPS data file: no line says how many atoms there are"},
        Fault{"t\n1 atoms\n", "b.data: has no section Atoms"},
        Fault{"t\nAtoms\n\n1 1 0 0 0\n", "b.data:2: the header must say how many atoms there are"},
        Fault{"t\n-1 atoms\n", "b.data:2: must be the number of balls, is \"-1\""},
        Fault{"t\n2 atoms\n\nAtoms\n\n1 1 0 0 0\n", "b.data:6: section Atoms has 1 lines, the header says 2"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 0 0 0\n2 1 0 0 0\n",
              "b.data:7: the header says that there are 1 atoms"},
        Fault{"t\n1 atoms\n\nAtoms # full\n\n1 1 0 0 0\n",
              "b.data:4: atom style \"full\" is not read (known: atomic, sphere)"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 0 0\n",
              "b.data:6: 4 columns are those of no known atom style (atomic: 5, sphere: 7, 3 more with image "
              "flags)"},
        Fault{"t\n1 atoms\n\nAtoms # sphere\n\n1 1 0 0 0\n",
              "b.data:6: must have 7 columns, or 10 with image flags, has 5"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 x 0 0\n", "b.data:6: column 3 must be a number, is \"x\""},
        Fault{"t\n2 atoms\n\nAtoms\n\n1 1 0 0 0\n1 1 3 0 0\n", "b.data:7: has the id 1 of line 6"},
        Fault{"t\n1 atoms\n\nMasses\n\n2 1\n\nAtoms\n\n1 1 0 0 0\n",
              "b.data:10: type 1 has no line in the section Masses"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 0 0 0\n\nVelocities\n\n2 0 0 0\n",
              "b.data: has velocities of atoms that are not in the section Atoms"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 0 0 0\n\nVelocities\n\n1 0 0 0\n1 0 0 0\n",
              "b.data:11: a second velocity of atom 1"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 0 0 0\n\nAtoms\n\n",
              "b.data:8: a second section Atoms; the first is at line 4"},
        Fault{"t\n1 atoms\n\nAtoms\n\n1 1 0 0 0\n\n5 6\n", "b.data:8: belongs to no section: \"5 6\""},
        Fault{"t\nwhat is this\n",
              "b.data:2: must be a header line or a section's name, is \"what is this\""}));

}  // namespace
}  // namespace carom
