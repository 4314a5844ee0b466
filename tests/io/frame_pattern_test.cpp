#include "io/frame_pattern.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/refusal.h"

namespace scree {
namespace {

TEST(FramePattern, ReadsAllThreeSpellings)
{
    EXPECT_EQ(expandFramePattern("x.####.obj", 1001), "x.1001.obj");
    EXPECT_EQ(expandFramePattern("x.%04d.obj", 7), "x.0007.obj");
    EXPECT_EQ(expandFramePattern("x.$F4.obj", 7), "x.0007.obj");
    EXPECT_EQ(expandFramePattern("x.%d.obj", 7), "x.7.obj");
    EXPECT_EQ(expandFramePattern("x.$F.obj", 7), "x.7.obj");
    EXPECT_EQ(expandFramePattern("x.#.obj", 7), "x.7.obj");
}

TEST(FramePattern, LongNumbersAreNeverCut)
{
    EXPECT_EQ(expandFramePattern("x.##.obj", 12345), "x.12345.obj");
}

TEST(FramePattern, AMinusSignTakesOneOfTheDigits)
{
    EXPECT_EQ(expandFramePattern("x.####.obj", -12), "x.-012.obj");
    EXPECT_EQ(expandFramePattern("x.####.obj", -123456), "x.-123456.obj");
}

TEST(FramePattern, FindsTheFrameInANameWhateverStandsBeforeIt)
{
    EXPECT_EQ(frameOf("x-####.png", "x-0001.png"), 1);
    EXPECT_EQ(frameOf("v2####.png", "v20012.png"), 12);
    EXPECT_EQ(frameOf("x.####.png", "x.-012.png"), -12);
    EXPECT_EQ(frameOf("x.####.png", "x.sheet.png"), std::nullopt);
    EXPECT_EQ(frameOf("x.####.png", "x.012.png"), std::nullopt);
}

TEST(FramePattern, FoldersMayHoldTheSignsWithoutMeaning)
{
    EXPECT_EQ(expandFramePattern("shot#2/50%d/x.####.obj", 1), "shot#2/50%d/x.0001.obj");
    EXPECT_FALSE(hasFramePattern("shot.####/x.obj"));
}

TEST(FramePattern, LoneSignsAreNoPattern)
{
    EXPECT_FALSE(hasFramePattern("100%.obj"));
    EXPECT_FALSE(hasFramePattern("$HOME.obj"));
    EXPECT_EQ(expandFramePattern("100%.####.obj", 3), "100%.0003.obj");
}

TEST(FramePattern, AMissingPatternIsAnsweredWithTheNameToWrite)
{
    const test::Refusal refusal = test::refusalBy([&] { expandFramePattern("out/x.obj", 1); });
    EXPECT_EQ(refusal.kind, ErrorKind::usage);
    EXPECT_TRUE(refusal.mentions("\"out/x.####.obj\"")) << refusal.message;
}

TEST(FramePattern, TwoPatternsAreRefused)
{
    EXPECT_THROW(expandFramePattern("x.##.%04d.obj", 1), Error);
}

}  // namespace
}  // namespace scree
