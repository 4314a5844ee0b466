// Fewer triangles for the same surface.
#include "core/geometry/mesh_decimation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/level_set_remesh.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/primitives.h"
#include "core/geometry/surface_rays.h"
#include "core/geometry/triangle_distance.h"

namespace scree {
namespace {

double farthestOff(const TriMesh& surface, const TriMesh& from)
{
    const SurfaceRays rays(surface);
    double farthest = 0.0;
    for (const auto& p : from.points.colwise()) {
        const auto nearest = cornersOf(surface, rays.closestTriangle(p));
        farthest = std::max(farthest, (p - closestOnTriangle(p, nearest).point).norm());
    }
    return farthest;
}

TEST(MeshDecimation, LeavesEveryPointWithinItsTolerance)
{
    for (const double tolerance : {0.01, 0.03}) {
        for (const TriMesh& mesh : {makeSphere(1.0, 4), makeTorus(1.0, 0.3, {96, 48})}) {
            const TriMesh few = decimatedWithin(mesh, tolerance);
            EXPECT_LT(few.triangles.cols(), mesh.triangles.cols() / 2) << tolerance;
            EXPECT_LE(farthestOff(few, mesh), 1.001 * tolerance);
            EXPECT_GT(farthestOff(few, mesh), 0.1 * tolerance);
            EXPECT_TRUE(findDefects(few, DefectSearch::topology).empty()) << tolerance;
        }
    }
    // Of what is flat only what bounds it is left.
    EXPECT_LE(decimatedWithin(makeBox({1.0, 1.0, 1.0}, {16, 16, 16}), 1e-6).triangles.cols(), 48);
}

TEST(MeshDecimation, AWrapHasNoCellsThatSayNothing)
{
    const TriMesh bar = makeBox({1.0, 0.2, 0.3}, {1, 1, 1});
    const double voxel = 1.0 / 64.0;
    const TriMesh wrapped = remeshSolid(bar, {MeshRepair::wrap, 0.0, voxel}, "bar");
    // Two triangles a cell all over.
    const double cells = 2.0 * (1.0 * 0.2 + 1.0 * 0.3 + 0.2 * 0.3) / (voxel * voxel);
    EXPECT_LT(static_cast<double>(wrapped.triangles.cols()), 0.5 * 2.0 * cells);
}

}  // namespace
}  // namespace scree
