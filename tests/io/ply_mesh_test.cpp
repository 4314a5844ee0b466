#include "io/ply_mesh.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/base/error.h"
#include "io/file_bytes.h"
#include "tests/support/export_scene.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

TriMesh smallMesh(bool hasUvs = false)
{
    const SceneMesh mesh = hasUvs ? test::texturedTetrahedron() : test::tetrahedron();
    return {mesh.points / 3.0, mesh.triangles, mesh.cornerUvs / 3.0f};
}

using test::contentOf;

void expectDamaged(const fs::path& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
    const test::Refusal refusal = test::refusalBy([&] { readPlyMesh(path); });
    EXPECT_EQ(refusal.kind, ErrorKind::inputOutput) << refusal.message;
}

TEST(PlyMesh, ReadsBackEveryBit)
{
    const test::TemporaryFolder folder;
    for (const bool hasUvs : {false, true}) {
        const TriMesh written = smallMesh(hasUvs);
        writeFileBytes(folder / "a.ply", encodePlyMesh(written));
        const TriMesh read = readPlyMesh(folder / "a.ply");
        EXPECT_EQ(read.points, written.points);
        EXPECT_EQ(read.triangles, written.triangles);
        ASSERT_EQ(read.cornerUvs.cols(), hasUvs ? 12 : 0);
        EXPECT_TRUE(read.cornerUvs == written.cornerUvs);
    }
}

TEST(PlyMesh, AnEmptyMeshIsAMesh)
{
    const test::TemporaryFolder folder;
    writeFileBytes(folder / "a.ply", encodePlyMesh({Points(3, 0), Triangles(3, 0)}));
    EXPECT_EQ(readPlyMesh(folder / "a.ply").points.cols(), 0);
}

TEST(PlyMesh, CutAnywhereItIsDamaged)
{
    const test::TemporaryFolder folder;
    for (const bool hasUvs : {false, true}) {
        writeFileBytes(folder / "a.ply", encodePlyMesh(smallMesh(hasUvs)));
        const std::string bytes = contentOf(folder / "a.ply");
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            expectDamaged(folder / "cut.ply", bytes.substr(0, length));
        }
        expectDamaged(folder / "cut.ply", bytes + "x");
    }
}

TEST(PlyMesh, CountsAndCornersThatCannotBeAreDamage)
{
    const test::TemporaryFolder folder;
    writeFileBytes(folder / "a.ply", encodePlyMesh(smallMesh()));
    const std::string bytes = contentOf(folder / "a.ply");

    std::string huge = bytes;
    huge.replace(huge.find("vertex 4"), 8, "vertex 768614336404564651");
    expectDamaged(folder / "b.ply", huge);

    std::string corner = bytes;
    corner[corner.size() - 4] = 4;  // the last corner names a fifth point
    expectDamaged(folder / "b.ply", corner);

    std::string quad = bytes;
    quad[quad.size() - 13] = 4;
    expectDamaged(folder / "b.ply", quad);
}

TEST(PlyMesh, TextureCoordinatesThatCannotBeAreDamage)
{
    const test::TemporaryFolder folder;
    writeFileBytes(folder / "a.ply", encodePlyMesh(smallMesh(true)));
    const std::string bytes = contentOf(folder / "a.ply");

    std::string count = bytes;
    count[count.size() - 25] = 5;
    expectDamaged(folder / "b.ply", count);

    std::string infinite = bytes;
    infinite.replace(infinite.size() - 4, 4, std::string("\x00\x00\x80\x7f", 4));
    expectDamaged(folder / "b.ply", infinite);
}

TEST(PlyMesh, AMeshWithoutTextureCoordinatesIsWrittenAsItEverWas)
{
    // Takes are compared by the hashes of these files: those of before must still be equal.
    const test::TemporaryFolder folder;
    writeFileBytes(folder / "a.ply", encodePlyMesh(smallMesh()));
    const std::string bytes = contentOf(folder / "a.ply");
    EXPECT_EQ(bytes.find("texcoord"), std::string::npos);
    EXPECT_EQ(bytes.size() - (bytes.find("end_header\n") + 11), 4 * 24 + 4 * 13u);
}

TEST(PlyMesh, AMissingFileIsSaidToBeMissing)
{
    const test::TemporaryFolder folder;
    const test::Refusal refusal = test::refusalBy([&] { readPlyMesh(folder / "none.ply"); });
    EXPECT_EQ(refusal.kind, ErrorKind::missingInput);
}

}  // namespace
}  // namespace scree
