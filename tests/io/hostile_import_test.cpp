// Files that were made to hurt, by accident or not, end in an ordinary error: the parser of foreign
// formats lives in a process of its own.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>

#include "core/base/error.h"
#include "core/base/random.h"
#include "io/build_world.h"
#include "io/confined_process.h"
#include "io/frame_writer.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
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

/// A tetrahedron as glTF with its bytes in a file called `buffer`, under a node that turns it
/// upside down, moves and doubles it; shown by two more nodes as it is.
std::string gltfText(const std::string& buffer)
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],"nodes":[
{"name":"Mug.big","mesh":0,"translation":[1,2,3],"rotation":[1,0,0,0],"scale":[2,2,2]},
{"name":"Mug.small","mesh":0,"translation":[0,5,0]},{"name":"Bowl","mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5125,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48}],
"buffers":[{"byteLength":96,"uri":")" +
           buffer + "\"}]}";
}

void writeGltf(const test::TemporaryFolder& folder)
{
    const float points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::uint32_t corners[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    std::ofstream data(folder / "data.bin", std::ios::binary);
    data.write(reinterpret_cast<const char*>(points), sizeof points);
    data.write(reinterpret_cast<const char*>(corners), sizeof corners);
    std::ofstream(folder / "set.gltf") << gltfText("data.bin");
}

TEST(MeshImport, GivesTheNodesOfAGltfWithTheirScaleBakedAndItsUnit)
{
    const test::TemporaryFolder folder;
    writeGltf(folder);
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
    writeGltf(folder);
    std::filesystem::create_directory(folder / "inner");
    const std::string path = (folder / "inner/set.gltf").string();
    std::ofstream(path) << gltfText("../data.bin");
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
    writeGltf(folder);
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
    std::string chain = gltfText("data.bin");
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
    writeGltf(folder);
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
    writeGltf(folder);
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
    writeGltf(folder);
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

/// Clean files to mutate, one of each format that can be made here.
std::map<std::string, std::string> cleanFiles()
{
    std::map<std::string, std::string> files;
    files["obj"] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    files["stl"] =
        "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"
        "endloop\nendfacet\nendsolid t\n";
    files["ply"] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 2 1\n";
    files["gltf"] = gltfText("data.bin");
    files["fbx"] =
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {\n FBXVersion: 7400\n}\nObjects: {\n"
        " Geometry: 1, \"Geometry::t\", \"Mesh\" {\n  Vertices: *9 {\n   a: 0,0,0,1,0,0,0,1,0\n  "
        "}\n"
        "  PolygonVertexIndex: *3 {\n   a: 0,1,-3\n  }\n  GeometryVersion: 124\n }\n"
        " Model: 2, \"Model::t\", \"Mesh\" {\n  Version: 232\n }\n}\nConnections: {\n"
        " C: \"OO\",1,2\n C: \"OO\",2,0\n}\n";
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("body")});
    SceneCamera camera;
    camera.keys = {{1.0, {0, 2, 9}, {0, 0, 0}, 40.0, {0, 1, 0}},
                   {2.0, {4, 2, 9}, {0, 0, 0}, 20.0, {1, 1, 0}}};
    scene.cameras = {camera};
    for (const std::string ending : {"glb", "abc"}) {
        const auto writer = makeFrameWriter(folder / ("t." + ending));
        writer->begin(scene, 1, 2);
        for (const int frame : {1, 2}) writer->write(test::tumblingFrame(scene, frame, 1));
        writer->finish();
        std::ifstream stream(folder / ("t." + ending), std::ios::binary);
        files[ending] = std::string(std::istreambuf_iterator<char>(stream), {});
    }
    return files;
}

/// Overwrites, cuts out, repeats or cuts off; every choice a hash of what it is for.
std::string mutated(std::string bytes, std::uint64_t number)
{
    const std::uint64_t changes = 1 + randomIndex(4, number, 0);
    for (std::uint64_t k = 1; k <= changes && !bytes.empty(); ++k) {
        const auto draw = [&](std::uint64_t most, std::uint64_t what) {
            return randomIndex(most, number, k, what);
        };
        const std::size_t at = draw(bytes.size(), 0), length = 1 + draw(16, 1);
        switch (draw(5, 2)) {
            case 0:
                bytes[at] = static_cast<char>(draw(256, 3));
                break;
            case 1:
                bytes.erase(at, length);
                break;
            case 2:
                bytes.insert(at, bytes.substr(draw(bytes.size(), 4), length));
                break;
            case 3:
                bytes.resize(at);
                break;
            default:
                bytes.replace(at, 1, draw(2, 5) == 0 ? "4294967295" : "-1e30");
        }
    }
    return bytes;
}

// The long form: SCREE_FUZZ=10000 build/scree_io_tests --gtest_filter='*Mutated*'
TEST(MeshImport, MutatedFilesNeverCrashOrHangTheProgram)
{
    const char* wanted = std::getenv("SCREE_FUZZ");
    const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 300;
    ImportLimits limits;
    limits.process.clockSeconds = 0.2;  // a third of the cut PLY files keep it busy for ever
    limits.process.memoryBytes = 512 << 20;
    const test::TemporaryFolder folder;
    writeGltf(folder);
    for (const auto& [ending, clean] : cleanFiles()) {
        std::map<std::string, int> outcomes;
        const std::string path = (folder / ("mutant." + ending)).string();
        for (std::uint64_t number = 0; number <= count; ++number) {
            // Number 0 is the clean file, so that the test is known to reach the parser.
            std::ofstream(path, std::ios::binary) << (number == 0 ? clean : mutated(clean, number));
            try {
                importFile(path, number == 0 ? ImportLimits() : limits);
                ++outcomes["read"];
            } catch (const Error& error) {
                ASSERT_EQ(error.kind(), ErrorKind::badInput) << error.what();
                const bool isCrash = std::strstr(error.what(), "crashed") != nullptr;
                const bool isStopped = std::strstr(error.what(), "too long or") != nullptr;
                ++outcomes[isCrash ? "crashed" : isStopped ? "stopped" : "refused"];
            }
            if (number > 0) continue;
            EXPECT_EQ(outcomes["read"], 1) << ending << " before any mutation";
        }
        std::printf("%s: %d read, %d refused, %d readers crashed, %d stopped\n", ending.c_str(),
                    outcomes["read"], outcomes["refused"], outcomes["crashed"],
                    outcomes["stopped"]);
    }
}

TEST(ShotParser, MutatedShotsAreReadOrRefusedWithTheirPlace)
{
    const char* wanted = std::getenv("SCREE_FUZZ");
    const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 300;
    int read = 0, refused = 0;
    for (const std::string name : {"gears", "card_house", "dump_truck", "crockery"}) {
        const std::filesystem::path path = test::sourceFile("shots/" + name + ".toml");
        std::ifstream stream(path, std::ios::binary);
        const std::string clean(std::istreambuf_iterator<char>(stream), {});
        for (std::uint64_t number = 0; number <= count; ++number) {
            try {
                parseShotText(number == 0 ? clean : mutated(clean, number), path.string());
                ++read;
            } catch (const Error& error) {
                ++refused;
                const bool isInput =
                    error.kind() == ErrorKind::badInput || error.kind() == ErrorKind::missingInput;
                ASSERT_TRUE(isInput) << error.what();
                ASSERT_NE(std::string(error.what()).find(".toml:"), std::string::npos)
                    << error.what();
            }
        }
    }
    std::printf("shots: %d read, %d refused\n", read, refused);
    EXPECT_GE(read, 4) << "the clean ones";
}

}  // namespace
}  // namespace scree
