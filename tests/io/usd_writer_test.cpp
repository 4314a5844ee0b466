#include "io/usd_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/cast.h"
#include "tests/support/readers.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

using MakeWriter = std::unique_ptr<FrameWriter> (*)(const fs::path& output);

// Samples at these times, and readers asked between them too.
const std::vector<double> kOffsets = {-0.25, 0.0, 0.25};

using test::contentOf;

std::string exported(MakeWriter make, const fs::path& path, const SceneDescription& scene,
                     const std::vector<double>& offsets = {0.0})
{
    test::exportCast(*make(path), scene, offsets);
    return contentOf(path);
}

std::size_t countOf(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

/// The text of a prim: from its name to the closing brace of the same depth.
std::string primText(const std::string& text, const std::string& name)
{
    const std::size_t begin = text.find("\"" + name + "\"");
    EXPECT_NE(begin, std::string::npos) << name;
    std::size_t end = text.find('{', begin);
    int depth = 0;
    do {
        if (text[end] == '{') ++depth;
        if (text[end] == '}') --depth;
    } while (++end < text.size() && depth > 0);
    return text.substr(begin, end - begin);
}

/// What tests/support/usd_check.py compares with.
nlohmann::json expectation(const SceneDescription& scene, const std::vector<double>& times,
                           bool isInstanced)
{
    const std::string prims[] = {"tumbler", "sleeper", "floor", "_9lives_2", "stranger", "_9lives"};
    const std::string materials[] = {"steel", "steel", "_2k_rubber", "wood", "", "steel"};
    nlohmann::json bodies;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        nlohmann::json poses;
        for (const double time : times) {
            const Pose pose = test::castPose(scene, body, time);
            const Vec3& p = pose.position;
            const Quat& q = pose.orientation;
            poses.push_back({p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()});
        }
        const bool isPrim = !isInstanced || !scene.bodies[body].moves;
        bodies.push_back({{"name", scene.bodies[body].name},
                          {"path", isPrim ? nlohmann::json("/test_shot/" + prims[body]) : nullptr},
                          {"material", materials[body]},
                          {"poses", poses}});
    }
    nlohmann::json uvs;
    for (const auto uv : scene.meshes[0].cornerUvs.colwise()) uvs.push_back({uv.x(), uv.y()});
    // Prims below a prototype, which is abstract, are found by their path all the same.
    return {{"times", times},
            {"bodies", bodies},
            {"textures", {{"path", "/test_shot/Prototypes/tetrahedron/Geo"}, {"uvs", uvs}}}};
}

void expectUsdAgrees(MakeWriter make, const SceneDescription& scene,
                     const std::vector<double>& offsets, bool isInstanced)
{
    const test::Reader& python = test::findReader("usd");
    SCREE_REQUIRE_READER(!python.command.empty(), python.reason);
    const test::TemporaryFolder folder;
    exported(make, folder / "cast.usda", scene, offsets);
    std::ofstream(folder / "expected.json")
        << expectation(scene, {1001.0, 1001.25, 1002.7, 1003.0, 1004.5, 1005.0}, isInstanced);
    const test::CommandResult result = test::runCommand(
        python.command + " " + test::quoted(test::sourceFile("tests/support/usd_check.py")) + " " +
        test::quoted(folder / "cast.usda") + " " + test::quoted(folder / "expected.json"));
    EXPECT_EQ(result.exitCode, 0) << result.output;
    std::printf("%s", result.output.c_str());
}

TEST(UsdWriter, OpenUsdFindsEveryBodyWhereItWasAtWholeAndFractionalTimes)
{
    expectUsdAgrees(makeUsdWriter, test::castScene(), {0.0}, false);
}

TEST(UsdWriter, OpenUsdFindsEveryBodyWhereItWasBetweenSubframes)
{
    expectUsdAgrees(makeUsdWriter, test::castScene(), kOffsets, false);
}

TEST(UsdWriter, OpenUsdComputesInstancesWhereBodiesWere)
{
    expectUsdAgrees(makeUsdInstancesWriter, test::castScene(), {0.0}, true);
}

TEST(UsdWriter, OpenUsdFindsAZUpShotInCentimetresUnchanged)
{
    SceneDescription scene = test::castScene();
    scene.zUp = true;
    scene.metresPerUnit = 0.01;
    scene.framesPerSecond = 23.976;
    expectUsdAgrees(makeUsdWriter, scene, {0.0}, false);
    expectUsdAgrees(makeUsdInstancesWriter, scene, kOffsets, true);
}

TEST(UsdWriter, TheEndingChoosesTheForm)
{
    const test::TemporaryFolder folder;
    for (const std::string name : {"x.usda", "x.INSTANCES.usda"}) {
        test::exportCast(*makeFrameWriter(folder / name), test::castScene());
        EXPECT_EQ(countOf(contentOf(folder / name), "def PointInstancer"),
                  name == "x.usda" ? 0u : 1u)
            << name;
    }
}

TEST(UsdWriter, AnUnknownEndingIsAnsweredWithBothForms)
{
    const test::Refusal refusal = test::refusalBy([&] { makeFrameWriter("x.usdc"); });
    for (const char* ending : {" .usda", ".instances.usda", ".glb", ".####.pov"}) {
        EXPECT_TRUE(refusal.mentions(ending)) << refusal.message;
    }
}

TEST(UsdWriter, TheHeaderTellsUnitAxesAndFrames)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.zUp = true;
    scene.metresPerUnit = 0.01;
    scene.framesPerSecond = 25.0;
    for (const MakeWriter make : {makeUsdWriter, makeUsdInstancesWriter}) {
        const std::string text = exported(make, folder / "x.usda", scene);
        EXPECT_EQ(text.find("#usda 1.0\n(\n"), 0u);
        const std::string header = text.substr(0, text.find("\ndef"));
        for (const char* entry :
             {"defaultPrim = \"test_shot\"", "upAxis = \"Z\"", "metersPerUnit = 0.01",
              "kilogramsPerUnit = 1", "timeCodesPerSecond = 25", "framesPerSecond = 25",
              "startTimeCode = 1001", "endTimeCode = 1005"}) {
            EXPECT_NE(header.find(std::string(entry) + "\n"), std::string::npos) << entry;
        }
    }
}

TEST(UsdWriter, WhatDoesNotMoveHasNoTimes)
{
    const test::TemporaryFolder folder;
    const std::string text = exported(makeUsdWriter, folder / "x.usda", test::castScene());
    for (const char* name : {"sleeper", "floor"}) {
        EXPECT_EQ(primText(text, name).find("timeSamples"), std::string::npos) << name;
    }
    EXPECT_EQ(countOf(primText(text, "tumbler"), "timeSamples"), 2u);
    EXPECT_EQ(countOf(primText(text, "tumbler"), "        1003: ("), 2u);
}

TEST(UsdWriter, TimesInTheMiddleOfARestAreLeftOut)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ball")});
    const std::unique_ptr<FrameWriter> writer = makeUsdWriter(folder / "x.usda");
    writer->begin(scene, 1, 8);
    for (int frame = 1; frame <= 8; ++frame) {
        // Falls until frame 3, rests until 6, falls on.
        const double height = frame <= 3 ? -frame : frame <= 6 ? -3.0 : 3.0 - frame;
        writer->write(test::frameWith(frame, {{Vec3(0.0, height, 0.0), Quat::Identity()}}));
    }
    writer->finish();
    const std::string prim = primText(contentOf(folder / "x.usda"), "ball");
    for (const char* time : {"1", "2", "3", "6", "7", "8"}) {
        EXPECT_NE(prim.find(std::string(time) + ": (0, -"), std::string::npos) << time;
    }
    for (const char* time : {"4", "5"}) {
        EXPECT_EQ(prim.find(std::string(time) + ": (0, -"), std::string::npos) << time;
    }
}

TEST(UsdWriter, NeighbouringQuaternionsLieInOneHemisphere)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ball")});
    const std::unique_ptr<FrameWriter> writer = makeUsdWriter(folder / "x.usda");
    const Quat turned(0.8, 0.6, 0.0, 0.0);
    writer->begin(scene, 1, 2);
    writer->write(test::frameWith(1, {{Vec3::Zero(), Quat(1.0, 0.0, 0.0, 0.0)}}));
    writer->write(test::frameWith(2, {{Vec3::Zero(), Quat(-turned.coeffs())}}));
    writer->finish();
    EXPECT_NE(contentOf(folder / "x.usda").find("2: (0.8, 0.6, "), std::string::npos);
}

/// Angles at times 1, 2, … of a body's or a camera's orientation, from w alone as OpenUSD has it.
std::vector<double> anglesOf(const std::string& prim)
{
    std::vector<double> angles;
    std::size_t at = prim.find("quatd xformOp:orient.timeSamples");
    EXPECT_NE(at, std::string::npos) << prim;
    while ((at = prim.find(": (", at)) < prim.find("xformOp:translate")) {
        at += 3;
        angles.push_back(2.0 * std::acos(std::stod(prim.substr(at))));
    }
    return angles;
}

TEST(UsdWriter, ATurnTooSmallForSinglePrecisionIsThere)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("hand")});
    constexpr double kTurn = 2e-5;  // [rad] a frame: a tenth of a degree in a hundred
    const std::unique_ptr<FrameWriter> writer = makeUsdWriter(folder / "x.usda");
    writer->begin(scene, 1, 10);
    for (int i = 0; i < 10; ++i) {
        const Quat turned(Eigen::AngleAxisd(kTurn * i, Vec3::UnitZ()));
        writer->write(test::frameWith(1 + i, {{Vec3::Zero(), turned}}));
    }
    writer->finish();
    const std::vector<double> angles = anglesOf(primText(contentOf(folder / "x.usda"), "hand"));
    ASSERT_EQ(angles.size(), 10u);
    // The cosine of half the angle, off by 1e-16, leaves the angle off by 4e-16 over it.
    for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_NEAR(angles[i], kTurn * i, 4e-11) << i;
}

TEST(UsdWriter, OrientationsOfInstancesHaveTheTypesTheSchemaAsksFor)
{
    const test::TemporaryFolder folder;
    const std::string text = exported(makeUsdInstancesWriter, folder / "x.usda", test::castScene());
    const std::string bodies = primText(text, "Bodies");
    EXPECT_EQ(countOf(bodies, "quath[] orientations.timeSamples"), 1u);
    EXPECT_EQ(countOf(bodies, "quatf[] orientationsf.timeSamples"), 1u);
    EXPECT_EQ(countOf(bodies, "quatd"), 0u);
}

TEST(UsdWriter, EachMeshIsWrittenOnceHoweverManyBodiesShowIt)
{
    const test::TemporaryFolder folder;
    for (const MakeWriter make : {makeUsdWriter, makeUsdInstancesWriter}) {
        const std::string text = exported(make, folder / "x.usda", test::castScene());
        EXPECT_EQ(countOf(text, "def Mesh "), 2u);
        EXPECT_EQ(countOf(text, "subdivisionScheme = \"none\""), 2u);
    }
}

TEST(UsdWriter, NamesUsdCannotHoldAreKeptBesideTheNewOnes)
{
    const test::TemporaryFolder folder;
    const std::string text = exported(makeUsdWriter, folder / "x.usda", test::castScene());
    EXPECT_NE(primText(text, "_9lives_2").find("userProperties:name = \"9lives\""),
              std::string::npos);
    EXPECT_EQ(primText(text, "_9lives").find("userProperties:name"), std::string::npos);
    EXPECT_NE(primText(text, "_2_tiles__a_").find("userProperties:name = \"2 tiles \\\"a\\\"\""),
              std::string::npos);
}

TEST(UsdWriter, ABodyMayHaveTheNameOfAScope)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.bodies[0].name = "Materials";
    const std::string text = exported(makeUsdWriter, folder / "x.usda", scene);
    EXPECT_NE(text.find("def Xform \"Materials\""), std::string::npos);
    EXPECT_NE(text.find("</test_shot/Materials_2/steel>"), std::string::npos);
}

TEST(UsdWriter, InstancesFarFromTheOriginKeepTheirDigits)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("a"), test::bodyNamed("b")});
    const Vec3 far(1e7, 0.0, 0.0), step(0.001953125, 0.0, 0.0);  // exact in binary
    const std::unique_ptr<FrameWriter> writer = makeUsdInstancesWriter(folder / "x.usda");
    writer->begin(scene, 1, 1);
    writer->write(test::frameWith(1, {{far, Quat::Identity()}, {far + step, Quat::Identity()}}));
    writer->finish();
    const std::string text = contentOf(folder / "x.usda");
    EXPECT_NE(text.find("1: [(0, 0, 0), (0.001953125, 0, 0)]"), std::string::npos) << text;
    EXPECT_NE(text.find("xformOp:translate = (1e+07, 0, 0)"), std::string::npos);
}

TEST(UsdWriter, EqualExportsAreEqualBytes)
{
    const test::TemporaryFolder folder;
    for (const MakeWriter make : {makeUsdWriter, makeUsdInstancesWriter}) {
        const std::string first = exported(make, folder / "1.usda", test::castScene(), kOffsets);
        EXPECT_GT(first.size(), 1000u);
        EXPECT_TRUE(first == exported(make, folder / "2.usda", test::castScene(), kOffsets));
    }
}

TEST(UsdWriter, AnExportThatStopsEarlyLeavesNothingBehind)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::castScene();
    for (const MakeWriter make : {makeUsdWriter, makeUsdInstancesWriter}) {
        const std::unique_ptr<FrameWriter> writer = make(folder / "x.usda");
        writer->begin(scene, 1001, 2);
        writer->write(test::castFrame(scene, 1001));
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(UsdWriter, AShotWithoutMovingBodiesIsStillAStage)
{
    SceneDescription scene = test::castScene();
    for (SceneBody& body : scene.bodies) body.moves = false;
    expectUsdAgrees(makeUsdWriter, scene, {0.0}, false);
    expectUsdAgrees(makeUsdInstancesWriter, scene, {0.0}, true);
}

}  // namespace
}  // namespace scree
