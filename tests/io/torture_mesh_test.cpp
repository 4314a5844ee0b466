// The torture set: every class of bad mesh, made from clean ones, has one stated outcome. It is a
// solid, silently or with a repair that is told; or it is refused with a word that says why and,
// where that can help, a repair that one may ask for. Nothing crashes.  [A1]
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <map>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/mesh_repair.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/geometry/shape_report.h"
#include "core/geometry/winding_number.h"
#include "io/mesh_import.h"
#include "tests/support/both_meshes.h"
#include "tests/support/import_mesh.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

using test::both;

TriMesh cube()
{
    return makeBox(Vec3::Ones(), {2, 2, 2});
}

TriMesh withTriangle(TriMesh mesh, int a, int b, int c)
{
    mesh.triangles.conservativeResize(3, mesh.triangles.cols() + 1);
    mesh.triangles.rightCols(1) << a, b, c;
    return mesh;
}

TriMesh withPoint(TriMesh mesh, const Vec3& point)
{
    mesh.points.conservativeResize(3, mesh.points.cols() + 1);
    mesh.points.rightCols(1) = point;
    return mesh;
}

TriMesh moved(const TriMesh& mesh, const Vec3& by)
{
    return transformed(mesh, {by, Quat::Identity()});
}

TriMesh turned(TriMesh mesh)
{
    mesh.triangles.row(1).swap(mesh.triangles.row(2));
    return mesh;
}

TriMesh scaled(const TriMesh& mesh, double scale)
{
    return transformed(mesh, Pose(), Vec3::Constant(scale));
}

/// Every triangle with points of its own, as STL stores them.
TriMesh exploded(const TriMesh& mesh)
{
    TriMesh soup{Points(3, 3 * mesh.triangles.cols()), Triangles(3, mesh.triangles.cols())};
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k) {
            soup.points.col(3 * f + k) = mesh.points.col(mesh.triangles(k, f));
            soup.triangles(k, f) = static_cast<int>(3 * f + k);
        }
    }
    return soup;
}

/// One face is cut in two at the middle of an edge; a triangle without area fills the crack, as
/// modellers leave them.
TriMesh withFlatTriangle()
{
    TriMesh mesh = cube();
    const int a = mesh.triangles(0, 0), c = mesh.triangles(1, 0), x = mesh.triangles(2, 0);
    mesh = withPoint(mesh, 0.5 * (mesh.points.col(a) + mesh.points.col(c)));
    const int m = static_cast<int>(mesh.points.cols()) - 1;
    mesh.triangles.col(0) << a, m, x;
    return withTriangle(withTriangle(mesh, m, c, x), a, c, m);
}

/// A square of n × n cells in the plane y = 0.
TriMesh sheet(int n)
{
    TriMesh mesh{Points(3, (n + 1) * (n + 1)), Triangles(3, 2 * n * n)};
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            mesh.points.col(i + (n + 1) * j) = Vec3(i, 0.0, j) / n - Vec3(0.5, 0.0, 0.5);
        }
    }
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const int p = i + (n + 1) * j, q = p + n + 1;
            mesh.triangles.col(2 * (i + n * j)) << p, q, p + 1;
            mesh.triangles.col(2 * (i + n * j) + 1) << p + 1, q, q + 1;
        }
    }
    return mesh;
}

TriMesh withoutFace()
{
    TriMesh mesh = cube();
    mesh.triangles = mesh.triangles.leftCols(mesh.triangles.cols() - 8).eval();
    return mesh;
}

std::string refusalOf(const TriMesh& mesh, const ShapeSettings& settings = {})
{
    const test::Refusal refusal = test::refusalBy([&] { buildMeshShape("thing", mesh, settings); });
    EXPECT_EQ(refusal.kind, ErrorKind::badInput);
    return refusal.message;
}

TEST(TortureMesh, WhatIsHarmlessIsRepairedAndTold)
{
    struct Case {
        const char* name;
        TriMesh mesh;
        std::string told;
    };
    const Case cases[] = {
        {"clean", cube(), ""},
        {"split points", exploded(cube()), "merged 118 equal or unused points"},
        {"unused point", withPoint(cube(), Vec3(9, 9, 9)), "merged 1 equal or unused points"},
        {"repeated corner", withTriangle(cube(), 0, 0, 1), "dropped 1 triangles without area"},
        {"flat triangle", withFlatTriangle(), "flipped 1 edges of flat triangles"},
        {"inside-out", turned(cube()), "turned the mesh, which was inside-out"},
    };
    for (const Case& item : cases) {
        const auto shape = buildMeshShape("thing", item.mesh);
        EXPECT_EQ(describe(shape->repairs.harmless), item.told) << item.name;
        EXPECT_NEAR(shape->unitMass.volume, 1.0, 1e-12) << item.name;
        EXPECT_EQ(shape->assetMesh.triangles, item.mesh.triangles) << item.name;
    }
}

/// Splits edges of a mesh on one side only and closes the gap with a triangle without area, as
/// often as no triangle is touched twice.
TriMesh withFlatTriangles(TriMesh mesh)
{
    std::map<std::pair<int, int>, int> walkers;
    for (int f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k)
            walkers[{mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f)}] = f;
    }
    std::vector<char> isTouched(static_cast<std::size_t>(mesh.triangles.cols()), 0);
    std::vector<Vec3> points;
    std::vector<Eigen::Vector3i> triangles;
    for (const auto& [edge, f] : walkers) {
        const auto [c, a] = edge;
        const int across = walkers.at({a, c});
        if (isTouched[f] || isTouched[across]) continue;
        isTouched[f] = isTouched[across] = 1;
        const int b = static_cast<int>(mesh.points.cols() + points.size());
        points.push_back(0.5 * (mesh.points.col(c) + mesh.points.col(a)));
        int far = 0;
        for (const int corner : mesh.triangles.col(f))
            far = corner == a || corner == c ? far : corner;
        mesh.triangles.col(f) << c, b, far;
        triangles.push_back({b, a, far});
        triangles.push_back({c, a, b});
    }
    TriMesh result{Points(3, mesh.points.cols() + points.size()),
                   Triangles(3, mesh.triangles.cols() + triangles.size())};
    result.points.leftCols(mesh.points.cols()) = mesh.points;
    result.triangles.leftCols(mesh.triangles.cols()) = mesh.triangles;
    for (std::size_t i = 0; i < points.size(); ++i)
        result.points.col(mesh.points.cols() + i) = points[i];
    for (std::size_t i = 0; i < triangles.size(); ++i)
        result.triangles.col(mesh.triangles.cols() + i) = triangles[i];
    return result;
}

// In a file of single precision a T-junction that was closed is flat but for rounding, and its
// normal is noise: a ball became a body with blades.
TEST(TortureMesh, WhatIsFlatButForRoundingIsFlipped)
{
    TriMesh ball = makeSphere(0.3, 3);
    const auto rounded = [](TriMesh mesh) {
        mesh.points = mesh.points.cast<float>().cast<double>().eval();
        return mesh;
    };
    const TriMesh closed = rounded(withFlatTriangles(rounded(ball)));
    const auto shape = buildMeshShape("ball", closed);
    EXPECT_GT(shape->repairs.harmless.flippedEdges, 100);
    EXPECT_FALSE(shape->usesTrueNormals);
    EXPECT_FALSE(shape->features.hasBlades());
}

// Of two flat triangles in a row one was given up, if it came first.
TEST(TortureMesh, FlatTrianglesInARowAreFlippedInAnyOrder)
{
    // The long edge 0-1 of a face has points at its thirds, and two triangles that close it.
    TriMesh mesh = makeBox({3, 1, 1}, {1, 1, 1});
    std::map<std::pair<int, int>, int> walkers;
    for (int f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k)
            walkers[{mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f)}] = f;
    }
    const auto isLong = [&](const std::pair<int, int>& edge) {
        const double length = (mesh.points.col(edge.first) - mesh.points.col(edge.second)).norm();
        return std::abs(length - 3.0) < 1e-9;
    };
    const auto found =
        std::ranges::find_if(walkers, [&](const auto& one) { return isLong(one.first); });
    ASSERT_NE(found, walkers.end());
    const auto [a, b] = found->first;
    const Vec3 start = mesh.points.col(a), way = mesh.points.col(b) - mesh.points.col(a);
    const int near = static_cast<int>(mesh.points.cols()), far = near + 1;
    int third = 0;
    for (const int corner : mesh.triangles.col(found->second))
        third = corner == a || corner == b ? third : corner;
    mesh.triangles.col(found->second) << a, near, third;
    mesh = withPoint(withPoint(mesh, start + way / 3.0), start + 2.0 * way / 3.0);
    mesh = withTriangle(withTriangle(mesh, near, far, third), far, b, third);
    for (const bool isTurned : {false, true}) {
        const auto add = [&](const TriMesh& to, bool isOuter) {
            return isOuter ? withTriangle(to, a, b, near) : withTriangle(to, near, b, far);
        };
        HarmlessRepairs repairs;
        const TriMesh repaired = repairHarmlessly(add(add(mesh, isTurned), !isTurned), repairs);
        EXPECT_EQ(repairs.flippedEdges, 2) << isTurned;
        EXPECT_TRUE(findDefects(repaired).empty()) << isTurned;
    }
}

// All edges were mapped anew for each of the triangles: 4000 of them took a minute.
TEST(TortureMesh, ThousandsOfTrianglesWithoutAreaAreFlippedInNoTime)
{
    const TriMesh mesh = withFlatTriangles(makeBox(Vec3::Ones(), {32, 32, 32}));
    const std::clock_t start = std::clock();
    HarmlessRepairs repairs;
    const TriMesh repaired = repairHarmlessly(mesh, repairs);
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 2.0);
    EXPECT_GT(repairs.flippedEdges, 4000);
    EXPECT_TRUE(findDefects(repaired).empty());
    EXPECT_NEAR(signedVolume(repaired), 1.0, 1e-12);
}

TEST(TortureMesh, EveryOtherDefectIsRefusedByName)
{
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    TriMesh flippedFace = cube();
    std::swap(flippedFace.triangles(1, 5), flippedFace.triangles(2, 5));
    TriMesh broken = cube();
    broken.points(1, 3) = nan;
    TriMesh endless = cube();
    endless.points(2, 7) = -infinity;
    TriMesh dangling = cube();
    dangling.triangles(0, 0) = 4711;
    TriMesh negative = cube();
    negative.triangles(2, 1) = -1;
    TriMesh flat = cube();
    flat.points.row(1).setZero();
    const int fin = static_cast<int>(cube().points.cols());
    const TriMesh inner = scaled(cube(), 0.5);
    const TriMesh block = makeBox(Vec3::Ones(), {1, 1, 1});
    struct Case {
        const char* name;
        TriMesh mesh;
        const char* why;
    };
    const Case cases[] = {
        {"a face is missing", withoutFace(), "open edge at ("},
        {"a sheet", sheet(4), "open edge at ("},
        {"a face is turned round", flippedFace, "oriented against each other"},
        {"a fin", withTriangle(withPoint(cube(), Vec3(3, 3, 3)), 0, 1, fin), "non-manifold edge"},
        {"a face twice",
         withTriangle(cube(), cube().triangles(0, 0), cube().triangles(1, 0),
                      cube().triangles(2, 0)),
         "non-manifold edge"},
        {"two that pierce", both(cube(), moved(cube(), Vec3(0.61, 0.43, 0.27))),
         "face that pierces another"},
        {"two that pierce on a grid", both(block, moved(block, Vec3::Constant(0.5))),
         "face that pierces another"},
        {"two that pierce flush", both(block, moved(block, Vec3(0.5, 0.5, 0.0))),
         "face that pierces another"},
        {"two flush all around", both(block, moved(block, Vec3(0.5, 0.0, 0.0))),
         "part that lies inside another"},
        {"one within another", both(cube(), inner), "part that lies inside another"},
        {"a part inside-out", both(cube(), moved(turned(inner), Vec3(5, 0, 0))),
         "part that is turned inside-out"},
        {"all in one plane", flat, "is not a closed"},
        {"not a number", broken, "point that is not a number"},
        {"infinite", endless, "point that is not a number"},
        {"no such corner", dangling, "corner that does not exist"},
        {"negative corner", negative, "corner that does not exist"},
        {"nothing", TriMesh(), "no triangles"},
        {"points alone", TriMesh{cube().points, Triangles(3, 0)}, "no triangles"},
        {"huge", scaled(cube(), 1e12), "farther than 1e9 m"},
        {"beyond floats", scaled(cube(), 1e300), "farther than 1e9 m"},
        {"tiny", scaled(cube(), 1e-12), "size of less than 1e-9 m"},
        {"a foil", makeBox({1.0, 1e-3, 1.0}, {2, 1, 2}), "voxels"},
    };
    for (const Case& item : cases) {
        const std::string told = refusalOf(item.mesh);
        EXPECT_NE(told.find(item.why), std::string::npos) << item.name << ": " << told;
        EXPECT_NE(told.find("'thing'"), std::string::npos) << item.name;
    }
    EXPECT_NE(refusalOf(withoutFace()).find("repair = \"wrap\""), std::string::npos);
    // A cavity and a second solid beside the first are no defects.
    EXPECT_TRUE(findDefects(both(cube(), turned(inner))).empty());
    EXPECT_TRUE(findDefects(both(cube(), moved(cube(), Vec3(1.5, 0, 0)))).empty());
}

TEST(TortureMesh, AtEveryScaleTheOutcomeIsTheSame)
{
    for (const double scale : {1e-3, 1e-1, 1e1, 1e3}) {
        const auto shape = buildMeshShape("thing", scaled(cube(), scale));
        EXPECT_NEAR(shape->unitMass.volume / std::pow(scale, 3), 1.0, 1e-12) << scale;
        EXPECT_EQ(
            describe(buildMeshShape("thing", scaled(withFlatTriangle(), scale))->repairs.harmless),
            "flipped 1 edges of flat triangles")
            << scale;
        EXPECT_NE(refusalOf(scaled(withoutFace(), scale)).find("open edge"), std::string::npos);
        EXPECT_NE(refusalOf(scaled(both(cube(), moved(cube(), Vec3(0.61, 0.43, 0.27))), scale))
                      .find("pierces"),
                  std::string::npos)
            << scale;
    }
}

ShapeSettings repairBy(MeshRepair repair, double thickness = 0.0)
{
    ShapeSettings settings;
    settings.repair = repair;
    settings.repairThickness = thickness;
    settings.resolution = 48;
    return settings;
}

TEST(TortureMesh, WrapMakesTheSolidThatTheMeshNearlyBounds)
{
    const Vec3 by(0.61, 0.43, 0.27);
    const double shared = (1 - 0.61) * (1 - 0.43) * (1 - 0.27);
    struct Case {
        const char* name;
        TriMesh mesh;
        double volume;
    };
    const int fin = static_cast<int>(cube().points.cols());
    const Case cases[] = {
        {"two that pierce", both(cube(), moved(cube(), by)), 2.0 - shared},
        {"one within another", both(cube(), scaled(cube(), 0.5)), 1.0},
        {"a fin", withTriangle(withPoint(cube(), Vec3(0.9, 0.9, 0.9)), 0, 1, fin), 1.0},
        // In the plane of the missing face the others fill half of all directions: the wrap is
        // flat.
        {"a face is missing", withoutFace(), 1.0},
        {"at 1e-3", scaled(both(cube(), moved(cube(), by)), 1e-3), 1e-9 * (2.0 - shared)},
    };
    for (const Case& item : cases) {
        const auto shape = buildMeshShape("thing", item.mesh, repairBy(MeshRepair::wrap));
        // Edges are rounded by about a voxel, a forty-eighth: 12 edges of length 1 and a section of
        // half a square voxel, and as much again for what the lattice cuts.
        EXPECT_NEAR(shape->unitMass.volume / item.volume, 1.0, 0.03) << item.name;
        EXPECT_EQ(shape->repairs.asked, MeshRepair::wrap);
        EXPECT_TRUE(findDefects(shape->mesh, DefectSearch::topology).empty());
    }
}

TEST(TortureMesh, AShellManyTimesAsThickAsItsMeshIsLongIsRefusedAtOnce)
{
    // In metres instead of centimetres: it filled the memory for minutes.
    const std::string message = refusalOf(sheet(4), repairBy(MeshRepair::shell, 100.0));
    EXPECT_NE(message.find("the shell is thicker than the shape is long"), std::string::npos)
        << message;
}

TEST(TortureMesh, AShapeFlatToTheRoundingOfItsNumbersIsMeasuredInTime)
{
    // The search for its largest ball climbed for ever.
    TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
    ring.points.row(1) *= 1e-12;
    ShapeSettings settings;
    settings.resolution = 32;
    EXPECT_LT(buildMeshShape("thing", ring, settings)->innerBall.radius, 1e-12);
}

TEST(TortureMesh, AShellGivesASheetItsThickness)
{
    const double thickness = 0.1;
    const auto shape = buildMeshShape("thing", sheet(4), repairBy(MeshRepair::shell, thickness));
    // A unit square of that thickness with a rounded rim of half the thickness.
    const double volume = thickness + 0.25 * 3.14159265 * thickness * thickness * 4.0 / 2.0;
    EXPECT_NEAR(shape->unitMass.volume / volume, 1.0, 0.03);
    EXPECT_NEAR(shape->innerThickness / thickness, 1.0, 0.1);
    EXPECT_NEAR(shape->repairs.drawnToColliding.distance / (0.5 * thickness), 1.0, 0.1);
    EXPECT_NE(refusalOf(sheet(4), repairBy(MeshRepair::shell, 0.01)).find("more than the 256"),
              std::string::npos);
}

/// A sheet with a hill that hangs over, a hole beside it, and an upright cliff.
TriMesh terrain()
{
    constexpr int kCells = 24, kCliff = 20;
    TriMesh mesh = sheet(kCells);
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const double x = mesh.points(0, v), z = mesh.points(2, v);
        const double hill = 0.3 * std::max(0.0, 1.0 - 16.0 * (x * x + z * z));
        mesh.points(1, v) = hill;
        mesh.points(0, v) += 1.5 * hill;
        if (v / (kCells + 1) < kCliff) continue;
        mesh.points(1, v) -= 0.2;
        mesh.points(2, v) -= 1.0 / kCells;
    }
    Triangles kept(3, mesh.triangles.cols() - 2);
    kept << mesh.triangles.leftCols(100), mesh.triangles.rightCols(mesh.triangles.cols() - 102);
    mesh.triangles = kept;
    return mesh;
}

TEST(TortureMesh, AGroundIsTouchedWhereItIsDrawn)
{
    const TriMesh drawn = terrain();
    const auto shape = buildMeshShape("thing", drawn, repairBy(MeshRepair::ground));
    EXPECT_TRUE(findDefects(shape->mesh).empty());
    int ofFloor = 0;
    for (Eigen::Index f = 0; f < shape->mesh.triangles.cols(); ++f) {
        const TriangleCorners corners = cornersOf(shape->mesh, f);
        const auto heightOf = [&](const Vec3& p) {
            return (inverse(shape->bodyFromAsset) * p).y();
        };
        if (std::max({heightOf(corners.a), heightOf(corners.b), heightOf(corners.c)}) > -0.3 + 1e-9)
            continue;
        ++ofFloor;
        EXPECT_GT(corners.areaVector().norm(), 1e-6) << f;
    }
    EXPECT_EQ(ofFloor, drawn.triangles.cols());
    EXPECT_EQ(shape->repairs.asked, MeshRepair::ground);
    EXPECT_EQ(shape->repairs.groundUp, Vec3(0, 1, 0));
    EXPECT_NEAR(shape->repairs.behind, 0.1, 1e-12);
    int overhanging = 0;
    for (Eigen::Index f = 0; f < drawn.triangles.cols(); ++f) {
        const TriangleCorners corners = cornersOf(drawn, f);
        overhanging += corners.normal().y() < 0.0;
        const Vec3 middle = shape->bodyFromAsset * corners.middle();
        const Vec3 out = shape->bodyFromAsset.orientation * corners.normal();
        EXPECT_NEAR(shape->distance.value(middle + 1e-3 * out), 1e-3, 1e-9) << f;
        EXPECT_NEAR(shape->distance.value(middle - 1e-3 * out), -1e-3, 1e-9) << f;
    }
    EXPECT_GT(overhanging, 0);
}

TEST(TortureMesh, AGroundIsSolidBehindItsFacesDownToItsFloor)
{
    const TriMesh flat = sheet(4);
    EXPECT_NEAR(buildMeshShape("thing", flat, repairBy(MeshRepair::ground))->unitMass.volume, 0.1,
                1e-12);
    const auto below = buildMeshShape("thing", flat, repairBy(MeshRepair::ground, 2.0));
    EXPECT_EQ(below->mesh.triangles.cols(), 32 + 3 * 16);
    EXPECT_NEAR(below->unitMass.volume, 2.0, 1e-12);
    EXPECT_NEAR(inverse(below->bodyFromAsset).position.y(), -1.0, 1e-12);
    const auto above = buildMeshShape("thing", turned(flat), repairBy(MeshRepair::ground, 2.0));
    EXPECT_EQ(above->repairs.groundUp, Vec3(0, -1, 0));
    EXPECT_NEAR(inverse(above->bodyFromAsset).position.y(), 1.0, 1e-12);
    // A closed part beside the sheet has no need of a floor.
    for (const TriMesh& part : {flat, terrain()}) {
        const auto alone = buildMeshShape("thing", part, repairBy(MeshRepair::ground, 2.0));
        const auto boulder = buildMeshShape("thing", both(part, moved(cube(), Vec3(0, 3, 0))),
                                            repairBy(MeshRepair::ground, 2.0));
        EXPECT_NEAR(boulder->unitMass.volume, alone->unitMass.volume + 1.0, 1e-12);
    }
}

TEST(TortureMesh, WhatMakesNoGroundIsToldWhy)
{
    TriMesh tube = cube();
    tube.triangles = tube.triangles.leftCols(tube.triangles.cols() - 16).eval();
    const TriMesh flat = sheet(4);
    const int fin = static_cast<int>(flat.points.cols());
    const std::pair<TriMesh, const char*> cases[] = {
        {cube(), "it has no rim"},
        {tube, "its faces look to all sides alike"},
        {withTriangle(withPoint(flat, Vec3(0, 1, 0)), 6, 7, fin), "non-manifold edge"},
        {both(flat, moved(scaled(cube(), 0.5), Vec3(0.03, 0.2, 0.01))),
         "face that pierces another"},
        {TriMesh(), "no triangles"},
    };
    for (const auto& [mesh, why] : cases) {
        const std::string told = refusalOf(mesh, repairBy(MeshRepair::ground));
        EXPECT_NE(told.find(why), std::string::npos) << told;
        EXPECT_NE(told.find("'thing'"), std::string::npos);
    }
}

TEST(TortureMesh, ARoomIsTouchedWhereItIsDrawnAndEmptyWithin)
{
    const TriMesh drawn = turned(cube());
    const auto shape = buildMeshShape("thing", drawn, repairBy(MeshRepair::room, 0.25));
    EXPECT_EQ(shape->repairs.asked, MeshRepair::room);
    EXPECT_EQ(shape->repairs.behind, 0.25);
    EXPECT_TRUE(shape->repairs.harmless.isNone());
    EXPECT_NEAR(shape->unitMass.volume, 1.5 * 1.5 * 1.5 - 1.0, 1e-12);
    EXPECT_NEAR(shape->distance.value(shape->bodyFromAsset * Vec3(0, 0, 0)), 0.5, 1e-9);
    EXPECT_NEAR(shape->distance.value(shape->bodyFromAsset * Vec3(0.3, 0.1, 0)), 0.2, 1e-9);
    EXPECT_NEAR(shape->distance.value(shape->bodyFromAsset * Vec3(0.55, 0, 0)), -0.05, 1e-9);
    // A tenth of the longest edge where nothing is said; furniture stays full.
    const TriMesh furnished = both(drawn, scaled(cube(), 0.25));
    EXPECT_NEAR(buildMeshShape("thing", furnished, repairBy(MeshRepair::room))->unitMass.volume,
                1.2 * 1.2 * 1.2 - 1.0 + 0.25 * 0.25 * 0.25, 1e-12);
}

TEST(TortureMesh, WhatMakesNoRoomIsToldWhy)
{
    TriMesh open = turned(cube());
    open.triangles = open.triangles.leftCols(open.triangles.cols() - 1).eval();
    const std::pair<TriMesh, const char*> cases[] = {
        {cube(), "its faces look outward"},
        {open, "open edge"},
        {both(turned(cube()), moved(scaled(cube(), 0.5), Vec3(0.53, 0.02, 0.01))),
         "face that pierces another"},
        {TriMesh(), "no triangles"},
    };
    for (const auto& [mesh, why] : cases) {
        const std::string told = refusalOf(mesh, repairBy(MeshRepair::room));
        EXPECT_NE(told.find(why), std::string::npos) << told;
        EXPECT_NE(told.find("'thing'"), std::string::npos);
    }
}

/// The floor of a stage of one metre, the wall behind it and one beside it: parts of a cube that
/// look into it, in squares of a quarter.
TriMesh stage()
{
    const TriMesh inward = turned(makeBox(Vec3(1, 1, 1), {4, 4, 4}));
    TriMesh open = inward;
    Eigen::Index kept = 0;
    for (Eigen::Index f = 0; f < inward.triangles.cols(); ++f) {
        const Vec3 normal = cornersOf(inward, f).normal();
        if (normal.minCoeff() > -0.5) open.triangles.col(kept++) = inward.triangles.col(f);
    }
    open.triangles.conservativeResize(3, kept);
    return open;
}

TEST(TortureMesh, AStageIsTouchedWhereItIsDrawnAndAsThickBehindAllOver)
{
    const auto shape = buildMeshShape("thing", stage(), repairBy(MeshRepair::solidify, 0.1));
    EXPECT_EQ(shape->repairs.asked, MeshRepair::solidify);
    EXPECT_EQ(shape->repairs.behind, 0.1);
    // Three slabs that meet in edges and in a corner, all straight on.
    EXPECT_NEAR(shape->unitMass.volume, 1.1 * 1.1 * 1.1 - 1.0, 1e-12);
    const auto distance = [&](const Vec3& p) {
        return shape->distance.value(shape->bodyFromAsset * p);
    };
    for (const int axis : {0, 1, 2}) {
        for (const double at : {-0.45, -0.1, 0.3}) {
            Vec3 p = Vec3::Constant(at);
            p[axis] = -0.5;
            const Vec3 out = Vec3::Unit(axis);
            EXPECT_NEAR(distance(p + 0.02 * out), 0.02, 1e-9);
            EXPECT_NEAR(distance(p - 0.02 * out), -0.02, 1e-9);
            EXPECT_NEAR(distance(p - 0.12 * out), 0.02, 1e-9);
        }
    }
}

TEST(TortureMesh, ASheetThatIsSmoothGetsAThicknessThatIsEvenToo)
{
    // The inside of a quarter pipe, of which the back is a larger one.
    const int sectors = 24;
    TriMesh pipe = sheet(sectors);
    for (auto p : pipe.points.colwise()) {
        const double angle = 1.5707963267948966 * (p.x() + 0.5);
        p = Vec3(-std::cos(angle), -std::sin(angle), p.z());
    }
    if (cornersOf(pipe, 0).normal().dot(cornersOf(pipe, 0).middle()) > 0.0) pipe = turned(pipe);
    const auto shape = buildMeshShape("thing", pipe, repairBy(MeshRepair::solidify, 0.2));
    EXPECT_NEAR(shape->unitMass.volume, 0.25 * 3.14159265 * (1.2 * 1.2 - 1.0), 2e-3);
}

TEST(TortureMesh, WhatCannotBeSolidifiedIsToldWhy)
{
    const std::pair<TriMesh, const char*> cases[] = {
        {cube(), "it has no rim"},
        {both(stage(), moved(scaled(cube(), 0.5), Vec3(0.03, -0.52, 0.01))),
         "face that pierces another"},
        {TriMesh(), "no triangles"},
    };
    for (const auto& [mesh, why] : cases) {
        const std::string told = refusalOf(mesh, repairBy(MeshRepair::solidify, 0.1));
        EXPECT_NE(told.find(why), std::string::npos) << told;
        EXPECT_NE(told.find("'thing'"), std::string::npos);
    }
    // A narrow ridge has no room for half a metre behind it.
    TriMesh ridge = sheet(4);
    for (auto p : ridge.points.colwise()) p.y() = std::abs(p.x()) < 0.1 ? 0.5 : 0.0;
    EXPECT_NE(refusalOf(ridge, repairBy(MeshRepair::solidify, 0.5)).find("less thickness"),
              std::string::npos);
}

TEST(TortureMesh, ASheetCannotBeWrapped)
{
    EXPECT_NE(refusalOf(sheet(4), repairBy(MeshRepair::wrap)).find("nothing is left"),
              std::string::npos);
    EXPECT_NE(refusalOf(TriMesh(), repairBy(MeshRepair::wrap)).find("no triangles"),
              std::string::npos);
}

TEST(TortureMesh, RepairsGiveTheSameBitsOnAnyNumberOfThreads)
{
    const TriMesh mesh = both(cube(), moved(cube(), Vec3(0.61, 0.43, 0.27)));
    const RemeshSettings settings{MeshRepair::wrap, 0.0, 0.04};
    const int before = threadCount();
    setThreadCount(1);
    const TriMesh one = remeshSolid(mesh, settings, "thing");
    setThreadCount(3);
    const TriMesh three = remeshSolid(mesh, settings, "thing");
    setThreadCount(before);
    ASSERT_EQ(one.triangles.cols(), three.triangles.cols());
    EXPECT_EQ(one.triangles, three.triangles);
    EXPECT_EQ(one.points, three.points);
}

TEST(WindingNumber, IsOneInsideZeroOutsideAndAHalfInAHole)
{
    // Far clusters count as one flux: the tolerance is what the header promises.
    const WindingNumber ball(makeSphere(1.0, 3));
    EXPECT_NEAR(ball.at(Vec3(0.3, 0.2, -0.4)), 1.0, 0.02);
    EXPECT_NEAR(ball.at(Vec3(1.3, 0.2, -0.4)), 0.0, 0.02);
    EXPECT_NEAR(ball.at(Vec3(30.0, 2.0, 4.0)), 0.0, 0.02);
    // Seen from the middle of the missing face the five others fill half of all directions.
    const TriMesh open = withoutFace();
    const TriMesh whole = cube();
    Vec3 middle = Vec3::Zero();
    for (Eigen::Index f = open.triangles.cols(); f < whole.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k) middle += whole.points.col(whole.triangles(k, f)) / 24.0;
    }
    EXPECT_NEAR(WindingNumber(open).at(middle), 0.5, 0.01);
}

TEST(ShapeReport, TheFieldHoldsTheVolumeOfTheMesh)
{
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    const ShapeReport report = reportShape(*ring);
    // Twelve voxels across the tube: the rounding of edges by the trilinear cells is second order.
    EXPECT_NEAR(report.fieldVolume / report.meshVolume, 1.0, 0.01);
    EXPECT_EQ(report.parts, 1);
    EXPECT_EQ(report.triangles, 320u);
    const ShapeReport two =
        reportShape(*buildMeshShape("two", both(cube(), moved(cube(), Vec3(1.5, 0, 0)))));
    EXPECT_EQ(two.parts, 2);
    EXPECT_EQ(two.sharpEdges, 2 * 24);  // twelve edges of two segments each
}

TEST(TortureMesh, WhatIsRepairedOfAFileIsToldAsOfAnyMesh)
{
    const test::TemporaryFolder folder;
    const auto told = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        const auto shape = buildMeshShape("thing", test::importMesh((folder / name).string()));
        EXPECT_NEAR(shape->unitMass.volume, 1.0 / 6.0, 1e-7) << name;
        return describe(shape->repairs.harmless);
    };
    // A tetrahedron; of the PLY's five points two are equal. The reader of OBJ gives every face
    // points of its own, of which nothing need be said.
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n3 0 2 1\n3 4 1 3\n3 0 3 2\n3 1 2 3\n3 1 2 2\n";
    EXPECT_EQ(told("a.ply", ply),
              "merged 1 equal or unused points, dropped 1 triangles without area");
    const std::string obj =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    EXPECT_EQ(told("clean.obj", obj), "");
    EXPECT_EQ(told("flat.obj", obj + "f 1 2 2\n"), "dropped 1 triangles without area");
}

TEST(TortureMesh, TrianglesWithoutAreaAreNotWhereWhatIsDrawnIsApartFromWhatCollides)
{
    const auto shape =
        buildMeshShape("thing", withTriangle(cube(), 0, 0, 1), cube(), ShapeSettings(), nullptr);
    EXPECT_LT(shape->repairs.drawnToColliding.distance, 1e-12);  // rounding
    TriMesh line = cube();
    line.triangles.row(2) = line.triangles.row(1);
    EXPECT_THROW(buildMeshShape("thing", line, cube(), ShapeSettings(), nullptr), Error);
}

TEST(TortureMesh, FilesThatAreCutOrEmptyOrNonsenseAreRefused)
{
    const test::TemporaryFolder folder;
    const auto expectRefused = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        const test::Refusal refusal = test::refusalBy(
            [&] { buildMeshShape("thing", test::importMesh((folder / name).string())); });
        EXPECT_EQ(refusal.kind, ErrorKind::badInput) << name << ": " << refusal.message;
    };
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.glb", "a.gltf", "a.fbx"}) {
        expectRefused(name, "");
        expectRefused(name, "solid\n\x01\x02 nonsense");
    }
    expectRefused("nan.obj",
                  "v 0 0 0\nv 1 0 0\nv nan 1 0\nv 0 0 1\n"
                  "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    expectRefused("cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2");
    expectRefused("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9999\n");
}

}  // namespace
}  // namespace scree
