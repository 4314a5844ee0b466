// Thousands of files and shots with bytes overwritten, cut out, repeated or cut off: whatever comes
// of them, the program neither crashes nor hangs. What stands behind that is in
// hostile_import_test.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "io/frame_writer.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
#include "tests/support/small_gltf.h"
#include "tests/support/support.h"

namespace scree {
namespace {

template <class Number>
void append(std::string& bytes, Number number)
{
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

constexpr std::array<float, 12> kTetrahedronPoints = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr std::array<std::int32_t, 12> kTetrahedronCorners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

std::string binaryStl()
{
    std::string bytes(80, ' ');
    append(bytes, std::uint32_t{4});
    for (std::size_t corner = 0; corner < 12; ++corner) {
        if (corner % 3 == 0) bytes.append(12, '\0');  // a normal that nobody reads
        const auto first = static_cast<std::size_t>(3 * kTetrahedronCorners[corner]);
        for (std::size_t k = 0; k < 3; ++k) append(bytes, kTetrahedronPoints[first + k]);
        if (corner % 3 == 2) append(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string binaryPly()
{
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n";
    for (const float coordinate : kTetrahedronPoints) append(bytes, coordinate);
    for (std::size_t corner = 0; corner < 12; ++corner) {
        if (corner % 3 == 0) bytes += '\3';
        append(bytes, kTetrahedronCorners[corner]);
    }
    return bytes;
}

/// A record of binary FBX; properties with their letter of type in front.
struct FbxRecord {
    std::string name;
    std::vector<std::string> properties;
    std::vector<FbxRecord> records;
};

std::string fbxText(const std::string& text)
{
    std::string property = "S";
    append(property, static_cast<std::uint32_t>(text.size()));
    return property + text;
}

template <class Number>
std::string fbxNumber(char type, Number number)
{
    std::string property(1, type);
    append(property, number);
    return property;
}

template <class Numbers>
std::string fbxArray(char type, const Numbers& numbers)
{
    std::string property(1, type);
    append(property, static_cast<std::uint32_t>(numbers.size()));
    append(property, std::uint32_t{0});  // not compressed
    append(property, static_cast<std::uint32_t>(numbers.size() * sizeof numbers[0]));
    for (const auto number : numbers) append(property, number);
    return property;
}

void append(std::string& bytes, const FbxRecord& record)
{
    std::string properties;
    for (const std::string& property : record.properties) properties += property;
    const std::size_t start = bytes.size();
    append(bytes, std::uint32_t{0});  // where it ends, known below
    append(bytes, static_cast<std::uint32_t>(record.properties.size()));
    append(bytes, static_cast<std::uint32_t>(properties.size()));
    append(bytes, static_cast<std::uint8_t>(record.name.size()));
    bytes += record.name + properties;
    for (const FbxRecord& inner : record.records) append(bytes, inner);
    if (!record.records.empty()) bytes.append(13, '\0');
    const auto end = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data() + start, &end, sizeof end);
}

std::string binaryFbx()
{
    std::array<double, 12> points;
    std::copy(kTetrahedronPoints.begin(), kTetrahedronPoints.end(), points.begin());
    std::array<std::int32_t, 12> corners = kTetrahedronCorners;
    for (std::size_t last : {2, 5, 8, 11}) corners[last] = -1 - corners[last];
    const auto id = [](std::int64_t number) { return fbxNumber('L', number); };
    const auto small = [](std::int32_t number) { return fbxNumber('I', number); };
    const std::string of = std::string("\0\1", 2);
    const FbxRecord geometry{"Geometry",
                             {id(1), fbxText("t" + of + "Geometry"), fbxText("Mesh")},
                             {{"Vertices", {fbxArray('d', points)}, {}},
                              {"PolygonVertexIndex", {fbxArray('i', corners)}, {}},
                              {"GeometryVersion", {small(124)}, {}}}};
    const FbxRecord model{"Model",
                          {id(2), fbxText("t" + of + "Model"), fbxText("Mesh")},
                          {{"Version", {small(232)}, {}}}};
    const std::vector<FbxRecord> records = {
        {"FBXHeaderExtension", {}, {{"FBXVersion", {small(7400)}, {}}}},
        {"Objects", {}, {geometry, model}},
        {"Connections",
         {},
         {{"C", {fbxText("OO"), id(1), id(2)}, {}}, {"C", {fbxText("OO"), id(2), id(0)}, {}}}}};
    std::string bytes("Kaydara FBX Binary  \0\x1a\0", 23);
    append(bytes, std::uint32_t{7400});
    for (const FbxRecord& record : records) append(bytes, record);
    bytes.append(13, '\0');
    return bytes;
}

/// Clean files to mutate, one of each format that can be made here: by name, in words and, where
/// the format has both, in bytes.
std::map<std::string, std::string> cleanFiles()
{
    std::map<std::string, std::string> files;
    files["bytes.fbx"] = binaryFbx();
    files["bytes.ply"] = binaryPly();
    files["bytes.stl"] = binaryStl();
    files["words.obj"] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    files["words.stl"] =
        "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"
        "endloop\nendfacet\nendsolid t\n";
    files["words.ply"] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 2 1\n";
    files["words.gltf"] = test::gltfText("data.bin");
    files["words.fbx"] =
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
        files["bytes." + ending] = std::string(std::istreambuf_iterator<char>(stream), {});
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
    const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 200;
    ImportLimits limits;
    limits.process.clockSeconds = 0.2;  // a third of the cut PLY files keep it busy for ever
    limits.process.memoryBytes = 512 << 20;
    const test::TemporaryFolder folder;
    test::writeGltf(folder);
    for (const auto& [name, clean] : cleanFiles()) {
        std::map<std::string, int> outcomes;
        const std::string path = (folder / name).string();
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
            EXPECT_EQ(outcomes["read"], 1) << name << " before any mutation";
        }
        EXPECT_LT(outcomes["read"], static_cast<int>(count / 2)) << name << " is hardly harmed";
        std::printf("%s: %d read, %d refused, %d readers crashed, %d stopped\n", name.c_str(),
                    outcomes["read"], outcomes["refused"], outcomes["crashed"],
                    outcomes["stopped"]);
    }
}

TEST(ShotParser, MutatedShotsAreReadOrRefusedWithTheirPlace)
{
    const char* wanted = std::getenv("SCREE_FUZZ");
    const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 200;
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
    EXPECT_GT(refused, read) << "most are harmed";
}

}  // namespace
}  // namespace scree
