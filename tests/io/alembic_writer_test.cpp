// What a reader finds in our Alembic files. The reader is abc_check.py, which shares no code with
// the writer and was itself checked against files of the official library.
#include "io/alembic_writer.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "core/base/error.h"
#include "core/picture/camera_motion.h"
#include "io/camera_pose.h"
#include "tests/support/abc_check.h"
#include "tests/support/export_scene.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr int kFirst = 1001;

// Every number takes one rounding from pose to file; 1e-12 of values up to 100 is far above that
// and far below what a picture shows.
constexpr double kTolerance = 1e-12;

void exportFrames(const SceneDescription& scene, const std::vector<SceneFrame>& frames,
                  const fs::path& output, const std::vector<double>& offsets = {0.0})
{
    const std::unique_ptr<FrameWriter> writer = makeAlembicWriter(output);
    const auto frameCount = static_cast<int>(frames.size() / offsets.size());
    writer->begin(scene, frames.front().frame, frameCount, offsets);
    for (const SceneFrame& frame : frames) writer->write(frame);
    writer->finish();
}

std::vector<SceneFrame> tumblingFrames(const SceneDescription& scene, int count)
{
    std::vector<SceneFrame> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(test::tumblingFrame(scene, kFirst + i, kFirst));
    return frames;
}

using test::contentOf;

/// Tree of the file as text, after a strict check.
std::string strictTree(const fs::path& file)
{
    const test::CommandResult result = test::runAbcCheck(file, "--strict");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    return result.output;
}

struct ReadSample {
    double time = 0.0;
    Eigen::Matrix4d local, world;  // for column vectors
};

Eigen::Matrix4d matrixFrom(const nlohmann::json& rows)
{
    Eigen::Matrix4d matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            matrix(column, row) = rows.at(static_cast<std::size_t>(row))
                                      .at(static_cast<std::size_t>(column))
                                      .get<double>();
        }
    }
    return matrix;
}

/// All transform samples by object path.
std::map<std::string, std::vector<ReadSample>> readTransforms(const fs::path& file)
{
    const test::CommandResult result = test::runAbcCheck(file, "--strict --dump-xforms --world");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    std::map<std::string, std::vector<ReadSample>> samples;
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);) {
        const nlohmann::json record = nlohmann::json::parse(line);
        samples[record.at("path").get<std::string>()].push_back({record.at("time").get<double>(),
                                                                 matrixFrom(record.at("matrix")),
                                                                 matrixFrom(record.at("world"))});
    }
    return samples;
}

Eigen::Matrix4d matrixOf(const Pose& pose)
{
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = pose.orientation.toRotationMatrix();
    matrix.topRightCorner<3, 1>() = pose.position;
    return matrix;
}

TEST(AlembicWriter, PosesReadBackAreThosePutIn)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf(
        {test::bodyNamed("ring_0"), test::bodyNamed("ring_1"), test::bodyNamed("ring_2")});
    const std::vector<SceneFrame> frames = tumblingFrames(scene, 12);
    exportFrames(scene, frames, folder / "a.abc");

    auto transforms = readTransforms(folder / "a.abc");
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const auto& samples = transforms["/test_shot/" + scene.bodies[body].name];
        ASSERT_EQ(samples.size(), frames.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const Eigen::Matrix4d expected = matrixOf(frames[i].worldFromAsset[body]);
            EXPECT_LT((samples[i].local - expected).cwiseAbs().maxCoeff(), kTolerance);
            EXPECT_LT((samples[i].world - expected).cwiseAbs().maxCoeff(), kTolerance);
        }
    }
}

TEST(AlembicWriter, FrameNumbersStandAtFrameOverRateSeconds)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    scene.framesPerSecond = 25.0;
    exportFrames(scene, tumblingFrames(scene, 3), folder / "a.abc");

    const auto samples = readTransforms(folder / "a.abc")["/test_shot/ring"];
    ASSERT_EQ(samples.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        // Start plus i steps is not exactly frame over rate; tools take 1e-5 s as equal.
        EXPECT_NEAR(samples[i].time, (kFirst + static_cast<double>(i)) / 25.0, 1e-12);
    }
    EXPECT_NE(strictTree(folder / "a.abc").find("_ai_DCC_FPS = 25\n"), std::string::npos);
}

TEST(AlembicWriter, ABodyThatNeverMovesHasASingleSample)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene =
        test::sceneOf({test::bodyNamed("ring"), test::bodyNamed("ground", false)});
    const std::vector<SceneFrame> frames = tumblingFrames(scene, 5);
    exportFrames(scene, frames, folder / "a.abc");

    auto transforms = readTransforms(folder / "a.abc");
    EXPECT_EQ(transforms["/test_shot/ring"].size(), 5u);
    ASSERT_EQ(transforms["/test_shot/ground"].size(), 1u);
    const Eigen::Matrix4d expected = matrixOf(frames.front().worldFromAsset[1]);
    EXPECT_LT((transforms["/test_shot/ground"][0].local - expected).cwiseAbs().maxCoeff(),
              kTolerance);
}

// A rest at the start, in the middle and at the end: which samples are stored differs, what is read
// must not.
TEST(AlembicWriter, RestsAtAnyTimeReadBackAsRests)
{
    const test::TemporaryFolder folder;
    const std::vector<std::vector<int>> patterns = {
        {0, 0, 0, 0, 0, 0}, {0, 1, 2, 3, 4, 5}, {0, 0, 0, 1, 1, 1}, {0, 1, 1, 1, 1, 1},
        {0, 0, 1, 0, 0, 0}, {0, 1, 0, 1, 0, 1}, {0, 1, 1, 1, 2, 2}};
    SceneDescription scene = test::sceneOf({});
    for (std::size_t p = 0; p < patterns.size(); ++p) {
        scene.bodies.push_back(test::bodyNamed("p" + std::to_string(p)));
    }
    std::vector<SceneFrame> frames;
    for (std::size_t i = 0; i < 6; ++i) {
        std::vector<Pose> poses;
        for (const auto& pattern : patterns) poses.push_back(test::tumblingPose(2, pattern[i]));
        frames.push_back(test::frameWith(kFirst + static_cast<int>(i), poses));
    }
    exportFrames(scene, frames, folder / "a.abc");

    auto transforms = readTransforms(folder / "a.abc");
    for (std::size_t p = 0; p < patterns.size(); ++p) {
        const auto& samples = transforms["/test_shot/p" + std::to_string(p)];
        ASSERT_EQ(samples.size(), 6u);
        for (std::size_t i = 0; i < 6; ++i) {
            const Eigen::Matrix4d expected = matrixOf(frames[i].worldFromAsset[p]);
            EXPECT_LT((samples[i].local - expected).cwiseAbs().maxCoeff(), kTolerance) << p;
        }
    }
}

TEST(AlembicWriter, ASleepingBodyCostsNoBytesWhileItSleeps)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    std::vector<SceneFrame> frames = {test::frameWith(kFirst, {test::tumblingPose(0, 0)})};
    for (int i = 1; i < 100; ++i) {
        frames.push_back(test::frameWith(kFirst + i, {test::tumblingPose(0, 1)}));
    }
    exportFrames(scene, {frames.begin(), frames.begin() + 50}, folder / "short.abc");
    exportFrames(scene, frames, folder / "long.abc");
    EXPECT_EQ(fs::file_size(folder / "short.abc"), fs::file_size(folder / "long.abc"));
}

TEST(AlembicWriter, BodiesOfOneShapeShareItsMesh)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({});
    SceneMesh& mesh = scene.meshes[0];
    mesh.points = Points::Random(3, 10000);
    mesh.triangles.resize(3, 0);
    for (int i = 0; i < 20; ++i) scene.bodies.push_back(test::bodyNamed("b" + std::to_string(i)));
    exportFrames(scene, tumblingFrames(scene, 1), folder / "a.abc");
    strictTree(folder / "a.abc");
    // One mesh has 120 kB of points; twenty of them would have 2.4 MB.
    EXPECT_LT(fs::file_size(folder / "a.abc"), 200000u);
}

TEST(AlembicWriter, ObjectsPropertiesAndMeshesAreWhereReadersLook)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    exportFrames(scene, tumblingFrames(scene, 2), folder / "a.abc");
    const std::string tree = strictTree(folder / "a.abc");
    for (const char* line : {
             "\n  /test_shot AbcGeom_Xform_v3\n",
             "\n    /test_shot/ring AbcGeom_Xform_v3\n",
             "\n      /test_shot/ring/ringShape AbcGeom_PolyMesh_v1\n",
             "P array float32_t[3] samples=1 stored=1 ts=0 items=4 geoScope=vtx;",
             ".faceIndices array int32_t samples=1 stored=1 ts=0 items=12",
             "mass scalar float64_t samples=1 stored=1 ts=0 value=2.5",
             "material scalar string samples=1 stored=1 ts=0 value='steel'",
             "shape scalar string samples=1 stored=1 ts=0 value='tetrahedron'",
             "bodyId scalar int32_t samples=1 stored=1 ts=0 value=0",
             "birthFrame scalar int32_t samples=1 stored=1 ts=0 value=1001",
         }) {
        EXPECT_NE(tree.find(line), std::string::npos) << line << "\nin\n" << tree;
    }
}

TEST(AlembicWriter, SubFrameSamplesStandAtTheirTimes)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    const std::vector<double> offsets = {-0.25, 0.0, 0.4};
    std::vector<SceneFrame> frames;
    for (int i = 0; i < 4; ++i) {
        for (const double offset : offsets) {
            frames.push_back(
                test::frameWith(kFirst + i, {test::tumblingPose(0, i + offset + 0.25)}));
            frames.back().offset = offset;
        }
    }
    exportFrames(scene, frames, folder / "a.abc", offsets);

    EXPECT_NE(strictTree(folder / "a.abc").find("time sampling 1: cyclic"), std::string::npos);
    const auto samples = readTransforms(folder / "a.abc")["/test_shot/ring"];
    ASSERT_EQ(samples.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_NEAR(samples[i].time, (frames[i].frame + frames[i].offset) / 24.0, 1e-12);
        const Eigen::Matrix4d expected = matrixOf(frames[i].worldFromAsset[0]);
        EXPECT_LT((samples[i].local - expected).cwiseAbs().maxCoeff(), kTolerance);
    }
}

TEST(AlembicWriter, TheMaterialIsAFaceSetOfAllFaces)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("ring"), test::bodyNamed("bare")});
    scene.bodies[1].material.clear();
    exportFrames(scene, tumblingFrames(scene, 1), folder / "a.abc");
    const std::string tree = strictTree(folder / "a.abc");
    EXPECT_NE(tree.find("/test_shot/ring/ringShape/steel AbcGeom_FaceSet_v1\n"), std::string::npos);
    EXPECT_NE(tree.find(".faces array int32_t samples=1 stored=1 ts=0 items=4"), std::string::npos);
    EXPECT_EQ(tree.find("/test_shot/bare/bareShape/"), std::string::npos);
}

TEST(AlembicWriter, EveryCornerHasANormalEvenOfATriangleWithoutArea)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    SceneMesh& mesh = scene.meshes[0];
    mesh.points.conservativeResize(3, 5);
    mesh.points.col(4) = mesh.points.col(3);
    mesh.triangles.conservativeResize(3, 6);
    mesh.triangles.col(4) << 3, 4, 0;
    mesh.triangles.col(5) << 1, 1, 2;
    exportFrames(scene, tumblingFrames(scene, 1), folder / "a.abc");
    EXPECT_NE(strictTree(folder / "a.abc")
                  .find("N array float32_t[3] samples=1 stored=1 ts=0 "
                        "items=18 arrayExtent=1;geoScope=fvr;"),
              std::string::npos);
}

TEST(AlembicWriter, AMeshWithoutFacesIsStillAValidCache)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    scene.meshes[0].triangles.resize(3, 0);
    exportFrames(scene, tumblingFrames(scene, 2), folder / "a.abc");
    strictTree(folder / "a.abc");
}

TEST(AlembicWriter, ACameraStandsWhereTheShotPutsItUnderAFreeName)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("main")});
    scene.cameras.push_back({"main", Vec3(3.0, 4.0, 5.0), Vec3(3.0, 4.0, -5.0), 40.0});
    exportFrames(scene, tumblingFrames(scene, 2), folder / "a.abc");
    EXPECT_NE(strictTree(folder / "a.abc").find("/test_shot/main_2/main_2Camera AbcGeom_Camera_v1"),
              std::string::npos);
    const auto samples = readTransforms(folder / "a.abc")["/test_shot/main_2"];
    ASSERT_EQ(samples.size(), 1u);
    // It looks along -z already, so only its place is left.
    const Eigen::Matrix4d expected = matrixOf({Vec3(3.0, 4.0, 5.0), Quat::Identity()});
    EXPECT_LT((samples[0].world - expected).cwiseAbs().maxCoeff(), kTolerance);
}

TEST(AlembicWriter, AKeyedCameraHasItsPlaceAndLensAtEverySample)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    SceneCamera camera;
    camera.keys = {{kFirst + 1.0, {3.0, 4.0, 5.0}, {3.0, 4.0, -5.0}, 40.0},
                   {kFirst + 3.0, {5.0, 4.0, 7.0}, {3.0, 1.0, -5.0}, 20.0}};
    scene.cameras.push_back(camera);
    exportFrames(scene, tumblingFrames(scene, 5), folder / "a.abc");
    const auto samples = readTransforms(folder / "a.abc")["/test_shot/main"];
    ASSERT_EQ(samples.size(), 5U);
    for (int i = 0; i < 5; ++i) {
        const Pose pose = worldFromCamera(cameraAt(camera, kFirst + i, false), false);
        EXPECT_LT((samples[i].world - matrixOf(pose)).cwiseAbs().maxCoeff(), kTolerance) << i;
    }
    // The lens zooms between the keys: frames 0 and 1 share one, so do 3 and 4.
    EXPECT_TRUE(
        std::regex_search(strictTree(folder / "a.abc"),
                          std::regex("\\.core scalar float64_t\\[16\\] samples=5 stored=3")))
        << strictTree(folder / "a.abc");
}

TEST(AlembicWriter, AZUpShotStandsUprightInAYUpReader)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    scene.zUp = true;
    exportFrames(scene, {test::frameWith(kFirst, {Pose{Vec3(1.0, 2.0, 3.0), Quat::Identity()}})},
                 folder / "a.abc");
    const auto samples = readTransforms(folder / "a.abc")["/test_shot/ring"];
    ASSERT_EQ(samples.size(), 1u);
    // Height 3 along the shot's z is height 3 along the reader's y.
    const Eigen::Vector3d origin = samples[0].world.topRightCorner<3, 1>();
    EXPECT_EQ(origin, Eigen::Vector3d(1.0, 3.0, -2.0));
    EXPECT_NEAR(samples[0].world.determinant(), 1.0, kTolerance);
}

TEST(AlembicWriter, EqualExportsAreEqualBytes)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene =
        test::sceneOf({test::bodyNamed("a"), test::bodyNamed("b"), test::bodyNamed("c", false)});
    exportFrames(scene, tumblingFrames(scene, 7), folder / "1.abc");
    exportFrames(scene, tumblingFrames(scene, 7), folder / "2.abc");
    EXPECT_FALSE(contentOf(folder / "1.abc").empty());
    EXPECT_TRUE(contentOf(folder / "1.abc") == contentOf(folder / "2.abc"));
}

TEST(AlembicWriter, SceneWithoutBodiesIsAValidCache)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({});
    exportFrames(scene, tumblingFrames(scene, 3), folder / "a.abc");
    strictTree(folder / "a.abc");
}

TEST(AlembicWriter, LongCachesOfManyBodiesPassTheCheck)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::sceneOf({});
    for (int i = 0; i < 300; ++i) scene.bodies.push_back(test::bodyNamed("b" + std::to_string(i)));
    scene.bodies[0].name = std::string(300, 'n');
    exportFrames(scene, tumblingFrames(scene, 3), folder / "many.abc");
    strictTree(folder / "many.abc");

    scene.bodies.resize(1);
    exportFrames(scene, tumblingFrames(scene, 257), folder / "long.abc");
    strictTree(folder / "long.abc");
}

TEST(AlembicWriter, AnExportThatStopsHalfWayLeavesNoFile)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    {
        const std::unique_ptr<FrameWriter> writer = makeAlembicWriter(folder / "a.abc");
        writer->begin(scene, kFirst, 10);
        writer->write(test::tumblingFrame(scene, kFirst, kFirst));
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace scree
