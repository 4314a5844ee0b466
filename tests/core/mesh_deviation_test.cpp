// How far what is drawn is from what collides, and where.
#include "core/geometry/mesh_deviation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"

namespace scree {
namespace {

TEST(MeshDeviation, TwoCubesAreFarthestApartAtACornerOfTheLarger)
{
    const TriMesh small = makeBox({1.0, 1.0, 1.0}, {1, 1, 1});
    const TriMesh large = makeBox({2.0, 2.0, 2.0}, {1, 1, 1});
    const MeshDeviation apart = farthestApart(small, large);
    EXPECT_NEAR(apart.distance, std::sqrt(0.75), 1e-12);
    EXPECT_FALSE(apart.isOnFirst);
    EXPECT_TRUE(apart.place.cwiseAbs().isApprox(Vec3::Ones(), 1e-12)) << apart.place.transpose();
    EXPECT_TRUE(farthestApart(large, small).isOnFirst);
    EXPECT_LT(farthestApart(small, small).distance, 1e-12) << "rounding alone";
}

TEST(MeshDeviation, AFaceIsFarWhereItHasNoPoint)
{
    // A slab with points at its corners alone over a ring that comes close to all of them.
    const TriMesh slab = makeBox({4.0, 1.0, 4.0}, {1, 1, 1});
    const MeshDeviation apart = farthestApart(slab, makeTorus(1.5, 0.25, {64, 32}));
    // Looks are a 64th of the box apart.
    EXPECT_NEAR(apart.distance, std::hypot(1.5, 0.5) - 0.25, 4.0 / 64.0);
    EXPECT_LT(std::hypot(apart.place.x(), apart.place.z()), 4.0 / 64.0);
}

TEST(MeshDeviation, AShapeWithACollisionMeshIsDrawnAsOneAndCollidesAsTheOther)
{
    // What is drawn is a single triangle, no solid at all.
    TriMesh leaf{Points(3, 3), Triangles(3, 1)};
    leaf.points << 0, 1, 0, 0, 0, 0, 0, 0, 1;
    leaf.triangles << 0, 1, 2;
    const TriMesh box = makeBox({2.0, 2.0, 2.0}, {2, 2, 2});
    const auto shape = buildMeshShape("leaf", leaf, box, {}, nullptr);
    EXPECT_EQ(shape->assetMesh.triangles, leaf.triangles);
    EXPECT_NEAR(shape->unitMass.volume, 8.0, 1e-9);
    EXPECT_LT(shape->distance.value(Vec3(0.9, 0.9, 0.9)), 0.0);
    EXPECT_TRUE(shape->repairs.hasCollisionMesh);
    EXPECT_NEAR(shape->repairs.drawnToColliding.distance, std::sqrt(3.0), 1e-9);
    EXPECT_FALSE(buildMeshShape("box", box)->repairs.hasCollisionMesh);
    EXPECT_THROW(buildMeshShape("leaf", box, leaf, {}, nullptr), Error);
}

TEST(MeshDeviation, OfPartsThatPierceEachOtherOnlyWhatIsSeenCounts)
{
    // Crosswise: the middle of each lies a tenth of a metre within the other.
    const TriMesh bar = makeBox({1.0, 0.2, 0.2}, {1, 1, 1});
    TriMesh cross = bar;
    cross.points.conservativeResize(3, 16);
    cross.points.rightCols(8) = bar.points;
    cross.points.rightCols(8).row(0).swap(cross.points.rightCols(8).row(1));
    cross.points.rightCols(8).row(0) *= -1.0;
    cross.triangles.conservativeResize(3, 24);
    cross.triangles.rightCols(12) = bar.triangles.array() + 8;
    ShapeSettings wrapped;
    wrapped.repair = MeshRepair::wrap;
    const auto shape = buildMeshShape("cross", cross, wrapped);
    EXPECT_GT(farthestApart(cross, shape->mesh).distance, 0.05);
    EXPECT_LE(shape->repairs.drawnToColliding.distance, 2.0 * shape->repairs.voxel);
}

}  // namespace
}  // namespace scree
