#include "tools/command_line.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

using Frames = std::vector<int>;

TEST(FrameRange, RangesStepsAndListsGiveTheirFrames)
{
    EXPECT_EQ(parseFrames("1001"), (Frames{1001}));
    EXPECT_EQ(parseFrames("1-4"), (Frames{1, 2, 3, 4}));
    EXPECT_EQ(parseFrames("1-10x3"), (Frames{1, 4, 7, 10}));
    EXPECT_EQ(parseFrames("1-9x3"), (Frames{1, 4, 7}));
    EXPECT_EQ(parseFrames("-2-1"), (Frames{-2, -1, 0, 1}));
    EXPECT_EQ(parseFrames("-3--1"), (Frames{-3, -2, -1}));
}

TEST(FrameRange, ListsAreSortedAndNameNoFrameTwice)
{
    EXPECT_EQ(parseFrames("8, 1-3,2-4"), (Frames{1, 2, 3, 4, 8}));
}

TEST(FrameRange, NonsenseIsRefused)
{
    for (const char* text : {"", ",", "a", "1-", "4-1", "1-4x0", "1-4x", "1,,2", "1,2,", "1.5",
                             "1-4x-1", "99999999999", "1 2"})
        EXPECT_THROW(parseFrames(text), Error) << '"' << text << '"';
}

TEST(FrameRange, DescriptionReadsBackAsTheSameFrames)
{
    for (const Frames& frames : {Frames{1001}, Frames{1, 2, 3}, Frames{1, 6, 11},
                                 Frames{1, 2, 5, 6, 9}, Frames{-3, -2, 4}})
        EXPECT_EQ(parseFrames(describeFrames(frames)), frames) << describeFrames(frames);
}

TEST(FrameRange, AskingForAFrameThatIsMissingIsAnErrorOfTheInput)
{
    EXPECT_EQ(chooseFrames("", {1, 2}), (Frames{1, 2}));
    EXPECT_EQ(chooseFrames("2", {1, 2}), (Frames{2}));
    EXPECT_EQ(chooseFrames("1,3", {1, 3}), (Frames{1, 3}));
    EXPECT_THROW(chooseFrames("", {1, 3}), Error);
    const test::Refusal refusal = test::refusalBy([&] { chooseFrames("2-3", {1, 2}); });
    EXPECT_EQ(refusal.kind, ErrorKind::missingInput);
    EXPECT_TRUE(refusal.mentions("frame 3"));
}

TEST(FrameRange, SpreadKeepsTheEndsAndNeverRepeats)
{
    Frames all;
    for (int frame = 1; frame <= 100; ++frame) all.push_back(frame);
    for (int count = 2; count <= 120; ++count) {
        const Frames chosen = spreadFrames(all, count);
        ASSERT_EQ(static_cast<int>(chosen.size()), std::min(count, 100));
        EXPECT_EQ(chosen.front(), 1);
        EXPECT_EQ(chosen.back(), 100);
        for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
    }
}

TEST(PictureSize, IsWidthTimesHeight)
{
    EXPECT_EQ(parseSize("1280x720"), (std::array<int, 2>{1280, 720}));
    for (const char* text : {"1280", "x", "0x10", "1280x720x3", "99999x1", "-1x5"})
        EXPECT_THROW(parseSize(text), Error) << text;
}

TEST(Threads, TheOptionWinsOverTheEnvironment)
{
    ::setenv("SLURM_CPUS_PER_TASK", "3", 1);
    EXPECT_EQ(threadsToUse(5), 5);
    EXPECT_EQ(threadsToUse(std::nullopt), 3);
    ::unsetenv("SLURM_CPUS_PER_TASK");
    EXPECT_GE(threadsToUse(std::nullopt), 1);
    EXPECT_THROW(threadsToUse(0), Error);
}

TEST(Threads, QuotaIsTheSmallestOfAllGroupsAboveAndRoundedUp)
{
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "cluster/job");
    std::ofstream(folder / "self") << "0::/cluster/job\n";
    std::ofstream(folder / "cluster/job/cpu.max") << "max 100000\n";
    EXPECT_EQ(processorQuota(folder.path(), folder / "self"), std::nullopt);
    std::ofstream(folder / "cluster/cpu.max") << "250000 100000\n";
    EXPECT_EQ(processorQuota(folder.path(), folder / "self"), 3);
    std::ofstream(folder / "cluster/job/cpu.max") << "50000 100000\n";
    EXPECT_EQ(processorQuota(folder.path(), folder / "self"), 1);
}

TEST(Threads, QuotaOfVersionOneIsReadToo)
{
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "cpu/job");
    std::ofstream(folder / "self") << "5:memory:/other\n4:cpu,cpuacct:/job\n";
    std::ofstream(folder / "cpu/job/cpu.cfs_quota_us") << "400000\n";
    std::ofstream(folder / "cpu/job/cpu.cfs_period_us") << "100000\n";
    EXPECT_EQ(processorQuota(folder.path(), folder / "self"), 4);
}

TEST(Duration, IsSaidAsAPersonWould)
{
    EXPECT_EQ(describeDuration(0.04), "0.0 s");
    EXPECT_EQ(describeDuration(42.4), "42 s");
    EXPECT_EQ(describeDuration(185.0), "3 min 05 s");
    EXPECT_EQ(describeDuration(7800.0), "2 h 10 min");
}

}  // namespace
}  // namespace scree
