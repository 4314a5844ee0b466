// What a resume refuses, what it makes good and what it leaves to the run.
#include "io/take_proof.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "io/frame_file.h"
#include "io/take_info.h"
#include "io/take_reader.h"
#include "tests/io/take_fixture.h"
#include "tests/support/refusal.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::flipByte;
using test::shotText;

class TakeResume : public test::TakeFixture {
protected:
    /// Leaves a checkpoint after a step of so many seconds, inside the frame after the first.
    void stopInsideAFrame(double dt)
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        World moved = world;
        take.writeFrame(moved, statsOf(moved));
        moved.clock.subStep = 3;
        moved.contactMemory.dt = dt;
        take.writeCheckpoint(moved);
    }
};

TEST_F(TakeResume, ShapesThatAreNotThereAreWrittenOnResume)
{
    writeWholeTake();
    fs::remove_all(TakePaths{folder / "take"}.shapes());
    open(ExistingTake::resume, shot);
    EXPECT_NO_THROW(TakeReader(folder / "take").describe());
}

TEST_F(TakeResume, FramesWithoutFiguresAreTold)
{
    writeWholeTake();
    EXPECT_TRUE(open(ExistingTake::resume, shot).notices().empty());
    fs::remove(folder / "take/stats.jsonl");
    const TakeWriter take = open(ExistingTake::resume, shot);
    ASSERT_EQ(take.notices().size(), 1u);
    EXPECT_NE(take.notices()[0].find("no figures for 5 frames"), std::string::npos)
        << take.notices()[0];
}

TEST_F(TakeResume, ResumeRefusesAnotherShot)
{
    writeWholeTake();
    const Shot other = parseShotText(shotText(), "two.toml", {"material.wood.friction=0.9"});
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, other); }), ErrorKind::badInput);
}

TEST_F(TakeResume, ResumeRefusesAWorldThatBeginsElsewhere)
{
    writeWholeTake();
    world.motion[1].position.x() += 1e-12;
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }), ErrorKind::badInput);
}

TEST_F(TakeResume, LostOrCutTakeJsonIsMadeAgainFromFramesOfTheShot)
{
    writeWholeTake();
    const std::string whole = readFileBytes(folder / "take/take.json");
    for (const bool isCut : {false, true}) {
        fs::remove(folder / "take/take.json");
        if (isCut) writeFileBytes(folder / "take/take.json", whole.substr(0, 20));
        EXPECT_NE(test::kindThrownBy([&] { TakeReader(folder / "take"); }), std::nullopt);
        const TakeWriter take = open(ExistingTake::resume, shot);
        EXPECT_EQ(take.notices().size(), 1u);
        EXPECT_TRUE(take.hasFrame(1005));
        EXPECT_EQ(readFileBytes(folder / "take/take.json"), whole);
    }
}

TEST_F(TakeResume, LostTakeJsonIsAnErrorBesideFramesOfAnotherShotOrWithAGap)
{
    writeWholeTake();
    fs::remove(folder / "take/take.json");
    const Shot other = parseShotText(shotText(), "two.toml", {"material.wood.friction=0.9"});
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, other); }), ErrorKind::badInput);
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::refuse, shot); }),
              ErrorKind::inputOutput);
    fs::remove(folder / "take/frames/frame.001003.scree");
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }),
              ErrorKind::inputOutput);
    EXPECT_EQ(listFrames({folder / "take"}).size(), 4u);
}

// A folder of shapes was there before: a name was taken for the mesh.
TEST_F(TakeResume, AMeshOfAnotherTakeIsNotTakenForTheShots)
{
    fs::create_directories(folder / "take/shapes");
    writeFileBytes(folder / "take/shapes/block.ply", "ply");
    open(ExistingTake::refuse, shot);
    EXPECT_NO_THROW(TakeReader(folder / "take").describe());
}

TEST_F(TakeResume, DamagedFrameIsReportedAndOpenAgainWhileOthersStay)
{
    writeWholeTake();
    flipByte(folder / "take/frames/frame.001003.scree", 300);
    TakeWriter take = open(ExistingTake::resume, shot);
    ASSERT_EQ(take.notices().size(), 1u);
    EXPECT_NE(take.notices()[0].find("frame.001003.scree"), std::string::npos);
    EXPECT_FALSE(take.hasFrame(1003));
    EXPECT_TRUE(take.hasFrame(1005));

    // Filling the hole gives the statistics their order back.
    World moved = world;
    take.prepareFor(1003, moved);
    EXPECT_EQ(moved.clock.frame, 1);
    advance(moved);
    take.writeFrame(moved, statsOf(moved));
    std::vector<int> frames;
    for (const FrameSummary& line : take.summaries()) frames.push_back(line.frame);
    EXPECT_EQ(frames, (std::vector<int>{1001, 1002, 1003, 1004, 1005}));
}

TEST_F(TakeResume, CheckpointIsWhereAFrameGoesOnAndGoesWithIt)
{
    World moved = world;
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        take.writeFrame(moved, statsOf(moved));
        moved.clock.subStep = 3;
        moved.contactMemory.dt = 0.01;
        moved.motion[1].position.y() -= 0.25;
        take.writeCheckpoint(moved);
    }
    TakeWriter take = open(ExistingTake::resume, shot);
    World resumed = world;
    take.prepareFor(1002, resumed);
    EXPECT_EQ(stateHash(resumed), stateHash(moved));
    resumed.clock = {1, 0, 0.0};
    take.writeFrame(resumed, statsOf(resumed));
    EXPECT_FALSE(fs::exists(take.paths().checkpoint()));
}

TEST_F(TakeResume, DamagedCheckpointFallsBackToTheFrame)
{
    stopInsideAFrame(0.01);
    flipByte(folder / "take/checkpoint.scree", 200);
    const TakeWriter take = open(ExistingTake::resume, shot);
    ASSERT_EQ(take.notices().size(), 1u);
    EXPECT_EQ(take.notices()[0].find("does not remember the step"), std::string::npos);
    World resumed = world;
    take.prepareFor(1002, resumed);
    EXPECT_EQ(stateHash(resumed), stateHash(world));
}

// The next step took no longer than the last one, and that was not known: no time at all.
TEST_F(TakeResume, ACheckpointThatForgotItsLastStepFallsBackToTheFrame)
{
    stopInsideAFrame(0.0);
    const TakeWriter take = open(ExistingTake::resume, shot);
    ASSERT_EQ(take.notices().size(), 1u);
    EXPECT_NE(take.notices()[0].find("does not remember the step"), std::string::npos);
    World resumed = world;
    take.prepareFor(1002, resumed);
    EXPECT_EQ(stateHash(resumed), stateHash(world));
}

// It stayed for ever, and every later resume told of it again.
TEST_F(TakeResume, DamagedCheckpointIsToldOnceAndRemoved)
{
    writeWholeTake();
    writeFileBytes(folder / "take/checkpoint.scree", "garbage");
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 1u);
    EXPECT_FALSE(fs::exists(folder / "take/checkpoint.scree"));
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 0u);
}

// Frames of two bodies were then of another take for every reader.
TEST_F(TakeResume, ATakeJsonThatLostItsBodiesIsPutRightOnResume)
{
    writeWholeTake();
    const fs::path path = folder / "take/take.json";
    const std::string whole = readFileBytes(path);
    TakeInfo info = decodeTakeInfo(whole, path);
    info.bodies.clear();
    writeFileBytes(path, encodeTakeInfo(info));
    EXPECT_EQ(TakeReader(folder / "take").damagedFrames().size(), 5u);
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 1u);
    EXPECT_EQ(readFileBytes(path), whole);
    EXPECT_TRUE(TakeReader(folder / "take").damagedFrames().empty());
}

TEST_F(TakeResume, CutLineOfTheStatisticsIsDroppedOnResume)
{
    writeWholeTake();
    std::ofstream(folder / "take/stats.jsonl", std::ios::app) << R"({"frame":1006,"wall_s":0.)";
    const TakeWriter take = open(ExistingTake::resume, shot);
    const std::string text = readFileBytes(take.paths().stats());
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
    EXPECT_TRUE(text.ends_with("}\n"));
}

// The line is written before the frame; cut, it was taken for statistics of something else.
TEST_F(TakeResume, ATakeOfOneCutLineIsGoneOnWith)
{
    open(ExistingTake::refuse, shot);
    writeFileBytes(folder / "take/stats.jsonl", "{\"frame\":10");
    EXPECT_NO_THROW(open(ExistingTake::resume, shot));
}

// It had replaced the meshes, and taken their hashes into take.json, before it saw that the shot is
// another: what was there fitted its frames no more.
TEST_F(TakeResume, AResumeThatIsRefusedHasWrittenNothing)
{
    writeWholeTake();
    const TakePaths paths{folder / "take"};
    TakeInfo info = decodeTakeInfo(readFileBytes(paths.info()), paths.info());
    const std::string asItWas = encodeTakeInfo(info);
    info.shapes.at(0).hash ^= 1;
    const std::string ofOtherMesh = encodeTakeInfo(info);
    for (const std::string& text : {asItWas, ofOtherMesh}) {
        writeFileBytes(paths.info(), text);
        writeFileBytes(paths.shape("block"), "an older mesh");
        World changed = world;
        if (text == asItWas) changed.motion[1].position.x() += 1e-12;
        EXPECT_EQ(test::kindThrownBy([&] {
                      TakeWriter(folder / "take", shot, changed, "1.2.3", ExistingTake::resume);
                  }),
                  ErrorKind::badInput);
        EXPECT_EQ(readFileBytes(paths.info()), text);
        EXPECT_EQ(readFileBytes(paths.shape("block")), "an older mesh");
    }
}

TEST_F(TakeResume, ALostTakeJsonIsNotMadeAgainForAWorldThatBeginsElsewhere)
{
    writeWholeTake();
    fs::remove(folder / "take/take.json");
    world.motion[1].position.x() += 1e-12;
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }), ErrorKind::badInput);
    EXPECT_FALSE(fs::exists(folder / "take/take.json"));
}

// What a look at all poses had found was forgotten between two sittings, and so were the figures of
// the steps before a stop: whether a limit was broken depended on where a run was interrupted.
TEST_F(TakeResume, ACheckpointKeepsFiguresAndOverlapsThatContactsDoNotTellOf)
{
    World moved = world;
    FrameReport soFar;
    soFar.steps = 3;
    soFar.shortestStep = 1e-3;
    soFar.substepCapReached = true;
    soFar.fastestBody = 1;
    soFar.sum.limitedBy = StepLimit::hover;
    soFar.sum.contactImpulses.rolling = 7;
    soFar.sum.worstOverlapRatio = 0.125;
    soFar.sum.worstA = 0;
    soFar.sum.worstB = 1;
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        take.writeFrame(moved, statsOf(moved), {}, {}, {{0, 1}});
        moved.clock.subStep = 3;
        moved.contactMemory.dt = 0.01;
        take.writeCheckpoint(moved, {}, soFar, {{0, 1}});
    }
    const TakeWriter take = open(ExistingTake::resume, shot);
    EXPECT_TRUE(take.notices().empty()) << take.notices().front();
    World resumed = world;
    const std::optional<FrameState> left = take.prepareFor(1002, resumed);
    ASSERT_TRUE(left);
    EXPECT_EQ(left->untold, (std::vector<BodyPair>{{0, 1}}));
    EXPECT_EQ(left->soFar.steps, 3);
    EXPECT_EQ(left->soFar.shortestStep, 1e-3);
    EXPECT_TRUE(left->soFar.substepCapReached);
    EXPECT_EQ(left->soFar.fastestBody, 1);
    EXPECT_EQ(left->soFar.sum.limitedBy, StepLimit::hover);
    EXPECT_EQ(left->soFar.sum.contactImpulses.rolling, 7);
    EXPECT_EQ(left->soFar.sum.worstOverlapRatio, 0.125);
    EXPECT_EQ(left->soFar.sum.worstB, 1);
    EXPECT_EQ(readFrameFile(take.paths().frame(1001)).untold, (std::vector<BodyPair>{{0, 1}}));
}

}  // namespace
}  // namespace scree
