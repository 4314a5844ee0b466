#include "core/geometry/mesh_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/parallel.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/both_meshes.h"

namespace scree {
namespace {

/// Two rings, one through the wall of the other, askew.
TriMesh twoRings()
{
    const TriMesh a = makeTorus(1.0, 0.25, {40, 20});
    const TriMesh b =
        transformed(a, {Vec3(0.31, 0.17, 0.05), rotated(Quat::Identity(), Vec3(0.4, 0.9, 0.2))});
    return test::both(a, b);
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return (b - a).dot((c - a).cross(d - a));
}

/// By the signs of five volumes, of every edge and every triangle.
std::set<std::pair<int, std::pair<int, int>>> piercingByVolumes(const TriMesh& mesh)
{
    std::set<std::pair<int, int>> edges;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k)
            edges.insert(std::minmax(mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f)));
    }
    std::set<std::pair<int, std::pair<int, int>>> found;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const TriangleCorners t = cornersOf(mesh, f);
        for (const auto& edge : edges) {
            const auto corners = mesh.triangles.col(f).array();
            if ((corners == edge.first || corners == edge.second).any()) continue;
            const Vec3 p = mesh.points.col(edge.first), q = mesh.points.col(edge.second);
            if (volume(t.a, t.b, t.c, p) * volume(t.a, t.b, t.c, q) >= 0.0) continue;
            const double sides[] = {volume(p, q, t.a, t.b), volume(p, q, t.b, t.c),
                                    volume(p, q, t.c, t.a)};
            const bool isThrough = std::ranges::all_of(sides, [](double v) { return v > 0.0; }) ||
                                   std::ranges::all_of(sides, [](double v) { return v < 0.0; });
            if (isThrough) found.insert({static_cast<int>(f), edge});
        }
    }
    return found;
}

TEST(MeshCrossings, AreWhatComparingAllWithAllFindsOnAnyNumberOfThreads)
{
    const TriMesh mesh = twoRings();
    const int before = threadCount();
    setThreadCount(1);
    const std::vector<MeshCrossing> one = findCrossings(mesh);
    setThreadCount(3);
    const std::vector<MeshCrossing> three = findCrossings(mesh);
    setThreadCount(before);
    std::multiset<int> found, pierced;  // triangles
    for (const MeshCrossing& crossing : one) found.insert(crossing.triangle);
    for (const auto& [triangle, edge] : piercingByVolumes(mesh)) pierced.insert(triangle);
    EXPECT_EQ(found, pierced);
    EXPECT_GT(one.size(), 50u);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].triangle, three[i].triangle);
        EXPECT_EQ(one[i].place, three[i].place);
    }
}

// On the grid of a modelling program edges go through faces just where their triangles meet.
TEST(MeshCrossings, AreFoundWhereTrianglesBorderOnEachOther)
{
    const TriMesh cube = makeBox(Vec3::Ones(), {1, 1, 1});
    const auto shifted = [&](const Vec3& by) {
        return test::both(cube, transformed(cube, {by, Quat::Identity()}));
    };
    EXPECT_FALSE(findCrossings(shifted({0.5, 0.5, 0.5})).empty());
    const TriMesh fine = makeBox(Vec3::Ones(), {2, 2, 2});
    const TriMesh inCorners =
        test::both(fine, transformed(cube, {Vec3::Constant(0.5), Quat::Identity()}));
    EXPECT_FALSE(findCrossings(inCorners).empty());
    // Beside each other, on each other's edge, and corner to corner.
    for (const Vec3& by :
         {Vec3(1.0, 0.5, 0.5), Vec3(1.0, 0.0, 0.0), Vec3(1.0, 1.0, 0.5), Vec3(1.0, 1.0, 1.0)})
        EXPECT_TRUE(findCrossings(shifted(by)).empty()) << by.transpose();
    // An edge that lies across another just touches it.
    const Quat eighth = rotated(Quat::Identity(), Vec3(0.25 * kPi, 0.0, 0.0));
    const double reach = 0.5 + 0.5 * std::sqrt(2.0);
    const TriMesh touching = test::both(
        cube, transformed(makeBox({0.5, 1.0, 1.0}, {1, 1, 1}), {Vec3(0, reach, 0), eighth}));
    EXPECT_TRUE(findCrossings(touching).empty());
}

}  // namespace
}  // namespace scree
