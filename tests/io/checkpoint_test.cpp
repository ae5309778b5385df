// Checkpoints as files: what is written is read back to the bit, and what is not whole is refused.
#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <carom/io/atomic_file.hpp>
#include <carom/io/checkpoint.hpp>

#include "crc64.hpp"
#include "little_endian.hpp"
#include "random_values.hpp"
#include "temporary_folder.hpp"

namespace carom {
namespace {

using testing::HasSubstr;
using testing_values::any_finite;
using testing_values::Generator;

Vec2 any_pair(Generator& generator) {
    const double x = any_finite(generator);
    return {x, any_finite(generator)};
}

Time any_time(Generator& generator) {
    return {static_cast<std::int64_t>(generator()), any_finite(generator)};
}

/// All bit patterns alike: a checkpoint's file judges no state.
Checkpoint any_checkpoint(std::uint64_t seed, std::size_t balls) {
    Generator generator(seed);
    Checkpoint c;
    Snapshot& s = c.snapshot;
    s.method = seed % 2 == 0 ? "event" : "sixteen letters!";
    s.scene_hash = generator();
    s.time = any_finite(generator);
    s.field_updates = generator();
    s.counts = {generator(), generator(), generator(), generator(), generator(), generator(), {}, {}};
    s.virial = {static_cast<std::int64_t>(generator()), generator(), seed % 3 == 0};
    for (std::size_t k = 0; k < balls; ++k) {
        s.anchors.push_back({any_pair(generator), any_pair(generator), any_time(generator),
                             static_cast<std::int32_t>(generator()), static_cast<std::int32_t>(generator())});
        if (seed % 4 < 2) s.last_collisions.push_back(any_time(generator));
        if (seed % 8 < 4) s.accelerations.push_back(any_pair(generator));
    }
    if (seed % 3 != 1) {
        s.counts.steps = generator();
        if (seed % 2 != 0) s.counts.missed_collisions = generator();
        std::vector<SavedContact>& contacts = s.contacts.emplace();
        for (std::uint64_t k = 0; k < seed % 4; ++k) {
            const std::uint64_t bodies = generator();
            const std::uint64_t periods = generator();
            contacts.push_back({static_cast<std::uint32_t>(bodies), static_cast<std::uint32_t>(bodies >> 32),
                                static_cast<std::int32_t>(periods),
                                static_cast<std::int32_t>(periods >> 32)});
        }
    }
    if (seed % 5 != 0)
        c.run = RunRecord{
            any_finite(generator), any_pair(generator), any_finite(generator), generator(), generator(),
            any_finite(generator), generator()};
    if (seed % 7 < 3) c.sensings_bytes = generator();
    if (seed % 9 < 4) {
        const std::uint64_t bytes = generator();
        const std::uint64_t next = generator();
        c.measures = MeasuresRecord{bytes, next, any_finite(generator), any_finite(generator)};
        std::vector<std::uint64_t>& words = c.observer.emplace();
        for (std::uint64_t k = 0; k < seed % 6; ++k) words.push_back(generator());
    }
    return c;
}

std::string bytes_of(const Checkpoint& checkpoint) {
    const TemporaryFolder folder;
    write_checkpoint(folder / "c", checkpoint);
    EXPECT_EQ(folder.file_count(), 1U);
    return content_of(folder / "c");
}

/// Why bytes are refused; empty where they are taken.
std::string refusal(const std::string& bytes) {
    try {
        (void)parse_checkpoint(bytes, "file");
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

/// The bytes with the checksum that fits them.
std::string sealed(std::string bytes) {
    bytes.resize(bytes.size() - 8);
    Crc64 checksum;
    checksum.add(bytes);
    append_little_endian(bytes, checksum.value());
    return bytes;
}

template <class Unsigned>
std::string with(std::string bytes, std::size_t place, Unsigned value) {
    std::string text;
    append_little_endian(text, value);
    bytes.replace(place, text.size(), text);
    return sealed(bytes);
}

// The check value of CRC-64/XZ in the catalogue of parametrised CRC algorithms (reveng.sourceforge.io).
TEST(Crc64, HasItsCheckValue) {
    Crc64 whole;
    whole.add("123456789");
    EXPECT_EQ(whole.value(), 0x995dc9bbdf1939faU);
    for (std::size_t cut = 0; cut <= 9; ++cut) {
        Crc64 parts;
        parts.add(std::string_view("123456789").substr(0, cut));
        parts.add(std::string_view("123456789").substr(cut));
        EXPECT_EQ(parts.value(), whole.value()) << cut;
    }
}

// Written again, what was read gives the same bytes; so every field came back, to the bit.
TEST(Checkpoint, ReadsBackBitForBit) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const Checkpoint written = any_checkpoint(seed, seed % 7 == 0 ? 0 : seed % 50);
        const std::string bytes = bytes_of(written);
        const Checkpoint read = parse_checkpoint(bytes, "file");
        EXPECT_EQ(bytes_of(read), bytes);
        EXPECT_EQ(read.snapshot.method, written.snapshot.method);
        EXPECT_EQ(read.snapshot.scene_hash, written.snapshot.scene_hash);
        EXPECT_EQ(read.snapshot.last_collisions, written.snapshot.last_collisions);
        EXPECT_EQ(read.snapshot.accelerations, written.snapshot.accelerations);
        EXPECT_EQ(read.snapshot.contacts, written.snapshot.contacts);
        EXPECT_EQ(read.snapshot.counts.steps, written.snapshot.counts.steps);
        EXPECT_EQ(read.snapshot.counts.missed_collisions, written.snapshot.counts.missed_collisions);
        EXPECT_EQ(read.run.has_value(), written.run.has_value());
        EXPECT_EQ(read.sensings_bytes, written.sensings_bytes);
        EXPECT_EQ(read.measures.has_value(), written.measures.has_value());
        EXPECT_EQ(read.observer, written.observer);
    }
}

// More than the writer's pieces of a mebibyte.
TEST(Checkpoint, ManyBallsReadBack) {
    const std::string bytes = bytes_of(any_checkpoint(1, 40'000));
    EXPECT_EQ(bytes_of(parse_checkpoint(bytes, "file")), bytes);
}

// The bytes as docs/checkpoint-format.md has them, one by one: a reader of another making can rely on it.
TEST(Checkpoint, HasTheDocumentedBytes) {
    Checkpoint c;
    c.snapshot.scene_hash = 0x0102030405060708;
    c.snapshot.time = 1;
    c.snapshot.anchors.push_back({{2, -2}, {0.5, 0}, {3, 0.25}, -1, 7});
    const std::string bytes = bytes_of(c);
    const auto word = [&bytes](std::size_t place) {
        return first_little_endian<std::uint64_t>(std::string_view(bytes).substr(place));
    };
    EXPECT_EQ(bytes.substr(0, 8),
              "\x89"
              "CAROM\r\n");
    EXPECT_EQ(word(8), 1U | std::uint64_t{4} << 32);  // version 1, four sections
    EXPECT_EQ(word(16), bytes.size());
    EXPECT_EQ(bytes.substr(24, 8), "\x08\x07\x06\x05\x04\x03\x02\x01");
    EXPECT_EQ(word(32), 1U);
    EXPECT_EQ(bytes.substr(40, 16), std::string("event") + std::string(11, '\0'));
    EXPECT_EQ(bytes.substr(56, 16), std::string("moment") + std::string(10, '\0'));
    EXPECT_EQ(word(72), 16U);
    EXPECT_EQ(word(80), 0x3ff0000000000000U);
    const std::size_t anchors = 56 + (24 + 16) + (24 + 48) + (24 + 24);
    EXPECT_EQ(bytes.substr(anchors, 16), std::string("anchors") + std::string(9, '\0'));
    EXPECT_EQ(word(anchors + 16), 56U);
    EXPECT_EQ(word(anchors + 24), 0x4000000000000000U);       // x = 2
    EXPECT_EQ(word(anchors + 24 + 32), 3U);                   // epoch
    EXPECT_EQ(word(anchors + 24 + 48), 0x00000007ffffffffU);  // periods -1 and 7
    EXPECT_EQ(bytes.size(), anchors + 24 + 56 + 8);
}

TEST(Checkpoint, EveryFlippedBitIsRefused) {
    for (const std::uint64_t seed : {1, 5}) {  // without contacts and with them
        std::string bytes = bytes_of(any_checkpoint(seed, 3));
        ASSERT_EQ(refusal(bytes), "");
        for (std::size_t place = 0; place < bytes.size(); ++place)
            for (int bit = 0; bit < 8; ++bit) {
                const char whole = bytes[place];
                bytes[place] = static_cast<char>(whole ^ (1 << bit));
                ASSERT_NE(refusal(bytes), "") << "byte " << place << " bit " << bit;
                bytes[place] = whole;
            }
    }
}

TEST(Checkpoint, EveryOtherByteIsRefused) {
    std::string bytes = bytes_of(any_checkpoint(1, 1));
    for (std::size_t place = 0; place < bytes.size(); ++place)
        for (int change = 1; change < 256; ++change) {
            const char whole = bytes[place];
            bytes[place] = static_cast<char>(whole ^ change);
            ASSERT_NE(refusal(bytes), "") << "byte " << place << " changed by " << change;
            bytes[place] = whole;
        }
}

TEST(Checkpoint, EveryOtherLengthIsRefused) {
    const std::string bytes = bytes_of(any_checkpoint(1, 3));
    for (std::size_t length = 0; length < bytes.size(); ++length)
        ASSERT_NE(refusal(bytes.substr(0, length)), "") << length;
    for (const std::size_t more : {1U, 8U, 1000U}) EXPECT_NE(refusal(bytes + std::string(more, '\0')), "");
    EXPECT_NE(refusal(bytes + bytes), "");
}

TEST(Checkpoint, EachRefusalSaysWhy) {
    const std::string bytes = bytes_of(any_checkpoint(1, 3));
    EXPECT_EQ(refusal(""), "file: is no whole checkpoint: it is cut short");
    EXPECT_EQ(refusal("{\"balls\": []}"), "file: is no checkpoint");
    EXPECT_EQ(
        refusal(bytes.substr(0, 70)),
        "file: is no whole checkpoint: it has 70 bytes, its header says " + std::to_string(bytes.size()));
    EXPECT_EQ(refusal(with<std::uint32_t>(bytes, 8, 2)),
              "file: is a checkpoint of version 2; this program knows version 1");
    std::string damaged = bytes;
    damaged[100] ^= 1;
    EXPECT_EQ(refusal(damaged), "file: is damaged: its checksum does not fit");
    std::string unknown = bytes;
    unknown[56] = 'M';
    EXPECT_EQ(refusal(sealed(unknown)), "file: is no sound checkpoint: section 'moment'");
}

// A file with a fitting checksum and lies in it: what it claims is not allocated, and it is refused.
TEST(Checkpoint, ClaimsBeyondTheFileAreRefused) {
    const std::string bytes = bytes_of(any_checkpoint(1, 3));
    constexpr std::uint64_t kMany = 1'000'000'000'000;
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    for (const std::uint64_t claim : {std::uint64_t{0}, std::uint64_t{2}, kMany, kMost}) {
        EXPECT_THAT(refusal(with(bytes, 32, claim)), HasSubstr("is no sound checkpoint")) << "balls";
        EXPECT_THAT(refusal(with(bytes, 72, claim)), HasSubstr("is no sound checkpoint"))
            << "size of a section";
    }
    for (const std::uint32_t claim : {0U, 6U, 8U, ~0U})
        EXPECT_THAT(refusal(with(bytes, 12, claim)), HasSubstr("is no sound checkpoint")) << "sections";
    // Nothing but a header: no sections, 10^12 balls.
    std::string header = bytes.substr(0, 56) + std::string(8, '\0');
    header = with(with(with<std::uint32_t>(header, 12, 0), 16, std::uint64_t{header.size()}), 32, kMany);
    EXPECT_THAT(refusal(header), HasSubstr("is no sound checkpoint"));
}

// A checksum may be made to fit by somebody's own program: every such change is taken or refused, and none
// ends the reader.
TEST(Checkpoint, SealedNonsenseIsTakenOrRefused) {
    const std::array<std::string, 2> sound = {bytes_of(any_checkpoint(1, 2)), bytes_of(any_checkpoint(5, 2))};
    Generator generator(7);
    for (std::size_t trial = 0; trial < 20'000; ++trial) {
        const std::string& bytes = sound[trial % 2];
        std::string changed = bytes;
        for (int change = 0; change < 3; ++change)
            changed[8 + testing_values::below(generator, bytes.size() - 16)] = static_cast<char>(generator());
        (void)refusal(sealed(changed));
    }
}

TEST(Checkpoint, FilesThatCannotBe) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)read_checkpoint(folder / "none"), FileError);
    EXPECT_THROW((void)read_checkpoint(folder.path()), FileError);
    EXPECT_THROW(write_checkpoint("/dev/full", any_checkpoint(1, 3)), FileError);
    EXPECT_THROW(write_checkpoint(folder / "no/such/folder", any_checkpoint(1, 3)), FileError);
    Checkpoint long_name = any_checkpoint(1, 3);
    long_name.snapshot.method = "seventeen letters";
    EXPECT_THROW(write_checkpoint(folder / "c", long_name), FileError);
    EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace carom
