// Extended XYZ: bits survive, foreign files are understood, torn ones refused at their line.
#include <carom/io/atomic_file.hpp>
#include <carom/io/trajectory.hpp>
#include <carom/io/xyz.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "random_values.hpp"
#include "temporary_folder.hpp"

namespace carom {
namespace {

using testing_values::any_finite;
using testing_values::Generator;
using testing_values::same_bits;

std::string xyz_message_of(const std::string& text) {
    try {
        (void)parse_xyz(text, "some.xyz");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "accepted";
}

std::vector<Ball> random_balls(Generator& generator, std::size_t count) {
    const bool with_acceleration = testing_values::below(generator, 2) == 0;
    const bool with_restitution = testing_values::below(generator, 2) == 0;
    const bool with_static = testing_values::below(generator, 2) == 0;
    const auto vector = [&] {
        const double x = any_finite(generator);
        return Vec2(x, any_finite(generator));
    };
    std::vector<Ball> balls(count);
    for (Ball& ball : balls) {
        ball.position = vector();
        ball.velocity = vector();
        ball.radius = any_finite(generator);
        ball.mass = any_finite(generator);
        if (with_acceleration) ball.acceleration = vector();
        if (with_restitution) ball.restitution = testing_values::unit(generator);
        if (with_static) ball.is_static = testing_values::below(generator, 2) == 0;
    }
    return balls;
}

void expect_same(const std::vector<Ball>& a, const std::vector<Ball>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "ball " << i);
        EXPECT_TRUE(same_bits(a[i].position, b[i].position));
        EXPECT_TRUE(same_bits(a[i].velocity, b[i].velocity));
        EXPECT_TRUE(same_bits(a[i].acceleration, b[i].acceleration));
        EXPECT_TRUE(same_bits(a[i].radius, b[i].radius));
        EXPECT_TRUE(same_bits(a[i].mass, b[i].mass));
        EXPECT_TRUE(same_bits(a[i].restitution, b[i].restitution));
        EXPECT_EQ(a[i].is_static, b[i].is_static);
    }
}

TEST(Xyz, WrittenFramesReadBackBitForBit) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Generator generator(seed);
        const std::vector<Ball> balls = random_balls(generator, testing_values::below(generator, 60));
        const double time = any_finite(generator);
        std::string text;
        append_xyz(text, time, balls, std::nullopt);
        const XyzFrame frame = parse_xyz(text, "some.xyz");
        expect_same(balls, frame.balls);
        ASSERT_TRUE(frame.time);
        EXPECT_TRUE(same_bits(frame.time.value_or(-time), time));
        EXPECT_FALSE(frame.box);
    }
}

TEST(Xyz, ExtremeNumbersSurvive) {
    using Limits = std::numeric_limits<double>;
    std::vector<Ball> balls(2);
    balls[0].position = {Limits::denorm_min(), -Limits::denorm_min()};
    balls[0].velocity = {Limits::max(), Limits::lowest()};
    balls[1].position = {-0.0, 0.0};
    balls[1].velocity = {Limits::min(), 0.1};
    balls[1].radius = 1.0 / 3;
    balls[1].mass = 0x1p53 + 2;
    std::string text;
    append_xyz(text, 0, balls, std::nullopt);
    expect_same(balls, parse_xyz(text, "some.xyz").balls);
}

// The form that OVITO and ASE read: a count, a comment with Lattice and Properties, as many words a line as
// Properties says.
TEST(Xyz, HasTheFormThatOthersRead) {
    std::vector<Ball> balls(2);
    balls[0].position = {1, 2.5};
    balls[0].velocity = {-1, 0};
    balls[1].position = {3, 4};
    std::string text;
    append_xyz(text, 0.5, balls, Domain{{{-5, 0}, {5, 20}}, {Boundary::kPeriodic, Boundary::kWall}, 1});
    EXPECT_EQ(text,
              "2\n"
              "Lattice=\"10 0 0 0 20 0 0 0 1\" Origin=\"-5 0 0\" pbc=\"T F F\" "
              "Properties=id:I:1:species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1 Time=0.5\n"
              "0 X 1 2.5 0 -1 0 0 0.5 1\n"
              "1 X 3 4 0 0 0 0 0.5 1\n");
    // The nearest float, in as many digits as tell it from the next one.
    balls[0].position.x() = 0.1;
    text.clear();
    append_xyz(text, 0.5, balls, std::nullopt, Precision::kFloat);
    EXPECT_THAT(text, testing::HasSubstr("\n0 X 0.1 2.5 0 -1 0 0 0.5 1\n"));
    balls[0].position.x() = 1.0 / 3;
    text.clear();
    append_xyz(text, 0.5, balls, std::nullopt, Precision::kFloat);
    EXPECT_THAT(text, testing::HasSubstr("\n0 X 0.33333334 2.5 0 "));
    balls[0].position.x() = 1;
    balls[1].restitution = 0.5;
    balls[1].is_static = true;
    text.clear();
    append_xyz(text, 1, balls, std::nullopt);
    EXPECT_EQ(text,
              "2\n"
              "Properties=id:I:1:species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1:restitution:R:1:static:L:1 "
              "Time=1\n"
              "0 X 1 2.5 0 -1 0 0 0.5 1 1 F\n"
              "1 X 3 4 0 0 0 0 0.5 1 0.5 T\n");
}

TEST(Xyz, ReadsTheBoxAndTime) {
    const XyzFrame frame = parse_xyz(
        "1\nTime = 3 time=2.5 Lattice='10 0 0 0 20 0 0 0 1' Origin=\"-5 1 0\" Properties=pos:R:2\n1 2\n",
        "some.xyz");
    ASSERT_TRUE(frame.box);
    const Box box = frame.box.value_or(Box{});
    EXPECT_EQ(box.min, Vec2(-5, 1));
    EXPECT_EQ(box.max, Vec2(5, 21));
    EXPECT_EQ(frame.time, 2.5);
}

TEST(Xyz, TakesColumnsInAnyOrderAndSkipsUnknownOnes) {
    const XyzFrame frame = parse_xyz(
        "2\r\n"
        "pbc=\"T T F\" bare "
        "Properties=\"Mass:R:1:forces:R:3:Velocities:R:2:Radius:R:1:species:S:1:pos:R:3:tag:I:1:restitution:"
        "R:1\" "
        "config={a b}\r\n"
        "2.5 9 9 9 3 -4 0.25 Ar +1.5 2e0 77 5 0.5\r\n"
        "  1\t9 9 9 0 0 1 Xe 7 8 77 5 1  \r\n"
        "\r\n",
        "some.xyz");
    ASSERT_EQ(frame.balls.size(), 2U);
    EXPECT_EQ(frame.balls[0].mass, 2.5);
    EXPECT_EQ(frame.balls[0].velocity, Vec2(3, -4));
    EXPECT_EQ(frame.balls[0].radius, 0.25);
    EXPECT_EQ(frame.balls[0].position, Vec2(1.5, 2));
    EXPECT_EQ(frame.balls[0].restitution, 0.5);
    EXPECT_EQ(frame.balls[1].position, Vec2(7, 8));
    EXPECT_EQ(frame.lines, (std::vector<std::uint64_t>{3, 4}));
}

TEST(Xyz, ReadsPlainXyz) {
    const XyzFrame frame = parse_xyz("2\na comment = of = any kind\nH 1 2 3\nO 4 5 6", "some.xyz");
    ASSERT_EQ(frame.balls.size(), 2U);
    EXPECT_EQ(frame.balls[1].position, Vec2(4, 5));
    EXPECT_EQ(frame.balls[1].radius, 0.5);
}

TEST(Xyz, IdsGiveTheOrderAndMayLeaveGaps) {
    const XyzFrame frame = parse_xyz("3\nProperties=pos:R:2:id:I:1\n1 1 30\n2 2 4\n3 3 17\n", "some.xyz");
    ASSERT_EQ(frame.balls.size(), 3U);
    EXPECT_EQ(frame.balls[0].position, Vec2(2, 2));
    EXPECT_EQ(frame.balls[1].position, Vec2(3, 3));
    EXPECT_EQ(frame.balls[2].position, Vec2(1, 1));
    EXPECT_EQ(frame.lines, (std::vector<std::uint64_t>{4, 5, 3}));
}

TEST(Xyz, RefusesBadFilesAtTheirLine) {
    EXPECT_EQ(xyz_message_of(""), "some.xyz: is empty");
    EXPECT_EQ(xyz_message_of(" \n\n"), "some.xyz: is empty");
    EXPECT_EQ(xyz_message_of("many\n\n"), "some.xyz:1: must be the number of balls, is \"many\"");
    EXPECT_EQ(xyz_message_of("-1\n\n"), "some.xyz:1: must be the number of balls, is \"-1\"");
    EXPECT_EQ(xyz_message_of("1 2\n\n"), "some.xyz:1: must be the number of balls, is \"1 2\"");
    EXPECT_EQ(xyz_message_of("99999999999999999999\n\n"),
              "some.xyz:1: must be the number of balls, is \"99999999999999999999\"");
    EXPECT_EQ(xyz_message_of("1"), "some.xyz:1: the file ends before the frame's comment line");
    EXPECT_EQ(xyz_message_of("1000000000000\n\nH 1 2 3\n"),
              "some.xyz:3: the file ends after 1 of the frame's 1000000000000 balls");
    EXPECT_EQ(xyz_message_of("1\n\nH 1 2\n"), "some.xyz:3: must have 4 columns, has 3");
    EXPECT_EQ(xyz_message_of("1\n\nH 1 2 3 4\n"), "some.xyz:3: must have 4 columns, has 5");
    EXPECT_EQ(xyz_message_of("1\n\nH 1 two 3\n"), "some.xyz:3: column 3 must be a number, is \"two\"");
    EXPECT_EQ(xyz_message_of("1\n\nH 1 1e999 3\n"), "some.xyz:3: column 3 must be a number, is \"1e999\"");
    EXPECT_EQ(xyz_message_of("1\nProperties=species:S:1\nH\n"), "some.xyz:2: Properties names no pos column");
    EXPECT_EQ(xyz_message_of("1\nProperties=pos:R\n1 2\n"),
              "some.xyz:2: Properties must be name:type:columns, again and again, as in species:S:1:pos:R:3");
    EXPECT_EQ(xyz_message_of("1\nProperties=pos:R:0\n\n"),
              "some.xyz:2: Properties must be name:type:columns, again and again, as in species:S:1:pos:R:3");
    EXPECT_EQ(xyz_message_of("1\nProperties=pos:R:4\n1 2 3 4\n"),
              "some.xyz:2: pos must have 2 or 3 columns, has 4");
    EXPECT_EQ(xyz_message_of("1\nProperties=pos:R:2:radius:R:2\n1 2 3 4\n"),
              "some.xyz:2: radius must have 1 column, has 2");
    EXPECT_EQ(xyz_message_of("1\nProperties=pos:R:2:position:R:2\n1 2 3 4\n"),
              "some.xyz:2: Properties names position twice");
    EXPECT_EQ(xyz_message_of("1\nProperties=\"pos:R:2\n1 2\n"),
              "some.xyz:2: the value of Properties has no closing quote");
    EXPECT_EQ(xyz_message_of("2\nProperties=id:I:1:pos:R:2\n7 1 2\n7 3 4\n"),
              "some.xyz:4: has the id 7 of line 3");
    EXPECT_EQ(xyz_message_of("1\nProperties=id:I:1:pos:R:2\n-7 1 2\n"),
              "some.xyz:3: column 1 must be a whole number, the ball's id, is \"-7\"");
    EXPECT_EQ(xyz_message_of("1\nProperties=pos:R:2:static:L:1\n1 2 yes\n"),
              "some.xyz:3: column 3 must be T or F, is \"yes\"");
    EXPECT_EQ(xyz_message_of("1\n\nH 1 2 3\nrubbish\n"),
              "some.xyz:4: must be the number of balls, is \"rubbish\"");
}

TEST(Xyz, TakesTheLastOfSeveralFrames) {
    const std::string text = "1\n\nH 1 2 3\n2\n\nH 4 5 6\nH 7 8 9\n";
    const XyzFrame frame = parse_xyz(text, "some.xyz");
    ASSERT_EQ(frame.balls.size(), 2U);
    EXPECT_EQ(frame.balls[1].position, Vec2(7, 8));
    EXPECT_EQ(xyz_message_of(text + "2\n\nH 1 2 3\n"),
              "some.xyz:10: the file ends after 1 of the frame's 2 balls");
}

TEST(Xyz, TrajectoriesGrowByFrames) {
    const TemporaryFolder folder;
    Generator generator(1);
    std::vector<std::vector<Ball>> frames;
    frames.reserve(4);
    for (std::size_t i = 0; i < 4; ++i) frames.push_back(random_balls(generator, 10 * i));
    const auto path = folder / "run.xyz";
    put_file(path, "an older file\n");
    {
        const auto trajectory = open_trajectory(path);
        trajectory->write(0, frames[0], std::nullopt, Precision::kDouble);
        trajectory->write(1, frames[1], std::nullopt, Precision::kDouble);
    }
    expect_same(frames[1], read_xyz(path).balls);
    {
        const auto trajectory = open_trajectory(path, {std::filesystem::file_size(path), 1});
        trajectory->write(2, frames[2], std::nullopt, Precision::kDouble);
        trajectory->write(3, frames[3], std::nullopt, Precision::kDouble);
    }
    std::size_t count = 0;
    for_each_xyz_frame(path, [&](const XyzFrame& frame) {
        EXPECT_EQ(frame.time, static_cast<double>(count));
        expect_same(frames[count], frame.balls);
        return ++count < 4;
    });
    EXPECT_EQ(count, 4U);
    EXPECT_THROW((void)open_trajectory(folder / "no/such/folder.xyz"), FileError);
}

TEST(Xyz, FilesAreWrittenWholeAndReadBack) {
    const TemporaryFolder folder;
    Generator generator(2);
    const std::vector<Ball> balls = random_balls(generator, 3000);
    write_xyz(folder / "state.xyz", 1, balls, std::nullopt);
    expect_same(balls, read_xyz(folder / "state.xyz").balls);
    EXPECT_EQ(folder.file_count(), 1U);
    EXPECT_THROW((void)read_xyz(folder / "missing.xyz"), FileError);
}

TEST(Xyz, MutatedTextIsReadOrRefused) {
    Generator first(3);
    std::string sound;
    append_xyz(sound, 0, random_balls(first, 3), Domain{{{0, 0}, {1, 1}}, {}, 1});
    append_xyz(sound, 1, random_balls(first, 4), std::nullopt);
    const std::string pieces = "0123456789.-+eE \n\r\t=:\"'{}[]TFposid";
    for (std::uint64_t seed = 1; seed <= 5000; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Generator generator(seed);
        std::string text = sound;
        for (std::uint64_t i = 0; i <= testing_values::below(generator, 4) && !text.empty(); ++i) {
            const std::size_t at = testing_values::below(generator, text.size());
            switch (testing_values::below(generator, 4)) {
                case 0:
                    text[at] = static_cast<char>(generator());
                    break;
                case 1:
                    text[at] = pieces[testing_values::below(generator, pieces.size())];
                    break;
                case 2:
                    text.erase(at, 1 + testing_values::below(generator, 10));
                    break;
                default:
                    text.resize(at);
                    break;
            }
        }
        try {
            (void)parse_xyz(text, "some.xyz");
        } catch (const SceneError& error) {
            const std::string message = error.what();
            EXPECT_TRUE(message.starts_with("some.xyz"));
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

}  // namespace
}  // namespace carom
