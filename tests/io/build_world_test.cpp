#include "io/build_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/stepper.h"
#include "io/shape_bytes.h"
#include "io/shape_cache.h"
#include "io/shot_parser.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

const std::string kHead =
    "scree = 1\n[shot]\nname = \"s\"\nunits = \"cm\"\n[material.wood]\n"
    "density = 500\n";

/// A box whose corner, not its centre, is its origin: 2 × 1 × 1 shot units.
const char* const kSlabObj =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

Shot slabShot(const test::TemporaryFolder& folder, const std::string& shapeLines,
              const std::string& bodyLines)
{
    std::ofstream(folder / "slab.obj") << kSlabObj;
    return parseShotText(kHead + "[shape.slab]\nfile = \"slab.obj\"\n" + shapeLines +
                             "[[body]]\nname = \"a\"\nshape = \"slab\"\nmaterial = \"wood\"\n" +
                             bodyLines,
                         (folder / "s.toml").string());
}

TEST(BuildWorld, FileMeshesAreInTheShotsUnitAndScaled)
{
    const test::TemporaryFolder folder;
    const Shot shot = slabShot(folder, "scale = [10, 20, 20]\n", "");
    const World world = buildWorld(shot);
    // 20 × 20 × 20 cm at 500 kg/m³; the mesh has passed through single precision.
    EXPECT_NEAR(1.0 / world.mass[0].inverseMass, 4.0, 1e-6);
}

TEST(BuildWorld, FramesGiveBackThePoseTheShotGave)
{
    const test::TemporaryFolder folder;
    const Shot shot = slabShot(folder, "",
                               "position = [3, 40, -7]\nrotation = [20, 30, 40]\n"
                               "velocity = [1, 2, 3]\nspin = [0, 90, 0]\n");
    World world = buildWorld(shot);
    world.clock.frame = 5;
    const SceneFrame frame = captureFrame(shot, world);
    EXPECT_EQ(frame.frame, 1006);
    EXPECT_TRUE(frame.worldFromAsset[0].position.isApprox(Vec3(3.0, 40.0, -7.0), 1e-12));
    const Quat given = shot.bodies[0].worldFromAsset.orientation;
    EXPECT_LT(frame.worldFromAsset[0].orientation.angularDistance(given), 1e-12);

    // The origin is a corner, so it circles the centre of mass: v + w × (origin - centre).
    const Vec3 spin(0.0, std::acos(-1.0) / 2.0, 0.0);
    const Vec3 centre = frame.worldFromAsset[0] * Vec3(1.0, 0.5, 0.5);
    const Vec3 expected =
        Vec3(1.0, 2.0, 3.0) + spin.cross(frame.worldFromAsset[0].position - centre);
    EXPECT_TRUE(frame.velocity[0].isApprox(expected, 1e-9)) << frame.velocity[0].transpose();
    EXPECT_TRUE(frame.angularVelocity[0].isApprox(spin, 1e-12));
}

/// A board of 2 m by 20 cm by 1 cm that falls aslant onto another one, with so many keys more.
Shot boardsShot(const test::TemporaryFolder& folder, const std::string& shapeLines,
                const std::string& end)
{
    return slabShot(folder, "scale = [100, 1, 20]\n" + shapeLines,
                    "position = [0, 0.01, 0]\n[[body]]\nname = \"b\"\nshape = \"slab\"\n"
                    "material = \"wood\"\nposition = [20, 20, 50]\nrotation = [5, 30, 10]\n"
                    "[[body]]\nname = \"floor\"\nmaterial = \"wood\"\nmotion = \"static\"\n"
                    "plane = { normal = [0, 1, 0] }\n" +
                        end);
}

/// Where both lie after three seconds, asleep [m].
std::vector<Vec3> restOf(const Shot& shot)
{
    World world = buildWorld(shot);
    Stepper stepper(shot.settings);
    for (int f = 0; f < 72; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_TRUE(world.contactMemory.isAsleep(0) && world.contactMemory.isAsleep(1));
    return {world.motion[0].position, world.motion[1].position};
}

// What is thinner than a field of 512 voxels shows is refused by the paper's method [A4]. The
// contacts of the other are places on meshes: a board falls as it does with the finest field.
TEST(BuildWorld, ThinThingsNeedNoFineFieldsByMethodScree)
{
    const test::TemporaryFolder folder;
    const test::Refusal refusal = test::refusalBy(
        [&] { buildWorld(boardsShot(folder, "", "[solver]\nmethod = \"paper\"\n")); });
    EXPECT_TRUE(refusal.mentions("more than the 512 allowed")) << refusal.message;

    const Shot shot = boardsShot(folder, "", "");
    EXPECT_LE(buildWorld(shot).shapeOf(0).distance.byteCount(), 8u << 20);
    const std::vector<Vec3> rest = restOf(shot);
    for (const char* keys : {"sdf = { resolution = 512 }\n", "sdf = { resolution = 48 }\n"}) {
        const std::vector<Vec3> other = restOf(boardsShot(folder, keys, ""));
        for (int board : {0, 1}) {
            EXPECT_LE((other[board] - rest[board]).norm(), 1e-4) << keys << board;
        }
    }
}

// A thousand shards, each with as fine a field as one alone may have, took a minute and a half and
// 3 GB to start.
TEST(BuildWorld, ManyShapesShareTheNodesOfTheirFields)
{
    const test::TemporaryFolder folder;
    std::string others;
    for (int n = 0; n < 400; ++n) {
        const std::string name = "ball_" + std::to_string(n);
        others += "[shape." + name + "]\nsphere = { radius = 1 }\ncollide = \"exact\"\n" +
                  "[[body]]\nname = \"" + name + "\"\nshape = \"" + name +
                  "\"\nmaterial = \"wood\"\nposition = [" + std::to_string(1000 + 5 * n) +
                  ", 5, 0]\n";
    }
    const auto bytesWith = [&](const std::string& end) {
        return buildWorld(boardsShot(folder, "", end)).shapeOf(0).distance.byteCount();
    };
    EXPECT_LE(bytesWith(others), bytesWith("") / 2);
}

TEST(BuildWorld, DescriptionHasTheArtistsMeshOncePerShapeAndPlanesAsSquares)
{
    const test::TemporaryFolder folder;
    const Shot shot = slabShot(folder, "",
                               "grid = { count = [3, 1, 1], spacing = [5, 0, 0] }\n"
                               "[[body]]\nname = \"ground\"\nmaterial = \"wood\"\n"
                               "motion = \"static\"\nplane = { point = [0, -4, 0], "
                               "normal = [1, 0, 0] }\n");
    const World world = buildWorld(shot);
    const SceneDescription scene = describeScene(shot, world, 100.0);
    EXPECT_EQ(scene.name, "s");
    EXPECT_EQ(scene.metresPerUnit, 0.01);
    ASSERT_EQ(scene.bodies.size(), 4u);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.bodies[2].name, "a_0002");
    EXPECT_EQ(scene.bodies[2].mesh, 0u);
    EXPECT_TRUE(scene.bodies[2].moves);
    EXPECT_EQ(scene.bodies[2].material, "wood");
    EXPECT_FALSE(scene.bodies[3].moves);
    EXPECT_EQ(scene.bodies[3].mass, 0.0);
    EXPECT_TRUE(scene.meshes[0].points.rowwise().maxCoeff().isApprox(Vec3(2.0, 1.0, 1.0)));
    EXPECT_EQ(scene.meshes[0].points.rowwise().minCoeff(), Vec3(0.0, 0.0, 0.0));

    // The square stands in the plane and its front is where the normal points.
    const SceneFrame frame = captureFrame(shot, world);
    const SceneMesh& square = scene.meshes[1];
    const Pose& pose = frame.worldFromAsset[3];
    EXPECT_TRUE(pose.position.isApprox(Vec3(0.0, -4.0, 0.0)));
    for (int f = 0; f < 2; ++f) {
        const Vec3 a = pose * Vec3(square.points.col(square.triangles(0, f)));
        const Vec3 b = pose * Vec3(square.points.col(square.triangles(1, f)));
        const Vec3 c = pose * Vec3(square.points.col(square.triangles(2, f)));
        EXPECT_TRUE((b - a).cross(c - a).normalized().isApprox(Vec3::UnitX(), 1e-12));
        EXPECT_NEAR(a.x(), 0.0, 1e-12);
        EXPECT_NEAR((b - a).cross(c - a).norm(), 200.0 * 200.0, 1e-6);
    }
}

TEST(BuildWorld, AssetErrorsAreLocatedAtTheShapeAndSaidOnce)
{
    const test::TemporaryFolder folder;
    const std::string path = (folder / "s.toml").string();
    std::ofstream(folder / "open.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n";
    const Shot shot =
        parseShotText(kHead +
                          "[shape.gone]\nfile = \"gone.obj\"\n[shape.open]\nfile = \"open.obj\"\n"
                          "[shape.unused]\nfile = \"unused.obj\"\n"
                          "[[body]]\nname = \"a\"\nshape = \"gone\"\nmaterial = \"wood\"\n"
                          "grid = { count = [2, 1, 1], spacing = [9, 9, 9] }\n"
                          "[[body]]\nname = \"b\"\nshape = \"open\"\nmaterial = \"wood\"\n",
                      path);
    const test::Refusal refusal = test::refusalBy([&] { buildWorld(shot); });
    const std::string& message = refusal.message;
    const std::string first = path + ":7:8: mesh file '" + (folder / "gone.obj").string() +
                              "' does not exist\n" + path + ":9:8: ";
    EXPECT_EQ(message.rfind(first, 0), 0u) << message;
    EXPECT_NE(message.find("open"), std::string::npos) << message;
    EXPECT_EQ(message.find("unused"), std::string::npos) << message;
    EXPECT_EQ(refusal.kind, ErrorKind::badInput);
}

// In centimetres instead of metres a voxel was larger than its shape, and bodies fell through it.
TEST(BuildWorld, AVoxelThatLeavesNothingOfAShapeIsRefusedAsAResolutionIs)
{
    const auto refusalOf = [](const char* voxel) {
        return test::refusalBy([&] {
            buildWorld(parseShotText(
                std::string(kHead) +
                    "[shape.b]\nbox = { size = [1, 1, 1] }\nsdf = { voxel = " + voxel +
                    " }\n[[body]]\nname = \"b\"\nshape = \"b\"\n"
                    "material = \"wood\"\n",
                "s.toml"));
        });
    };
    EXPECT_TRUE(refusalOf("5").mentions("makes 0.2 of them along")) << refusalOf("5").message;
    EXPECT_TRUE(refusalOf("0.2").mentions("a field has 8 to 512"));
    EXPECT_TRUE(refusalOf("1e-9").mentions("a field has 8 to 512"));
    EXPECT_FALSE(refusalOf("0.1").kind) << refusalOf("0.1").message;
}

// Of four hundred shards each is too small to be shared out among many threads.
TEST(BuildWorld, ShapesMadeSideBySideAreThoseMadeOneAfterAnother)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "open.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n";
    const auto shotOf = [&](int count, const std::string& every) {
        std::string text = kHead + "[[body]]\nname = \"floor\"\nplane = { normal = [0, 1, 0] }\n" +
                           "motion = \"static\"\nmaterial = \"wood\"\n";
        for (int n = 0; n < count; ++n) {
            const std::string name = "s" + std::to_string(n);
            const bool isFine = n == 7;  // more triangles than all others together
            text += "[shape." + name + "]\n" +
                    (n % 9 == 3 && !every.empty() ? every
                     : isFine
                         ? "sphere = { radius = 3, subdivisions = 4 }"
                         : "torus = { major = " + std::to_string(2 + 0.1 * n) + ", minor = 0.5 }") +
                    "\nsdf = { resolution = 24 }\n[[body]]\nname = \"" + name + "\"\nshape = \"" +
                    name + "\"\nmaterial = \"wood\"\nposition = [" + std::to_string(20 * n) +
                    ", 9, 0]\n";
        }
        return parseShotText(text, (folder / "s.toml").string());
    };
    const Shot good = shotOf(30, ""), bad = shotOf(30, "file = \"open.obj\"");
    const int before = threadCount();
    std::vector<std::string> fields, messages;
    for (const int threads : {1, 4}) {
        setThreadCount(threads);
        ShapeCache cache(folder / std::to_string(threads));
        const World world = buildWorld(good, &cache);
        EXPECT_EQ(cache.keptCount(), 30);
        std::string& all = fields.emplace_back();
        for (std::size_t body = 1; body < world.bodyCount(); ++body) {
            const Shape& shape = world.shapeOf(static_cast<BodyId>(body));
            all += shape.name + bytesOfField(0, shape.distance.field());
        }
        messages.push_back(test::refusalBy([&] { buildWorld(bad); }).message);
    }
    setThreadCount(before);
    EXPECT_EQ(fields[0], fields[1]);
    EXPECT_EQ(messages[0], messages[1]);
    EXPECT_EQ(std::ranges::count(messages[0], '\n'), 2) << messages[0];  // three of them
}

TEST(BuildWorld, AMeshThatIsRoughForItLiesFarFromItsOriginIsToldAsSuch)
{
    const test::TemporaryFolder folder;
    const Shot shot = slabShot(folder, "", "");
    const auto moveBy = [&](const std::string& digits) {  // which come before those of x
        std::string text = kSlabObj;
        for (std::size_t at = 0; (at = text.find("v ", at)) != std::string::npos; at += 2) {
            text.insert(at + 2, digits);
        }
        std::ofstream(folder / "slab.obj") << text;
    };
    moveBy("1000");  // two units long, ten thousand from its origin
    const World world = buildWorld(shot);
    EXPECT_EQ(roughnessOf(world.shapeOf(0).assetMesh, 0.001), "");
    EXPECT_NE(roughnessOf(world.shapeOf(0).assetMesh, 0.0001), "");
    moveBy("400000");  // four million, where units have quarters
    const test::Refusal refusal = test::refusalBy([&] { buildWorld(shot); });
    EXPECT_TRUE(
        refusal.mentions("shape 'slab' lies 4e+04 m from the origin of its file, where single "
                         "precision is exact to 0.0024 m only, and is 0.02 m long"))
        << refusal.message;
}

TEST(BuildWorld, AShapeNamedPlaneDoesNotCollideWithPlanes)
{
    const Shot shot =
        parseShotText(kHead +
                          "[shape.plane]\nbox = {}\n[[body]]\nname = \"a\"\nshape = \"plane\"\n"
                          "material = \"wood\"\n[[body]]\nname = \"g\"\nmaterial = \"wood\"\n"
                          "motion = \"static\"\nplane = { normal = [0, 1, 0] }\n",
                      "s.toml");
    const SceneDescription scene = describeScene(shot, buildWorld(shot), 10.0);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].name, "plane");
    EXPECT_NE(scene.meshes[1].name, "plane");
}

}  // namespace
}  // namespace scree
