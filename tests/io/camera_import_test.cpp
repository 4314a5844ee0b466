// [[camera]] file: the camera of an asset is where other programs show it.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"
#include "io/camera_pose.h"
#include "io/file_bytes.h"
#include "io/frame_writer.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
#include "tests/support/import_mesh.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kFirst = 1001, kFrames = 5;

/// One that never moves, one that goes around, and one that rolls over as it looks down and zooms.
std::vector<SceneCamera> someCameras()
{
    SceneCamera still;
    still.name = "still";
    still.eye = {3.0, 4.0, 12.0};
    still.target = {0.5, 2.0, -1.0};
    still.fovDegrees = 28.0;
    SceneCamera around;
    around.name = "around";
    around.orbit = CameraOrbit{{0.0, 1.0, 0.0}, 8.0, 3.0, 0.0, 120.0, 1001.0, 1005.0};
    SceneCamera rolling;
    rolling.name = "rolling";
    rolling.isSmooth = false;
    for (int i = 0; i < kFrames; ++i) {
        // Neither at rest nor at right angles to the way it looks.
        const double angle = 0.4 * i;
        rolling.keys.push_back({1001.0 + i, Vec3(0.2 * i, 9.0, 0.0), Vec3(0.2 * i, 0.0, 1.0), 35.0,
                                Vec3(std::sin(angle), 0.3, std::cos(angle))});
    }
    return {still, around, rolling};
}

double zoomAt(double frame)
{
    return 35.0 - 6.0 * (frame - kFirst);
}

void writeAsset(const std::filesystem::path& output)
{
    SceneDescription scene = test::sceneOf({test::bodyNamed("mover")});
    scene.cameras = someCameras();
    const bool holdsZoom = output.extension() == ".abc";
    if (holdsZoom) {
        for (CameraKey& key : scene.cameras.back().keys) key.fovDegrees = zoomAt(key.frame);
    }
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, kFrames);
    for (int i = 0; i < kFrames; ++i) {
        writer->write(test::frameWith(kFirst + i, {test::tumblingPose(0, i)}));
    }
    writer->finish();
}

std::string shotText(const std::string& file, const std::string& lines)
{
    return "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1005\"\n[[camera]]\nfile = \"" + file +
           "\"\n" + lines;
}

class CameraImport : public testing::TestWithParam<const char*> {};

TEST_P(CameraImport, StandsAndLooksAtEveryFrameAsTheFileHasIt)
{
    const test::TemporaryFolder folder;
    const bool isAlembic = std::string(GetParam()).ends_with(".abc");
    writeAsset(folder / GetParam());
    for (const SceneCamera& expected : someCameras()) {
        const Shot shot = parseShotText(
            shotText(folder / GetParam(), "node = \"" + expected.name + "*\"\n"), "s.toml");
        ASSERT_EQ(shot.cameras.size(), 1u);
        EXPECT_EQ(shot.cameras[0].name, "main");
        EXPECT_EQ(moves(shot.cameras[0]), moves(expected));
        for (int frame = kFirst; frame < kFirst + kFrames; ++frame) {
            const SceneCamera have = cameraAt(shot.cameras[0], frame, false);
            const SceneCamera want = cameraAt(expected, frame, false);
            // Coordinates pass through single precision in a glb.
            EXPECT_TRUE(have.eye.isApprox(want.eye, 1e-5)) << frame << ": " << have.eye.transpose();
            const Vec3 way = (have.target - have.eye).normalized();
            const Vec3 wanted = (want.target - want.eye).normalized();
            EXPECT_LT((way - wanted).norm(), 1e-5) << frame;
            const bool zooms = isAlembic && expected.name == "rolling";
            EXPECT_NEAR(have.fovDegrees, zooms ? zoomAt(frame) : want.fovDegrees, 1e-3);
            // Which way the picture's axes point is where the camera's roll shows.
            const Quat turn = worldFromCamera(have, false).orientation;
            const Quat wantedTurn = worldFromCamera(want, false).orientation;
            EXPECT_LT(turn.angularDistance(wantedTurn), 1e-5) << expected.name << ' ' << frame;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, CameraImport, testing::Values("a.glb", "a.abc"),
                         [](const auto& one) { return std::string(one.param).substr(2); });

TEST(CameraImport, StandsInOneFileWithWhatIsNoRigidBody)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.abc";
    writeAsset(path);
    std::string bytes = readFileBytes(path);
    const std::string mesh = "AbcGeom_PolyMesh_v1";
    std::size_t count = 0;
    for (std::size_t at = 0; (at = bytes.find(mesh, at)) != std::string::npos; ++count) {
        bytes.replace(at, mesh.size(), "AbcGeom_SubD_vvvvv1");
    }
    ASSERT_GT(count, 0u);
    writeFileBytes(path, bytes);
    EXPECT_EQ(parseShotText(shotText(path, ""), "s.toml").cameras.size(), 1u);
    EXPECT_EQ(
        test::messageOfShot("scree = 1\n[shot]\nname = \"s\"\n[material.m]\n[[import]]\n"
                            "material = \"m\"\nfile = \"" +
                            path + "\"\n"),
        "s.toml:7:8: mesh file '" + path +
            "' has a mesh 'mover' that is a subdivision surface; export it as a polygon mesh, "
            "or leave it out of 'nodes'");
    EXPECT_THROW(test::importMesh(path), Error);
}

TEST(CameraImport, SaysWhichCamerasThereAreAndRefusesWhatTheFileDecides)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.abc";
    writeAsset(path);
    EXPECT_EQ(test::messageOfShot(shotText(path, "node = \"arond\"\n")),
              "s.toml:7:8: no camera of '" + path +
                  "' is called \"arond\"; did you mean 'around'? (it has: still, around, rolling)");
    EXPECT_EQ(test::messageOfShot(
                  "scree = 1\n[shot]\nname = \"s\"\n[[camera]]\neye = [1, 2, 3]\nnode = \"a\"\n"),
              "s.toml:6:8: 'node' chooses a camera of a 'file', and there is none");
    EXPECT_NE(test::messageOfShot(shotText(path, "eye = [1, 2, 3]\n")).find("'eye'"),
              std::string::npos);
    EXPECT_NE(test::messageOfShot(shotText(path, "fov = 30\n")).find("'fov'"), std::string::npos);
}

/// A camera in FBX as words: on a node that a quarter turn about y makes look along -z, since a
/// camera of FBX looks along +x, and that rises by a metre in a second. `more` are further objects.
std::string fbxText(const std::string& more)
{
    constexpr const char* kBegin = R"(; FBX 7.4.0 project file
FBXHeaderExtension: {
 FBXVersion: 7400
}
GlobalSettings: {
 Version: 1000
 Properties70: {
  P: "UnitScaleFactor", "double", "Number", "", 100
 }
}
Objects: {
 NodeAttribute: 1, "NodeAttribute::view", "Camera" {
  Properties70: {
   P: "FieldOfView", "FieldOfView", "", "A", 40
   P: "AspectWidth", "double", "Number", "", 16
   P: "AspectHeight", "double", "Number", "", 9
  }
  TypeFlags: "Camera"
  GeometryVersion: 124
 }
 Model: 2, "Model::view", "Camera" {
  Version: 232
  Properties70: {
   P: "Lcl Translation", "Lcl Translation", "", "A", 1, 2, 3
   P: "Lcl Rotation", "Lcl Rotation", "", "A", 0, 90, 0
  }
 }
 AnimationStack: 3, "AnimStack::take", "" {
 }
 AnimationLayer: 4, "AnimLayer::base", "" {
 }
 AnimationCurveNode: 5, "AnimCurveNode::T", "" {
 }
 AnimationCurve: 6, "AnimCurve::", "" {
  Default: 0
  KeyVer: 4008
  KeyTime: *2 {
   a: 0,46186158000
  }
  KeyValueFloat: *2 {
   a: 2,3
  }
 }
)";
    constexpr const char* kEnd = R"(}
Connections: {
 C: "OO",1,2
 C: "OO",2,0
 C: "OO",4,3
 C: "OO",5,4
 C: "OP",5,2,"Lcl Translation"
 C: "OP",6,5,"d|Y"
}
)";
    return kBegin + more + kEnd;
}

TEST(CameraImport, OfAnFbxLooksAlongItsNodesXAndMovesWithIt)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.fbx";
    writeFileBytes(path, fbxText(""));
    const Shot shot = parseShotText(shotText(path, ""), "s.toml");
    EXPECT_TRUE(shot.warnings.empty()) << shot.warnings.front();
    ASSERT_EQ(shot.cameras.size(), 1u);
    for (const double frame : {1001.0, 1003.0, 1005.0}) {
        const SceneCamera now = cameraAt(shot.cameras[0], frame, false);
        // Single precision.
        const double height = 2.0 + (frame - 1001.0) / 24.0;
        EXPECT_LT((now.eye - Vec3(1.0, height, 3.0)).norm(), 1e-5) << now.eye.transpose();
        EXPECT_LT(((now.target - now.eye).normalized() - Vec3(0.0, 0.0, -1.0)).norm(), 1e-5);
        EXPECT_LT((upOf(now, false) - Vec3::UnitY()).norm(), 1e-5);
        // Of 40 degrees of width in 16:9.
        const double half = std::atan(std::tan(20.0 * kPi / 180.0) * 9.0 / 16.0);
        EXPECT_NEAR(now.fovDegrees, 2.0 * half * 180.0 / kPi, 1e-4);
    }
}

/// A camera in glTF whose angle of view goes from 0.6 to 0.3 rad in a second, as the extension has
/// it that may animate anything.
std::string zoomingGltf()
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"view","camera":0}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.6,"znear":0.1}}],
"extensionsUsed":["KHR_animation_pointer"],
"animations":[{"samplers":[{"input":0,"output":1}],"channels":[{"sampler":0,"target":{
"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/cameras/0/perspective/yfov"}}}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":8}],
"buffers":[{"byteLength":16,"uri":"data:application/octet-stream;base64,AAAAAAAAgD+amRk/mpmZPg=="}]
})";
}

TEST(CameraImport, ThatZoomsInAWayThatIsNotReadIsWarnedOfWithItsPlace)
{
    const test::TemporaryFolder folder;
    const std::string lens = " AnimationCurveNode: 7, \"AnimCurveNode::FocalLength\", \"\" {\n }\n";
    for (const auto& [name, text] :
         {std::pair("a.fbx", fbxText(lens)), std::pair("a.gltf", zoomingGltf())}) {
        const std::string path = folder / name;
        writeFileBytes(path, text);
        const Shot shot = parseShotText(shotText(path, ""), "s.toml");
        ASSERT_EQ(shot.warnings.size(), 1u) << name;
        EXPECT_TRUE(shot.warnings[0].starts_with("s.toml:6:8: the zoom of camera 'view'"))
            << shot.warnings[0];
    }
}

std::string withoutAngle(const std::string& lens)
{
    std::string text = fbxText("");
    const std::string angle = "P: \"FieldOfView\", \"FieldOfView\", \"\", \"A\", 40";
    return text.replace(text.find(angle), angle.size(), lens);
}

// It was one degree, which showed a wall of one colour.
TEST(CameraImport, AnFbxWithoutAnAngleSeesWhatItsFilmAndFocalLengthSay)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.fbx";
    const std::string film = "P: \"FilmWidth\", \"double\", \"Number\", \"\", 1.5\n";
    writeFileBytes(path, withoutAngle(film + "P: \"FocalLength\", \"Number\", \"\", \"A\", 50"));
    const Shot shot = parseShotText(shotText(path, ""), "s.toml");
    ASSERT_EQ(shot.cameras.size(), 1u);
    const double half = std::atan(0.5 * 1.5 * 25.4 / 50.0 * 9.0 / 16.0);
    EXPECT_NEAR(shot.cameras[0].fovDegrees, 2.0 * half * 180.0 / kPi, 1e-4);

    writeFileBytes(path, withoutAngle(film));
    EXPECT_EQ(test::messageOfShot(shotText(path, "")),
              "s.toml:6:8: camera 'view' of '" + path +
                  "' has no angle of view, nor a film and focal length that it would follow from: "
                  "export it with 'FieldOfView'");

    std::string narrow = fbxText("");
    narrow.replace(narrow.find("\"A\", 40"), 7, "\"A\", 1");
    writeFileBytes(path, narrow);
    EXPECT_NEAR(parseShotText(shotText(path, ""), "s.toml").cameras[0].fovDegrees, 9.0 / 16.0,
                1e-3);
}

TEST(CameraImport, AnFbxThatLiesOnItsSideIsWarnedOfUnlessItIsTurned)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.fbx";
    std::string text = fbxText("");
    text.insert(text.find("  P: \"UnitScaleFactor\""),
                "  P: \"UpAxis\", \"int\", \"Integer\", \"\", 2\n"
                "  P: \"UpAxisSign\", \"int\", \"Integer\", \"\", 1\n");
    writeFileBytes(path, text);
    const Shot shot = parseShotText(shotText(path, ""), "s.toml");
    ASSERT_EQ(shot.warnings.size(), 1u);
    EXPECT_EQ(shot.warnings[0], "s.toml:6:8: '" + path +
                                    "' says that its up is +z, and the shot's is +y: rotation = "
                                    "[-90, 0, 0] turns it");
    EXPECT_TRUE(
        parseShotText(shotText(path, "rotation = [-90, 0, 0]\n"), "s.toml").warnings.empty());
}

/// An Alembic file whose only camera has a film of 36 by 24 mm, as Blender writes it whatever the
/// picture, behind 50 mm; `shift` [cm].
void writeFilmAsset(const std::filesystem::path& output, double shift)
{
    SceneDescription scene = test::sceneOf({test::bodyNamed("mover")});
    scene.cameras = {someCameras().front()};
    scene.aspect = 1.5;
    scene.cameras[0].fovDegrees = 2.0 * std::atan(12.0 / 50.0) * 180.0 / kPi;
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, 1);
    writer->write(test::frameWith(kFirst, {test::tumblingPose(0, 0)}));
    writer->finish();
    if (shift == 0.0) return;
    // After its width of 3.6 cm.
    const double film[] = {3.6, 0.0}, shifted[] = {3.6, shift};
    std::string bytes = readFileBytes(output);
    const std::string before(reinterpret_cast<const char*>(film), sizeof film);
    const std::string after(reinterpret_cast<const char*>(shifted), sizeof shifted);
    ASSERT_NE(bytes.find(before), std::string::npos);
    bytes.replace(bytes.find(before), before.size(), after);
    writeFileBytes(output, bytes);
}

// The height of the film was taken for the height of the picture: in 16:9 all was too small.
TEST(CameraImport, OfAnAlembicFileFillsThePictureWithTheWidthOfItsFilm)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "film.abc";
    writeFilmAsset(path, 0.0);
    const auto fovIn = [&](const std::string& size) {
        const Shot shot =
            parseShotText(shotText(path, "[render]\nsize = " + size + "\n"), "s.toml");
        EXPECT_TRUE(shot.warnings.empty());
        return shot.cameras.at(0).fovDegrees * kPi / 180.0;
    };
    const double half = 18.0 / 50.0;  // of the width, through the focal length
    EXPECT_NEAR(std::tan(0.5 * fovIn("[1600, 900]")), half * 9.0 / 16.0, 1e-9);
    EXPECT_NEAR(std::tan(0.5 * fovIn("[1500, 1000]")), half / 1.5, 1e-9);
    EXPECT_NEAR(std::tan(0.5 * fovIn("[500, 1000]")), half, 1e-9);  // laid across its height
}

TEST(CameraImport, AFilmThatIsShiftedIsWarnedOf)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "film.abc";
    writeFilmAsset(path, 0.25);
    const Shot shot = parseShotText(shotText(path, ""), "s.toml");
    ASSERT_EQ(shot.warnings.size(), 1u);
    EXPECT_TRUE(shot.warnings[0].starts_with("s.toml:6:8: the film offset of camera 'still'"))
        << shot.warnings[0];
}

}  // namespace
}  // namespace scree
