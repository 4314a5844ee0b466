// The experiments of scree verify, each a test in its brief form, for both methods: musts hold,
// controls fail as stated. And the report that is made of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "io/build_world.h"
#include "io/take.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"
#include "tools/html_text.h"
#include "tools/verify/heap_record.h"
#include "tools/verify/plot.h"
#include "tools/verify/pose_judge.h"
#include "tools/verify/report.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

Context briefContext()
{
    Context context;
    context.shots = test::sourceFile("shots/verify");
    return context;
}

const std::vector<std::string> kBoth = {"paper", "scree"};

/// Runs one experiment and fails with every row that breaks a release.
void expectNothingBroken(const std::string& id, const std::vector<std::string>& methods = kBoth)
{
    const Experiment& experiment = *chooseExperiments({id}).at(0);
    int gates = 0;  // that have been passed
    for (const std::string& method : methods) {
        Context context = briefContext();
        context.method = method;
        Findings findings;
        runExperiment(experiment, context, findings);
        for (const Measurement& row : findings.rows) {
            gates += row.weight == Weight::must && row.verdict == Verdict::pass;
            EXPECT_FALSE(isBroken(row))
                << method << ": " << row.what << ": " << row.measured << " " << row.unit
                << ", theory " << row.theory << ", tolerance " << row.tolerance << row.note;
        }
    }
    EXPECT_GT(gates, 0);
}

/// Of a part that both methods share.
void expectNothingBrokenInEither(const std::string& id)
{
    expectNothingBroken(id, {"paper"});
}

TEST(E1BlockAtRest, AnElasticBlockStaysWhereItWasPutAndTheTextbookOrderThrowsItAbout)
{
    expectNothingBroken("E1");
}
TEST(E2Sliding, BlocksFollowCoulombToFirstOrderInTheStep)
{
    expectNothingBroken("E2");
}
TEST(E3Billiards, TheLastOfFiveBallsLeavesWithTheWholeMomentum)
{
    expectNothingBroken("E3");
}
TEST(E4Stack, StacksStandOnlyWithShockAndAWeightOnAPlankThrowsThemUp)
{
    expectNothingBroken("E4");
}
TEST(E5SeeSaw, WeightIsFeltThroughThePlankButNotByShockAlone)
{
    expectNothingBroken("E5");
}
TEST(E6ContactGraph, DominoesInACircleAreOneLevelOnTheGround)
{
    expectNothingBroken("E6");
}
TEST(E7Rings, OnAPoleAndBesideItAreJudgedByTheirPosesAndASpoiltFrameIsSeen)
{
    expectNothingBroken("E7");
}
TEST(E8Bones, FallThroughAFunnelWithoutOverlapAndASpoiltFrameIsSeen)
{
    expectNothingBroken("E8");
}
TEST(E9Rolling, BallsStopWhenAndWhereTheorySaysAndNeverTurnBack)
{
    expectNothingBroken("E9");
}
TEST(E10MassProperties, AreThoseOfClosedForms)
{
    expectNothingBrokenInEither("E10");
}
TEST(E11PushOut, WhatOverlapsComesApartAndNoVelocityChanges)
{
    expectNothingBroken("E11");
}
TEST(E12FastAndThin, NothingTunnelsUnlessTheLimiterIsSwitchedOff)
{
    expectNothingBroken("E12");
}
TEST(E13FreeFlight, AHundredSpinningBodiesKeepEveryLaw)
{
    expectNothingBroken("E13");
}
TEST(E14Tumbling, OnlyTheSecondOrderUpdateKeepsEnergyAndTheTimesOfTheFlips)
{
    expectNothingBroken("E14");
}
TEST(E15Impulses, RandomPairsMirrorImagesAndTripleCollisionsObeyEveryLaw)
{
    expectNothingBroken("E15");
}
TEST(E16Bounce, AnElasticBallLosesNoMoreHeightThanAStepOfItsFall)
{
    expectNothingBroken("E16");
}
TEST(E17AcceleratedFrames, LiftsCarryTurntablesFlingAndRamsPush)
{
    expectNothingBroken("E17");
}
TEST(E18FreeCluster, ShockPropagationCreatesNoMomentum)
{
    expectNothingBroken("E18");
}
TEST(E19Determinism, ThreadsAndCheckpointsLeaveNoTrace)
{
    expectNothingBroken("E19");
}
TEST(E20HeapQuality, WithMethodScreeAHeapKeepsApartAnArchStandsAndANutTurns)
{
    expectNothingBroken("E20");
}
TEST(E21DistanceField, IsExactWhereItDecidesInBothStorages)
{
    expectNothingBrokenInEither("E21");
}
TEST(E22Variants, LaggedHeapsAreLikeOthersAndStrictPassesWhatItShould)
{
    expectNothingBroken("E22", {"paper"});
}
TEST(E23EdgeAgainstEdge, ACrossedBeamRestsOnTheEdgeOfAnother)
{
    expectNothingBroken("E23");
}
TEST(E24NoMissedBounce, ContactStopsNothingThatCollisionHasNotSeen)
{
    expectNothingBroken("E24");
}
TEST(E25DropToRest, WithAllDefaultsEachShapeComesToRestOnTheFloor)
{
    expectNothingBroken("E25");
}
TEST(E26WhatShockBuys, FiveTimesTheSweepsDoNotReplaceIt)
{
    expectNothingBroken("E26");
}
TEST(E27TallAndHeavy, StandWithMethodScreeAtOneStepAFrame)
{
    expectNothingBroken("E27", {"scree"});
}
TEST(E28BounceHeight, IsThatOfTheoryWithMethodScree)
{
    expectNothingBroken("E28", {"scree"});
}

TEST(Verify, ARowPassesOnlyWithinItsBoundAndNothingThatIsNoNumberPasses)
{
    Findings findings;
    findings.atMost(Weight::must, "within", 1.0, 1.0, "m");
    findings.atMost(Weight::must, "beyond", 1.1, 1.0, "m");
    findings.near(Weight::must, "no number", std::nan(""), 1.0, 1.0, "m");
    findings.atLeast(Weight::control, "a control that sees nothing", 0.0, 0.1, "m");
    findings.atMost(Weight::goal, "a goal missed", 2.0, 1.0, "m");
    findings.atMost(Weight::departure, "a known departure", 2.0, 1.0, "m");
    findings.notRun(Weight::must, "missing", "why");
    const std::vector<bool> broken = {false, true, true, true, false, false, false};
    for (std::size_t i = 0; i < broken.size(); ++i) {
        EXPECT_EQ(isBroken(findings.rows[i]), broken[i]) << findings.rows[i].what;
    }
    const Summary summary = summarize({{nullptr, "paper", findings, 0.0}});
    EXPECT_EQ(summary.broken, 3);
    EXPECT_EQ(summary.missing, 1);
    EXPECT_EQ(summary.departures, 1);
    EXPECT_FALSE(summary.isComplete());
}

TEST(Verify, AFigureThatWasNoNumberOnceFailsItsBound)
{
    const double none = std::nan("");
    for (const auto& [a, b] : {std::pair{1.0, none}, std::pair{none, 1.0}}) {
        EXPECT_TRUE(std::isnan(larger(a, b)));
        EXPECT_TRUE(std::isnan(smaller(a, b)));
    }
    EXPECT_EQ(larger(1.0, 2.0), 2.0);
    EXPECT_EQ(smaller(1.0, 2.0), 1.0);
}

// No sample of a face is near the place where two edges cross.
TEST(Verify, TheJudgeSeesEdgesThatCrossABodyBetweenItsSamples)
{
    ShotRun run(briefContext(), "E23_beams");
    const PoseJudge judge(run.describe());
    const double sunk = 1e-3, touching = 0.1 * std::sqrt(2.0);
    BodyMotion& upper = run.world.motion[run.body("upper")];
    upper.position.y() += touching - sunk - (upper.position - run.motion("lower").position).y();
    // A point below an edge is as deep as the faces beside it, which lean by 45 degrees.
    EXPECT_NEAR(judge.deepestOverlap(run.capture()), sunk / std::sqrt(2.0), 1e-6);
    upper.position.y() += 2.0 * sunk;
    EXPECT_EQ(judge.deepestOverlap(run.capture()), 0.0);
}

/// Blows a block away by steps or by frames, and asks for nothing that could fail but numbers.
template <bool kByFrames>
void runBlownAway(const Context& context, Findings& findings)
{
    ShotRun run(context, "E01_floor", {}, [](StepSettings& settings) {
        settings.gravity.y() = std::numeric_limits<double>::infinity();
    });
    if (kByFrames)
        run.advanceFrames(2);
    else
        run.advance(0.1, 60.0);
    findings.atMost(Weight::must, "shift of a vertex", 0.0, 1.0, "m");
}

TEST(Verify, ARunThatIsNoLongerFiniteFailsInEitherMethod)
{
    Context context = briefContext();
    for (const char* method : {"paper", "scree"}) {
        context.method = method;
        for (const auto run : {runBlownAway<false>, runBlownAway<true>}) {
            Findings findings;
            runExperiment({"E0", "", true, "", "", run}, context, findings);
            ASSERT_EQ(findings.rows.size(), 1u) << method;
            EXPECT_TRUE(isBroken(findings.rows[0]));
            EXPECT_NE(findings.rows[0].note.find("block"), std::string::npos);
        }
    }
}

TEST(Verify, ATakeOfLessThanTwoFramesIsMissingAndNotJudged)
{
    const test::TemporaryFolder takes;
    Context context = briefContext();
    context.takes = takes.path();
    const Shot shot = parseShotText(
        test::shotTextOf({}, test::bodyText("block", "position = [0, 2, 0]")), "s.toml");
    World world = buildWorld(shot);
    TakeWriter take(folderOfTake(context, "s"), shot, world, "1.2.3", ExistingTake::refuse);
    for (int frames = 0; frames < 3; ++frames) {
        Findings findings;
        EXPECT_EQ(largeTake(context, "s", findings).has_value(), frames == 2) << frames;
        EXPECT_EQ(std::ranges::count_if(findings.rows, isMissing), frames < 2) << frames;
        FrameStats stats;
        stats.frame = shot.firstFrame + frames;
        take.writeFrame(world, stats);
        ++world.clock.frame;
    }
}

TEST(Verify, ExperimentsAreFoundByAnySpellingOfTheirNumber)
{
    for (const char* id : {"E5", "e5", "5"}) {
        EXPECT_STREQ(chooseExperiments({id}).at(0)->id, "E5");
    }
    EXPECT_EQ(chooseExperiments({}).size(), experiments().size());
    EXPECT_THROW(chooseExperiments({"E99"}), Error);
    EXPECT_THROW(methodsToRun("papre"), Error);
    EXPECT_EQ(methodsToRun("paper"), std::vector<std::string>{"paper"});
}

TEST(Verify, ThePageHoldsTablesPlotsAndPicturesAndNeedsNothingElse)
{
    const Experiment& experiment = *chooseExperiments({"E23"}).at(0);
    Context context = briefContext();
    context.wantsPictures = true;
    Result result{&experiment, "paper", {}, 0.0};
    runExperiment(experiment, context, result.findings);
    Curve curve{"a < b", {0.0, 1.0, 2.0}, {0.0, 1.0, 4.0}, false};
    result.findings.plots.push_back({"title", "x", "y", {curve}});
    const std::string page = toHtml({result}, context);
    EXPECT_NE(page.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(page.find("a &lt; b"), std::string::npos);
    EXPECT_NE(page.find("<polyline"), std::string::npos);
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
    for (const Measurement& row : result.findings.rows) {
        EXPECT_NE(page.find(escapedForHtml(row.what)), std::string::npos);
    }
}

TEST(Verify, AxesHaveRoundNumbers)
{
    EXPECT_DOUBLE_EQ(niceStep(6.0), 1.0);
    EXPECT_DOUBLE_EQ(niceStep(9.0), 2.0);
    EXPECT_DOUBLE_EQ(niceStep(0.03), 0.005);
    EXPECT_DOUBLE_EQ(niceStep(1.0), 0.2);
}

}  // namespace
}  // namespace scree::verify
