// The edges of a mesh: each once, with all the triangles that it is a side of.
#include "core/geometry/mesh_edges.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "core/geometry/primitives.h"

namespace scree::test {
namespace {

TEST(MeshEdges, AreMetOnceAndAscendingWithTheSidesOfTheirTriangles)
{
    const TriMesh mesh = makeTorus(1.0, 0.25, {16, 10});
    std::map<std::pair<int, int>, std::vector<int>> sidesOf;  // triangle and corner in one number
    for (int f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const int from = mesh.triangles(k, f), to = mesh.triangles((k + 1) % 3, f);
            sidesOf[std::minmax(from, to)].push_back(3 * f + k);
        }
    }
    auto expected = sidesOf.begin();
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        ASSERT_NE(expected, sidesOf.end());
        std::vector<int> found;
        for (const TriangleSide& side : sides) {
            EXPECT_EQ(std::pair(side.low, side.high), expected->first);
            EXPECT_EQ(mesh.triangles(side.corner, side.triangle), side.isUp ? side.low : side.high);
            found.push_back(3 * side.triangle + side.corner);
        }
        EXPECT_EQ(found, expected->second);
        ++expected;
    });
    EXPECT_EQ(expected, sidesOf.end());
}

TEST(MeshEdges, OfOpenAndCrowdedMeshesHaveAnyNumberOfSides)
{
    // Three triangles on one edge, and one beside them.
    const TriMesh mesh{Points::Random(3, 8),
                       (Triangles(3, 4) << 0, 1, 0, 5, 1, 0, 1, 6, 2, 3, 4, 7).finished()};
    std::vector<std::size_t> counts;
    MeshEdges(mesh).forEach(
        [&](std::span<const TriangleSide> sides) { counts.push_back(sides.size()); });
    EXPECT_EQ(counts, (std::vector<std::size_t>{3, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
}

}  // namespace
}  // namespace scree::test
