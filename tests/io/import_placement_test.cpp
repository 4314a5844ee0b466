// [[import]] and [[camera]] file with position, rotation or orientation, and scale: all that a file
// holds is moved as one.
#include <gtest/gtest.h>

#include <string>

#include "core/math/point_box.h"
#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"
#include "io/camera_pose.h"
#include "io/frame_writer.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kFirst = 1001, kFrames = 4;

// Coordinates near ten pass through single precision.
constexpr double kTolerance = 2e-5;

/// A file in metres with a body that tumbles, one that never moves, and a camera that goes around.
std::string writeAsset(const std::filesystem::path& output)
{
    SceneDescription scene =
        test::sceneOf({test::bodyNamed("mover"), test::bodyNamed("still", false)});
    for (SceneBody& body : scene.bodies) body.birthFrame = kFirst;
    SceneCamera camera;
    camera.orbit = CameraOrbit{{0.0, 1.0, 0.0}, 8.0, 3.0, 0.0, 120.0, 1001.0, 1004.0};
    scene.cameras = {camera};
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, kFrames);
    for (int i = 0; i < kFrames; ++i) {
        writer->write(test::frameWith(
            kFirst + i, {test::tumblingPose(0, i + 1.0), test::tumblingPose(1, 0.0)}));
    }
    writer->finish();
    return output;
}

/// The asset in a shot in centimetres; `placement` are lines of the import and of the camera.
Shot shotWith(const std::string& file, const std::string& motion, const std::string& placement,
              const std::string& shotKeys = "")
{
    return parseShotText(
        "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1004\"\nunits = "
        "\"cm\"\n" +
            shotKeys + "[material.wood]\n[[import]]\nfile = \"" + file +
            "\"\nmaterial = \"wood\"\nmotion = \"" + motion + "\"\n" + placement +
            "[[camera]]\nfile = \"" + file + "\"\n" + placement,
        "s.toml");
}

/// Where `pose` [m] comes to when its places are scaled and `placement` [m] is done to it.
Pose placed(const Pose& placement, double scale, Pose pose)
{
    pose.position *= scale;
    return placement * pose;
}

void expectNear(const Pose& pose, const Pose& expected, const std::string& what)
{
    EXPECT_LT((pose.position - expected.position).norm(), kTolerance) << what;
    EXPECT_LT(pose.orientation.angularDistance(expected.orientation), 1e-5) << what;
}

Pose cameraPose(const Shot& shot, int frame)
{
    const SceneCamera camera = cameraAt(shot.cameras.at(0), frame, shot.zUp);
    return worldFromCamera(camera, shot.zUp);
}

/// Asks that `moved` is `plain` placed, at every frame, and its meshes as much larger.
void expectPlaced(const Shot& plain, const Shot& moved, const Pose& placement, double scale)
{
    ASSERT_EQ(moved.bodies.size(), plain.bodies.size());
    for (std::size_t b = 0; b < plain.bodies.size(); ++b) {
        const ShotBody &before = plain.bodies[b], &after = moved.bodies[b];
        expectNear(after.worldFromAsset, placed(placement, scale, before.worldFromAsset),
                   after.name);
        ASSERT_EQ(after.keys.size(), before.keys.size());
        for (std::size_t k = 0; k < before.keys.size(); ++k) {
            EXPECT_EQ(after.keys[k].time, before.keys[k].time);
            expectNear(after.keys[k].pose, placed(placement, scale, before.keys[k].pose),
                       after.name + ", key " + std::to_string(k));
        }
    }
    for (std::size_t s = 0; s < plain.shapes.size(); ++s) {
        const Points& before = std::get<NodeSpec>(plain.shapes[s].source).mesh->points;
        const Points& after = std::get<NodeSpec>(moved.shapes.at(s).source).mesh->points;
        EXPECT_TRUE(after.isApprox(scale * before, 1e-6));
    }
    ASSERT_EQ(moved.cameras.size(), 1u);
    for (int frame = kFirst; frame < kFirst + kFrames; ++frame) {
        expectNear(cameraPose(moved, frame), placed(placement, scale, cameraPose(plain, frame)),
                   "camera at " + std::to_string(frame));
    }
}

class ImportPlacement : public testing::TestWithParam<const char*> {};

TEST_P(ImportPlacement, BodiesKeysAndCamerasGoTogether)
{
    const test::TemporaryFolder folder;
    const std::string file = writeAsset(folder / GetParam());
    const Pose placement = {Vec3(1.0, -2.0, 0.5), fromEulerXyz(kPi / 180.0 * Vec3(90, 20, -30))};
    for (const std::string shotKeys : {"", "up = \"+z\"\n"}) {
        for (const std::string motion : {"dynamic", "keyed"}) {
            expectPlaced(shotWith(file, motion, "", shotKeys),
                         shotWith(file, motion,
                                  "position = [100, -200, 50]\nrotation = [90, 20, -30]\n"
                                  "scale = 0.5\n",
                                  shotKeys),
                         placement, 0.5);
        }
    }
}

TEST_P(ImportPlacement, AnOrientationDoesWhatARotationDoes)
{
    const test::TemporaryFolder folder;
    const std::string file = writeAsset(folder / GetParam());
    expectPlaced(shotWith(file, "keyed", "rotation = [0, 90, 0]\n"),
                 shotWith(file, "keyed", "orientation = [2, 0, 2, 0]\n"), Pose(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Formats, ImportPlacement, testing::Values("x.glb", "x.abc"));

TEST(ImportPlacements, TheVelocityOfAnImportIsNotTurnedWithIt)
{
    const test::TemporaryFolder folder;
    const std::string file = writeAsset(folder / "x.glb");
    const std::string text =
        "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1004\"\n[material.wood]\n"
        "[[import]]\nfile = \"" +
        file +
        "\"\nmaterial = \"wood\"\nrotation = [0, 90, 0]\nvelocity = [3, 0, "
        "0]\n";
    EXPECT_EQ(parseShotText(text, "s.toml").bodies[0].velocity, Vec3(3.0, 0.0, 0.0));
}

TEST(ImportPlacements, WhatPlacesNothingIsRefused)
{
    const test::TemporaryFolder folder;
    const std::string file = writeAsset(folder / "x.glb");
    const auto messageOf = [&](const std::string& lines) {
        return test::messageOfShot(
            "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1004\"\n[material.wood]\n"
            "[[import]]\nfile = \"" +
            file + "\"\nmaterial = \"wood\"\n" + lines);
    };
    EXPECT_EQ(messageOf("orientation = [0, 0, 0, 0]\n"),
              "s.toml:9:15: 'orientation' must not be zero");
    EXPECT_EQ(messageOf("rotation = [0, 0, 0]\norientation = [1, 0, 0, 0]\n"),
              "s.toml:10:1: 'orientation' cannot stand beside 'rotation' in [[import]]");
    for (const std::string scale : {"0", "-1", "nan", "[1, 2, 1]"}) {
        EXPECT_TRUE(messageOf("scale = " + scale + "\n")
                        .starts_with("s.toml:9:9: 'scale' must be a number above 0"))
            << messageOf("scale = " + scale + "\n");
    }
    EXPECT_EQ(messageOf("[[camera]]\nposition = [0, 1, 9]\n"),
              "s.toml:10:12: 'position' places the camera of a 'file', and there is none; where a "
              "camera stands is its 'eye'");
}

}  // namespace
}  // namespace scree
