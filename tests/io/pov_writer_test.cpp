#include "io/pov_writer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "io/frame_pattern.h"
#include "tests/support/cast.h"
#include "tests/support/readers.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

using test::contentOf;

/// The comma-separated numbers between the < and > that follow `before`, from `at` on.
std::vector<double> numbersAfter(const std::string& text, const std::string& before,
                                 std::size_t at = 0)
{
    const std::size_t begin = text.find(before + " <", at);
    EXPECT_NE(begin, std::string::npos) << before;
    std::istringstream list(text.substr(begin + before.size() + 2));
    std::vector<double> numbers;
    char comma = ',';
    for (double number = 0.0; comma == ',' && list >> number >> comma;) numbers.push_back(number);
    return numbers;
}

TEST(PovWriter, MatricesMoveBodiesWhereTheyWere)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::castScene();
    test::exportCast(*makePovWriter(folder / "x.####.pov"), scene);
    const std::string text = contentOf(folder / "x.1003.pov");
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const std::size_t end = text.find("} // " + scene.bodies[body].name + "\n");
        ASSERT_NE(end, std::string::npos);
        const std::vector<double> m = numbersAfter(text, "matrix", text.rfind("object", end));
        ASSERT_EQ(m.size(), 12u);
        // POV-Ray: x' = m0 x + m3 y + m6 z + m9, and so on.
        const Vec3 p(0.3, -1.7, 2.9);
        const Vec3 moved(m[0] * p.x() + m[3] * p.y() + m[6] * p.z() + m[9],
                         m[1] * p.x() + m[4] * p.y() + m[7] * p.z() + m[10],
                         m[2] * p.x() + m[5] * p.y() + m[8] * p.z() + m[11]);
        const Pose pose = test::castPose(scene, body, 1003.0);
        EXPECT_LT((moved - pose * p).norm(), 1e-13);  // roundings of numbers near 10
    }
}

TEST(PovWriter, MeshesAreWrittenOnceForAllFrames)
{
    const test::TemporaryFolder folder;
    test::exportCast(*makePovWriter(folder / "heap.%04d.pov"), test::castScene());
    const std::string shared = contentOf(folder / "heap_meshes.inc");
    EXPECT_NE(shared.find("#declare Mesh_0 = mesh2"), std::string::npos);
    EXPECT_NE(shared.find("#declare Mesh_1 = mesh2"), std::string::npos);
    const std::string frame = contentOf(folder / "heap.1001.pov");
    EXPECT_NE(frame.find("#include \"heap_meshes.inc\""), std::string::npos);
    EXPECT_EQ(frame.find("mesh2"), std::string::npos);
}

/// 24-bit picture as POV-Ray writes it with +FP.
struct Ppm {
    int width = 0, height = 0;
    std::string bytes;

    explicit Ppm(const fs::path& path)
    {
        std::ifstream stream(path, std::ios::binary);
        std::string magic;
        int highest = 0;
        stream >> magic >> std::ws;
        for (std::string comment; stream.peek() == '#';) std::getline(stream, comment);
        stream >> width >> height >> highest;
        stream.get();
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
        EXPECT_EQ(magic, "P6");
        EXPECT_EQ(highest, 255);
        EXPECT_EQ(bytes.size(), static_cast<std::size_t>(3 * width * height));
    }

    std::array<int, 3> at(int x, int y) const
    {
        const std::size_t i = static_cast<std::size_t>(3 * (y * width + x));
        return {static_cast<unsigned char>(bytes[i]), static_cast<unsigned char>(bytes[i + 1]),
                static_cast<unsigned char>(bytes[i + 2])};
    }
};

/// Three small cards, red, green and blue, on x, y and z; a picture of them cannot be mirrored or
/// turned without a colour changing its place.
SceneDescription cardScene(bool zUp)
{
    SceneDescription scene =
        test::sceneOf({test::bodyNamed("red", true, 0), test::bodyNamed("green", true, 0),
                       test::bodyNamed("blue", true, 0)});
    scene.zUp = zUp;
    for (Eigen::Index i = 0; i < 3; ++i) {
        SceneMaterial material;
        material.name = scene.bodies[static_cast<std::size_t>(i)].name;
        scene.bodies[static_cast<std::size_t>(i)].material = material.name;
        material.color = 0.9 * Mat3::Identity().col(i);
        material.roughness = 1.0;
        scene.materials.push_back(material);
    }
    scene.cameras = {{"main", {7.0, 5.0, 9.0}, {0.5, 0.2, 0.4}, 35.0}};
    return scene;
}

/// Where a point is in the picture [pixels], by the definition of a pinhole camera.
Eigen::Vector2d pixelOf(const SceneDescription& scene, const Vec3& point, int width, int height)
{
    const SceneCamera& camera = scene.cameras[0];
    const Vec3 forward = (camera.target - camera.eye).normalized();
    const Vec3 right =
        forward.cross(scene.zUp ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitY())).normalized();
    const Vec3 up = right.cross(forward);
    const Vec3 ray = point - camera.eye;
    const double unit = ray.dot(forward) * std::tan(camera.fovDegrees * std::acos(-1.0) / 360.0);
    return {0.5 * width * (1.0 + ray.dot(right) / unit / scene.aspect),
            0.5 * height * (1.0 - ray.dot(up) / unit)};
}

void expectCardsInPlace(bool zUp)
{
    const test::CommandResult version = test::runCommand("povray --version");
    SCREE_REQUIRE_READER(version.output.find("POV-Ray 3.7") != std::string::npos, version.output);
    const test::TemporaryFolder folder;
    const SceneDescription scene = cardScene(zUp);
    const Quat turned(Eigen::AngleAxisd(0.8, Vec3(1.0, 2.0, 3.0).normalized()));
    std::vector<Pose> poses;
    for (Eigen::Index i = 0; i < 3; ++i) poses.push_back({2.0 * Mat3::Identity().col(i), turned});
    const std::unique_ptr<FrameWriter> writer = makePovWriter(folder / "x.####.pov");
    writer->begin(scene, 1001, 1);
    writer->write(test::frameWith(1001, poses));
    writer->finish();

    const int width = 160, height = 90;
    const test::CommandResult result =
        test::runCommand("cd " + test::quoted(folder.path()) +
                         " && povray +Ix.1001.pov +Ox.ppm +FP +W160 +H90 -D +WT1");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const Ppm picture(folder / "x.ppm");
    ASSERT_EQ(picture.width, width);
    ASSERT_EQ(picture.height, height);
    for (std::size_t body = 0; body < 3; ++body) {
        // The middle of the tetrahedron is inside its outline from every side.
        const Vec3 middle = poses[body] * scene.meshes[0].points.rowwise().mean().eval();
        const Eigen::Vector2d pixel = pixelOf(scene, middle, width, height);
        const std::array<int, 3> color =
            picture.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
        const int own = color[body];
        EXPECT_GT(own, 2 * color[(body + 1) % 3]) << scene.bodies[body].name;
        EXPECT_GT(own, 2 * color[(body + 2) % 3]) << scene.bodies[body].name;
        EXPECT_GT(own, 60) << scene.bodies[body].name;
    }
}

TEST(PovWriter, PovRaySeesEachColourWhereTheCameraSeesIt)
{
    expectCardsInPlace(false);
}

TEST(PovWriter, PovRaySeesAZUpShotUpright)
{
    expectCardsInPlace(true);
}

TEST(PovWriter, AShotWithoutCameraGetsOneThatHoldsForAllFrames)
{
    const test::TemporaryFolder folder;
    SceneDescription scene = test::castScene();
    scene.cameras.clear();
    test::exportCast(*makePovWriter(folder / "x.####.pov"), scene);
    const std::string first = contentOf(folder / "x.1001.pov");
    const std::string last = contentOf(folder / "x.1005.pov");
    const std::vector<double> eye = numbersAfter(first, "location");
    EXPECT_EQ(eye, numbersAfter(last, "location"));
    EXPECT_EQ(eye.size(), 3u);
}

TEST(PovWriter, EqualExportsAreEqualBytes)
{
    const test::TemporaryFolder one, two;
    test::exportCast(*makePovWriter(one / "x.####.pov"), test::castScene());
    test::exportCast(*makePovWriter(two / "x.####.pov"), test::castScene());
    for (const char* name : {"x.1001.pov", "x.1005.pov", "x_meshes.inc"}) {
        EXPECT_FALSE(contentOf(one / name).empty());
        EXPECT_TRUE(contentOf(one / name) == contentOf(two / name)) << name;
    }
}

// What one export wrote another read: its bodies had the meshes of the other's.
TEST(PovWriter, ExportsBesideEachOtherDoNotShareTheirMeshes)
{
    const test::TemporaryFolder folder;
    std::set<std::string> includes;
    for (const char* name : {"heap.####.pov", "heap_####.pov", "heap####.pov", "####.pov",
                             "####_a.pov", "####_b.pov"}) {
        test::exportCast(*makePovWriter(folder / name), test::castScene());
        const std::string text = contentOf(folder / expandFramePattern(name, 1001));
        const std::size_t begin = text.find("#include \"");
        includes.insert(text.substr(begin, text.find('\n', begin) - begin));
    }
    EXPECT_EQ(includes.size(), 6u);
    EXPECT_TRUE(includes.contains("#include \"heap_meshes.inc\""));
}

}  // namespace
}  // namespace scree
