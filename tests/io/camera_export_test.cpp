// Cameras that move, in the caches: each format must say where the camera is at every sample.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"
#include "io/alembic_writer.h"
#include "io/camera_pose.h"
#include "io/gltf_writer.h"
#include "io/pov_writer.h"
#include "io/take_info.h"
#include "io/usd_writer.h"
#include "tests/support/cast.h"
#include "tests/support/export_scene.h"
#include "tests/support/readers.h"

namespace scree {
namespace {

/// The cast seen by a camera that pans and zooms from the second frame to the last, and by one that
/// goes around.
SceneDescription filmedCast()
{
    SceneDescription scene = test::castScene();
    SceneCamera& pan = scene.cameras[0];
    pan.keys = {{1002.0, {3.0, 4.0, 12.0}, {0.5, 2.0, -1.0}, 40.0},
                {1005.0, {9.0, 4.0, 6.0}, {0.5, 1.0, 0.0}, 20.0}};
    pan.isSmooth = false;
    SceneCamera orbit;
    orbit.name = "around";
    orbit.orbit = CameraOrbit{{0.0, 1.0, 0.0}, 8.0, 3.0, 0.0, 400.0, 1001.0, 1005.0};
    scene.cameras.push_back(orbit);
    return scene;
}

using test::contentOf;

TEST(CameraOfAll, SeesWhatMovesInPicturesOfAnyShape)
{
    SceneDescription scene = test::sceneOf({test::bodyNamed("near"), test::bodyNamed("far")});
    const SceneFrame frame = test::frameWith(
        1001, {{Vec3::Zero(), Quat::Identity()}, {{6.0, 1.0, -3.0}, Quat::Identity()}});
    for (const double aspect : {0.4, 1.0, 2.5}) {
        scene.aspect = aspect;
        const SceneCamera camera = cameraOfAll(scene, frame);
        const Pose viewFromWorld = inverse(worldFromCamera(camera, scene.zUp));
        const double tanY = std::tan(camera.fovDegrees * kPi / 360.0);
        for (const Pose& pose : frame.worldFromAsset) {
            for (const Vec3 point : scene.meshes[0].points.colwise()) {
                const Vec3 seen = viewFromWorld * (pose * point);
                EXPECT_LT(std::abs(seen.y()), -seen.z() * tanY) << aspect;
                EXPECT_LT(std::abs(seen.x()), -seen.z() * tanY * aspect) << aspect;
            }
        }
    }
}

TEST(CameraExport, OpenUsdFindsPanZoomAndOrbitAtEverySample)
{
    const test::Reader& python = test::findReader("usd");
    SCREE_REQUIRE_READER(!python.command.empty(), python.reason);
    const test::TemporaryFolder folder;
    const SceneDescription scene = filmedCast();
    test::exportCast(*makeUsdWriter(folder / "x.usda"), scene, {0.0, 0.5});
    std::ofstream(folder / "read.py") << R"(
import math, sys
from pxr import Usd, UsdGeom
stage = Usd.Stage.Open(sys.argv[1])
for name in ("main", "around"):
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/test_shot/" + name))
    for time in (1001, 1002.5, 1004, 1005.5):
        seen = camera.GetCamera(time)
        eye = seen.transform.ExtractTranslation()
        way = seen.transform.TransformDir((0, 0, -1))
        fov = seen.GetFieldOfView(type(seen).FOVVertical)
        print(*eye, *way, fov)
)";
    const test::CommandResult read =
        test::runCommand(python.command + " " + test::quoted(folder / "read.py") + " " +
                         test::quoted(folder / "x.usda"));
    ASSERT_EQ(read.exitCode, 0) << read.output;
    std::istringstream numbers(read.output);
    for (const SceneCamera& camera : scene.cameras) {
        for (const double time : {1001.0, 1002.5, 1004.0, 1005.5}) {
            const SceneCamera now = cameraAt(camera, time, false);
            Vec3 eye, way;
            double fov = 0.0;
            numbers >> eye.x() >> eye.y() >> eye.z() >> way.x() >> way.y() >> way.z() >> fov;
            ASSERT_TRUE(numbers) << read.output;
            EXPECT_LT((eye - now.eye).norm(), 1e-9) << camera.name << " " << time;
            EXPECT_LT((way - (now.target - now.eye).normalized()).norm(), 1e-9) << camera.name;
            // Lenses are stored in single precision.
            EXPECT_NEAR(fov, now.fovDegrees, 1e-4) << camera.name;
        }
    }
}

TEST(CameraExport, GltfMovesTheNodeOfTheCameraTheShortWay)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = filmedCast();
    scene.zUp = true;
    scene.metresPerUnit = 0.01;
    test::exportCast(*makeGltfWriter(folder / "x.glb"), scene);
    const std::string bytes = contentOf(folder / "x.glb");
    std::uint32_t textSize = 0;
    std::memcpy(&textSize, bytes.data() + 12, 4);
    const auto json = nlohmann::json::parse(bytes.substr(20, textSize));
    const auto floats = [&](std::size_t accessor, int rows) {
        const auto& about = json["accessors"][accessor];
        const auto& view = json["bufferViews"][about["bufferView"].get<std::size_t>()];
        Eigen::MatrixXf values(rows, about["count"].get<int>());
        std::memcpy(values.data(),
                    bytes.data() + 20 + textSize + 8 + view["byteOffset"].get<std::size_t>() +
                        about.value("byteOffset", std::size_t{0}),
                    sizeof(float) * static_cast<std::size_t>(values.size()));
        return values;
    };
    std::size_t seen = 0;
    for (const auto& channel : json["animations"][0]["channels"]) {
        const auto& node = json["nodes"][channel["target"]["node"].get<std::size_t>()];
        if (!node.contains("camera")) continue;
        ++seen;
        const bool isAround = node["name"] == "around";
        const auto& sampler =
            json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
        const bool isPlace = channel["target"]["path"] == "translation";
        const Eigen::MatrixXf values =
            floats(sampler["output"].get<std::size_t>(), isPlace ? 3 : 4);
        ASSERT_EQ(values.cols(), 5);
        for (int i = 0; i < 5; ++i) {
            const SceneCamera now = cameraAt(scene.cameras[isAround ? 1 : 0], 1001.0 + i, true);
            const auto yUp = [](const Vec3& p) { return Vec3(p.x(), p.z(), -p.y()); };
            if (isPlace) {
                EXPECT_LT((values.col(i).cast<double>() - 0.01 * yUp(now.eye)).norm(), 1e-7);
                continue;
            }
            const Quat turn(Eigen::Vector4d(values.col(i).cast<double>()));
            const Vec3 way = yUp(now.target - now.eye).normalized();
            EXPECT_LT((turn * Vec3(0.0, 0.0, -1.0) - way).norm(), 1e-6);
            if (i > 0) {
                EXPECT_GT(values.col(i).dot(values.col(i - 1)), 0.0F);
            }
        }
    }
    EXPECT_EQ(seen, 4U) << "translation and rotation of two cameras";
}

TEST(CameraExport, OnlyTheFormatThatLosesAZoomSaysSo)
{
    const SceneDescription scene = filmedCast();
    const std::vector<std::string> lost = makeGltfWriter("x.glb")->losses(scene);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_NE(lost[0].find("zoom of camera 'main'"), std::string::npos) << lost[0];
    EXPECT_TRUE(makeUsdWriter("x.usda")->losses(scene).empty());
    EXPECT_TRUE(makeGltfWriter("x.glb")->losses(test::castScene()).empty());
}

// It was main_ in Alembic, main_2 in USD and main, like the body, in glTF.
TEST(CameraExport, ACameraThatIsCalledLikeABodyHasOneNameInAllFormats)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.bodies[0].name = "main";
    test::exportCast(*makeAlembicWriter(folder / "x.abc"), scene);
    test::exportCast(*makeUsdWriter(folder / "x.usda"), scene);
    test::exportCast(*makeUsdInstancesWriter(folder / "x.instances.usda"), scene);
    test::exportCast(*makeGltfWriter(folder / "x.glb"), scene);
    for (const char* file : {"x.usda", "x.instances.usda"}) {
        EXPECT_NE(contentOf(folder / file).find("def Camera \"main_2\""), std::string::npos);
    }
    EXPECT_NE(contentOf(folder / "x.glb").find("{\"name\":\"main_2\",\"camera\":0"),
              std::string::npos);
    EXPECT_NE(contentOf(folder / "x.abc").find("main_2Camera"), std::string::npos);
}

TEST(CameraExport, EveryPovFileHasTheCameraOfItsFrame)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = filmedCast();
    test::exportCast(*makePovWriter(folder / "x.####.pov"), scene);
    for (const int frame : {1001, 1003, 1005}) {
        const std::string text = contentOf(folder / ("x." + std::to_string(frame) + ".pov"));
        const std::size_t place = text.find("location <");
        ASSERT_NE(place, std::string::npos);
        Vec3 eye;
        ASSERT_EQ(std::sscanf(text.c_str() + place, "location <%lf,%lf,%lf>", &eye.x(), &eye.y(),
                              &eye.z()),
                  3);
        EXPECT_LT((eye - cameraAt(scene.cameras[0], frame, false).eye).norm(), 1e-9) << frame;
    }
}

TEST(CameraOfATake, IsWhereTheScriptThatReadsTakesPutsIt)
{
    SceneCamera bent;
    bent.name = "bent";
    bent.keys = {{1001.0, {3, 4, 12}, {0, 2, -1}, 40.0, {0, 1, 0}},
                 {1003.5, {9, 4, 6}, {0, 1, 0}, 20.0, {1, 1, 0}},
                 {1009.0, {11, 2, 6}, {1, 1, 0}, 30.0, {1, 0, 0.5}},
                 {1010.0, {10, 1, 6}, {2, 0, 0}, 31.0, {1, 0, 0}}};
    SceneCamera orbit;
    orbit.orbit = CameraOrbit{{0, 1, 0}, 8.0, 3.0, 30.0, 400.0, 1002.0, 1008.0};
    SceneCamera still;
    still.eye = {1, 2, 3};
    TakeInfo info;
    info.cameras = {bent, orbit, still};
    const test::TemporaryFolder folder;
    std::ofstream(folder / "take.json") << encodeTakeInfo(info);
    std::ofstream(folder / "read.py") << R"(
import json, sys
sys.path.insert(0, sys.argv[2])
from read_take import camera_at
for camera in json.load(open(sys.argv[1]))["cameras"]:
    for time in (1000, 1001, 1002.2, 1003.5, 1007.25, 1009.5, 1010, 1020):
        eye, target, up, fov = camera_at(camera, time, "+y")
        print(*eye, *target, *up, fov)
)";
    const test::CommandResult read = test::runCommand(
        "/usr/bin/python3 " + test::quoted(folder / "read.py") + " " +
        test::quoted(folder / "take.json") + " " + test::quoted(test::sourceFile("tools")));
    ASSERT_EQ(read.exitCode, 0) << read.output;
    std::istringstream numbers(read.output);
    for (const SceneCamera& camera : info.cameras) {
        for (const double time :
             {1000.0, 1001.0, 1002.2, 1003.5, 1007.25, 1009.5, 1010.0, 1020.0}) {
            Vec3 eye, target, up;
            double fov = 0.0;
            for (Vec3* v : {&eye, &target, &up}) numbers >> v->x() >> v->y() >> v->z();
            numbers >> fov;
            const SceneCamera now = cameraAt(camera, time, false);
            EXPECT_LT((eye - now.eye).norm(), 1e-9) << camera.name << ' ' << time;
            EXPECT_LT((target - now.target).norm(), 1e-9) << camera.name << ' ' << time;
            EXPECT_LT((up - upOf(now, false)).norm(), 1e-9) << camera.name << ' ' << time;
            EXPECT_NEAR(fov, now.fovDegrees, 1e-9) << camera.name << ' ' << time;
        }
    }
}

}  // namespace
}  // namespace scree
