// What we write, read by what we read with: assimp for .glb, .obj and .ply, our own reader for
// .abc. Neither shares code with the writers.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_defects.h"
#include "io/alembic_archive.h"
#include "io/byte_order.h"
#include "io/frame_writer.h"
#include "io/mesh_import.h"
#include "tests/support/export_scene.h"
#include "tests/support/readers.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kFirst = 1001;

// Single precision of coordinates near 2 and of quaternions.
constexpr double kTolerance = 1e-6;

/// Exports frames in which all bodies tumble, and imports them.
ImportedFile roundTrip(const SceneDescription& scene, const std::filesystem::path& output,
                       int frameCount, const std::vector<double>& offsets = {0.0})
{
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, frameCount, offsets);
    for (int frame = 0; frame < frameCount; ++frame) {
        for (const double offset : offsets) {
            std::vector<Pose> poses;
            for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
                // A step late, so that no square root of a time before the first is asked for.
                const double step = scene.bodies[body].moves ? frame + offset + 1.0 : 1.0;
                poses.push_back(test::tumblingPose(body, step));
            }
            SceneFrame sample = test::frameWith(kFirst + frame, poses);
            sample.offset = offset;
            writer->write(sample);
        }
    }
    writer->finish();
    const std::string name = output.filename().string();
    const std::size_t marks = name.find("####");
    if (marks == std::string::npos) return importFile(output.string());
    return importFile(output.parent_path() / std::string(name).replace(marks, 4, "1001"));
}

SceneDescription texturedScene()
{
    SceneDescription scene = test::sceneOf({test::bodyNamed("painted", false)});
    scene.meshes = {test::texturedTetrahedron()};
    return scene;
}

/// Each triangle of `read`, in the order of `written`, shows the same at the same points.
void expectSameUvs(const TriMesh& read, const SceneMesh& written, const Pose& worldFromAsset)
{
    ASSERT_EQ(read.triangles.cols(), written.triangles.cols());
    ASSERT_EQ(read.cornerUvs.cols(), written.cornerUvs.cols());
    for (Eigen::Index f = 0; f < written.triangles.cols(); ++f) {
        for (Eigen::Index k = 0; k < 3; ++k) {
            const Vec3 x = worldFromAsset * written.points.col(written.triangles(k, f));
            int found = 0;
            for (Eigen::Index m = 0; m < 3; ++m) {
                if ((read.points.col(read.triangles(m, f)) - x).norm() > 10 * kTolerance) continue;
                ++found;
                EXPECT_EQ(read.cornerUvs.col(3 * f + m), written.cornerUvs.col(3 * f + k))
                    << "triangle " << f;
            }
            EXPECT_EQ(found, 1) << "triangle " << f;
        }
    }
    EXPECT_GT(signedVolume(read), 0.0);
}

class ExportImport : public testing::TestWithParam<const char*> {};

TEST_P(ExportImport, TextureCoordinatesComeBackWithTheirSeams)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = texturedScene();
    const ImportedFile file = roundTrip(scene, folder / GetParam(), 1);
    const TriMesh read = joinedMesh(file);
    EXPECT_EQ(read.points.cols(), 4) << "a seam is one point for what collides";
    expectSameUvs(read, scene.meshes[0], test::tumblingPose(0, 1.0));
}

TEST_P(ExportImport, AMeshWithoutTextureCoordinatesGetsNone)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("plain", false)});
    EXPECT_EQ(joinedMesh(roundTrip(scene, folder / GetParam(), 1)).cornerUvs.cols(), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, ExportImport, testing::Values("x.glb", "x.####.obj", "x.abc"));

// assimp mixes them up (see mesh_import_assimp.cpp): none are better than those of another face.
TEST(ExportImports, TextureCoordinatesOfPlyFacesAreLeftOut)
{
    const test::TemporaryFolder folder;
    const TriMesh read = joinedMesh(roundTrip(texturedScene(), folder / "x.####.ply", 1));
    EXPECT_EQ(read.triangles.cols(), 4);
    EXPECT_EQ(read.cornerUvs.cols(), 0);
}

class MotionRoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(MotionRoundTrip, EveryBodyIsAtEveryTimeWhereItWas)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf(
        {test::bodyNamed("first"), test::bodyNamed("second"), test::bodyNamed("still", false)});
    const std::vector<double> offsets = {-0.25, 0.0, 0.25};
    const ImportedFile file = roundTrip(scene, folder / GetParam(), 4, offsets);
    ASSERT_EQ(file.nodes.size(), 3u);
    // glTF has no time for the sample before the first frame.
    const std::size_t leftOut = file.countsFramesFromZero ? 0 : 1;
    const double start = file.countsFramesFromZero ? kFirst : 0.0;
    for (std::size_t body = 0; body < 2; ++body) {
        const ImportedNode& node = file.nodes[body];
        EXPECT_EQ(node.name.substr(0, 5), scene.bodies[body].name.substr(0, 5));
        ASSERT_EQ(node.keys.size(), 12u - leftOut) << node.obstacle;
        for (std::size_t i = 0; i < node.keys.size(); ++i) {
            const std::size_t sample = i + leftOut;
            const double frame = static_cast<double>(sample / 3) + offsets[sample % 3];
            EXPECT_NEAR(node.keys[i].seconds, (start + frame) / scene.framesPerSecond, 1e-5);
            const Pose expected = test::tumblingPose(body, frame + 1.0);
            const Pose& read = node.keys[i].fileFromNode;
            EXPECT_LT((read.position - expected.position).norm(), 10 * kTolerance);
            EXPECT_LT(read.orientation.angularDistance(expected.orientation), 3 * kTolerance);
        }
    }
    EXPECT_TRUE(file.nodes[2].keys.empty());
    const Pose still = test::tumblingPose(2, 1.0);
    EXPECT_LT((file.nodes[2].fileFromNode.position - still.position).norm(), 10 * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Formats, MotionRoundTrip, testing::Values("x.glb", "x.abc"));

TEST(AlembicImport, AZUpShotComesBackYUp)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = texturedScene();
    scene.zUp = true;
    const ImportedFile file = roundTrip(scene, folder / "x.abc", 1);
    const Vec3 was = test::tumblingPose(0, 1.0) * scene.meshes[0].points.col(1);
    const Vec3 is = file.nodes[0].fileFromNode * file.nodes[0].mesh.points.col(1);
    EXPECT_TRUE(file.isYUp);
    EXPECT_LT((is - Vec3(was.x(), was.z(), -was.y())).norm(), kTolerance);
}

/// A file with a tetrahedron below a transform of no operations and no numbers.
void writeBelowEmptyTransform(const std::filesystem::path& path)
{
    AlembicArchive archive(path);
    const SceneMesh mesh = test::tetrahedron();
    const Eigen::Matrix3Xf points = mesh.points.cast<float>();
    const std::vector<std::int32_t> counts(static_cast<std::size_t>(mesh.triangles.cols()), 3);
    const auto array = [&](const std::string& name, AlembicType type, int extent,
                           std::string_view bytes, Eigen::Index count) {
        const auto values = static_cast<std::uint64_t>(count);
        return archive.writeProperty({name, AlembicKind::array, type, extent, 0, ""},
                                     SampleTrack(archive.writeArray(bytes, values)));
    };
    const std::vector<AlembicProperty> geometry = {
        array("P", AlembicType::f32, 3, bytesOf(points), points.cols()),
        array(".faceIndices", AlembicType::i32, 1, bytesOf(mesh.triangles), mesh.triangles.size()),
        array(".faceCounts", AlembicType::i32, 1, bytesOf(counts), mesh.triangles.cols())};
    const AlembicProperty shown = archive.writeCompound(".geom", "", geometry);
    const AlembicObject shape = archive.writeObject(
        "shape", "schemaObjTitle=AbcGeom_PolyMesh_v1:.geom", std::span(&shown, 1), {});
    const std::vector<AlembicProperty> nothing = {array(".ops", AlembicType::u8, 1, "", 0),
                                                  array(".vals", AlembicType::f64, 1, "", 0)};
    const AlembicProperty place = archive.writeCompound(".xform", "", nothing);
    const AlembicObject root = archive.writeObject("root", "schemaObjTitle=AbcGeom_Xform_v3:.xform",
                                                   std::span(&place, 1), std::span(&shape, 1));
    archive.finish(std::span(&root, 1), "_ai_Application=test");
}

TEST(AlembicImport, ATransformWithoutOperationsMovesNothing)
{
    const test::TemporaryFolder folder;
    writeBelowEmptyTransform(folder / "x.abc");
    const ImportedFile file = importFile((folder / "x.abc").string());
    ASSERT_EQ(file.nodes.size(), 1u);
    EXPECT_EQ(file.nodes[0].name, "root");
    EXPECT_LT((file.nodes[0].mesh.points - test::tetrahedron().points).norm(), kTolerance);
    EXPECT_TRUE(file.nodes[0].fileFromNode.position.isZero(0.0));
}

/// The distance from every point of `expected` to the nearest of the mesh.
double farthest(const TriMesh& mesh, const Pose& worldFromNode, const nlohmann::json& expected)
{
    double worst = 0.0;
    for (const nlohmann::json& point : expected) {
        const Vec3 x(point[0].get<double>(), point[1].get<double>(), point[2].get<double>());
        double nearest = 1e9;
        for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
            nearest = std::min(nearest, (worldFromNode * mesh.points.col(v) - x).norm());
        }
        worst = std::max(worst, nearest);
    }
    return worst;
}

TEST(AlembicImport, WhatBlenderWroteIsWhereBlenderHasIt)
{
    const test::Reader& blender = test::findReader("blender");
    SCREE_REQUIRE_READER(!blender.command.empty(), blender.reason);
    const test::TemporaryFolder folder;
    const test::CommandResult result = test::runCommand(
        test::quoted(blender.command) + " " +
        test::quoted(test::sourceFile("tests/support/blender_check.py")) + " write " +
        test::quoted(folder / "x.abc") + " " + test::quoted(folder / "x.json"));
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const nlohmann::json expected = nlohmann::json::parse(std::ifstream(folder / "x.json"));

    const ImportedFile file = importFile((folder / "x.abc").string());
    ASSERT_EQ(file.nodes.size(), 3u);
    for (const ImportedNode& node : file.nodes) {
        const nlohmann::json& frames = expected.at(node.name);
        EXPECT_TRUE(findDefects(node.mesh).empty()) << node.name;
        EXPECT_EQ(node.mesh.points.cols(), static_cast<Eigen::Index>(frames[0].size()));
        EXPECT_EQ(node.mesh.cornerUvs.cols(), node.mesh.triangles.size()) << node.name;
        // Points in single precision, and Blender's matrices too.
        EXPECT_LT(farthest(node.mesh, node.fileFromNode, frames[0]), 1e-5) << node.name;
        const bool isCarried = node.name == "crate";
        ASSERT_EQ(node.keys.size(), isCarried ? 4u : 0u) << node.name << node.obstacle;
        for (std::size_t i = 0; i < node.keys.size(); ++i) {
            EXPECT_NEAR(node.keys[i].seconds * 24.0, 1001.0 + static_cast<double>(i), 1e-3);
            EXPECT_LT(farthest(node.mesh, node.keys[i].fileFromNode, frames[i]), 1e-5) << i;
        }
    }
}

TEST(AlembicImport, CutAnywhereItIsRefused)
{
    const test::TemporaryFolder folder;
    roundTrip(texturedScene(), folder / "x.abc", 2);
    std::ifstream stream(folder / "x.abc", std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    ASSERT_GT(bytes.size(), 1000u);
    for (std::size_t length = 0; length < bytes.size(); length += 41) {
        std::ofstream(folder / "cut.abc", std::ios::binary) << bytes.substr(0, length);
        EXPECT_THROW(importFile((folder / "cut.abc").string()), Error) << length;
    }
}

TEST(AlembicImport, WhatIsNoFinishedFileIsSaidSo)
{
    const test::TemporaryFolder folder;
    const std::string path = (folder / "x.abc").string();
    const auto refusal = [&](const std::string& bytes) {
        std::ofstream(path, std::ios::binary) << bytes;
        return test::refusalBy([&] { importFile(path); }).message;
    };
    const std::string begin = "mesh file '" + path + "' cannot be read: it ";
    EXPECT_EQ(refusal("hello"), begin + "is no Alembic file");
    EXPECT_EQ(refusal("\x89HDF\r\n"),
              begin + "is an Alembic file in the old HDF5 form; save it again as Ogawa");
    EXPECT_EQ(refusal(std::string("Ogawa\0\0\1\0\0\0\0\0\0\0\0", 16)),
              begin + "is not complete: whoever wrote it did not finish");
}

}  // namespace
}  // namespace scree
