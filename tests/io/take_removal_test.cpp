// What may be removed from a folder that is to hold a take.
#include "io/take_removal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "tests/io/take_fixture.h"
#include "tests/support/refusal.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

class TakeRemoval : public test::TakeFixture {};

TEST_F(TakeRemoval, OverwritingLeavesNothingOfTheOldTake)
{
    writeWholeTake();
    const TakeWriter take = open(ExistingTake::overwrite, shot);
    EXPECT_FALSE(take.hasFrame(1001));
    EXPECT_FALSE(fs::exists(take.paths().frame(1003)));
    EXPECT_TRUE(take.summaries().empty());
}

TEST_F(TakeRemoval, OverwritingTakesPicturesAndCachesOfTheOldTakeWithIt)
{
    // In a folder that holds no take they are somebody else's.
    for (const char* name : {"images", "exports"}) fs::create_directories(folder / "take" / name);
    writeFileBytes(folder / "take/images/holiday.png", "mine");
    EXPECT_THROW(open(ExistingTake::overwrite, shot), Error);
    EXPECT_TRUE(fs::exists(folder / "take/images/holiday.png"));
    fs::remove(folder / "take/images/holiday.png");

    open(ExistingTake::overwrite, shot);
    writeFileBytes(folder / "take/images/ours.png", "made from it");
    writeFileBytes(folder / "take/exports/old.abc", "old");
    open(ExistingTake::overwrite, shot);
    EXPECT_FALSE(fs::exists(folder / "take/images"));
    EXPECT_FALSE(fs::exists(folder / "take/exports"));
}

TEST_F(TakeRemoval, OverwritingLeavesWhatIsSomebodyElses)
{
    writeWholeTake();
    const std::array mine = {folder / "take/frames/beauty.1001.exr",
                             folder / "take/shapes/hero.ply"};
    for (const fs::path& file : mine) writeFileBytes(file, "mine");
    open(ExistingTake::overwrite, shot);
    for (const fs::path& file : mine) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(TakeRemoval, AFolderWithADescriptionOrStatisticsOfSomethingElseIsRefused)
{
    fs::create_directories(folder / "take/images");
    for (const char* name : {"take.json", "stats.jsonl"}) {
        const fs::path file = folder / "take" / name;
        writeFileBytes(file, "{\"foo\": 1}\n");
        for (const auto existing :
             {ExistingTake::refuse, ExistingTake::resume, ExistingTake::overwrite}) {
            EXPECT_EQ(test::kindThrownBy([&] { open(existing, shot); }), ErrorKind::cannotCreate);
        }
        EXPECT_TRUE(fs::exists(folder / "take/images"));
        fs::remove(file);
    }
}

TEST_F(TakeRemoval, TemporariesOfAKilledWriterAreRemovedAndNoOthers)
{
    writeWholeTake();
    const pid_t killed = ::fork();
    if (killed == 0) ::_exit(0);
    ::waitpid(killed, nullptr, 0);
    const std::string gone = "." + std::to_string(killed) + "-2.tmp";
    const std::array ours = {folder / ("take/frames/.frame.001006.scree" + gone),
                             folder / ("take/shapes/.block.ply" + gone),
                             folder / ("take/.take.json" + gone)};
    // A film that is being made there, what somebody else calls so, and what another machine may be
    // writing, where locks are not passed on.
    const std::array others = {folder / ("take/.film.mp4" + gone), folder / "take/frames/.x.tmp",
                               folder / ("take/frames/.frame.001007.scree" + gone)};
    const auto longAgo = fs::file_time_type::clock::now() - std::chrono::hours(2);
    for (const fs::path& file : ours) writeFileBytes(file, "half");
    for (const fs::path& file : others) writeFileBytes(file, "half");
    for (const fs::path& file : ours) fs::last_write_time(file, longAgo);
    open(ExistingTake::resume, shot);
    for (const fs::path& file : ours) EXPECT_FALSE(fs::exists(file)) << file;
    for (const fs::path& file : others) EXPECT_TRUE(fs::exists(file)) << file;
}

// Of a take whose take.json was lost, old pictures and caches stayed beside the new frames.
TEST_F(TakeRemoval, OverwritingATakeWithoutTakeJsonTakesPicturesAndCachesWithItToo)
{
    writeWholeTake();
    for (const char* name : {"images", "exports"}) fs::create_directories(folder / "take" / name);
    writeFileBytes(folder / "take/images/two.1001.png", "old");
    writeFileBytes(folder / "take/exports/two.abc", "old");
    fs::remove(folder / "take/take.json");
    open(ExistingTake::overwrite, shot);
    EXPECT_FALSE(fs::exists(folder / "take/images"));
    EXPECT_FALSE(fs::exists(folder / "take/exports"));
}

// Frames went back to the small disk that the link was to spare.
TEST_F(TakeRemoval, OverwritingLeavesFoldersThatAreLinksWhereTheyLead)
{
    for (const char* name : {"frames", "shapes", "images"}) {
        fs::create_directories(folder / "disk" / name);
        fs::create_directories(folder / "take");
        fs::create_directory_symlink(folder / "disk" / name, folder / "take" / name);
    }
    writeWholeTake();
    writeFileBytes(folder / "disk/images/two.1001.png", "old");
    const TakeWriter take = open(ExistingTake::overwrite, shot);
    for (const char* name : {"frames", "shapes", "images"})
        EXPECT_TRUE(fs::is_symlink(folder / "take" / name)) << name;
    EXPECT_TRUE(listFrames(take.paths()).empty());
    EXPECT_TRUE(fs::exists(folder / "disk/shapes/block.ply"));
    EXPECT_FALSE(fs::exists(folder / "disk/images/two.1001.png"));
}

}  // namespace
}  // namespace scree
