// Samples between frames: where bodies are when a shutter is open, at no cost to the simulation.
#include "io/subframes.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "core/math/rotation.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "io/take_reader.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// A block that lands within the shot, one that spins in mid-air, a ground and a block at rest.
const std::string kShotText =
    test::shotTextOf({.name = "blocks",
                      .shotKeys = "units = \"cm\"\n[solver]\nsubsteps = { min = 24, max = 256 }",
                      .box = "[20, 20, 20]"},
                     test::bodyText("landing",
                                    "position = [0, 11, 0]\nrotation = [3, 2, 1]\n"
                                    "velocity = [30, 0, 0]") +
                         test::bodyText("spinner",
                                        "position = [200, 400, 0]\nvelocity = [100, 50, 0]\n"
                                        "spin = [0, 0, 1000]") +
                         "[output]\nsubframes = [-0.25, 0.25, 0.4]\n");

constexpr std::size_t kGround = 0, kSpinner = 2;
constexpr double kGravity = 981.0;  // [cm/s²]
constexpr double kFrame = 1.0 / 24.0;

Shot shotWith(const std::vector<std::string>& overrides = {})
{
    return parseShotText(kShotText, "blocks.toml", overrides);
}

/// Simulates what the take lacks, as `scree sim` does; stops after `stepLimit` sub-steps if that is
/// not 0. Returns the state hash of every frame it wrote.
std::vector<std::uint64_t> simulate(const Shot& shot, const fs::path& folder,
                                    ExistingTake existing = ExistingTake::refuse, int stepLimit = 0)
{
    World world = buildWorld(shot);
    TakeWriter take(folder, shot, world, "1.2.3", existing);
    SubframeRecorder recorder(shot, world);
    Stepper stepper(shot.settings);
    std::vector<std::uint64_t> hashes;
    int steps = 0;
    for (int frame = shot.firstFrame; frame <= shot.lastFrame; ++frame) {
        if (take.hasFrame(frame)) continue;
        FrameStats stats;
        stats.frame = frame;
        if (frame > shot.firstFrame) {
            const std::optional<FrameState> left = take.prepareFor(frame, world);
            recorder.begin(world, left ? left->between : std::vector<SceneFrame>());
            stats.report = stepper.advanceFrame(
                world, 1.0 / shot.framesPerSecond, [&] { return ++steps == stepLimit; },
                [&](const World& moved, double time) { recorder.afterStep(moved, time); });
            if (!stats.report.finished) {
                take.writeCheckpoint(world, recorder.samples());
                return hashes;
            }
        }
        take.writeFrame(world, stats, recorder.samples());
        hashes.push_back(stateHash(world));
    }
    return hashes;
}

class SubframesTest : public testing::Test {
protected:
    test::TemporaryFolder folder;
};

TEST_F(SubframesTest, AskingForSamplesChangesNoBitOfTheSimulation)
{
    const auto with = simulate(shotWith(), folder / "with");
    const auto without = simulate(shotWith({"output.subframes=[]"}), folder / "without");
    EXPECT_EQ(with.size(), 6u);
    EXPECT_EQ(with, without);
}

TEST_F(SubframesTest, ARunStoppedAnywhereGoesOnToTheSameBytes)
{
    const Shot shot = shotWith();
    simulate(shot, folder / "whole");
    // The stops lie before, between and behind the three instants of a frame.
    for (const int stop : {1, 2, 3, 5, 9, 20}) {
        const fs::path stopped = folder / ("stopped" + std::to_string(stop));
        simulate(shot, stopped, ExistingTake::refuse, stop);
        ASSERT_TRUE(fs::exists(TakePaths{stopped}.checkpoint())) << stop;
        simulate(shot, stopped, ExistingTake::resume);
        for (int frame = shot.firstFrame; frame <= shot.lastFrame; ++frame) {
            EXPECT_TRUE(readFileBytes(TakePaths{stopped}.frame(frame)) ==
                        readFileBytes(TakePaths{folder / "whole"}.frame(frame)))
                << "frame " << frame << " after a stop at sub-step " << stop;
        }
    }
}

TEST_F(SubframesTest, EverySampleOfABodyInFlightLiesOnItsPath)
{
    simulate(shotWith(), folder / "take");
    const TakeReader take(folder / "take");
    ASSERT_EQ(take.offsets(), (std::vector<double>{-0.25, 0.0, 0.25, 0.4}));
    for (int frame = 1002; frame < 1006; ++frame) {
        const std::vector<SceneFrame> samples = take.readSamples(frame);
        ASSERT_EQ(samples.size(), 4u);
        for (const SceneFrame& sample : samples) {
            EXPECT_EQ(sample.frame, frame);
            const double t = (frame - 1001 + sample.offset) * kFrame;
            const Pose& pose = sample.worldFromAsset[kSpinner];
            // Steps of 1/168 s: their parabola in chords is off by g dt²/8 = 0.004 cm, and the
            // integrator by g t dt/2 at most.
            EXPECT_NEAR(pose.position.x(), 200.0 + 100.0 * t, 1e-9);
            EXPECT_NEAR(pose.position.y(), 400.0 + 50.0 * t - 0.5 * kGravity * t * t,
                        0.005 + 0.5 * kGravity * t / 168.0);
            // A cube turns evenly; the chord of one step (6°) is off by far less than 1e-4 rad.
            const Quat turn(Eigen::AngleAxisd(1000.0 * t * kPi / 180.0, Vec3::UnitZ()));
            EXPECT_LT(pose.orientation.angularDistance(turn), 1e-4);
        }
    }
}

TEST_F(SubframesTest, AKeyedBodyIsOnItsScriptInEverySample)
{
    // 144° and 2 m a frame, each of them one step.
    std::string keys;
    for (int k = 0; k < 6; ++k) {
        keys += "{ frame = " + std::to_string(1001 + k) + ", position = [" + std::to_string(2 * k) +
                ", 5, 0], rotation = [0, 0, " + std::to_string(144 * k) + "] },\n";
    }
    const Shot shot = parseShotText(
        test::shotTextOf(
            {.name = "propeller", .box = "[20, 20, 20]"},
            test::bodyText("propeller",
                           "motion = \"keyed\"\ninterpolate = \"linear\"\nkeys = [" + keys + "]") +
                "[output]\nsubframes = [0.25]\n"),
        "propeller.toml", {});
    simulate(shot, folder / "take");
    const TakeReader take(folder / "take");
    for (int frame = 1001; frame < 1006; ++frame) {
        const SceneFrame sample = take.readSamples(frame).back();
        const double share = (frame - 1001 + sample.offset) / 5.0;
        const Pose& pose = sample.worldFromAsset[1];
        EXPECT_NEAR(pose.position.x(), 10.0 * share, 1e-9) << frame;
        const Quat turn(Eigen::AngleAxisd(4.0 * kPi * share, Vec3::UnitZ()));
        EXPECT_LT(pose.orientation.angularDistance(turn), 1e-9) << frame;
    }
}

/// What is round about an axis, of a radius of 2 cm; `bodies` stand behind the ground.
Shot fastRoundBodies(const std::string& bodies, const std::vector<std::string>& overrides = {})
{
    const std::string shapes =
        "[shape.marble]\nsphere = { radius = 0.02 }\n"
        "[shape.coin]\ncylinder = { radius = 0.02, height = 0.002, sectors = 48 }\n";
    return parseShotText(
        test::shotTextOf({.name = "round"},
                         shapes + bodies + "[output]\nsubframes = [-0.25, 0.1, 0.25]\n"),
        "round.toml", overrides);
}

constexpr double kMarbleSpeed = 10.0, kMarbleSpin = 500.0;  // [m/s], [rad/s]

/// Two marbles at that speed and spin, for which a few steps a frame do: one rolls, one flies.
Shot fastMarbles()
{
    const auto marble = [](const std::string& name, double height) {
        return test::bodyText(name,
                              "position = [0, " + std::to_string(height) + ", 0]\nvelocity = [" +
                                  std::to_string(kMarbleSpeed) + ", 0, 0]\nspin = [0, 0, " +
                                  std::to_string(-kMarbleSpin * 180.0 / kPi) + "]\n",
                              "marble");
    };
    return fastRoundBodies(marble("roller", 0.02) + marble("flyer", 40.0));
}

// What is round may turn by any angle in a step: marbles turned back between two of them.
TEST_F(SubframesTest, FastMarblesTurnTheWayTheyRoll)
{
    simulate(fastMarbles(), folder / "take");
    const TakeReader take(folder / "take");
    for (int frame = 1002; frame < 1006; ++frame) {
        for (const SceneFrame& sample : take.readSamples(frame)) {
            const double t = (frame - 1001 + sample.offset) * kFrame;
            const Quat turn(Eigen::AngleAxisd(-kMarbleSpin * t, Vec3::UnitZ()));
            // Degrees have six decimals in the shot; contacts brake nothing that rolls.
            for (const std::size_t body : {1, 2})
                EXPECT_LT(sample.worldFromAsset[body].orientation.angularDistance(turn), 1e-6)
                    << "body " << body << " at " << frame + sample.offset;
        }
    }
}

TEST_F(SubframesTest, SamplesOfABlurDoNotDependOnHowManyStepsItTakes)
{
    // About its own axis it turns 2000 rad/s, and wobbles.
    const std::string text =
        test::bodyText("coin", "position = [0, 50, 0]\nspin = [300, 114592, 0]", "coin");
    simulate(fastRoundBodies(text), folder / "few");
    simulate(fastRoundBodies(text, {"solver.substeps.min=160"}), folder / "many");
    const TakeReader few(folder / "few"), many(folder / "many");
    constexpr std::size_t kCoin = 1;
    for (int frame = 1002; frame < 1006; ++frame) {
        const std::vector<SceneFrame> a = few.readSamples(frame), b = many.readSamples(frame);
        for (std::size_t i = 0; i < a.size(); ++i)
            EXPECT_LT(a[i].worldFromAsset[kCoin].orientation.angularDistance(
                          b[i].worldFromAsset[kCoin].orientation),
                      1e-6)
                << frame + a[i].offset;
    }
}

// Between the samples of a picture they turned the short way once more.
TEST_F(SubframesTest, BetweenTwoSamplesAFastMarbleTurnsAsOftenAsItsVelocityTells)
{
    simulate(fastMarbles(), folder / "take");
    const std::vector<SceneFrame> samples = TakeReader(folder / "take").readSamples(1003);
    const SceneFrame &a = samples.front(), &b = samples.back();
    const double seconds = (b.offset - a.offset) * kFrame;  // of 10.4 rad
    for (const double share : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        const SceneFrame moment = inBetween(a, b, share, seconds);
        const double t = (2.0 + a.offset) * kFrame + share * seconds;
        const Quat turn(Eigen::AngleAxisd(-kMarbleSpin * t, Vec3::UnitZ()));
        for (const std::size_t body : {1, 2}) {
            const Pose& pose = moment.worldFromAsset[body];
            EXPECT_LT(pose.orientation.angularDistance(turn), 1e-6) << body << ", " << share;
            EXPECT_NEAR(pose.position.x(), kMarbleSpeed * t, 1e-9) << body << ", " << share;
        }
    }
}

TEST_F(SubframesTest, BeforeTheFirstAndAfterTheLastFrameBodiesCoast)
{
    simulate(shotWith(), folder / "take");
    const TakeReader take(folder / "take");
    const std::vector<SceneFrame> first = take.readSamples(1001);
    const Vec3 shift =
        first[1].worldFromAsset[kSpinner].position - first[0].worldFromAsset[kSpinner].position;
    EXPECT_NEAR(shift.x(), 100.0 * 0.25 * kFrame, 1e-9);
    EXPECT_NEAR(first[0].worldFromAsset[kSpinner].orientation.angularDistance(
                    first[1].worldFromAsset[kSpinner].orientation),
                1000.0 * 0.25 * kFrame * kPi / 180.0, 1e-9);

    const std::vector<SceneFrame> last = take.readSamples(1006);
    EXPECT_NEAR(last[3].worldFromAsset[kSpinner].position.x() -
                    last[1].worldFromAsset[kSpinner].position.x(),
                100.0 * 0.4 * kFrame, 1e-9);
}

TEST_F(SubframesTest, WhatStandsStillHasTheSameBitsInEverySample)
{
    simulate(shotWith(), folder / "take");
    const TakeReader take(folder / "take");
    const Pose still = take.readFrame(1001).worldFromAsset[kGround];
    const std::vector<SceneFrame> samples = take.readSamples(1004);
    ASSERT_EQ(samples.size(), 4u);
    for (const SceneFrame& sample : samples) {
        EXPECT_EQ(sample.worldFromAsset[kGround].position, still.position);
        EXPECT_EQ(sample.worldFromAsset[kGround].orientation.coeffs(), still.orientation.coeffs());
    }
}

TEST_F(SubframesTest, ATakeWithoutThemHasNothingButWholeFrames)
{
    simulate(shotWith({"output.subframes=[]"}), folder / "take");
    const TakeReader take(folder / "take");
    ASSERT_EQ(take.offsets(), std::vector<double>{0.0});
    const std::vector<SceneFrame> samples = take.readSamples(1003);
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].offset, 0.0);
}

TEST_F(SubframesTest, ADamagedNextFrameIsAnErrorAndNoGuess)
{
    simulate(shotWith(), folder / "take");
    const fs::path next = TakePaths{folder / "take"}.frame(1004);
    fs::resize_file(next, fs::file_size(next) - 1);
    EXPECT_THROW(TakeReader(folder / "take").readSamples(1003), Error);
    EXPECT_NO_THROW(TakeReader(folder / "take").readSamples(1002));
}

TEST(SampleOffsets, ZeroIsAlwaysAmongThem)
{
    EXPECT_EQ(sampleOffsets({}), std::vector<double>{0.0});
    EXPECT_EQ(sampleOffsets({0.25, -0.25}), (std::vector<double>{-0.25, 0.0, 0.25}));
    EXPECT_EQ(sampleOffsets({0.0, -0.5}), (std::vector<double>{-0.5, 0.0}));
}

TEST(SampleOffsets, OnlyThoseThatFitIntoAFrameAreAccepted)
{
    EXPECT_TRUE(areSampleOffsets({}));
    EXPECT_TRUE(areSampleOffsets({-0.5, -0.25, 0.25}));
    EXPECT_TRUE(areSampleOffsets({0.5, 0.25}));
    EXPECT_FALSE(areSampleOffsets({-0.5, 0.5}));    // the same instant twice
    EXPECT_FALSE(areSampleOffsets({0.25, 0.251}));  // times that readers take for equal
    EXPECT_FALSE(areSampleOffsets({0.25, 0.25}));
    EXPECT_FALSE(areSampleOffsets({0.995}));
}

TEST(SampleOffsets, InstantsOfBothNeighboursMeetInOneInterval)
{
    EXPECT_EQ(instantsBetween({-0.25, 0.0, 0.25, 0.5}), (std::vector<double>{0.25, 0.5, 0.75}));
    EXPECT_TRUE(instantsBetween({0.0}).empty());
}

}  // namespace
}  // namespace scree
