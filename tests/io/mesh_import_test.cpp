#include "io/mesh_import.h"
#include "core/geometry/mesh_defects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "io/mesh_import_bytes.h"
#include "tests/support/export_scene.h"
#include "tests/support/import_mesh.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

/// A unit cube of six squares, corners at 0 and 1, in two groups and with texture coordinates, as
/// modelling packages write it.
const char* const kCubeObj =
    "o first\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv -0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\n"
    "f 4/1 3/2 2/3 1/1\nf 5/1 6/2 7/3 8/1\nf 1/1 2/2 6/3 5/1\n"
    "o second\nf 3/1 4/2 8/3 7/1\nf 2/2 3/2 7/2 6/2\nf 4/3 1/2 5/1 8/1\n";

std::string write(const test::TemporaryFolder& folder, const std::string& name,
                  const std::string& text)
{
    std::ofstream(folder / name) << text;
    return (folder / name).string();
}

/// Kind and message of the error that importing gives.
std::string messageOf(const std::string& path, ErrorKind expected = ErrorKind::badInput)
{
    const test::Refusal refusal = test::refusalBy([&] { test::importMesh(path); });
    EXPECT_EQ(refusal.kind, expected);
    return refusal.message;
}

TEST(MeshImport, JoinsTheObjectsOfAnObjIntoOneClosedMesh)
{
    const test::TemporaryFolder folder;
    const TriMesh cube = test::importMesh(write(folder, "cube.obj", kCubeObj));
    EXPECT_EQ(cube.points.cols(), 8);
    EXPECT_EQ(cube.triangles.cols(), 12);
    EXPECT_TRUE(findDefects(cube).empty());
    EXPECT_DOUBLE_EQ(signedVolume(cube), 1.0);
}

TEST(MeshImport, ObjectsOfAnObjAreToldApartByTheWholeOfTheirNames)
{
    const test::TemporaryFolder folder;
    std::string text = kCubeObj;
    text.replace(text.find("first"), 5, "Left  wheel \r");
    text.replace(text.find("second"), 6, "Left door");
    const ImportedFile file = importFile(write(folder, "cube.obj", text));
    ASSERT_EQ(file.nodes.size(), 2u);
    EXPECT_EQ(file.nodes[0].name, "Left  wheel");
    EXPECT_EQ(file.nodes[1].name, "Left door");
}

TEST(MeshImport, KeepsPositionsToSinglePrecision)
{
    const test::TemporaryFolder folder;
    const TriMesh mesh = test::importMesh(
        write(folder, "t.obj", "v 0.1 -20.5 1e3\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n"));
    EXPECT_EQ(mesh.points.col(0), Vec3(0.1f, -20.5, 1000.0));
}

double surfaceOf(const TriMesh& mesh)
{
    double area = 0.0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Vec3 a = mesh.points.col(mesh.triangles(0, t));
        const Vec3 b = mesh.points.col(mesh.triangles(1, t));
        const Vec3 c = mesh.points.col(mesh.triangles(2, t));
        area += 0.5 * (b - a).cross(c - a).norm();
    }
    return area;
}

// Happened: the notch of an L with arms of one length was covered by a triangle that lay on another
// one, and the mesh was closed and of the right volume.
TEST(MeshImport, AFaceWithANotchKeepsIt)
{
    const test::TemporaryFolder folder;
    const std::string points =
        "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 1\n2 0 1\n2 1 1\n1 1 1\n1 2 1\n0 2 1\n";
    std::string obj = "v " + points, ply;
    for (std::size_t at = obj.find('\n'); at + 1 < obj.size(); at = obj.find('\n', at + 1))
        obj.insert(at + 1, "v ");
    obj += "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
    ply =
        "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\n"
        "property float z\nelement face 8\nproperty list uchar int vertex_indices\nend_header\n" +
        points + "6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n";
    for (int k = 0; k < 6; ++k) {
        const int next = (k + 1) % 6;
        const auto corners = [&](int first) {
            return std::to_string(first + k) + " " + std::to_string(first + next) + " " +
                   std::to_string(first + next + 6) + " " + std::to_string(first + k + 6) + "\n";
        };
        obj += "f " + corners(1);
        ply += "4 " + corners(0);
    }
    for (const std::string& path : {write(folder, "l.obj", obj), write(folder, "l.ply", ply)}) {
        const TriMesh mesh = test::importMesh(path);
        EXPECT_TRUE(findDefects(mesh).empty());
        EXPECT_NEAR(signedVolume(mesh), 3.0, 1e-12);
        EXPECT_NEAR(surfaceOf(mesh), 14.0, 1e-12) << path;
    }
}

TEST(MeshImport, AFaceThatCrossesItselfIsRefusedWhereItIsUsed)
{
    const test::TemporaryFolder folder;
    const std::string path = write(folder, "bow.obj", std::string(kCubeObj) + "o bow\nf 1 7 2 8\n");
    EXPECT_EQ(messageOf(path),
              "mesh file '" + path +
                  "' has a mesh 'bow' that has a face of 4 corners from (0, 0, 0) "
                  "on, which crosses itself or has no area: mend it or cut it into triangles");
    EXPECT_EQ(importFile(path).nodes.at(0).mesh.triangles.cols(), 6);
}

TEST(MeshImport, AFaceOfManyCornersOneOfWhichIsNoPointIsRefused)
{
    const test::TemporaryFolder folder;
    const std::string path =
        write(folder, "torn.ply",
              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
              "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 9999999\n");
    EXPECT_EQ(
        messageOf(path),
        "mesh file '" + path + "' cannot be read: it has a face with a corner that is no point");
}

TEST(MeshImport, ReadsPlyAndStl)
{
    const test::TemporaryFolder folder;
    const TriMesh ply = test::importMesh(
        write(folder, "t.ply",
              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
              "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
    EXPECT_EQ(ply.triangles.cols(), 4);
    EXPECT_TRUE(findDefects(ply).empty());
    EXPECT_DOUBLE_EQ(signedVolume(ply), 1.0 / 6.0);

    const char* const facet = "facet normal 0 0 0\nouter loop\n";
    const std::string stl =
        std::string("solid t\n") + facet +
        "vertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n" + facet +
        "vertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n" + facet +
        "vertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n" + facet +
        "vertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "endsolid t\n";
    const TriMesh fromStl = test::importMesh(write(folder, "t.STL", stl));
    EXPECT_EQ(fromStl.points.cols(), 4);
    EXPECT_DOUBLE_EQ(signedVolume(fromStl), 1.0 / 6.0);
}

/// What the triangles of the plane x_axis = value show at a point.
std::vector<Eigen::Vector2f> uvsAt(const TriMesh& mesh, int axis, double value, const Vec3& point)
{
    std::vector<Eigen::Vector2f> uvs;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        bool isInPlane = true;
        for (const int v : mesh.triangles.col(f)) {
            isInPlane = isInPlane && mesh.points(axis, v) == value;
        }
        for (Eigen::Index k = 0; isInPlane && k < 3; ++k) {
            if (mesh.points.col(mesh.triangles(k, f)) != point) continue;
            uvs.push_back(mesh.cornerUvs.col(3 * f + k));
        }
    }
    return uvs;
}

TEST(MeshImport, APointOnASeamHasTheTextureCoordinatesOfBothSides)
{
    const test::TemporaryFolder folder;
    const TriMesh cube = test::importMesh(write(folder, "cube.obj", kCubeObj));
    ASSERT_EQ(cube.points.cols(), 8);
    ASSERT_EQ(cube.cornerUvs.cols(), 36);
    // Point 3 of the file, (1, 1, 0): "3/2" in the face z = 0, "3/1" in y = 1.
    for (const Eigen::Vector2f& uv : uvsAt(cube, 2, 0.0, {1, 1, 0})) {
        EXPECT_EQ(uv, Eigen::Vector2f(1, 0));
    }
    for (const Eigen::Vector2f& uv : uvsAt(cube, 1, 1.0, {1, 1, 0})) {
        EXPECT_EQ(uv, Eigen::Vector2f(0, 0));
    }
    EXPECT_GT(uvsAt(cube, 2, 0.0, {1, 1, 0}).size(), 0u);
    EXPECT_GT(uvsAt(cube, 1, 1.0, {1, 1, 0}).size(), 0u);
}

TEST(MeshImport, OneOfTwoObjectsMayHaveNoTextureCoordinates)
{
    const test::TemporaryFolder folder;
    const TriMesh mesh = test::importMesh(
        write(folder, "t.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0.5 0.25\no plain\nf 1 3 2\nf 1 2 4\n"
              "o painted\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n"));
    ASSERT_EQ(mesh.cornerUvs.cols(), 12);
    EXPECT_TRUE(mesh.cornerUvs.leftCols(6).isZero(0.0f));
    EXPECT_TRUE((mesh.cornerUvs.rightCols(6).colwise() - Eigen::Vector2f(0.5, 0.25)).isZero(0.0f));
}

/// What the parent says of an answer of the child that `spoil` has been at.
std::string refusalOf(const std::function<void(ImportedNode& node)>& spoil)
{
    ImportedFile file;
    file.nodes.resize(1);
    const SceneMesh mesh = test::texturedTetrahedron();
    file.nodes[0].mesh = {mesh.points, mesh.triangles, mesh.cornerUvs};
    file.nodes[0].keys = {{0.0, Pose()}, {1.0, Pose()}};
    spoil(file.nodes[0]);
    return test::refusalBy([&] { decodeImport(encodeImport(file), "t.obj"); }).message;
}

TEST(MeshImport, AnAnswerThatNoFileCanGiveIsRefused)
{
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(refusalOf([](ImportedNode&) {}), "nothing was thrown");
    EXPECT_EQ(refusalOf([](ImportedNode& node) { node.mesh.cornerUvs(1, 7) = kInfinity; }),
              "mesh file 't.obj' has texture coordinates that are not finite");
    EXPECT_EQ(refusalOf([](ImportedNode& node) { node.mesh.cornerUvs.conservativeResize(2, 9); }),
              "mesh file 't.obj' has texture coordinates of other corners");
    EXPECT_EQ(refusalOf([](ImportedNode& node) { node.mesh.points(0, 0) = kInfinity; }),
              "mesh file 't.obj' has coordinates that are not finite");
    EXPECT_EQ(refusalOf([](ImportedNode& node) { node.mesh.triangles(0, 0) = 4; }),
              "mesh file 't.obj' has a face with a corner that is no point");
    EXPECT_EQ(refusalOf([](ImportedNode& node) { node.keys[1].seconds = 0.0; }),
              "mesh file 't.obj' has keys that are not in order");
    EXPECT_EQ(refusalOf([](ImportedNode& node) { node.keys[1].fileFromNode.position.x() = NAN; }),
              "mesh file 't.obj' has coordinates that are not finite");
}

TEST(MeshImport, AMissingFileIsMissingInput)
{
    EXPECT_EQ(messageOf("/no/such/bone.obj", ErrorKind::missingInput),
              "mesh file '/no/such/bone.obj' does not exist");
}

TEST(MeshImport, AnUnsupportedEndingListsTheSupportedOnes)
{
    EXPECT_EQ(
        messageOf("bone.max"),
        "mesh file 'bone.max' has an ending that cannot be read; supported: obj, ply, stl, glb, "
        "gltf, fbx, abc");
}

TEST(MeshImport, AFileThatIsNoMeshIsRefusedWithTheReason)
{
    const test::TemporaryFolder folder;
    const std::string path = write(folder, "t.ply", "this is no ply file\n");
    const std::string message = messageOf(path);
    EXPECT_EQ(message.rfind("mesh file '" + path + "' cannot be read: ", 0), 0u) << message;
    EXPECT_GT(message.size(), path.size() + 40) << message;
}

TEST(MeshImport, AFolderIsRefused)
{
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "t.obj");
    const std::string path = (folder / "t.obj").string();
    EXPECT_EQ(messageOf(path), "mesh file '" + path + "' is not a file");
}

TEST(MeshImport, PointsWithoutFacesAreRefused)
{
    const test::TemporaryFolder folder;
    const std::string path = write(folder, "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n");
    EXPECT_EQ(messageOf(path), "mesh file '" + path + "' has no faces");
}

TEST(MeshImport, CoordinatesThatAreNotFiniteAreRefused)
{
    const test::TemporaryFolder folder;
    const std::string path =
        write(folder, "t.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n");
    EXPECT_NE(messageOf(path).find("not finite"), std::string::npos) << messageOf(path);
}

}  // namespace
}  // namespace scree
