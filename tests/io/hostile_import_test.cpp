// Files that were made to hurt, by accident or not, end in an ordinary error: the parser of foreign
// formats lives in a process of its own.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "core/base/error.h"
#include "io/build_world.h"
#include "io/confined_process.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/small_gltf.h"
#include "tests/support/support.h"

namespace scree {
namespace {

std::string refusalOf(const std::function<std::string()>& work, const ConfinedLimits& limits = {})
{
    try {
        return "nothing was thrown: " + runConfined("work", work, limits);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::badInput);
        return error.what();
    }
}

TEST(ConfinedProcess, HandsBackLongResultsWhole)
{
    const std::string longText(3'000'000, 'x');
    EXPECT_EQ(runConfined("work", [&] { return longText; }), longText);
    EXPECT_EQ(runConfined("work", [] { return std::string(); }), "");
}

TEST(ConfinedProcess, ACrashIsAnOrdinaryError)
{
    EXPECT_EQ(refusalOf([]() -> std::string { std::abort(); }),
              "work: its reader crashed (Aborted)");
    EXPECT_EQ(refusalOf([]() -> std::string {
                  std::raise(SIGSEGV);
                  return "";
              }),
              "work: its reader crashed (Segmentation fault)");
    EXPECT_EQ(refusalOf([]() -> std::string { throw std::runtime_error("no good"); }),
              "work: no good");
}

TEST(ConfinedProcess, TakesNeitherMemoryNorTimeWithoutEnd)
{
    ConfinedLimits limits;
    limits.memoryBytes = 64 << 20;
    limits.seconds = 1;
    EXPECT_EQ(refusalOf([] { return std::string(std::size_t{1} << 30, 'x'); }, limits),
              "work: it needs more memory than an import may take");
    EXPECT_EQ(refusalOf(
                  []() -> std::string {
                      for (volatile int i = 0;;) i = i + 1;
                  },
                  limits),
              "work: its reader took too long or too much memory");
}

TEST(ConfinedProcess, CannotWriteFiles)
{
    const test::TemporaryFolder folder;
    const std::string path = (folder / "written").string();
    refusalOf([&]() -> std::string {
        std::signal(SIGXFSZ, SIG_IGN);
        std::ofstream(path) << "something";
        return "";
    });
    std::ifstream stream(path);
    EXPECT_EQ(stream.peek(), std::ifstream::traits_type::eof());
}

TEST(MeshImport, GivesTheNodesOfAGltfWithTheirScaleBakedAndItsUnit)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const ImportedFile file = importFile((folder / "set.gltf").string());
    ASSERT_EQ(file.nodes.size(), 3u);
    EXPECT_EQ(file.metresPerUnit, 1.0);
    EXPECT_EQ(file.nodes[0].name, "Mug.big");
    EXPECT_TRUE(file.nodes[0].fileFromNode.position.isApprox(Vec3(1, 2, 3), 1e-6));
    EXPECT_TRUE((file.nodes[0].fileFromNode * Vec3(0, 1, 0)).isApprox(Vec3(1, 1, 3), 1e-6));
    EXPECT_NEAR(signedVolume(file.nodes[0].mesh), 8.0 / 6.0, 1e-6);
    EXPECT_DOUBLE_EQ(signedVolume(file.nodes[1].mesh), 1.0 / 6.0);
}

TEST(MeshImport, RefusesReferencesOutsideTheFolder)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    std::filesystem::create_directory(folder / "inner");
    const std::string path = (folder / "inner/set.gltf").string();
    std::ofstream(path) << test::gltfText("../data.bin");
    try {
        importFile(path);
        FAIL() << "the buffer of another folder was read";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("outside its own folder"), std::string::npos)
            << error.what();
    }
}

TEST(MeshImport, RefusesWhatExceedsACapAndSaysWhichFlagRaisesIt)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const std::string path = (folder / "set.gltf").string();
    const auto refusal = [&](std::uint32_t ImportLimits::*cap, std::uint32_t most) -> std::string {
        ImportLimits limits;
        limits.*cap = most;
        try {
            importFile(path, limits);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::badInput);
            return error.what();
        }
        return "not refused";
    };
    const std::string file = "mesh file '" + path + "' ";
    EXPECT_EQ(refusal(&ImportLimits::points, 3), file + "has more than 3 points (--import-points)");
    EXPECT_EQ(refusal(&ImportLimits::nodes, 2), file + "has more than 2 nodes (--import-nodes)");
    EXPECT_EQ(refusal(&ImportLimits::nameLength, 8),
              file + "has more than 8 letters in a name (--import-name)");
    // Three nodes side by side, of four points each and names of nine letters.
    EXPECT_EQ(refusal(&ImportLimits::points, 4), "not refused");
    EXPECT_EQ(refusal(&ImportLimits::nodes, 3), "not refused");
    EXPECT_EQ(refusal(&ImportLimits::nameLength, 9), "not refused");
    // The same below each other.
    std::string chain = test::gltfText("data.bin");
    chain.replace(chain.find("\"nodes\":[0,1,2]"), 15, "\"nodes\":[0]");
    chain.replace(chain.find("\"mesh\":0"), 8, "\"mesh\":0,\"children\":[1]");
    const std::size_t second = chain.find("\"mesh\":0", chain.find("Mug.small"));
    chain.replace(second, 8, "\"mesh\":0,\"children\":[2]");
    std::ofstream(path) << chain;
    EXPECT_EQ(refusal(&ImportLimits::depth, 1),
              file + "cannot be read: its nodes are nested deeper than 1 (--import-depth)");
    EXPECT_EQ(refusal(&ImportLimits::depth, 2), "not refused");
}

std::string shotOf(const test::TemporaryFolder& folder, const std::string& nodes)
{
    return "scree = 1\n[shot]\nname = \"s\"\nunits = \"cm\"\n[material.wood]\n[[import]]\nfile = "
           "\"" +
           (folder / "set.gltf").string() + "\"\nmaterial = \"wood\"\nnodes = " + nodes + "\n";
}

TEST(ShotImport, KeepsTheCapsOfWhoAsked)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const std::string text = shotOf(folder, "\"*\"");
    ImportLimits limits;
    limits.nodes = 2;
    EXPECT_THROW(parseShotText(text, "s.toml", {}, limits), Error);
    limits = {};
    limits.points = 3;
    const std::string shape =
        "scree = 1\n[shot]\nname = \"s\"\n[material.m]\n[shape.a]\nfile = \"" +
        (folder / "set.gltf").string() +
        "\"\n[[body]]\nname = \"b\"\nshape = \"a\"\nmaterial = \"m\"\n";
    const Shot shot = parseShotText(shape, "s.toml", {}, limits);
    EXPECT_THROW(buildWorld(shot), Error) << "shapes are read when the world is built";
}

TEST(ShotImport, MakesABodyOfEveryNodeThatAPatternFits)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const Shot shot = parseShotText(shotOf(folder, "[\"Mug*\", \"B?wl\"]"), "s.toml");
    ASSERT_EQ(shot.bodies.size(), 3u);
    EXPECT_EQ(shot.bodies[0].name, "Mug_big");
    EXPECT_EQ(shot.bodies[1].name, "Mug_small");
    EXPECT_EQ(shot.shapes.size(), 2u) << "two nodes show the same mesh";
    // glTF is in metres, whatever the shot's unit.
    EXPECT_TRUE(shot.bodies[1].worldFromAsset.position.isApprox(Vec3(0, 5, 0), 1e-6));
    const World world = buildWorld(shot);
    EXPECT_NEAR(world.shapeOf(0).unitMass.volume, 8.0 / 6.0, 1e-6);
}

TEST(ShotImport, APatternThatFitsNothingIsAnError)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    try {
        parseShotText(shotOf(folder, "[\"Mug*\", \"Bowls\"]"), "s.toml");
        FAIL() << "no node is called Bowls";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "s.toml:9:18: no node of '" + (folder / "set.gltf").string() +
                      "' is called \"Bowls\"; did you mean 'Bowl'? (it has: Mug.big, Mug.small, "
                      "Bowl)");
    }
}

}  // namespace
}  // namespace scree
