// What lies around a point and beyond an edge.
#include "core/geometry/mesh_fans.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/primitives.h"

namespace scree {
namespace {

TEST(MeshFans, BeyondAnEdgeLiesTheOtherTriangleThatHasBothEnds)
{
    const TriMesh mesh = makeTorus(1.0, 0.25, {8, 6});
    const MeshFans fans(mesh);
    ASSERT_EQ(fans.triangleCount(), mesh.triangles.cols());
    for (std::int32_t f = 0; f < fans.triangleCount(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t other = fans.beyond(f)[k];
            ASSERT_GE(other, 0);
            EXPECT_NE(other, f);
            for (const int end : {(k + 1) % 3, (k + 2) % 3}) {
                const int vertex = mesh.triangles(end, f);
                EXPECT_TRUE((mesh.triangles.col(other).array() == vertex).any()) << f << " " << k;
            }
        }
    }
}

TEST(MeshFans, AroundAPointLieAllTrianglesThatHaveIt)
{
    const TriMesh mesh = makeTorus(1.0, 0.25, {8, 6});
    const MeshFans fans(mesh);
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh.points.cols()); ++v) {
        EXPECT_EQ(fans.around(v).size(), 6u);  // of a grid cut along its diagonals
        EXPECT_TRUE(std::ranges::is_sorted(fans.around(v)));
        for (const std::int32_t f : fans.around(v))
            EXPECT_TRUE((mesh.triangles.col(f).array() == v).any());
    }
}

}  // namespace
}  // namespace scree
