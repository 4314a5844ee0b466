// Bodies that others collide with and nobody is to see: `visible = false`.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/frame_writer.h"
#include "io/take.h"
#include "io/take_reader.h"
#include "tests/support/abc_check.h"
#include "tests/support/export_scene.h"
#include "tests/support/readers.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

TEST(Visibility, IsSaidOfBodiesOfAllTheirCopiesOfPlanesAndOfImports)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "pair.obj")
        << "o left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
           "o right\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n";
    const std::string text = test::shotTextOf(
        {}, test::bodyText("seen", "") +
                test::bodyText("proxy",
                               "visible = false\n"
                               "grid = { count = [2, 1, 1], spacing = [3, 3, 3] }\n"
                               "position = [0, 5, 0]") +
                "[[body]]\nname = \"wall\"\nmaterial = \"wood\"\n"
                "plane = { point = [9, 0, 0], normal = [-1, 0, 0] }\n"
                "motion = \"static\"\nvisible = false\n"
                "[[import]]\nfile = \"pair.obj\"\nmaterial = \"wood\"\n"
                "nodes = \"left\"\nvisible = false\n"
                "[[import]]\nfile = \"pair.obj\"\nmaterial = \"wood\"\n"
                "nodes = \"right\"\nvisible = true\n");
    const Shot shot = parseShotText(text, folder / "s.toml");
    std::map<std::string, bool> isVisible;
    for (const ShotBody& body : shot.bodies) isVisible[body.name] = body.isVisible;
    EXPECT_EQ(isVisible, (std::map<std::string, bool>{{"ground", true},
                                                      {"seen", true},
                                                      {"proxy_0000", false},
                                                      {"proxy_0001", false},
                                                      {"wall", false},
                                                      {"left", false},
                                                      {"right", true}}));
}

TEST(Visibility, ATakeKeepsItAndAResumeToo)
{
    const test::TemporaryFolder folder;
    const Shot shot = parseShotText(
        test::shotTextOf({}, test::bodyText("proxy", "visible = false\nposition = [0, 1, 0]") +
                                 test::bodyText("seen", "position = [0, 3, 0]")),
        "s.toml");
    World world = buildWorld(shot);
    {
        TakeWriter take(folder / "take", shot, world, "1", ExistingTake::refuse);
        FrameStats stats;
        stats.frame = 1001;
        take.writeFrame(world, stats);
    }
    const auto hidden = [&] {
        std::string names;
        for (const SceneBody& body : TakeReader(folder / "take").describe().bodies)
            if (!body.isVisible) names += body.name + " ";
        return names;
    };
    EXPECT_EQ(hidden(), "proxy ");

    // Somebody has taken it out of the take's list: it is put right.
    const auto path = folder / "take/take.json";
    std::string info = readFileBytes(path);
    const std::string key = "\"visible\"";
    ASSERT_NE(info.find(key), std::string::npos);
    info.replace(info.find(key), key.size(), "\"no_such\"");
    std::ofstream(path) << info;
    EXPECT_EQ(hidden(), "");
    TakeWriter(folder / "take", shot, world, "1", ExistingTake::resume);
    EXPECT_EQ(hidden(), "proxy ");
}

/// Of bodies that move and that never do, one each to be seen and one each to be hidden.
class HiddenExport : public testing::Test {
protected:
    HiddenExport()
        : scene_(test::sceneOf({test::bodyNamed("seen"), test::bodyNamed("proxy"),
                                test::bodyNamed("floor", false), test::bodyNamed("wall", false)}))
    {
        scene_.bodies[1].isVisible = scene_.bodies[3].isVisible = false;
    }

    std::filesystem::path write(const std::string& name) const
    {
        const auto writer = makeFrameWriter(folder_ / name);
        writer->begin(scene_, 1001, 3);
        for (int frame = 1001; frame <= 1003; ++frame)
            writer->write(test::tumblingFrame(scene_, frame, 1000));
        writer->finish();
        return folder_ / name;
    }

    const test::TemporaryFolder folder_;
    SceneDescription scene_;
};

TEST_F(HiddenExport, AlembicSaysSoOnce)
{
    const test::CommandResult result = test::runAbcCheck(write("a.abc"), "--strict");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const auto partOf = [&](const std::string& name) {
        const std::size_t begin = result.output.find("/test_shot/" + name + " ");
        return result.output.substr(begin, result.output.find("/test_shot/", begin + 1) - begin);
    };
    const std::string hidden = "visible scalar int8_t samples=3 stored=1";
    EXPECT_NE(partOf("proxy").find(hidden), std::string::npos) << result.output;
    EXPECT_NE(partOf("wall").find(hidden), std::string::npos) << result.output;
    EXPECT_EQ(partOf("seen").find("visible"), std::string::npos) << result.output;
    EXPECT_EQ(partOf("floor").find("visible"), std::string::npos) << result.output;
}

TEST_F(HiddenExport, UsdItselfSaysWhoIsHiddenAndWhereHeIs)
{
    const test::Reader& reader = test::findReader("usd");
    SCREE_REQUIRE_READER(!reader.command.empty(), reader.reason);
    const std::string script = (folder_ / "visible.py").string();
    std::ofstream(script) << R"(
import sys
from pxr import Usd, UsdGeom
plain, instanced = (Usd.Stage.Open(path) for path in sys.argv[1:3])
for name in ("seen", "proxy", "floor", "wall"):
    prim = UsdGeom.Imageable(plain.GetPrimAtPath("/test_shot/" + name))
    scale = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(1002).ExtractRotationMatrix()
    print(name, prim.ComputeVisibility(1002), round(scale.GetDeterminant()),
          prim.GetVisibilityAttr().GetNumTimeSamples())
instancer = UsdGeom.PointInstancer(instanced.GetPrimAtPath("/test_shot/Bodies"))
print(*map(int, instancer.ComputeMaskAtTime(1002)))
for name in ("floor", "wall"):
    print(name, UsdGeom.Imageable(instanced.GetPrimAtPath("/test_shot/" + name)).ComputeVisibility())
)";
    const test::CommandResult result =
        test::runCommand(reader.command + " " + script + " " + test::quoted(write("a.usda")) + " " +
                         test::quoted(write("a.instances.usda")));
    EXPECT_EQ(result.output,
              "seen inherited 1 0\nproxy invisible 1 0\nfloor inherited 1 0\nwall invisible 1 0\n"
              "1 0\nfloor inherited\nwall invisible\n");
}

TEST_F(HiddenExport, GltfKeepsItsNodeAndItsMotionButNoMesh)
{
    const std::string file = readFileBytes(write("a.glb"));
    const auto json = nlohmann::json::parse(file.substr(20, file.find("BIN") - 24));
    std::map<std::string, bool> hasMesh;
    std::map<std::string, int> tracks;
    for (const auto& channel : json["animations"][0]["channels"]) {
        EXPECT_NE(channel["target"]["path"], "scale");
        ++tracks[json["nodes"][channel["target"]["node"].get<int>()]["name"]];
    }
    for (const auto& node : json["nodes"])
        hasMesh[node["name"].get<std::string>()] = node.contains("mesh");
    EXPECT_TRUE(hasMesh.at("seen") && hasMesh.at("floor"));
    EXPECT_FALSE(hasMesh.at("proxy") || hasMesh.at("wall"));
    EXPECT_EQ(tracks, (std::map<std::string, int>{{"seen", 2}, {"proxy", 2}}));
}

TEST_F(HiddenExport, SequencesLeaveItOut)
{
    write("a.####.obj");
    const std::string text = readFileBytes(folder_ / "a.1002.obj");
    for (const std::string name : {"seen", "floor"})
        EXPECT_NE(text.find("o " + name), std::string::npos) << name;
    for (const std::string name : {"proxy", "wall"})
        EXPECT_EQ(text.find("o " + name), std::string::npos) << name;
}

}  // namespace
}  // namespace scree
