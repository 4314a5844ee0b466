// start = "asleep": bodies that wait where they are put until something touches them.
#include <gtest/gtest.h>

#include <string>

#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/frame_file.h"
#include "io/shot_parser.h"
#include "io/world_state.h"
#include "tests/support/small_shot.h"

namespace scree {
namespace {

const std::string kHead =
    "scree = 1\n[shot]\nname = \"s\"\n[material.wood]\n[shape.block]\nbox = {}\n";

std::string blockAt(const std::string& name, const std::string& position,
                    const std::string& lines = "start = \"asleep\"\n")
{
    return "[[body]]\nname = \"" + name +
           "\"\nshape = \"block\"\nmaterial = \"wood\"\nposition = " + position + "\n" + lines;
}

/// Two that touch in mid-air, one that hangs alone, and one that falls on the first after a third
/// of a second.
const std::string kHanging = kHead + blockAt("hit", "[0, 10, 0]") +
                             blockAt("beside", "[1.001, 10, 0]") + blockAt("alone", "[4, 10, 0]") +
                             blockAt("falling", "[-0.3, 11.5, 0]", "");

TEST(StartAsleep, NothingMovesUntilItIsTouchedThoughItHangsInTheAir)
{
    const Shot shot = parseShotText(kHanging, "s.toml");
    World world = buildWorld(shot);
    const World before = world;
    Stepper stepper(shot.settings);
    const double frame = 1.0 / shot.framesPerSecond;
    // Half a metre of free fall takes 0.32 s, which is 7.7 frames.
    for (int i = 0; i < 7; ++i) {
        stepper.advanceFrame(world, frame);
        for (const BodyId body : {0, 1, 2}) {
            ASSERT_EQ(world.motion[body].position, before.motion[body].position) << i;
        }
    }
    for (int i = 0; i < 8; ++i) stepper.advanceFrame(world, frame);
    EXPECT_LT(world.motion[0].position.y(), 9.8) << "what is hit falls";
    EXPECT_LT(world.motion[1].position.y(), 9.9) << "what touches it wakes with it";
    EXPECT_EQ(world.motion[2].position, before.motion[2].position) << "the others sleep on";
    EXPECT_TRUE(world.contactMemory.isAsleep(2));
}

TEST(StartAsleep, WhoTouchesWhomIsKnownFromTheStart)
{
    // What stood on a body that is knocked away is never touched: it must wake all the same.
    const World world = buildWorld(parseShotText(kHanging, "s.toml"));
    ASSERT_EQ(world.contactMemory.contacts.size(), 1u);
    EXPECT_EQ(world.contactMemory.contacts[0].a, 0);
    EXPECT_EQ(world.contactMemory.contacts[0].b, 1);
}

// The first frame of a take held nothing of who slept, and who went on from it let all of them
// fall.
TEST(StartAsleep, IsKeptInTheFileOfTheFirstFrame)
{
    const Shot shot = parseShotText(kHanging, "s.toml");
    const World world = buildWorld(shot);
    const std::string bytes = encodeFrame(captureState(shot, world));
    const FrameState state = decodeFrame(bytes, "memory");
    EXPECT_EQ(state.contactMemory.contacts.size(), 1u);
    ASSERT_EQ(state.contactMemory.rest.size(), world.contactMemory.rest.size());
    World restored = buildWorld(shot);
    restored.contactMemory = {};
    restoreState(restored, state);
    for (const BodyId body : {0, 1, 2}) EXPECT_TRUE(restored.contactMemory.isAsleep(body)) << body;
    EXPECT_EQ(encodeFrame(captureState(shot, restored)), bytes);
}

TEST(StartAsleep, AForceThatChangesWakes)
{
    const Shot shot = parseShotText(
        kHead + blockAt("b", "[0, 10, 0]") +
            "[[force]]\ntype = \"vortex\"\ndirection = [0, 1, 0]\ncenter = [9, 0, 0]\n"
            "keys = [{ frame = 1001, strength = 0 }, { frame = 1006, strength = 0 }, "
            "{ frame = 1007, strength = 5 }]\n",
        "s.toml");
    World world = buildWorld(shot);
    const Vec3 start = world.motion[0].position;
    Stepper stepper(shot.settings);
    for (int i = 0; i < 4; ++i) stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
    EXPECT_EQ(world.motion[0].position, start);
    for (int i = 0; i < 4; ++i) stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
    EXPECT_NE(world.motion[0].position, start);
}

TEST(StartAsleep, IsRefusedWithItsPlaceWhereItMeansNothing)
{
    const std::string asleep = "start = \"asleep\"\n";
    EXPECT_EQ(
        test::messageOfShot(kHead + blockAt("b", "[0, 0, 0]", "motion = \"static\"\n" + asleep)),
        "s.toml:13:9: only a dynamic body can be asleep; nothing moves this one anyway");
    EXPECT_EQ(
        test::messageOfShot(kHead + blockAt("b", "[0, 0, 0]", "velocity = [1, 0, 0]\n" + asleep)),
        "s.toml:13:9: a body that starts asleep has no 'velocity' or 'spin'");
    EXPECT_EQ(
        test::messageOfShot(kHead + blockAt("b", "[0, 0, 0]") + "[solver]\nmethod = \"paper\"\n"),
        "s.toml:12:9: start = \"asleep\" needs method = \"scree\" with sleep = true");
}

}  // namespace
}  // namespace scree
