// The shots that come with the project.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/dynamics/start_check.h"
#include "core/dynamics/start_overlap.h"
#include "core/geometry/mesh_defects.h"
#include "io/build_world.h"
#include "io/mesh_import.h"
#include "io/shot_parser.h"
#include "tests/support/import_mesh.h"
#include "tests/support/support.h"

namespace scree {
namespace {

Shot shippedShot(const std::string& name)
{
    return parseShot(test::sourceFile("shots/" + name).string());
}

TEST(ShotFiles, AllParseAndKeepTheirMeaningWhenResolved)
{
    int count = 0;
    for (const auto& file :
         std::filesystem::recursive_directory_iterator(test::sourceFile("shots"))) {
        if (file.path().extension() != ".toml") continue;
        const std::string path = file.path().string();
        const Shot shot = parseShot(path);
        EXPECT_EQ(parseShotText(shot.resolvedText, path).resolvedText, shot.resolvedText) << path;
        EXPECT_EQ(shot.name, file.path().stem().string());
        EXPECT_FALSE(shot.bodies.empty()) << path;
        EXPECT_FALSE(shot.cameras.empty()) << path;
        ++count;
    }
    EXPECT_GE(count, 34);
}

/// Names of the shots themselves, without those of the experiments.
std::vector<std::string> shippedNames()
{
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(test::sourceFile("shots"))) {
        if (file.path().extension() == ".toml") names.push_back(file.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

class EveryShot : public testing::TestWithParam<std::string> {};

TEST_P(EveryShot, StartsWithNothingToComplainOf)
{
    const Shot shot = shippedShot(GetParam() + ".toml");
    const World world = buildWorld(shot);
    const std::vector<StartOverlap> overlaps = findStartOverlaps(world, shot.penetrationWarn);
    EXPECT_TRUE(overlaps.empty()) << world.info[overlaps.front().a].name << " and "
                                  << world.info[overlaps.front().b].name;
    const std::vector<BodyId> loose = findUnsupported(world, shot.settings.gravity);
    EXPECT_TRUE(loose.empty()) << world.info[loose.front()].name << " will fall for ever";
    const std::vector<FastBody> fast =
        findTooFast(world, shot.settings, 1.0 / shot.framesPerSecond);
    EXPECT_TRUE(fast.empty()) << world.info[fast.front().body].name << " is too fast";
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const Shape& shape = world.shapeOf(static_cast<BodyId>(i));
        const bool isMeant = shape.repairs.asked != MeshRepair::none;
        EXPECT_TRUE(isMeant || shape.repairs.harmless.isNone()) << shape.name << " needs repair";
    }
}

INSTANTIATE_TEST_SUITE_P(ShotFiles, EveryShot, testing::ValuesIn(shippedNames()),
                         [](const auto& one) { return one.param; });

TEST(ShotFiles, RingsStartApartAndAboveThePoles)
{
    const Shot shot = shippedShot("rings_100.toml");
    std::vector<Vec3> rings;
    int poleCount = 0;
    for (const ShotBody& body : shot.bodies) {
        if (body.shape == "ring") rings.push_back(body.worldFromAsset.position);
        if (body.shape != "pole") continue;
        ++poleCount;
        EXPECT_EQ(body.worldFromAsset.position.y(), 4.0);
    }
    ASSERT_EQ(rings.size(), 100u);
    EXPECT_EQ(poleCount, 25);
    // A ring fits in a ball of 1.25 m about its centre.
    for (std::size_t i = 0; i < rings.size(); ++i) {
        EXPECT_GT(rings[i].y() - 1.25, 8.0);
        for (std::size_t j = 0; j < i; ++j) EXPECT_GT((rings[i] - rings[j]).norm(), 2.5);
    }
    EXPECT_EQ(shot.lastFrame - shot.firstFrame + 1, 240);
}

TEST(ShotFiles, StackedCubesTouchExactly)
{
    const Shot shot = shippedShot("stack_10.toml");
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(shot.bodies[i].worldFromAsset.position, Vec3(0.0, i + 0.5, 0.0));
    }
}

TEST(ShotFiles, BlocksLieOnTheSlopeAndOnlyRubberSticks)
{
    const Shot shot = shippedShot("incline.toml");
    const PlaneSpec slope = *shot.bodies[0].plane;
    const double steepness = std::hypot(slope.normal.x(), slope.normal.z()) / slope.normal.y();
    std::map<std::string, double> friction;
    for (const ShotMaterial& material : shot.materials) {
        friction[material.material.name] = material.material.friction;
    }
    int sticking = 0, sliding = 0;
    for (std::size_t i = 1; i < shot.bodies.size(); ++i) {
        const Vec3 bottom = shot.bodies[i].worldFromAsset * Vec3(0.7, -0.3, 0.7);
        EXPECT_NEAR((bottom - slope.point).dot(slope.normal), 0.0, 1e-14);
        const double mu = std::max(friction["slope"], friction[shot.bodies[i].material]);
        EXPECT_EQ(mu > steepness, shot.bodies[i].material == "rubber");
        ++(mu > steepness ? sticking : sliding);
    }
    EXPECT_EQ(sticking, 1);
    EXPECT_EQ(sliding, 2);
}

TEST(ShotFiles, WedgeIsASharpSolidOfTwelveTriangles)
{
    const TriMesh wedge = test::importMesh(test::sourceFile("shots/meshes/wedge.obj").string());
    EXPECT_EQ(wedge.triangles.cols(), 12);
    EXPECT_TRUE(findDefects(wedge).empty());
    // Every wedge fits in a ball about its origin, and the balls do not overlap at the start.
    const double reach = wedge.points.colwise().norm().maxCoeff();
    const Shot shot = shippedShot("wedges.toml");
    ASSERT_EQ(shot.bodies.size(), 61u);
    for (std::size_t i = 0; i + 1 < shot.bodies.size(); ++i) {
        EXPECT_GT(shot.bodies[i].worldFromAsset.position.y(), reach);
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 apart =
                shot.bodies[i].worldFromAsset.position - shot.bodies[j].worldFromAsset.position;
            EXPECT_GT(apart.norm(), 2.0 * reach) << i << " " << j;
        }
    }
}

TEST(ShotFiles, BonesAreSolidsOfTheTrianglesTheyPromise)
{
    struct Bone {
        std::string name;
        Eigen::Index triangles;
        Eigen::Index handles;  ///< genus
    };
    // The skull: brain case with two eyes, a nose and the way out below, cheek and jaw bones as
    // handles. The pelvis: the brim and two seats.
    for (const Bone& bone : {Bone{"skull", 3520, 6}, {"pelvis", 8680, 3}, {"femur", 8160, 0}}) {
        const TriMesh mesh =
            test::importMesh(test::sourceFile("shots/meshes/" + bone.name + ".ply").string());
        EXPECT_EQ(mesh.triangles.cols(), bone.triangles) << bone.name;
        EXPECT_TRUE(findDefects(mesh).empty()) << bone.name;
        // Euler's formula, with three half edges to a face.
        EXPECT_EQ(mesh.points.cols() - mesh.triangles.cols() / 2, 2 - 2 * bone.handles)
            << bone.name;
    }
}

TEST(ShotFiles, BonesStartApartInColumnsAboveTheFunnel)
{
    // Balls as given to tools/scatter_poses.py hold the bones, which are scaled by 0.8.
    const std::map<std::string, double> balls = {
        {"skull", 0.345}, {"pelvis", 0.34}, {"femur", 0.345}};
    for (const auto& [name, radius] : balls) {
        const TriMesh mesh =
            test::importMesh(test::sourceFile("shots/meshes/" + name + ".ply").string());
        EXPECT_LT(0.8 * mesh.points.colwise().norm().maxCoeff(), radius) << name;
    }
    const Shot shot = shippedShot("bones_500.toml");
    std::map<std::string, int> counts;
    std::vector<std::pair<Vec3, double>> placed;
    for (const ShotBody& body : shot.bodies) {
        if (!body.shape || !balls.count(*body.shape)) continue;
        ++counts[*body.shape];
        const double radius = balls.at(*body.shape);
        const Vec3 at = body.worldFromAsset.position;
        EXPECT_GE(at.y() - radius, 10.0);
        EXPECT_LE(at.y() + radius, 50.0);
        for (const auto& [other, otherRadius] : placed) {
            EXPECT_GT((at - other).norm(), radius + otherRadius - 1e-6);
        }
        placed.emplace_back(at, radius);
    }
    EXPECT_EQ(counts, (std::map<std::string, int>{{"skull", 300}, {"pelvis", 150}, {"femur", 50}}));
}

TEST(ShotFiles, ExactShapesAreBuiltWithTheirScaleAndTheMassOfTheSolid)
{
    const Shot shot = parseShotText(
        "scree = 1\n[shot]\nname = \"s\"\nunits = \"cm\"\n[material.m]\ndensity = 1000\n"
        "[shape.pole]\ncylinder = { radius = 10, height = 100 }\nscale = [2, 1, 2]\n"
        "collide = \"exact\"\n[[body]]\nname = \"b\"\nshape = \"pole\"\nmaterial = \"m\"\n",
        "s.toml");
    const World world = buildWorld(shot);
    const ExactSolid* solid = world.shapeOf(0).distance.solid();
    ASSERT_NE(solid, nullptr);
    EXPECT_TRUE(solid->half().isApprox(Vec3(0.2, 0.5, 0.2), 1e-12));
    EXPECT_NEAR(1.0 / world.mass[0].inverseMass, 1000.0 * std::acos(-1.0) * 0.04, 1e-9);
}

TEST(ShotFiles, WedgesBuildWithNormalsOfTheMeshAndEdgeSamples)
{
    const Shot shot = shippedShot("wedges.toml");
    const World world = buildWorld(shot);
    ASSERT_EQ(world.bodyCount(), 61u);
    EXPECT_TRUE(world.shapeOf(0).usesTrueNormals);
    EXPECT_GT(world.shapeOf(0).samples.edges.size(), 0u);
}

}  // namespace
}  // namespace scree
