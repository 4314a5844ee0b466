// Keyed motion, forces, groups, pairs and extends: from the text of a shot to the world and the
// take.
#include <gtest/gtest.h>

#include <fstream>

#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "core/math/rotation.h"
#include "io/build_world.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "io/take_reader.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

const std::string kShot = R"(scree = 1
[shot]
name = "push"
frames = "1001-1012"
units = "cm"
[solver]
combine = { friction = "mean", restitution = "max" }
collision = "lagged"
[material.wood]
density = 500
[material.ice]
friction = 0.1
restitution = 0.3
[shape.block]
box = { size = [20, 20, 20] }
[[body]]
name = "floor"
plane = { normal = [0, 1, 0] }
material = "wood"
motion = "static"
[[body]]
name = "pusher"
shape = "block"
material = "wood"
motion = "keyed"
keys = [ { frame = 1001, position = [-30, 10, 0] }, { frame = 1006.5, position = [0, 10, 0], rotation = [0, 90, 0] } ]
interpolate = "linear"
release = 1008
group = "actors"
[[body]]
name = "pushed"
shape = "block"
material = "ice"
position = [0, 10, 0]
collides = ["actors"]
unmoved_by = []
force = [0, 0, 2]
torque = [0, 1, 0]
[[force]]
type = "wind"
direction = [2, 0, 0]
strength = 300
center = [0, 100, 0]
falloff = "smooth"
reach = 400
[[force]]
name = "swirl"
type = "vortex"
direction = [0, 1, 0]
keys = [ { frame = 1001, strength = 0 }, { frame = 1013, strength = 4 } ]
[[force]]
type = "uniform"
direction = [0, 0, 3]
strength = 2
groups = ["actors"]
[[pair]]
of = ["wood", "ice"]
friction = 0.05
)";

TEST(ShotMotion, KeysBecomeMetresRadiansAndSeconds)
{
    const Shot shot = parseShotText(kShot, "push.toml");
    const ShotBody& pusher = shot.bodies[1];
    EXPECT_EQ(pusher.kind, BodyKind::keyed);
    ASSERT_EQ(pusher.keys.size(), 2u);
    EXPECT_NEAR(pusher.keys[1].time, 5.5 / 24.0, 1e-15);
    EXPECT_NEAR(pusher.keys[0].pose.position.x(), -0.3, 1e-15);
    EXPECT_LE(
        pusher.keys[1].pose.orientation.angularDistance(exponentialMap({0.0, kPi / 2.0, 0.0})),
        1e-7);
    EXPECT_EQ(pusher.interpolation, KeyInterpolation::linear);
    EXPECT_EQ(pusher.releaseFrame, 1008);
}

TEST(ShotMotion, RulesPairsGroupsAndForcesReachTheWorld)
{
    const Shot shot = parseShotText(kShot, "push.toml");
    EXPECT_EQ(shot.settings.frictionRule, CombineRule::mean);
    EXPECT_EQ(shot.settings.restitutionRule, CombineRule::maximum);
    EXPECT_EQ(shot.settings.collision, CollisionVariant::lagged);
    const World world = buildWorld(shot);
    ASSERT_EQ(world.materialPairs.size(), 1u);
    EXPECT_EQ(world.materialPairs[0].friction, 0.05);
    EXPECT_FALSE(world.materialPairs[0].restitution);
    EXPECT_EQ(world.traits[2].groups.collidesWith, world.traits[1].groups.group);
    EXPECT_EQ(world.traits[2].groups.unmovedBy, 0u);
    EXPECT_EQ(world.info[2].force, Vec3(0.0, 0.0, 2.0));
    EXPECT_EQ(world.info[2].torque, Vec3(0.0, 1.0, 0.0));
    ASSERT_EQ(world.fields.size(), 3u);
    EXPECT_EQ(world.fields[0].strength, 3.0);  // 300 cm/s
    EXPECT_EQ(world.fields[0].direction, Vec3::UnitX());
    EXPECT_EQ(world.fields[0].reach, 4.0);
    EXPECT_EQ(world.fields[1].keys[1].strength, 4.0);  // m/s² whatever the unit of length
    EXPECT_EQ(world.fields[1].keys[1].time, 0.5);
    EXPECT_EQ(world.fields[2].kind, ForceField::Kind::uniform);
    EXPECT_EQ(world.fields[2].direction, Vec3::UnitZ());
    EXPECT_EQ(world.fields[2].groups, world.traits[1].groups.group);
    EXPECT_EQ(world.fields[0].groups & world.traits[2].groups.group, world.traits[2].groups.group);
    EXPECT_EQ(world.info[1].keyedUntil, 7);
}

TEST(ShotMotion, ABodyIsDynamicUntilItsKeysTakeItOver)
{
    std::string text = kShot;
    text.replace(text.find("release = 1008"), 14, "keyed_from = 1004\nrelease = 1008\nmass = 2");
    World world = buildWorld(parseShotText(text, "push.toml"));
    EXPECT_EQ(world.info[1].keyedFrom, 3);
    EXPECT_EQ(world.info[1].keyedUntil, 7);
    EXPECT_NEAR(1.0 / world.mass[1].inverseMass, 2.0, 1e-12);
    EXPECT_LE((world.motion[1].position - Vec3(-0.3, 0.1, 0.0)).norm(), 1e-15);
    for (const auto& [frame, kind] :
         {std::pair(0, BodyKind::dynamic), std::pair(2, BodyKind::dynamic),
          std::pair(3, BodyKind::keyed), std::pair(7, BodyKind::dynamic)}) {
        world.clock.frame = frame;
        world.assignKinds();
        EXPECT_EQ(world.info[1].kind, kind) << frame;
    }
}

TEST(ShotMotion, TheResolvedShotIsTheShotAgain)
{
    const Shot shot = parseShotText(kShot, "push.toml");
    const Shot again = parseShotText(shot.resolvedText, "push.toml");
    EXPECT_EQ(again.resolvedText, shot.resolvedText);
    EXPECT_EQ(again.bodies[1].keys.size(), 2u);
    ASSERT_EQ(again.fields.size(), 3u);
    EXPECT_EQ(again.fields[2].groups, shot.fields[2].groups);
}

TEST(ShotMotion, StrictSetsEverythingItPromises)
{
    const Shot shot =
        parseShotText(kShot, "push.toml", {"solver.method=paper", "solver.strict=true"});
    EXPECT_EQ(shot.settings.orientation, OrientationUpdate::euler);
    EXPECT_TRUE(shot.settings.freezeUnsupported);
    EXPECT_EQ(shot.settings.frictionFallback, FrictionFallback::plainKinetic);
    EXPECT_FALSE(shot.settings.slideSmoothSamples);
    EXPECT_FALSE(shot.settings.curvatureScaling);
    EXPECT_EQ(shot.shapes[0].settings.field, FieldMode::grid);
}

/// Simulates what is missing of a take; stops after `steps` steps if that is not 0. False when it
/// stopped.
bool simulate(const Shot& shot, const std::filesystem::path& folder, int steps)
{
    World world = buildWorld(shot);
    TakeWriter take(folder, shot, world, "test", ExistingTake::resume);
    Stepper stepper(shot.settings);
    const double duration = 1.0 / shot.framesPerSecond;
    int left = steps;
    for (int frame = shot.firstFrame; frame <= shot.lastFrame; ++frame) {
        if (take.hasFrame(frame)) continue;
        FrameStats stats;
        stats.frame = frame;
        if (frame > shot.firstFrame) {
            take.prepareFor(frame, world);
            stats.report = stepper.advanceFrame(world, duration, [&] { return --left == 0; });
            if (!stats.report.finished) {
                take.writeCheckpoint(world);
                return false;
            }
        }
        take.writeFrame(world, stats);
    }
    return true;
}

TEST(ShotMotion, KillingAndResumingAcrossAReleaseGivesTheSameTake)
{
    const TemporaryFolder folder;
    // Method scree stops after every fourth step: twice in each of the eleven frames.
    const Shot shot = parseShotText(kShot, "push.toml", {"solver.substeps.min=12"});
    simulate(shot, folder / "whole", 0);
    int sittings = 1;
    while (sittings < 200 && !simulate(shot, folder / "broken", 1)) ++sittings;
    EXPECT_GE(sittings, 2 * 11 + 1);
    const TakeReader whole(folder / "whole"), broken(folder / "broken");
    ASSERT_EQ(broken.frames().size(), 12u);
    for (const int frame : whole.frames()) {
        const auto read = [&](const char* take) {
            return readFrameFile(TakePaths{folder / take}.frame(frame));
        };
        EXPECT_EQ(encodeFrame(read("broken")), encodeFrame(read("whole"))) << frame;
    }
}

TEST(ShotMotion, AKeyedBodyMovesInTheTakeAndInWhatExportersAreTold)
{
    const TemporaryFolder folder;
    const Shot shot = parseShotText(kShot, "push.toml");
    simulate(shot, folder / "take", 0);
    const TakeReader take(folder / "take");
    EXPECT_EQ(take.info().bodies[1].kind, BodyKind::keyed);
    EXPECT_FALSE(take.describe().bodies[0].moves);
    EXPECT_TRUE(take.describe().bodies[1].moves);
    const SceneFrame early = take.readFrame(1002);
    const SceneFrame later = take.readFrame(1005);
    EXPECT_NEAR(early.worldFromAsset[1].position.x(), -30.0 + 30.0 / 5.5, 1e-9);
    EXPECT_NEAR(later.worldFromAsset[1].position.x(), -30.0 + 4.0 * 30.0 / 5.5, 1e-9);
    // Velocities too, for motion blur: 30 cm and 90° in 5.5 frames, and from the first one on.
    const SceneFrame first = take.readFrame(1001);
    EXPECT_NEAR(first.velocity[1].x(), 24.0 * 30.0 / 5.5, 1e-6);
    EXPECT_NEAR(first.angularVelocity[1].y(), 24.0 * kPi / 2.0 / 5.5, 1e-6);
    EXPECT_NEAR(later.velocity[1].x(), 24.0 * 30.0 / 5.5, 1e-6);
    EXPECT_NEAR(later.angularVelocity[1].y(), 24.0 * kPi / 2.0 / 5.5, 1e-6);
}

void writeText(const std::filesystem::path& path, const std::string& text)
{
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

TEST(ShotExtends, KeysHoldWhereTheOtherShotSaysNothing)
{
    const TemporaryFolder folder;
    writeText(folder / "base/base.toml", kShot + "[shape.prop]\nfile = \"../meshes/prop.obj\"\n");
    writeText(folder / "over.toml", R"(scree = 1
extends = "base/base.toml"
[shot]
name = "over"
[material.wood]
friction = 0.9
[[body]]
name = "pushed"
orientation = [1, 0, 0, 1]
[[body]]
name = "extra"
shape = "block"
material = "ice"
)");
    const std::string path = (folder / "over.toml").string();
    const Shot shot = parseShot(path);
    EXPECT_EQ(shot.name, "over");
    EXPECT_EQ(shot.lastFrame, 1012);
    EXPECT_EQ(shot.materials[0].material.friction, 0.9);
    EXPECT_EQ(shot.materials[0].material.density, 500.0);
    ASSERT_EQ(shot.bodies.size(), 4u);
    EXPECT_EQ(shot.bodies[2].name, "pushed");
    EXPECT_EQ(shot.bodies[2].material, "ice");
    EXPECT_NEAR(shot.bodies[2].worldFromAsset.orientation.z(), std::sqrt(0.5), 1e-15);
    EXPECT_EQ(shot.bodies[3].name, "extra");
    // Files are found from where the base stands, also by the resolved shot.
    EXPECT_EQ(std::get<FileSpec>(shot.shapes[1].source).path,
              (folder / "meshes/prop.obj").string());
    EXPECT_EQ(std::get<FileSpec>(parseShotText(shot.resolvedText, path).shapes[1].source).path,
              (folder / "meshes/prop.obj").string());
}

TEST(ShotExtends, ACameraWithoutANameIsTheOneThatIsMeantByItsDefaultName)
{
    const TemporaryFolder folder;
    writeText(folder / "base.toml", kShot + "[[camera]]\neye = [0, 1, 9]\n");
    for (const std::string name : {"", "name = \"main\"\n"}) {
        writeText(folder / "over.toml",
                  "scree = 1\nextends = \"base.toml\"\n[[camera]]\n" + name + "fov = 20\n");
        const Shot shot =
            parseShot((folder / "over.toml").string(), {"camera.main.target=[0,2,0]"});
        ASSERT_EQ(shot.cameras.size(), 1u);
        EXPECT_EQ(shot.cameras[0].eye.z(), 0.09);  // in cm
        EXPECT_EQ(shot.cameras[0].target.y(), 0.02);
        EXPECT_EQ(shot.cameras[0].fovDegrees, 20.0);
    }
}

// Of two crates one was lost, and of two shapes or turns the first, without a word.
TEST(ShotExtends, WhatTheShotItselfSaysTwiceIsNoMoreLostThanWithoutABase)
{
    const TemporaryFolder folder;
    writeText(folder / "base.toml", kShot);
    const auto complaintOf = [&](const std::string& text) {
        writeText(folder / "over.toml", "scree = 1\nextends = \"base.toml\"\n" + text);
        try {
            parseShot((folder / "over.toml").string());
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto crateAt = [](const std::string& name, int x) {
        return "[[body]]\nname = \"" + name + "\"\nshape = \"block\"\nmaterial = \"wood\"\n" +
               "position = [" + std::to_string(x) + ", 90, 0]\n";
    };
    for (const std::string name : {"crate", "pushed"}) {
        const std::string text = complaintOf(crateAt(name, 100) + crateAt(name, 200));
        EXPECT_NE(text.find("body name '" + name + "' is taken"), std::string::npos) << text;
    }
    const std::string turns = complaintOf(
        "[[body]]\nname = \"pushed\"\nrotation = [0, 9, 0]\norientation = [1, 0, 0, 1]\n");
    EXPECT_NE(turns.find("cannot stand beside"), std::string::npos) << turns;
    const std::string solids = complaintOf(
        "[shape.block]\nbox = { size = [9, 9, 9] }\n"
        "sphere = { radius = 3 }\n");
    EXPECT_NE(solids.find("sphere"), std::string::npos) << solids;
    EXPECT_EQ(complaintOf("[shape.block]\nsphere = { radius = 3 }\n"), "");
}

TEST(ShotExtends, AFolderWithAShotIsThatShot)
{
    const TemporaryFolder folder;
    writeText(folder / "base/shot.toml", kShot + "[shape.prop]\nfile = \"prop.obj\"\n");
    writeText(folder / "over.toml", "scree = 1\nextends = \"base\"\n[shot]\nname = \"over\"\n");
    const Shot shot = parseShot((folder / "over.toml").string());
    EXPECT_EQ(shot.bodies.size(), 3u);
    EXPECT_EQ(std::get<FileSpec>(shot.shapes[1].source).path, (folder / "base/prop.obj").string());
}

TEST(ShotExtends, ProblemsAreSaidWithTheFileTheyStandIn)
{
    const TemporaryFolder folder;
    const auto message = [&](const std::string& text) {
        writeText(folder / "over.toml", text);
        return test::refusalBy([&] { parseShot((folder / "over.toml").string()); }).message;
    };
    const std::string over = (folder / "over.toml").string();
    const std::string base = (folder / "base.toml").string();
    EXPECT_EQ(message("extends = \"base.toml\"\n"),
              over + ":1:11: shot file '" + base + "' does not exist");
    writeText(folder / "base.toml", "scree = 1\n[shot]\nname = \"b\"\nfsp = 24\n");
    EXPECT_NE(message("extends = \"base.toml\"\n").find(base + ":4:1: unknown key 'fsp'"),
              std::string::npos);
    writeText(folder / "base.toml", "extends = \"over.toml\"\n");
    EXPECT_NE(message("extends = \"base.toml\"\n").find("goes round in a circle"),
              std::string::npos);
}

}  // namespace
}  // namespace scree::test
