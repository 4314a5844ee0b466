// The files are read with small readers of the test's own, written from the formats' descriptions.
#include "io/mesh_sequence_writer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/export_scene.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr int kFirst = 1001;

// A point is a rotation and a sum; two spellings of it differ by a few roundings of values near 10.
constexpr double kTolerance = 1e-13;

using test::contentOf;

/// Two shapes, three bodies, spinning: enough for shared numbering to go wrong.
SceneDescription mixedScene()
{
    SceneDescription scene =
        test::sceneOf({test::bodyNamed("first", true, 1), test::bodyNamed("second", true, 0),
                       test::bodyNamed("third", false, 1)});
    SceneMesh triangle;
    triangle.name = "triangle";
    triangle.points = Points::Identity(3, 3);
    triangle.triangles.resize(3, 1);
    triangle.triangles << 0, 1, 2;
    scene.meshes.push_back(triangle);
    return scene;
}

SceneFrame spinningFrame(const SceneDescription& scene, int number)
{
    SceneFrame frame = test::tumblingFrame(scene, number, kFirst);
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const double b = static_cast<double>(body);
        frame.velocity[body] = Vec3(b, 1.0, -2.0);
        frame.angularVelocity[body] = Vec3(0.5, b, 3.0);
    }
    return frame;
}

void exportTwoFrames(FrameWriter& writer, const SceneDescription& scene)
{
    writer.begin(scene, kFirst, 2);
    writer.write(spinningFrame(scene, kFirst));
    writer.write(spinningFrame(scene, kFirst + 1));
    writer.finish();
}

struct ReadFace {
    std::string object;
    std::vector<std::size_t> corners;  // from 0
};

struct ReadObj {
    std::vector<Vec3> points;
    std::vector<ReadFace> faces;
};

ReadObj readObj(const fs::path& path)
{
    ReadObj mesh;
    std::istringstream lines(contentOf(path));
    std::string object;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "o") words >> object;
        if (key == "v") {
            Vec3 point;
            words >> point.x() >> point.y() >> point.z();
            mesh.points.push_back(point);
        }
        if (key != "f") continue;
        ReadFace face = {object, {}};
        for (std::size_t corner = 0; words >> corner;) face.corners.push_back(corner - 1);
        mesh.faces.push_back(face);
    }
    return mesh;
}

TEST(ObjSequenceWriter, FacesOfEachBodyStandWhereTheBodyStands)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = mixedScene();
    exportTwoFrames(*makeObjSequenceWriter(folder / "x.####.obj"), scene);

    const ReadObj mesh = readObj(folder / "x.1002.obj");
    const SceneFrame frame = spinningFrame(scene, 1002);
    std::size_t face = 0;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const SceneMesh& expected = scene.meshes[scene.bodies[b].mesh];
        for (Eigen::Index f = 0; f < expected.triangles.cols(); ++f, ++face) {
            ASSERT_LT(face, mesh.faces.size());
            EXPECT_EQ(mesh.faces[face].object, scene.bodies[b].name);
            ASSERT_EQ(mesh.faces[face].corners.size(), 3u);
            for (Eigen::Index c = 0; c < 3; ++c) {
                const Vec3 x =
                    frame.worldFromAsset[b] * expected.points.col(expected.triangles(c, f));
                const std::size_t corner = mesh.faces[face].corners[static_cast<std::size_t>(c)];
                ASSERT_LT(corner, mesh.points.size());
                EXPECT_LT((mesh.points[corner] - x).norm(), kTolerance);
            }
        }
    }
    EXPECT_EQ(face, mesh.faces.size());
}

/// Bytes behind the header, with the header's text apart.
struct PlyParts {
    std::string header, body;
};

PlyParts splitPly(const fs::path& path)
{
    const std::string bytes = contentOf(path);
    const std::string last = "end_header\n";
    const std::size_t end = bytes.find(last);
    EXPECT_NE(end, std::string::npos);
    return {bytes.substr(0, end + last.size()), bytes.substr(end + last.size())};
}

#pragma pack(push, 1)
struct PlyPoint {
    double position[3];
    float velocity[3];
    std::int32_t body;
};
struct PlyFace {
    std::uint8_t count;
    std::int32_t corners[3];
};
#pragma pack(pop)

TEST(PlySequenceWriter, PointsCarryPositionVelocityAndBody)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = mixedScene();
    exportTwoFrames(*makePlySequenceWriter(folder / "x.%04d.ply"), scene);

    const PlyParts parts = splitPly(folder / "x.1002.ply");
    EXPECT_NE(parts.header.find("element vertex 10\n"), std::string::npos) << parts.header;
    EXPECT_NE(parts.header.find("comment body 1 second\n"), std::string::npos) << parts.header;
    ASSERT_EQ(parts.body.size(), 10 * sizeof(PlyPoint) + 6 * sizeof(PlyFace));
    std::vector<PlyPoint> points(10);
    std::memcpy(points.data(), parts.body.data(), 10 * sizeof(PlyPoint));

    // The velocity must be what moves the point: compare with a small step of the motion.
    const SceneFrame frame = spinningFrame(scene, 1002);
    const double h = 1e-6;
    std::size_t index = 0;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const Pose& pose = frame.worldFromAsset[b];
        const double spin = frame.angularVelocity[b].norm();
        const Eigen::AngleAxisd turn(spin * h, frame.angularVelocity[b] / spin);
        const Pose later = {pose.position + h * frame.velocity[b], Quat(turn) * pose.orientation};
        const Points& expected = scene.meshes[scene.bodies[b].mesh].points;
        for (Eigen::Index v = 0; v < expected.cols(); ++v, ++index) {
            const PlyPoint& point = points[index];
            const Vec3 x(point.position[0], point.position[1], point.position[2]);
            const Vec3 velocity(point.velocity[0], point.velocity[1], point.velocity[2]);
            const Vec3 moved = (later * expected.col(v) - pose * expected.col(v)) / h;
            EXPECT_LT((x - pose * expected.col(v)).norm(), kTolerance);
            EXPECT_LT((velocity - moved).norm(), 1e-4);  // the step's own error, and float
            EXPECT_EQ(point.body, static_cast<int>(b));
        }
    }
}

TEST(PlySequenceWriter, FacesNumberThePointsOfTheirOwnBody)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = mixedScene();
    exportTwoFrames(*makePlySequenceWriter(folder / "x.####.ply"), scene);

    const PlyParts parts = splitPly(folder / "x.1001.ply");
    ASSERT_EQ(parts.body.size(), 10 * sizeof(PlyPoint) + 6 * sizeof(PlyFace));
    std::vector<PlyFace> faces(6);
    std::memcpy(faces.data(), parts.body.data() + 10 * sizeof(PlyPoint), 6 * sizeof(PlyFace));
    const std::int32_t firstPoint[] = {0, 3, 7};
    std::size_t index = 0;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const Triangles& expected = scene.meshes[scene.bodies[b].mesh].triangles;
        for (Eigen::Index f = 0; f < expected.cols(); ++f, ++index) {
            EXPECT_EQ(faces[index].count, 3);
            for (int c = 0; c < 3; ++c) {
                EXPECT_EQ(faces[index].corners[c], firstPoint[b] + expected(c, f));
            }
        }
    }
}

TEST(PlySequenceWriter, FacesHaveTheTextureCoordinatesOfTheirCorners)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = mixedScene();
    scene.meshes[0] = test::texturedTetrahedron();
    exportTwoFrames(*makePlySequenceWriter(folder / "x.####.ply"), scene);

    const PlyParts parts = splitPly(folder / "x.1001.ply");
    EXPECT_NE(parts.header.find("property list uchar float texcoord\n"), std::string::npos);
    // The triangle before and the one behind have an empty list each.
    const std::size_t first = 10 * sizeof(PlyPoint) + sizeof(PlyFace) + 1;
    const std::size_t faceBytes = sizeof(PlyFace) + 1 + 6 * sizeof(float);
    ASSERT_EQ(parts.body.size(), first + 4 * faceBytes + sizeof(PlyFace) + 1);
    EXPECT_EQ(parts.body[first - 1], 0);
    for (Eigen::Index f = 0; f < 4; ++f) {
        const std::size_t at = first + static_cast<std::size_t>(f) * faceBytes + sizeof(PlyFace);
        Eigen::Matrix<float, 2, 3> uvs;
        std::memcpy(uvs.data(), parts.body.data() + at + 1, sizeof uvs);
        EXPECT_EQ(parts.body[at], 6);
        EXPECT_TRUE(uvs == (scene.meshes[0].cornerUvs.middleCols<3>(3 * f)));
    }
    EXPECT_EQ(parts.body.back(), 0);
}

TEST(MeshSequenceWriter, EqualExportsAreEqualBytes)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = mixedScene();
    for (const char* name : {"1.####", "2.####"}) {
        exportTwoFrames(*makeObjSequenceWriter(folder / (std::string(name) + ".obj")), scene);
        exportTwoFrames(*makePlySequenceWriter(folder / (std::string(name) + ".ply")), scene);
    }
    for (const char* ending : {".1001.obj", ".1002.obj", ".1001.ply", ".1002.ply"}) {
        const std::string content = contentOf(folder / (std::string("1") + ending));
        EXPECT_FALSE(content.empty());
        EXPECT_TRUE(content == contentOf(folder / (std::string("2") + ending))) << ending;
    }
}

}  // namespace
}  // namespace scree
