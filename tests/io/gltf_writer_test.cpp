// The files are read with a small reader of the test's own, written from the specification, and by
// the validator of the format's authors.
#include "io/gltf_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/cast.h"
#include "tests/support/readers.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Single precision of positions near 10 and of quaternions.
constexpr double kTolerance = 1e-6;

using test::contentOf;

struct Glb {
    Json json;
    std::string bytes;

    explicit Glb(const fs::path& path)
    {
        const std::string file = contentOf(path);
        const auto word = [&](std::size_t at) {
            std::uint32_t value = 0;
            std::memcpy(&value, file.data() + at, 4);
            return value;
        };
        EXPECT_EQ(file.substr(0, 4), "glTF");
        EXPECT_EQ(word(8), file.size());
        const std::size_t length = word(12);
        json = Json::parse(file.substr(20, length));
        if (20 + length < file.size()) bytes = file.substr(28 + length);
    }

    /// Values of an accessor of floats, an element a column.
    Eigen::MatrixXf floats(std::size_t index) const
    {
        const Json& accessor = json["accessors"][index];
        const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const int rows = accessor["type"] == "SCALAR" ? 1 : accessor["type"] == "VEC3" ? 3 : 4;
        Eigen::MatrixXf values(rows, accessor["count"].get<int>());
        const std::size_t offset =
            view["byteOffset"].get<std::size_t>() + accessor.value("byteOffset", std::size_t{0});
        std::memcpy(values.data(), bytes.data() + offset, sizeof(float) * values.size());
        return values;
    }

    std::size_t nodeNamed(const std::string& name) const
    {
        for (std::size_t node = 0; node < json["nodes"].size(); ++node) {
            if (json["nodes"][node]["name"] == name) return node;
        }
        ADD_FAILURE() << "no node " << name;
        return 0;
    }

    /// A node's translation or rotation at a time [s], as a viewer would have it.
    Eigen::VectorXf valueAt(std::size_t node, const std::string& path, double seconds) const
    {
        for (const Json& channel : json["animations"][0]["channels"]) {
            if (channel["target"]["node"] != node || channel["target"]["path"] != path) continue;
            const Json& sampler =
                json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
            const Eigen::MatrixXf times = floats(sampler["input"]);
            const Eigen::MatrixXf values = floats(sampler["output"]);
            Eigen::Index i = 0;
            while (i + 2 < times.cols() && times(0, i + 1) <= seconds) ++i;
            const float share =
                (static_cast<float>(seconds) - times(0, i)) / (times(0, i + 1) - times(0, i));
            if (path == "translation") {
                return values.col(i) + share * (values.col(i + 1) - values.col(i));
            }
            EXPECT_GT(values.col(i).dot(values.col(i + 1)), 0.0f);
            const Eigen::Quaternionf a(Eigen::Vector4f(values.col(i)));
            const Eigen::Quaternionf b(Eigen::Vector4f(values.col(i + 1)));
            return a.slerp(share, b).coeffs();
        }
        const std::vector<float> fixed = json["nodes"][node][path];
        return Eigen::Map<const Eigen::VectorXf>(fixed.data(),
                                                 static_cast<Eigen::Index>(fixed.size()));
    }
};

Vec3 vectorOf(const Json& array)
{
    return {array[0].get<double>(), array[1].get<double>(), array[2].get<double>()};
}

Quat quaternionOf(const Json& array)
{
    return {array[3].get<double>(), array[0].get<double>(), array[1].get<double>(),
            array[2].get<double>()};
}

Glb exported(const fs::path& path, const SceneDescription& scene,
             const std::vector<double>& offsets = {0.0})
{
    test::exportCast(*makeGltfWriter(path), scene, offsets);
    return Glb(path);
}

TEST(GltfWriter, NodesAreWhereBodiesWereAtWholeAndFractionalTimes)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::castScene();
    for (const std::vector<double>& offsets : {std::vector{0.0}, std::vector{-0.25, 0.0, 0.25}}) {
        const Glb glb = exported(folder / "x.glb", scene, offsets);
        for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
            const std::size_t node = glb.nodeNamed(scene.bodies[body].name);
            for (const double time : {1001.0, 1002.0, 1002.6, 1004.25, 1005.0}) {
                const double seconds = (time - test::kCastFirst) / scene.framesPerSecond;
                const Pose pose = test::castPose(scene, body, time);
                const Eigen::Vector3f position = glb.valueAt(node, "translation", seconds);
                const Eigen::Vector4f rotation = glb.valueAt(node, "rotation", seconds);
                EXPECT_LT((position.cast<double>() - pose.position).norm(), 10.0 * kTolerance);
                const Quat read(rotation.cast<double>().eval());
                EXPECT_LT(read.angularDistance(pose.orientation), 2.0 * kTolerance)
                    << scene.bodies[body].name << " at " << time;
            }
        }
    }
}

TEST(GltfWriter, TimeZeroIsTheFirstFrameAndWhatIsBeforeItIsLeftOut)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.cameras[0].keys = {{1001.0, {3.0, 4.0, 12.0}, {0.5, 2.0, -1.0}, 40.0},
                             {1005.0, {9.0, 4.0, 6.0}, {0.5, 1.0, 0.0}, 40.0}};
    scene.cameras[0].isSmooth = false;
    const std::vector<double> offsets = {-0.25, 0.0, 0.25};
    const Glb glb = exported(folder / "x.glb", scene, offsets);
    const Json& animation = glb.json["animations"][0];
    EXPECT_EQ(animation["extras"]["firstFrame"], test::kCastFirst);
    for (const Json& sampler : animation["samplers"]) {
        const Eigen::MatrixXf seconds = glb.floats(sampler["input"]);
        ASSERT_EQ(seconds.cols(), 14);
        EXPECT_EQ(glb.json["accessors"][sampler["input"].get<std::size_t>()]["min"][0], 0.0);
        for (Eigen::Index i = 0; i < seconds.cols(); ++i) {
            const auto sample = static_cast<std::size_t>(i + 1);
            const double frame = static_cast<double>(sample / 3) + offsets[sample % 3];
            EXPECT_NEAR(seconds(0, i) * scene.framesPerSecond, frame, 1e-5);
        }
    }
    const std::size_t camera = glb.nodeNamed("main");
    EXPECT_LT((vectorOf(glb.json["nodes"][camera]["translation"]) - Vec3(3.0, 4.0, 12.0)).norm(),
              kTolerance);
    const Eigen::Vector3f middle = glb.valueAt(camera, "translation", 2.0 / scene.framesPerSecond);
    EXPECT_LT((middle.cast<double>() - Vec3(6.0, 4.0, 9.0)).norm(), 10.0 * kTolerance);
}

TEST(GltfWriter, TheRootTurnsAZUpShotInCentimetresIntoYUpMetres)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.zUp = true;
    scene.metresPerUnit = 0.01;
    const Glb glb = exported(folder / "x.glb", scene);
    const Json& root = glb.json["nodes"][glb.nodeNamed(scene.name)];
    const Quat turn = quaternionOf(root["rotation"]);
    EXPECT_LT((turn * Vec3::UnitZ() - Vec3::UnitY()).norm(), kTolerance);
    EXPECT_LT((turn * Vec3::UnitX() - Vec3::UnitX()).norm(), kTolerance);
    EXPECT_EQ(root["scale"], Json({0.01, 0.01, 0.01}));
    EXPECT_EQ(root["children"].size(), scene.bodies.size());
}

TEST(GltfWriter, TheCameraLooksAtItsTargetFromItsEyeInMetres)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.zUp = true;
    scene.metresPerUnit = 0.01;
    const Glb glb = exported(folder / "x.glb", scene);
    const Json& node = glb.json["nodes"][glb.nodeNamed("main")];
    const auto yUpMetres = [](const Vec3& p) { return Vec3(0.01 * Vec3(p.x(), p.z(), -p.y())); };
    const Vec3 eye = yUpMetres(scene.cameras[0].eye), target = yUpMetres(scene.cameras[0].target);
    EXPECT_LT((vectorOf(node["translation"]) - eye).norm(), kTolerance);
    const Quat rotation = quaternionOf(node["rotation"]);
    const Vec3 forward = rotation * Vec3(0.0, 0.0, -1.0), right = rotation * Vec3::UnitX();
    EXPECT_LT((forward - (target - eye).normalized()).norm(), kTolerance);
    EXPECT_NEAR(right.y(), 0.0, kTolerance);  // not tilted
    EXPECT_GT((rotation * Vec3::UnitY()).y(), 0.0);
    const Json& lens = glb.json["cameras"][0]["perspective"];
    EXPECT_NEAR(lens["yfov"].get<double>(), 40.0 * std::acos(-1.0) / 180.0, 1e-12);
    EXPECT_EQ(lens["aspectRatio"], scene.aspect);
}

TEST(GltfWriter, BodiesOfAShapeShareItsData)
{
    const test::TemporaryFolder folder;
    const Glb glb = exported(folder / "x.glb", test::castScene());
    // Shape and material: tetrahedron in steel and unknown, tile in steel, rubber and wood.
    ASSERT_EQ(glb.json["meshes"].size(), 5u);
    std::map<std::string, std::set<Json>> attributes;
    for (const Json& mesh : glb.json["meshes"]) {
        attributes[mesh["name"]].insert(mesh["primitives"][0]["attributes"]);
    }
    ASSERT_EQ(attributes.size(), 2u);
    for (const auto& [name, sets] : attributes) EXPECT_EQ(sets.size(), 1u) << name;
}

TEST(GltfWriter, BoundsOfPointsAreThoseOfTheMesh)
{
    const test::TemporaryFolder folder;
    const Glb glb = exported(folder / "x.glb", test::castScene());
    const std::size_t accessor = glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    const Json& points = glb.json["accessors"][accessor];
    EXPECT_LT((vectorOf(points["min"]) - Vec3(0.1, 0.1, 0.1)).norm(), kTolerance);
    EXPECT_LT((vectorOf(points["max"]) - Vec3(1.3, 1.4, 1.7)).norm(), kTolerance);
    EXPECT_EQ(points["count"], 12);  // a tetrahedron has creases everywhere
}

TEST(GltfWriter, MaterialsHaveTheShotsColoursAndRoughness)
{
    const test::TemporaryFolder folder;
    const Glb glb = exported(folder / "x.glb", test::castScene());
    const Json& rubber = glb.json["materials"][1];
    EXPECT_EQ(rubber["name"], "2k_rubber");
    EXPECT_EQ(rubber["pbrMetallicRoughness"]["baseColorFactor"], Json({0.8, 0.05, 0.04, 1.0}));
    EXPECT_EQ(rubber["pbrMetallicRoughness"]["roughnessFactor"], 0.9);
    const Json& floor = glb.json["nodes"][glb.nodeNamed("floor")];
    EXPECT_EQ(glb.json["meshes"][floor["mesh"].get<std::size_t>()]["primitives"][0]["material"], 1);
}

TEST(GltfWriter, WhatDoesNotMoveIsNotAnimated)
{
    const test::TemporaryFolder folder;
    const Glb glb = exported(folder / "x.glb", test::castScene());
    const std::size_t floor = glb.nodeNamed("floor"), sleeper = glb.nodeNamed("sleeper");
    for (const Json& channel : glb.json["animations"][0]["channels"]) {
        EXPECT_NE(channel["target"]["node"], floor);
        EXPECT_NE(channel["target"]["node"], sleeper);
    }
    EXPECT_EQ(glb.json["animations"][0]["channels"].size(), 8u);  // four bodies tumble

    SceneDescription still = test::castScene();
    for (SceneBody& body : still.bodies) body.moves = false;
    EXPECT_FALSE(exported(folder / "y.glb", still).json.contains("animations"));
}

TEST(GltfWriter, TheFormatsOwnValidatorFindsNothing)
{
    const test::Reader& node = test::findReader("gltf");
    SCREE_REQUIRE_READER(!node.command.empty(), node.reason);
    const test::TemporaryFolder folder;
    const SceneDescription tumbling = test::castScene();
    SceneDescription still = tumbling;
    for (SceneBody& body : still.bodies) body.moves = false;
    SceneDescription shapeless = test::sceneOf({test::bodyNamed("ghost")});
    shapeless.meshes[0].triangles.resize(3, 0);
    for (const SceneDescription& scene : {tumbling, still, shapeless}) {
        exported(folder / "x.glb", scene);
        const test::CommandResult result = test::runCommand(
            node.command + " " + test::quoted(test::sourceFile("tests/support/gltf_check.cjs")) +
            " " + test::quoted(folder / "x.glb"));
        EXPECT_EQ(result.exitCode, 0) << result.output;
        std::printf("%s", result.output.c_str());
    }
}

TEST(GltfWriter, EqualExportsAreEqualBytes)
{
    const test::TemporaryFolder folder;
    exported(folder / "1.glb", test::castScene());
    exported(folder / "2.glb", test::castScene());
    EXPECT_TRUE(contentOf(folder / "1.glb") == contentOf(folder / "2.glb"));
}

TEST(GltfWriter, AnExportThatStopsEarlyLeavesNothingBehind)
{
    const test::TemporaryFolder folder;
    {
        const SceneDescription scene = test::castScene();
        const std::unique_ptr<FrameWriter> writer = makeGltfWriter(folder / "x.glb");
        writer->begin(scene, 1001, 2);
        writer->write(test::castFrame(scene, 1001));
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace scree
