// Variants that go on from a frame of another take, and where two takes part.
#include "io/take_branch.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/frame_file.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "io/take_diff.h"
#include "io/take_reader.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// A block that falls on the ground in its third frame and slides.
const std::string kShotText =
    test::shotTextOf({.name = "slide", .frames = "1001-1009", .box = "[0.4, 0.2, 0.4]"},
                     test::bodyText("block", "position = [0, 0.13, 0]\nvelocity = [2, 0, 0]") +
                         test::bodyText("away", "position = [0, 50, 0]"));

class BranchTest : public testing::Test {
protected:
    /// Simulates into a take, from time zero or from a branch, and reads it.
    TakeReader simulate(const std::string& name, const std::vector<std::string>& overrides,
                        const std::optional<TakeBranch>& branch = std::nullopt)
    {
        writeFileBytes(folder / "slide.toml", kShotText);
        const Shot shot = parseShot((folder / "slide.toml").string(), overrides);
        World world = buildWorld(shot);
        TakeWriter take(folder / name, shot, world, "1.2.3", ExistingTake::refuse, branch);
        Stepper stepper(shot.settings);
        for (int frame = shot.firstFrame; frame <= shot.lastFrame; ++frame) {
            if (take.hasFrame(frame)) continue;
            FrameStats stats;
            stats.frame = frame;
            if (frame > shot.firstFrame) {
                take.prepareFor(frame, world);
                stats.report = stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
            }
            take.writeFrame(world, stats);
        }
        return TakeReader(folder / name);
    }

    std::string refusalOf(const std::vector<std::string>& overrides, const TakeBranch& branch)
    {
        try {
            simulate("refused", overrides, branch);
        } catch (const Error& error) {
            fs::remove_all(folder / "refused");
            return error.what();
        }
        return "not refused";
    }

    test::TemporaryFolder folder;
};

TEST_F(BranchTest, ABranchWithTheSameSettingsGivesTheSameBits)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader branch = simulate("branch", {}, TakeBranch{folder / "whole", 1005});
    EXPECT_TRUE(compareTakes(whole, branch).isSame());
    EXPECT_EQ(readFileBytes(whole.paths().frame(1009)), readFileBytes(branch.paths().frame(1009)));
    EXPECT_EQ(branch.info().branchFrame, 1005);
    EXPECT_EQ(branch.stats().size(), 9u);
}

TEST_F(BranchTest, AVariantPartsFromItsOriginalAfterTheBranchAndOnlyInWhatItChanges)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader slippery =
        simulate("slippery", {"material.wood.friction=0.0"}, TakeBranch{folder / "whole", 1005});
    const TakeComparison comparison = compareTakes(whole, slippery);
    ASSERT_TRUE(comparison.difference);
    EXPECT_EQ(comparison.difference->frame, 1006);
    EXPECT_EQ(comparison.difference->bodies, std::vector<std::string>{"block"});
    EXPECT_EQ(comparison.difference->farthestBody, "block");
    EXPECT_GT(comparison.difference->farthest, 1e-4);
    EXPECT_GT(comparison.difference->stepsA, 0);
    EXPECT_EQ(comparison.framesCompared, 6);
}

TEST_F(BranchTest, TakesThatOnlyRememberOtherContactsDiffer)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader other = simulate("other", {});
    const fs::path path = other.paths().frame(1004);
    FrameState state = readFrameFile(path);
    ASSERT_FALSE(state.contactMemory.contacts.empty());
    state.contactMemory.contacts.front().force *= 2.0;
    writeFileBytes(path, encodeFrame(state));
    const TakeComparison comparison = compareTakes(whole, other);
    ASSERT_TRUE(comparison.difference);
    EXPECT_EQ(comparison.difference->frame, 1004);
    EXPECT_TRUE(comparison.difference->isMemoryOnly);
    EXPECT_EQ(comparison.difference->bodies, (std::vector<std::string>{"ground", "block"}));
}

TEST_F(BranchTest, OtherBodiesAreRefusedWithWhatDiffers)
{
    simulate("whole", {});
    const TakeBranch branch{folder / "whole", 1005};
    EXPECT_NE(refusalOf({"material.wood.density=700"}, branch).find("mass of 'block'"),
              std::string::npos);
    EXPECT_NE(refusalOf({"shape.block.scale=1.5"}, branch).find("another"), std::string::npos);
    EXPECT_NE(refusalOf({"shot.fps=30"}, branch).find("frame rate"), std::string::npos);
    EXPECT_NE(refusalOf({}, TakeBranch{folder / "whole", 1009}).find("leaves nothing"),
              std::string::npos);
    EXPECT_NE(refusalOf({}, TakeBranch{folder / "nowhere", 1005}).find("nowhere"),
              std::string::npos);
}

TEST_F(BranchTest, FramesOfTheOriginalCannotBeSimulatedAgain)
{
    simulate("whole", {});
    simulate("branch", {"material.wood.friction=0.0"}, TakeBranch{folder / "whole", 1005});
    fs::remove(TakePaths{folder / "branch"}.frame(1003));
    const Shot shot = parseShot((folder / "slide.toml").string(), {"material.wood.friction=0.0"});
    const World world = buildWorld(shot);
    try {
        TakeWriter take(folder / "branch", shot, world, "1.2.3", ExistingTake::resume);
        FAIL() << "a hole before the branch was accepted";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("--from"), std::string::npos);
    }
}

TEST(ParseBranch, WantsATakeAndAFrame)
{
    EXPECT_EQ(parseBranch("takes/a@b@1080").take, "takes/a@b");
    EXPECT_EQ(parseBranch("takes/a@-5").frame, -5);
    for (const char* text : {"takes/a", "@1001", "takes/a@", "takes/a@10x", "takes/a@1001-1005"}) {
        EXPECT_THROW(parseBranch(text), Error) << text;
    }
}

}  // namespace
}  // namespace scree
