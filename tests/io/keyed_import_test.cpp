// [[import]] with motion = "keyed": bodies of a shot stand at every frame where the file has them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "core/math/point_box.h"
#include "core/math/rotation.h"
#include "io/file_bytes.h"
#include "io/frame_writer.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kFirst = 1001, kFrames = 5;

/// Where "mover" is `frames` after the first one; defined for samples before it too.
Pose moverAt(double frames)
{
    return test::tumblingPose(0, frames + 1.0);
}

/// A file whose bodies "mover" tumbles from frame to frame and "still" never moves, both there from
/// the first frame on, as a take says it.
void writeAsset(const std::filesystem::path& output, const std::vector<double>& offsets = {0.0})
{
    SceneDescription scene =
        test::sceneOf({test::bodyNamed("mover"), test::bodyNamed("still", false)});
    for (SceneBody& body : scene.bodies) body.birthFrame = kFirst;
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, kFrames, offsets);
    for (int i = 0; i < kFrames; ++i) {
        for (const double offset : offsets) {
            SceneFrame sample =
                test::frameWith(kFirst + i, {moverAt(i + offset), test::tumblingPose(1, 0.0)});
            sample.offset = offset;
            writer->write(sample);
        }
    }
    writer->finish();
}

std::string shotText(const std::string& file, const std::string& nodes, const std::string& more)
{
    return "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1005\"\n[material.wood]\n[[import]]\n"
           "file = \"" +
           file + "\"\nmaterial = \"wood\"\nnodes = \"" + nodes + "\"\nmotion = \"keyed\"\n" + more;
}

class KeyedImport : public testing::TestWithParam<const char*> {};

TEST_P(KeyedImport, BodiesStandAtEveryFrameWhereTheFileHasThem)
{
    const test::TemporaryFolder folder;
    for (const std::vector<double>& offsets : {std::vector{0.0}, std::vector{-0.25, 0.0, 0.25}}) {
        writeAsset(folder / GetParam(), offsets);
        const Shot shot = parseShotText(shotText(folder / GetParam(), "*", ""), "s.toml");
        ASSERT_EQ(shot.bodies.size(), 2u);
        EXPECT_EQ(shot.bodies[0].kind, BodyKind::keyed);
        const MotionScript moverScript(shot.bodies[0].keys, shot.bodies[0].interpolation);
        const MotionScript stillScript(shot.bodies[1].keys, shot.bodies[1].interpolation);
        for (int i = 0; i < kFrames; ++i) {
            const double time = i / shot.framesPerSecond;
            const Pose mover = moverScript.at(time), still = stillScript.at(time);
            // Quaternions and places in single precision; times of glTF are, too: 6e-8 of the
            // speed.
            const Pose expected = moverAt(i);
            EXPECT_LT((mover.position - expected.position).norm(), 1e-5) << "frame " << i;
            EXPECT_LT(mover.orientation.angularDistance(expected.orientation), 1e-5);
            EXPECT_LT((still.position - test::tumblingPose(1, 0.0).position).norm(), 1e-5);
        }
        // Half way between two samples it is half way from the one to the other.
        const double step = offsets.back() > 0.0 ? 0.5 : 1.0;
        const Pose before = moverAt(2.5 - 0.5 * step), after = moverAt(2.5 + 0.5 * step);
        const Pose between = moverScript.at(2.5 / shot.framesPerSecond);
        EXPECT_LT((between.position - 0.5 * (before.position + after.position)).norm(), 1e-5);
    }
}

// With ten frames of pre-roll the animation began ten frames too soon, and nothing could be said
// against it; and what was animated could not be let go of.
TEST_P(KeyedImport, ItsMotionMayComeLaterAndEnd)
{
    const test::TemporaryFolder folder;
    writeAsset(folder / GetParam());
    const Shot shot = parseShotText(
        shotText(folder / GetParam(), "mover", "offset = 2.5\nrelease = 1004\n"), "s.toml");
    ASSERT_EQ(shot.bodies.size(), 1u);
    EXPECT_EQ(shot.bodies[0].releaseFrame, 1004);
    EXPECT_FALSE(shot.bodies[0].isNeverFree());
    const MotionScript script(shot.bodies[0].keys, shot.bodies[0].interpolation);
    for (int i = 0; i < kFrames; ++i) {
        const Pose then = script.at((i + 2.5) / shot.framesPerSecond);
        EXPECT_LT((then.position - moverAt(i).position).norm(), 1e-5) << i;
    }
    EXPECT_EQ(test::messageOfShot(shotText(folder / GetParam(), "mover", "release = 1001\n")),
              "s.toml:11:11: 'release' must be a frame after the first, 1001; a body that is free "
              "from the beginning has motion = \"dynamic\"");
}

TEST(KeyedImports, WhatOnlyKeyedMotionHasIsRefusedWithoutIt)
{
    const test::TemporaryFolder folder;
    writeAsset(folder / "a.glb");
    std::string text = shotText(folder / "a.glb", "mover", "release = 1004\noffset = 3\n");
    text.replace(text.find("keyed"), 5, "dynamic");
    const std::string message = test::messageOfShot(text);
    for (const std::string key : {"release", "offset"})
        EXPECT_NE(message.find("'" + key + "' is for imports with motion = \"keyed\""),
                  std::string::npos)
            << message;
}

TEST_P(KeyedImport, AFileThatMovesNothingIsRefused)
{
    const test::TemporaryFolder folder;
    writeAsset(folder / GetParam());
    const std::string message = test::messageOfShot(shotText(folder / GetParam(), "*still*", ""));
    EXPECT_NE(message.find("s.toml:10:10: the file animates none of these nodes; motion = "
                           "\"static\""),
              std::string::npos)
        << message;
}

// Our own files give no size to who is not born yet, as other programs do to hide things.
TEST_P(KeyedImport, WhatHasNoSizeAtFirstWaitsWhereItWillAppear)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("late")});
    scene.bodies[0].birthFrame = kFirst + 2;
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(folder / GetParam());
    writer->begin(scene, kFirst, kFrames);
    for (int i = 0; i < kFrames; ++i) writer->write(test::tumblingFrame(scene, kFirst + i, kFirst));
    writer->finish();
    const Shot shot = parseShotText(shotText(folder / GetParam(), "*", ""), "s.toml");
    ASSERT_EQ(shot.bodies.size(), 1u);
    EXPECT_TRUE(shot.warnings.empty()) << shot.warnings[0];
    const auto& node = std::get<NodeSpec>(shot.shapes.at(0).source);
    EXPECT_TRUE(
        boxOf(node.mesh->points).size().isApprox(boxOf(scene.meshes[0].points).size(), 1e-6));
    const MotionScript script(shot.bodies[0].keys, shot.bodies[0].interpolation);
    for (int i = 0; i < kFrames; ++i) {
        const Pose expected = test::tumblingPose(0, std::max(i, 2));
        const Pose pose = script.at(i / shot.framesPerSecond);
        EXPECT_LT((pose.position - expected.position).norm(), 1e-5) << "frame " << i;
        EXPECT_LT(pose.orientation.angularDistance(expected.orientation), 1e-5) << "frame " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, KeyedImport, testing::Values("x.glb", "x.abc"));

/// A door, a tetrahedron two metres from the hinge on which it hangs, and a camera on the same
/// hinge. It turns by a right angle about z in four frames; `join` is how, `path` what it moves.
void writeDoor(const std::filesystem::path& file, const std::string& join = "LINEAR",
               const std::string& more = "")
{
    const float h = std::sqrt(0.5f);
    const float numbers[] = {0, 0,
                             0, 1,
                             0, 0,
                             0, 1,
                             0, 0,
                             0, 1,             // points
                             0, 4.0f / 24.0f,  // times
                             0, 0,
                             0, 1,
                             0, 0,
                             h, h};  // turns
    const std::uint16_t corners[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    {
        std::ofstream data(file.parent_path() / "door.bin", std::ios::binary);
        data.write(reinterpret_cast<const char*>(numbers), sizeof numbers);
        data.write(reinterpret_cast<const char*>(corners), sizeof corners);
    }
    std::ofstream(file) << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"hinge","children":[1,2]},{"name":"door","mesh":0,"translation":[2,0,0]},
{"name":"view","camera":0,"translation":[0,3,0]}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.6,"znear":0.1,"aspectRatio":1}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":3)"
                        << more << R"(}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":0,"byteOffset":48,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[0.17]},
{"bufferView":0,"byteOffset":56,"componentType":5126,"count":2,"type":"VEC4"},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":88},{"buffer":0,"byteOffset":88,"byteLength":24}],
"buffers":[{"byteLength":112,"uri":"door.bin"}],
"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}],
"samplers":[{"input":1,"output":2,"interpolation":")"
                        << join << "\"}]}]}";
}

// A door that grows is no rigid one, whether it grows from nothing or not; one that pops up is.
TEST(KeyedImports, ScaleThatChangesIsRefusedUnlessItOnlyShowsAndHides)
{
    const test::TemporaryFolder folder;
    const std::string file = folder / "door.gltf";
    const auto obstacleOf = [&](const std::string& join, float first, float seconds) {
        writeDoor(file, join);
        std::string text = readFileBytes(file);
        const std::string rotation = "\"node\":0,\"path\":\"rotation\"",
                          turns = "\"type\":\"VEC4\"";
        text.replace(text.find(rotation), rotation.size(), "\"node\":1,\"path\":\"scale\"");
        text.replace(text.find(turns), turns.size(), "\"type\":\"VEC3\"");
        writeFileBytes(file, text);
        std::string numbers = readFileBytes(folder / "door.bin");
        const float scales[] = {first, first, first, 1.0f, 1.0f, 1.0f};
        std::memcpy(numbers.data() + 52, &seconds, sizeof seconds);
        std::memcpy(numbers.data() + 56, scales, sizeof scales);
        writeFileBytes(folder / "door.bin", numbers);
        return importFile(file).nodes.at(0).obstacle;
    };
    const std::string changes = "its scale changes over time, and bodies are rigid";
    EXPECT_EQ(obstacleOf("LINEAR", 0.5f, 0.01f), changes);
    EXPECT_EQ(obstacleOf("STEP", 0.5f, 1.0f), changes);
    EXPECT_EQ(obstacleOf("LINEAR", 0.0f, 1.0f), changes);
    EXPECT_EQ(obstacleOf("LINEAR", 0.0f, 0.04f), "");
    EXPECT_EQ(obstacleOf("STEP", 0.0f, 1.0f), "");
    const std::string shot = test::messageOfShot(shotText(file, "*", ""));
    EXPECT_EQ(shot, "nothing was thrown");
    obstacleOf("LINEAR", 0.5f, 1.0f);
    const std::string message = test::messageOfShot(shotText(file, "*", ""));
    EXPECT_NE(message.find("'door' cannot be keyed: " + changes), std::string::npos) << message;
}

TEST(KeyedImports, WhatTheFileScalesToNothingIsRefusedWhereItIsChosen)
{
    const test::TemporaryFolder folder;
    const std::string file = folder / "door.gltf";
    writeDoor(file);
    std::string text = readFileBytes(file);
    const std::string place = "\"mesh\":0,";
    text.replace(text.find(place), place.size(), place + "\"scale\":[0,0,0],");
    writeFileBytes(file, text);
    const std::string message = test::messageOfShot(shotText(file, "*", ""));
    EXPECT_NE(message.find("a mesh 'door' that is scaled to nothing where the file is at rest"),
              std::string::npos)
        << message;
}

TEST(KeyedImports, WhatHangsOnANodeThatTurnsGoesRoundBetweenItsKeys)
{
    const test::TemporaryFolder folder;
    writeDoor(folder / "door.gltf");
    const std::string file = folder / "door.gltf";
    const std::string camera = "[[camera]]\nfile = \"" + file + "\"\n";
    const Shot shot = parseShotText(shotText(file, "*", camera), "s.toml");
    ASSERT_EQ(shot.bodies.size(), 1u);
    EXPECT_TRUE(shot.warnings.empty());
    const MotionScript script(shot.bodies[0].keys, shot.bodies[0].interpolation);
    for (int i = 0; i <= 32; ++i) {
        const double angle = 0.5 * kPi * i / 32, seconds = i / (8.0 * 24.0);
        const Pose pose = script.at(seconds);
        // Straight from key to key it strays by 0.59 m; the chords of two degrees that are left, by
        // a six-thousandth of the radius.
        const Vec3 expected(2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0);
        EXPECT_LT((pose.position - expected).norm(), 1e-3) << i;
        const Quat turn(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle));
        EXPECT_LT(pose.orientation.angularDistance(turn), 1e-3) << i;
    }
    ASSERT_EQ(shot.cameras.size(), 1u);
    ASSERT_EQ(shot.cameras[0].keys.size(), 5u);
    for (int i = 0; i < 5; ++i) {
        const double angle = kPi * i / 8;
        const Vec3 expected(-3.0 * std::sin(angle), 3.0 * std::cos(angle), 0.0);
        EXPECT_LT((shot.cameras[0].keys[i].eye - expected).norm(), 1e-3) << i;
    }
    // Smooth motion is smooth from one of the file's own keys to the next.
    const Shot smooth = parseShotText(shotText(file, "*", "interpolate = \"smooth\"\n"), "s.toml");
    EXPECT_EQ(smooth.bodies[0].keys.size(), 2u);
}

// What was stretched by hand and animated then: its scale was laid along the axes of the room, and
// seemed to change.
TEST(KeyedImports, WhatIsStretchedInItsOwnAxesTurnsWithThem)
{
    const test::TemporaryFolder folder;
    const std::string file = folder / "door.gltf";
    writeDoor(file);
    std::string text = readFileBytes(file);
    const std::string hinge = "\"name\":\"hinge\",";
    text.replace(text.find(hinge), hinge.size(), hinge + "\"scale\":[2,1,1],");
    writeFileBytes(file, text);
    const Shot shot = parseShotText(shotText(file, "*", ""), "s.toml");
    ASSERT_EQ(shot.bodies.size(), 1u);
    const MotionScript script(shot.bodies[0].keys, shot.bodies[0].interpolation);
    for (int i = 0; i <= 4; ++i) {
        const double angle = kPi * i / 8;
        const Pose pose = script.at(i / 24.0);
        const Vec3 expected(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.0);
        EXPECT_LT((pose.position - expected).norm(), 2e-3) << i;
        const Quat turn(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle));
        EXPECT_LT(pose.orientation.angularDistance(turn), 1e-3) << i;
    }
    const Points& points = std::get<NodeSpec>(shot.shapes.at(0).source).mesh->points;
    EXPECT_NEAR(points.row(0).maxCoeff() - points.row(0).minCoeff(), 2.0, 1e-6);
    EXPECT_NEAR(points.row(1).maxCoeff() - points.row(1).minCoeff(), 1.0, 1e-6);
}

TEST(KeyedImports, SamplesThatTheFileJoinsOtherwiseAreWarnedOf)
{
    const test::TemporaryFolder folder;
    const std::string file = folder / "door.gltf";
    const std::string camera = "[[camera]]\nfile = \"" + file + "\"\n";
    writeDoor(folder / "door.gltf", "STEP");
    const Shot shot = parseShotText(shotText(file, "*", camera), "s.toml");
    ASSERT_EQ(shot.warnings.size(), 2u);
    EXPECT_TRUE(shot.warnings[0].starts_with(
        "s.toml:10:10: the file joins the samples of 'door' by jumps (STEP); here they are joined "
        "steadily"))
        << shot.warnings[0];
    EXPECT_TRUE(
        shot.warnings[1].starts_with("s.toml:12:8: the file joins the samples of camera "
                                     "'view' by jumps (STEP)"))
        << shot.warnings[1];
}

TEST(KeyedImports, OfSeveralClipsThatMoveANodeItIsSaidWhichIsPlayed)
{
    const test::TemporaryFolder folder;
    const std::string file = folder / "door.gltf";
    writeDoor(file);
    std::string text = readFileBytes(file);
    const std::size_t begin = text.find("\"animations\":[") + 14, end = text.rfind("]}");
    const std::string clip = text.substr(begin, end - begin);
    const auto named = [&](const std::string& name) {
        return "{\"name\":\"" + name + "\"," + clip.substr(1);
    };
    const auto warningsOf = [&](const std::string& clips, const std::string& more) {
        writeFileBytes(file, text.substr(0, begin) + clips + text.substr(end));
        return parseShotText(shotText(file, "*", more), "s.toml").warnings;
    };
    const std::string camera = "[[camera]]\nfile = \"" + file + "\"\n";
    const auto warnings = warningsOf(named("open") + "," + named("close"), camera);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(warnings[0],
              "s.toml:10:10: several clips of the file move 'door': 'open' is played, and not "
              "'close'; export the one that is meant alone");
    EXPECT_TRUE(
        warnings[1].starts_with("s.toml:12:8: several clips of the file move camera 'view'"))
        << warnings[1];
    const auto unnamed = warningsOf(clip + "," + named("") + "," + clip, "");
    ASSERT_EQ(unnamed.size(), 1u);
    EXPECT_NE(unnamed[0].find("number 1 is played, and not number 2 or 1 more"), std::string::npos)
        << unnamed[0];
    EXPECT_TRUE(warningsOf(named("open"), "").empty());
}

TEST(KeyedImports, AnOrthographicCameraIsInNobodysWayUntilItIsChosen)
{
    const test::TemporaryFolder folder;
    const std::string file = folder / "door.gltf";
    writeDoor(file);
    std::string text = readFileBytes(file);
    const std::string lens =
        R"("perspective","perspective":{"yfov":0.6,"znear":0.1,"aspectRatio":1})";
    text.replace(text.find(lens), lens.size(),
                 R"("orthographic","orthographic":{"xmag":2,"ymag":2,"znear":0.1,"zfar":9})");
    writeFileBytes(file, text);
    EXPECT_EQ(parseShotText(shotText(file, "*", ""), "s.toml").bodies.size(), 1u);
    EXPECT_EQ(test::messageOfShot(shotText(file, "*", "[[camera]]\nfile = \"" + file + "\"\n")),
              "s.toml:12:8: camera 'view' of '" + file +
                  "' is orthographic: only perspective ones can be used");
}

TEST(KeyedImports, AMeshThatOtherProgramsBendIsWarnedOf)
{
    const test::TemporaryFolder folder;
    writeDoor(folder / "door.gltf", "LINEAR", ",\"targets\":[{\"POSITION\":0}]");
    const Shot shot = parseShotText(shotText(folder / "door.gltf", "*", ""), "s.toml");
    ASSERT_EQ(shot.warnings.size(), 1u);
    EXPECT_TRUE(shot.warnings[0].starts_with("s.toml:7:8: bones or morph targets bend 'door'"))
        << shot.warnings[0];
}

}  // namespace
}  // namespace scree
