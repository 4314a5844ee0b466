// What a repair keeps of a mesh.
#include "core/geometry/level_set_remesh.h"

#include <gtest/gtest.h>

#include "core/geometry/mass_properties.h"
#include "core/geometry/primitives.h"
#include "tests/support/both_meshes.h"

namespace scree {
namespace {

// Its two and a half voxels lie between nodes that are asked from afar, and which are all outside.
TEST(LevelSetRemesh, AThinPlateIsWrappedWhereverItLiesOnTheLattice)
{
    constexpr double kVoxel = 0.02;
    TriMesh plate = makeBox({1.0, 0.05, 1.0}, {1, 1, 1});
    TriMesh cube = makeBox({0.2, 0.2, 0.2}, {1, 1, 1});
    cube.points.row(0).array() -= 0.7;
    for (const double higher : {0.0, 0.01, 0.02, 0.03}) {
        cube.points.row(1).array() +=
            plate.points.row(1).minCoeff() - higher - cube.points.row(1).minCoeff();
        const RemeshSettings wrap{MeshRepair::wrap, 0.0, kVoxel};
        const TriMesh solid = remeshSolid(test::both(plate, cube), wrap, "both");
        EXPECT_NEAR(massProperties(solid).volume, 0.05 + 0.008, 0.003) << higher;
    }
}

}  // namespace
}  // namespace scree
