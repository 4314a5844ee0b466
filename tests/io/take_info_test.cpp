// take.json: what it says is what the shot says, and nonsense is refused.
#include "io/take_info.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/picture/camera_motion.h"
#include "io/take_reader.h"
#include "tests/io/take_fixture.h"
#include "tests/support/refusal.h"
#include "tests/support/small_gltf.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

class TakeInfoText : public test::TakeFixture {};

TEST_F(TakeInfoText, DescriptionOfTheTakeIsTheOneOfTheShot)
{
    writeWholeTake();
    const SceneDescription expected = describeScene(shot, world, 1.0);
    const SceneDescription scene = TakeReader(folder / "take").describe();
    ASSERT_EQ(scene.bodies.size(), expected.bodies.size());
    EXPECT_EQ(scene.name, expected.name);
    EXPECT_EQ(scene.metresPerUnit, expected.metresPerUnit);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const SceneBody &body = scene.bodies[i], &other = expected.bodies[i];
        EXPECT_EQ(body.name, other.name);
        EXPECT_EQ(body.material, other.material);
        EXPECT_EQ(body.mass, other.mass);
        EXPECT_EQ(body.moves, other.moves);
        const SceneMesh& mesh = scene.meshes[body.mesh];
        EXPECT_EQ(mesh.name, expected.meshes[other.mesh].name);
        EXPECT_EQ(mesh.triangles.cols(), expected.meshes[other.mesh].triangles.cols());
    }
    const SceneMesh& block = scene.meshes[scene.bodies[1].mesh];
    EXPECT_EQ(block.points, expected.meshes[expected.bodies[1].mesh].points);
}

TEST_F(TakeInfoText, TakeInfoSurvivesItsText)
{
    const SceneDescription scene = describeScene(shot, world, 1.0);
    const TakeInfo info = makeTakeInfo(shot, world, scene, "1.2.3");
    const std::string text = encodeTakeInfo(info);
    const TakeInfo back = decodeTakeInfo(text, "take.json");
    EXPECT_EQ(encodeTakeInfo(back), text);
    EXPECT_EQ(back.cameras.at(0).eye, info.cameras.at(0).eye);
    EXPECT_NEAR(back.cameras.at(0).eye.x(), 300.0, 1e-10);
    EXPECT_EQ(back.resolvedShot, shot.resolvedText);
}

TEST_F(TakeInfoText, WhatNoShotCouldHaveSaidIsRefusedByItsKey)
{
    const TakeInfo info = makeTakeInfo(shot, world, describeScene(shot, world, 1.0), "1.2.3");
    const nlohmann::json good = nlohmann::json::parse(encodeTakeInfo(info));
    const auto expectRefusal = [&](const std::string& pointer, const nlohmann::json& value) {
        nlohmann::json json = good;
        json.at(nlohmann::json::json_pointer(pointer)) = value;
        const test::Refusal refusal =
            test::refusalBy([&] { decodeTakeInfo(json.dump(), "take.json"); });
        EXPECT_EQ(refusal.kind, ErrorKind::inputOutput);
        const std::string& message = refusal.message;
        EXPECT_TRUE(message.starts_with("take.json: damaged: \"")) << message;
        EXPECT_NE(message.find(value.dump()), std::string::npos) << message;
    };
    EXPECT_NO_THROW(decodeTakeInfo(good.dump(), "take.json"));
    expectRefusal("/picture_size/0", 0);
    expectRefusal("/picture_size/1", 4294967296.0 + 720.0);  // once 720
    expectRefusal("/picture_size/1", 720.5);
    expectRefusal("/motion_blur", 0);
    expectRefusal("/fps", 0.0);
    expectRefusal("/fps", -24.0);
    expectRefusal("/frames/0", 1006);
    expectRefusal("/frames/1", 1e300);
    expectRefusal("/metres_per_unit", 0.0);
    expectRefusal("/up", "+x");
    expectRefusal("/name", "../../elsewhere");
    expectRefusal("/name", "");
    expectRefusal("/cameras/0/fov", 180.0);
    expectRefusal("/bodies/1/motion", "dynamik");
    expectRefusal("/bodies/1/mass", -1.0);
    expectRefusal("/looks/0/color/2", 1.5);
    expectRefusal("/looks/0/roughness", -0.5);
}

TEST_F(TakeInfoText, CamerasThatMoveSurviveTheTextOfTheTake)
{
    SceneCamera keyed, orbiting;
    keyed.keys = {{1001.0, {1.0, 2.0, 3.0}, {0.0, 0.1, 0.0}, 30.0},
                  {1003.5, {4.0, 2.0, 3.0}, {0.0, 0.2, 0.0}, 40.0}};
    keyed.isSmooth = false;
    orbiting.orbit = CameraOrbit{{0.1, 0.2, 0.3}, 5.0, 2.0, 30.0, -90.0, 1001.0, 1004.0};
    shot.cameras = {keyed, orbiting};
    const TakeInfo info = makeTakeInfo(shot, world, describeScene(shot, world, 1.0), "1.2.3");
    const TakeInfo back = decodeTakeInfo(encodeTakeInfo(info), "take.json");
    ASSERT_EQ(back.cameras.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
        // The shot is in centimetres, the cameras above are in metres.
        const Vec3 eye = 100.0 * cameraAt(shot.cameras[k], 1002.3, false).eye;
        EXPECT_LT((cameraAt(back.cameras[k], 1002.3, false).eye - eye).norm(), 1e-9) << k;
    }
    EXPECT_FALSE(back.cameras[0].isSmooth);
}

TEST_F(TakeInfoText, ChangedShotTextInTakeJsonIsNoticed)
{
    const SceneDescription scene = describeScene(shot, world, 1.0);
    std::string text = encodeTakeInfo(makeTakeInfo(shot, world, scene, "1.2.3"));
    text.replace(text.find("density = 650"), 13, "density = 651");
    EXPECT_EQ(test::kindThrownBy([&] { decodeTakeInfo(text, "take.json"); }),
              ErrorKind::inputOutput);
}

// A camera, a pile of poses and the bytes of a glTF could change under a take.
TEST(TakeInputs, AreAllTheFilesThatAShotIsReadFrom)
{
    const TemporaryFolder folder;
    test::writeGltf(folder);
    fs::copy_file(folder / "set.gltf", folder / "cam.gltf");
    std::string camera = readFileBytes(folder / "cam.gltf");
    camera.replace(camera.find("\"mesh\":0}]"), 10, "\"camera\":0}]");
    camera.insert(camera.rfind('}'),
                  R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}])");
    writeFileBytes(folder / "cam.gltf", camera);
    for (const char* name : {"a.poses", "b.poses"})
        writeFileBytes(folder / name, "0 5 0 1 0 0 0\n");
    const std::string text =
        test::shotTextOf({}, test::bodyText("pile", "poses = \"a.poses\"") +
                                 "[[emitter]]\nname = \"rain\"\nshape = \"block\"\nmaterial = "
                                 "\"wood\"\ncount = 1\nposes = \"b.poses\"\n[[camera]]\nfile = "
                                 "\"cam.gltf\"\n[[import]]\nfile = \"set.gltf\"\nmaterial = "
                                 "\"wood\"\nmotion = \"static\"\n");
    writeFileBytes(folder / "s.toml", text);
    const Shot shot = parseShot(folder / "s.toml", {});
    const World world = buildWorld(shot);
    const TakeInfo info = makeTakeInfo(shot, world, describeScene(shot, world, 1.0), "1.2.3");
    std::vector<std::string> names;
    for (const TakeInput& input : info.inputs) names.push_back(fs::path(input.path).filename());
    EXPECT_EQ(names,
              (std::vector<std::string>{"set.gltf", "a.poses", "b.poses", "cam.gltf", "data.bin"}));
}

}  // namespace
}  // namespace scree
