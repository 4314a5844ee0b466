#include "tools/run_estimate.h"

#include <gtest/gtest.h>

#include "io/build_world.h"
#include "tests/support/small_shot.h"

namespace scree {
namespace {

RunEstimate estimateOf(const std::vector<std::string>& overrides)
{
    const std::string text = test::shotTextOf(
        {.frames = "1001-1200"},
        test::bodyText("block",
                       "position = [0, 2, 0]\ngrid = { count = [5, 2, 5], spacing = [2, 2, 2] }"));
    const Shot shot = parseShotText(text, "s.toml", overrides);
    return estimateRun(shot, buildWorld(shot), 1, 10.0, [] { return false; });
}

TEST(RunEstimate, ASampleBetweenFramesCostsItsPosesAndVelocitiesInEveryFrame)
{
    const RunEstimate without = estimateOf({"output.subframes=[]"});
    const RunEstimate with = estimateOf({"output.subframes=[-0.25, 0.0, 0.25]"});
    // Two samples that are no frames, of 51 bodies, 13 numbers each; times in the lines of figures
    // have more digits or fewer.
    const double samples = 200.0 * 2 * 51 * 13 * sizeof(double);
    const double more =
        static_cast<double>(with.diskBytes) - static_cast<double>(without.diskBytes);
    EXPECT_NEAR(more, samples, 0.02 * samples);
}

TEST(RunEstimate, TimeIsScaledToTheWholeShot)
{
    const RunEstimate estimate = estimateOf({});
    EXPECT_EQ(estimate.framesTried, 1);
    EXPECT_GE(estimate.stepsTried, 1);
    EXPECT_EQ(estimate.complaint, "");
    // A hundred times the frames; noise of either run is a factor of a few. Of the time on the
    // wall it is not, while others want the machine: that is held against the other in each run.
    const RunEstimate brief = estimateOf({"shot.frames=1001-1003"});
    EXPECT_GT(estimate.cpuSeconds, 10.0 * brief.cpuSeconds);
    EXPECT_LT(estimate.cpuSeconds, 1000.0 * brief.cpuSeconds);
    for (const RunEstimate& each : {estimate, brief}) {
        EXPECT_GT(each.cpuSeconds, 0.0);
        EXPECT_GT(each.wallSeconds, 0.8 * each.cpuSeconds);
    }
}

/// A block that is always there, and four hundred that come within a hundred frames of two hundred.
Shot rainOfBlocks()
{
    const std::string emitter =
        "[[emitter]]\nname = \"rain\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 400\n"
        "frames = \"1001-1100\"\n"
        "layout = { position = [0, 5, 0], grid = { count = [20, 1, 20], spacing = [2, 2, 2] } }\n";
    return parseShotText(
        test::shotTextOf({.frames = "1001-1201"},
                         test::bodyText("block", "position = [0, 2, 0]") + emitter),
        "s.toml", {});
}

TEST(RunEstimate, BodiesThatAreStillToComeCountFromTheirBirth)
{
    const World world = buildWorld(rainOfBlocks());
    EXPECT_LE(bodyFrames(world, 1.0), 1.0 + 4.0 + 4.0);
    // One for all of the time, and those that come for three quarters of it, if evenly.
    EXPECT_NEAR(bodyFrames(world, 200.0), 200.0 + 400.0 * 150.0, 400.0);
}

TEST(RunEstimate, WhoIsToComeIsCounted)
{
    const Shot shot = rainOfBlocks();
    const RunEstimate estimate = estimateRun(shot, buildWorld(shot), 1, 10.0, [] { return false; });
    EXPECT_GE(estimate.bodiesToCome, 390);
    EXPECT_LT(estimate.bodiesToCome, 400);
    EXPECT_EQ(estimateOf({}).bodiesToCome, 0);
}

}  // namespace
}  // namespace scree
