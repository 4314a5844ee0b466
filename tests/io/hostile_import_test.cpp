// Files that were made to hurt, by accident or not, end in an ordinary error: the parser of foreign
// formats lives in a process of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "core/base/error.h"
#include "io/build_world.h"
#include "io/confined_process.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/refusal.h"
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
              "work: it needs more memory than the 64 MB that an import may take; a damaged header "
              "may ask for them");
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

/// The nodes of small_gltf.h replaced by others that show the same tetrahedron.
ImportedFile importNodes(const test::TemporaryFolder& folder, const std::string& roots,
                         const std::string& nodes, const std::string& accessors = "",
                         const std::string& more = "")
{
    test::writeGltf(folder);
    std::string text = test::gltfText("data.bin");
    text.replace(text.find("[0,1,2]"), 7, roots);
    const std::size_t begin = text.find("\"nodes\":[\n") + 9, end = text.find("],\n\"meshes\"");
    text.replace(begin, end - begin, nodes);
    text.insert(text.find("],\n\"bufferViews\""), accessors);
    text.insert(text.rfind('}'), more);
    std::ofstream(folder / "set.gltf") << text;
    return importFile((folder / "set.gltf").string());
}

TEST(MeshImport, PointsOfAShearedNodeAreWhereTheFileHasThem)
{
    const test::TemporaryFolder folder;
    // Turned by 45 degrees about z under a scale of (1, 3, 0.5).
    const ImportedFile file = importNodes(folder, "[0]",
                                          R"({"name":"root","scale":[1,3,0.5],"children":[1]},
{"name":"leaf","mesh":0,"rotation":[0,0,0.3826834323650898,0.9238795325112867]})");
    ASSERT_EQ(file.nodes.size(), 1u);
    const ImportedNode& leaf = file.nodes[0];
    const double h = std::sqrt(0.5);
    Points expected(3, 4);
    expected.transpose() << 0, 0, 0, h, 3 * h, 0, -h, 3 * h, 0, 0, 0, 0.5;
    for (Eigen::Index i = 0; i < 4; ++i) {
        const Vec3 there = leaf.fileFromNode * leaf.mesh.points.col(i);
        EXPECT_LE((there - expected.col(i)).norm(), 1e-6) << i;
    }
}

TEST(MeshImport, NodesThatShowOneMeshTurnedShareItToTheBit)
{
    const test::TemporaryFolder folder;
    std::string nodes = R"({"name":"root","rotation":[0.1,0.2,0.3,0.9273618495495704],
"scale":[1.7,1.7,1.7],"children":[1,2,3,4,5,6,7,8]})";
    for (int i = 1; i <= 8; ++i) {
        const double angle = 0.37 * i;
        nodes += ",\n{\"name\":\"n" + std::to_string(i) + "\",\"mesh\":0,\"rotation\":[0," +
                 std::to_string(std::sin(angle)) + ",0," + std::to_string(std::cos(angle)) + "]}";
    }
    const ImportedFile file = importNodes(folder, "[0]", nodes);
    ASSERT_EQ(file.nodes.size(), 8u);
    for (const ImportedNode& node : file.nodes)
        EXPECT_EQ(node.mesh.points, file.nodes[0].mesh.points) << node.name;
}

TEST(MeshImport, AGltfWhoseCopiesOrPointsWouldBeLostIsRefused)
{
    const test::TemporaryFolder folder;
    const char* nodes = R"({"name":"a","mesh":0})";
    for (const std::string extension : {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization"}) {
        const test::Refusal refusal = test::refusalBy([&] {
            importNodes(folder, "[0]", nodes, "", ",\"extensionsUsed\":[\"" + extension + "\"]");
        });
        EXPECT_EQ(refusal.kind, ErrorKind::badInput);
        EXPECT_TRUE(refusal.mentions("it uses the glTF extension " + extension)) << refusal.message;
    }
    // What only looks otherwise is no reason.
    importNodes(folder, "[0]", nodes, "", ",\"extensionsUsed\":[\"KHR_materials_ior\"]");
}

TEST(MeshImport, AnAnimationThatMayMeanEitherOfTwoNodesIsNotPlayed)
{
    const test::TemporaryFolder folder;
    const char* nodes = R"({"name":"dup","mesh":0},{"name":"dup","mesh":0})";
    EXPECT_EQ(importNodes(folder, "[0,1]", nodes).nodes.size(), 2u);
    const char* times = R"(,{"bufferView":0,"byteOffset":8,"componentType":5126,"count":2,
"type":"SCALAR","min":[0],"max":[1]},{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"})";
    const char* animation = R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":1,
"path":"translation"}}],"samplers":[{"input":2,"output":3}]}])";
    // Where they stand is told all the same.
    const ImportedFile file = importNodes(folder, "[0,1]", nodes, times, animation);
    ASSERT_EQ(file.nodes.size(), 2u);
    for (const ImportedNode& node : file.nodes) {
        EXPECT_TRUE(node.keys.empty());
        EXPECT_TRUE(node.obstacle.starts_with("several nodes are called 'dup'")) << node.obstacle;
    }
}

TEST(MeshImport, APlyThatEndsInItsHeaderIsRefusedAtOnce)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "cut.ply") << "ply\nformat ascii 1.0\nelement vertex 4\n";
    const test::Refusal refusal =
        test::refusalBy([&] { importFile((folder / "cut.ply").string()); });
    EXPECT_TRUE(refusal.mentions("cut short")) << refusal.message;
}

TEST(MeshImport, AnObjWithoutItsMaterialsIsReadFromItsOwnFolder)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.obj") << "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                       "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(std::filesystem::path(folder / "a.obj").parent_path());
    EXPECT_NO_THROW(importFile("a.obj"));
    std::filesystem::current_path(before);
}

TEST(MeshImport, RefusesReferencesOutsideTheFolder)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    std::filesystem::create_directory(folder / "inner");
    const std::string path = (folder / "inner/set.gltf").string();
    std::ofstream(path) << test::gltfText("../data.bin");
    const test::Refusal refusal = test::refusalBy([&] { importFile(path); });
    EXPECT_TRUE(refusal.mentions("outside its own folder")) << refusal.message;
}

TEST(MeshImport, RefusesWhatExceedsACapAndSaysWhichFlagRaisesIt)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const std::string path = (folder / "set.gltf").string();
    const auto messageWith = [&](std::uint32_t ImportLimits::*cap,
                                 std::uint32_t most) -> std::string {
        ImportLimits limits;
        limits.*cap = most;
        const test::Refusal refusal = test::refusalBy([&] { importFile(path, limits); });
        EXPECT_EQ(refusal.kind.value_or(ErrorKind::badInput), ErrorKind::badInput);
        return refusal.message;
    };
    const std::string file = "mesh file '" + path + "' ";
    EXPECT_EQ(messageWith(&ImportLimits::points, 3),
              file + "has more than 3 points (--import-points)");
    EXPECT_EQ(messageWith(&ImportLimits::nodes, 2),
              file + "has more than 2 nodes (--import-nodes)");
    EXPECT_EQ(messageWith(&ImportLimits::nameLength, 8),
              file + "has more than 8 letters in a name (--import-name)");
    // Three nodes side by side, of four points each and names of nine letters.
    EXPECT_EQ(messageWith(&ImportLimits::points, 4), "nothing was thrown");
    EXPECT_EQ(messageWith(&ImportLimits::nodes, 3), "nothing was thrown");
    EXPECT_EQ(messageWith(&ImportLimits::nameLength, 9), "nothing was thrown");
    // The same below each other.
    std::string chain = test::gltfText("data.bin");
    chain.replace(chain.find("\"nodes\":[0,1,2]"), 15, "\"nodes\":[0]");
    chain.replace(chain.find("\"mesh\":0"), 8, "\"mesh\":0,\"children\":[1]");
    const std::size_t second = chain.find("\"mesh\":0", chain.find("Mug.small"));
    chain.replace(second, 8, "\"mesh\":0,\"children\":[2]");
    std::ofstream(path) << chain;
    EXPECT_EQ(messageWith(&ImportLimits::depth, 1),
              file + "cannot be read: its nodes are nested deeper than 1 (--import-depth)");
    EXPECT_EQ(messageWith(&ImportLimits::depth, 2), "nothing was thrown");
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

/// A tetrahedron without a side.
void writeOpenGltf(const test::TemporaryFolder& folder)
{
    test::writeGltf(folder);
    std::string text = test::gltfText("data.bin");
    text.replace(text.find("\"count\":12"), 10, "\"count\":9");
    std::ofstream(folder / "set.gltf") << text;
}

TEST(ShotImport, AMeshThatIsNoSolidIsToldWhereItsRepairCanBeWritten)
{
    const test::TemporaryFolder folder;
    writeOpenGltf(folder);
    const test::Refusal refusal =
        test::refusalBy([&] { buildWorld(parseShotText(shotOf(folder, "\"Bowl\""), "s.toml")); });
    EXPECT_TRUE(refusal.mentions("a key of an [[import]] holds for all of its nodes"))
        << refusal.message;
}

// A name of 250 letters made a take whose mesh could not be written, exit code 73.
TEST(ShotImport, ALongNameIsCutToWhatAFileCanHave)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    std::string text = test::gltfText("data.bin");
    for (const char* name : {"Mug.big", "Mug.small"})
        text.replace(text.find(name), std::string(name).size(), std::string(250, 'm'));
    std::ofstream(folder / "set.gltf") << text;
    const Shot shot = parseShotText(shotOf(folder, "\"m*\""), "s.toml");
    ASSERT_EQ(shot.bodies.size(), 2u);
    EXPECT_EQ(shot.bodies[0].name, std::string(200, 'm'));
    EXPECT_EQ(shot.bodies[1].name, std::string(200, 'm') + "_2");
    for (const ShotShape& shape : shot.shapes) EXPECT_LT(shape.name.size(), 210u);
}

// "Its reader crashed (Segmentation fault)" told nobody what to export otherwise.
TEST(ShotImport, ASkinWithoutBindMatricesIsToldWithItsNode)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    std::string text = test::gltfText("data.bin");
    text.replace(text.find("\"name\":\"Bowl\""), 13, "\"name\":\"Bowl\",\"skin\":0");
    text.insert(text.find("\"meshes\""), "\"skins\":[{\"joints\":[0]}],");
    std::ofstream(folder / "set.gltf") << text;
    const test::Refusal refusal =
        test::refusalBy([&] { parseShotText(shotOf(folder, "\"Mug*\""), "s.toml"); });
    EXPECT_TRUE(refusal.mentions("bones bend its node 'Bowl' without")) << refusal.message;
}

// Pieces of a broken vase came with fields of 25 MB each, and an open mesh of a set could not be
// closed, because an [[import]] had none of the keys of a shape.
TEST(ShotImport, SaysForAllItsNodesHowTheyCollide)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const std::string keys = "sdf = { voxel = 2 }\nnormals = \"smooth\"\nedge_samples = true\n";
    const Shot shot = parseShotText(shotOf(folder, "\"*\"") + keys, "s.toml");
    ASSERT_FALSE(shot.shapes.empty());
    for (const ShotShape& shape : shot.shapes) {
        EXPECT_EQ(shape.settings.voxel, 0.02) << "the shot is in centimetres";
        EXPECT_EQ(shape.settings.normals, NormalMode::smooth);
        EXPECT_EQ(shape.settings.edgeSamples, true);
        EXPECT_EQ(shape.settings.field, FieldMode::refined);
    }
    EXPECT_EQ(
        parseShotText(shotOf(folder, "\"*\"") + "[solver]\nmethod = \"paper\"\nstrict = true\n",
                      "s.toml")
            .shapes.front()
            .settings.field,
        FieldMode::grid);
}

TEST(ShotImport, ClosesAnOpenNodeWhenAsked)
{
    const test::TemporaryFolder folder;
    writeOpenGltf(folder);
    const std::string keys = "mesh = { repair = \"wrap\" }\nsdf = { resolution = 32 }\n";
    const World world = buildWorld(parseShotText(shotOf(folder, "\"Bowl\"") + keys, "s.toml"));
    EXPECT_EQ(world.shapeOf(0).repairs.asked, MeshRepair::wrap);
    EXPECT_NEAR(world.shapeOf(0).unitMass.volume, 1.0 / 6.0, 0.03);
}

TEST(ShotImport, GivesAllItsBodiesAGroupAndAVelocity)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const Shot shot = parseShotText(
        shotOf(folder, "\"Mug*\"") +
            "group = \"set\"\nvelocity = [0, -200, 0]\n[[import]]\nfile = \"" +
            (folder / "set.gltf").string() +
            "\"\nnodes = \"Bowl\"\nmaterial = \"wood\"\nunmoved_by = [\"set\"]\ncollides = []\n",
        "s.toml");
    ASSERT_EQ(shot.bodies.size(), 3u);
    EXPECT_EQ(shot.bodies[1].velocity, Vec3(0, -2, 0));
    EXPECT_EQ(shot.bodies[1].groups.group, shot.bodies[0].groups.group);
    EXPECT_EQ(shot.bodies[2].groups.unmovedBy, shot.bodies[0].groups.group);
    EXPECT_EQ(shot.bodies[2].groups.collidesWith, 0u);
    EXPECT_EQ(shot.bodies[2].velocity, Vec3(Vec3::Zero()));
}

TEST(ShotImport, BracketsInANameStandForThemselves)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "tiles.obj")
        << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no Tile1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
           "v 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\no Tile[1]\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    const std::string head =
        "scree = 1\n[shot]\nname = \"s\"\n[material.wood]\n[[import]]\nfile = \"" +
        (folder / "tiles.obj").string() + "\"\nmaterial = \"wood\"\nnodes = ";
    const Shot shot = parseShotText(head + "\"Tile[1]\"\n", "s.toml");
    ASSERT_EQ(shot.bodies.size(), 1u);
    EXPECT_GT(buildWorld(shot).motion[0].position.x(), 4.0);
    EXPECT_EQ(parseShotText(head + "\"Tile?1?\"\n", "s.toml").bodies.size(), 1u);
    EXPECT_EQ(parseShotText(head + "\"Tile*\"\n", "s.toml").bodies.size(), 2u);
}

TEST(ShotImport, WhatIsWrongWithAllItsBodiesIsToldOnce)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const std::string keys = "motion = \"static\"\nvelocity = [1, 0, 0]\n";
    const std::string told = "only dynamic bodies have a 'velocity'";
    const std::string message =
        test::refusalBy([&] { parseShotText(shotOf(folder, "\"*\"") + keys, "s.toml"); }).message;
    const std::size_t first = message.find(told);
    ASSERT_NE(first, std::string::npos) << message;
    EXPECT_EQ(message.find(told, first + 1), std::string::npos) << message;
}

TEST(ShotImport, APatternThatFitsNothingIsAnError)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const test::Refusal refusal =
        test::refusalBy([&] { parseShotText(shotOf(folder, "[\"Mug*\", \"Bowls\"]"), "s.toml"); });
    EXPECT_EQ(refusal.message,
              "s.toml:9:18: no node of '" + (folder / "set.gltf").string() +
                  "' is called \"Bowls\"; did you mean 'Bowl'? (it has: Mug.big, Mug.small, "
                  "Bowl)");
}

// What stands in a file that is not read here is lost without a word; assimp reads on where a
// letter is none.
TEST(MeshImport, AGltfWhoseWordsCannotBeReadIsRefused)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    std::string text = test::gltfText("data.bin");
    text.replace(text.find("Bowl"), 4, "B\xf6wl");
    std::ofstream(folder / "latin.gltf") << text;
    const auto refusal = test::refusalBy([&] { importFile(folder / "latin.gltf"); });
    EXPECT_EQ(refusal.kind, ErrorKind::badInput);
    EXPECT_TRUE(refusal.mentions("its JSON is damaged")) << refusal.message;

    // Zeros at the end are what some programs fill up with.
    std::string filled = test::gltfText("data.bin");
    filled.insert(filled.rfind('}'), R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])");
    std::ofstream(folder / "filled.gltf") << filled << std::string(3, '\0');
    const auto lost = test::refusalBy([&] { importFile(folder / "filled.gltf"); });
    EXPECT_TRUE(lost.mentions("EXT_mesh_gpu_instancing")) << lost.message;
    std::ofstream(folder / "zeros.gltf") << test::gltfText("data.bin") << std::string(3, '\0');
    EXPECT_EQ(importFile(folder / "zeros.gltf").nodes.size(), 3u);
}

// Asset stores keep each file under the hash of its bytes, and a folder of links for people.
TEST(MeshImport, AnAssetOfLinksIsReadThoughTheyLeadApart)
{
    const test::TemporaryFolder store, folder;
    test::writeGltf(store);
    std::filesystem::create_directory(store / "f3");
    std::filesystem::rename(store / "data.bin", store / "f3/9a");
    std::filesystem::create_symlink(store / "f3/9a", folder / "data.bin");
    std::filesystem::create_symlink(store / "set.gltf", folder / "set.gltf");
    EXPECT_EQ(importFile(folder / "set.gltf").nodes.size(), 3u);
}

// Names grew by a letter for each: what a file of many rocks made was no name for a file.
TEST(ShotImport, ManyMeshesOfOneNameAreNumbered)
{
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    const auto nodes = [](const std::string& scale) {
        return R"({"name":"Rock","mesh":0,"scale":)" + scale + "},";
    };
    std::string text = test::gltfText("data.bin");
    const std::size_t begin = text.find("{\"name\":\"Mug.big\""), end = text.find("],\n\"meshes\"");
    text.replace(begin, end - begin,
                 nodes("[1,1,1]") + nodes("[2,2,2]") + nodes("[1,1,1]") +
                     R"({"name":"Rock","mesh":0,"scale":[3,3,3]})");
    text.replace(text.find("[0,1,2]}],\"nodes\""), 7, "[0,1,2,3]");
    std::ofstream(folder / "rocks.gltf") << text;
    const Shot shot = parseShotText(
        "scree = 1\n[shot]\nname = \"s\"\n[material.m]\n[[import]]\n"
        "material = \"m\"\nfile = \"" +
            (folder / "rocks.gltf").string() + "\"\n",
        "s.toml");
    std::vector<std::string> bodies, shapes;
    for (const ShotBody& body : shot.bodies) bodies.push_back(body.name + ":" + *body.shape);
    for (const ShotShape& shape : shot.shapes) shapes.push_back(shape.name);
    EXPECT_EQ(bodies, (std::vector<std::string>{"Rock:Rock", "Rock_2:Rock_2", "Rock_3:Rock",
                                                "Rock_4:Rock_3"}));
    EXPECT_EQ(shapes, (std::vector<std::string>{"Rock", "Rock_2", "Rock_3"}));
}

}  // namespace
}  // namespace scree
