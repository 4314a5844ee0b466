// The world box of a placed shape: all of it, and little else.
#include <gtest/gtest.h>

#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "tests/support/draw.h"

namespace scree {
namespace {

using Shapes = std::vector<std::shared_ptr<const Shape>>;

/// Flat, long, stout, with a corner that sticks out, and exact.
Shapes someShapes()
{
    TriMesh spike = makeBox({1.0, 1.0, 1.0}, {1, 1, 1});
    spike.points.col(0) *= 3.0;
    const ExactSolid rod = ExactSolid::cylinder(0.1, 2.0), brick = ExactSolid::box({1.0, 2.0, 3.0}),
                     ball = ExactSolid::sphere(0.5);
    return {buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10})),
            buildMeshShape("rod", makeCylinder(0.1, 2.0, 20, 4)),
            buildMeshShape("cube", makeBox({1.0, 1.0, 1.0}, {1, 1, 1})),
            buildMeshShape("spike", spike),
            buildExactShape("exact rod", rod, makeCylinder(0.1, 2.0, 20, 4), {}),
            buildExactShape("brick", brick, makeBox({1.0, 2.0, 3.0}, {1, 1, 1}), {}),
            buildExactShape("ball", ball, makeSphere(0.5, 2), {})};
}

/// Anyhow for i > 0; the first stands straight.
Pose poseOf(std::uint64_t i)
{
    if (i == 0) return {Vec3(0.1, 0.2, 0.3), Quat::Identity()};
    const Vec3 part = test::signedUnits(2 * i, 3);
    return {test::signedUnits(2 * i, 0),
            Quat(test::signedUnit(2 * i, 6), part.x(), part.y(), part.z()).normalized()};
}

/// The smallest.
Aabb boxOfPoints(const Shape& shape, const Pose& pose)
{
    Aabb box;
    for (Eigen::Index v = 0; v < shape.mesh.points.cols(); ++v)
        box.include(pose * Vec3(shape.mesh.points.col(v)));
    return box;
}

TEST(ShapeBox, HoldsAllOfTheShapeHoweverItIsTurned)
{
    constexpr double kRounding = 1e-14;
    for (const auto& shape : someShapes()) {
        SCOPED_TRACE(shape->name);
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const Aabb box = boxAt(*shape, poseOf(i)).grown(kRounding);
            ASSERT_TRUE(box.contains(boxOfPoints(*shape, poseOf(i)))) << "pose " << i;
        }
    }
}

TEST(ShapeBox, HoldsLittleBesidesWhatIsFlatLongOrRound)
{
    for (const auto& shape : someShapes()) {
        if (shape->name == "spike" || shape->name == "cube" || shape->name == "brick") continue;
        SCOPED_TRACE(shape->name);
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const Vec3 size = boxAt(*shape, poseOf(i)).size();
            const Vec3 least = boxOfPoints(*shape, poseOf(i)).size();
            // A tube ends round where a cylinder has an edge; facets are a little smaller.
            ASSERT_LT(size.cwiseQuotient(least).maxCoeff(), 1.16) << "pose " << i;
        }
    }
}

}  // namespace
}  // namespace scree
