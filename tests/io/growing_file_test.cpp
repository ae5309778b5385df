// Files that are gone on with: what was kept stays, what was beyond it goes.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <carom/io/events_csv.hpp>
#include <carom/io/growing_file.hpp>

#include "temporary_folder.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

std::string refusal(const fs::path& path, std::uint64_t kept) {
    try {
        const GrowingFile file(path, kept);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

TEST(GrowingFile, IsThereAtOnceAndGrows) {
    const TemporaryFolder folder;
    put_file(folder / "f", "older");
    GrowingFile file(folder / "f");
    EXPECT_EQ(content_of(folder / "f"), "");
    file.write("one ");
    file.write("two");
    EXPECT_EQ(content_of(folder / "f"), "one two");
    EXPECT_EQ(file.size(), 7U);
    file.sync();
}

TEST(GrowingFile, GoesOnAfterWhatIsKept) {
    const TemporaryFolder folder;
    for (const std::uint64_t kept : {0U, 4U, 9U}) {
        put_file(folder / "f", "one two 3");
        GrowingFile file(folder / "f", kept);
        EXPECT_EQ(file.size(), kept);
        file.write("new");
        EXPECT_EQ(content_of(folder / "f"), std::string("one two 3").substr(0, kept) + "new");
        EXPECT_EQ(file.size(), kept + 3);
    }
}

TEST(GrowingFile, RefusesAnotherFile) {
    const TemporaryFolder folder;
    const fs::path path = folder / "f";
    put_file(path, "short");
    EXPECT_EQ(refusal(path, 6),
              path.string() + ": cannot be gone on with: has 5 bytes, the checkpoint was made after 6");
    EXPECT_EQ(content_of(path), "short");
    EXPECT_EQ(refusal(folder / "none", 1),
              (folder / "none").string() + ": cannot be written: No such file or directory");
    EXPECT_EQ(refusal("/dev/null", 100), "") << "nothing is kept there, and nothing is missed";
    GrowingFile full("/dev/full");
    EXPECT_THROW(full.write("text"), FileError);
}

TEST(EventsCsv, GrowsAndIsGoneOnWith) {
    const TemporaryFolder folder;
    const fs::path path = folder / "e.csv";
    const auto row = [](double time) {
        return EventsCsv::Row{time, EventsCsv::Kind::kBall, 3, 7, {1, 2}, {0.6, 0.8}, 1.25};
    };
    std::uint64_t kept = 0;
    {
        EventsCsv events(path, 0);
        events.write(row(0.5));
        kept = events.sync();
        EXPECT_EQ(kept, fs::file_size(path));
        events.write(row(99));  // after the checkpoint, and then the run is stopped
        events.commit();
        EXPECT_GT(fs::file_size(path), kept);
    }
    EventsCsv events(path, kept);
    events.write(row(0.75));
    events.commit();
    EXPECT_EQ(content_of(path),
              "time,kind,i,j,x,y,nx,ny,impulse\n"
              "0.5,ball,3,7,1,2,0.6,0.8,1.25\n"
              "0.75,ball,3,7,1,2,0.6,0.8,1.25\n");
}

}  // namespace
}  // namespace carom
