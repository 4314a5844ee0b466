// How deep convex bodies are in each other, against all axes there are.
#include "core/collision/convex_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

std::vector<std::shared_ptr<const Shape>> convexShapes()
{
    return {boxShape({0.5, 0.3, 0.4}, 1), boxShape(Vec3::Constant(0.4), 2), prismShape(),
            splinterShape(), buildMeshShape("pebble", makeSphere(0.3, 0))};
}

/// By how much the corners of two bodies overlap along an axis, one way or the other.
double overlapAlong(const Points& a, const Points& b, const Vec3& axis)
{
    const Eigen::RowVectorXd ofA = axis.transpose() * a, ofB = axis.transpose() * b;
    return std::min(ofA.maxCoeff() - ofB.minCoeff(), ofB.maxCoeff() - ofA.minCoeff());
}

/// The shortest way out, by the normals of all faces and what is across any two edges.
double leastOverlap(const RelativePair& pair)
{
    const Points a = (pair.rotation * pair.first.features.points()).colwise() + pair.translation;
    const Points& b = pair.second.features.points();
    double least = std::numeric_limits<double>::infinity();
    const auto ask = [&](const Vec3& axis) {
        if (axis.norm() > 1e-6) least = std::min(least, overlapAlong(a, b, axis.normalized()));
    };
    for (const ConvexEdge& ofA : pair.first.features.edges()) {
        for (const Vec3& n : ofA.faceNormal) ask(pair.rotation * n);
        for (const ConvexEdge& ofB : pair.second.features.edges()) {
            for (const Vec3& n : ofB.faceNormal) ask(n);
            ask((pair.rotation * ofA.direction).cross(ofB.direction));
        }
    }
    return least;
}

TEST(ConvexOverlap, IsTheShortestWayOutOfAllAxes)
{
    const auto shapes = convexShapes();
    int overlapping = 0, byEdges = 0;
    for (std::uint64_t k = 0; k < 600; ++k) {
        const Shape& a = *shapes[randomIndex(shapes.size(), 61, k)];
        const Shape& b = *shapes[randomIndex(shapes.size(), 62, k)];
        const RelativePair pair{a, b,
                                exponentialMap(3.0 * signedUnits(63, 3 * k)).toRotationMatrix(),
                                0.3 * signedUnits(64, 3 * k)};
        const double least = leastOverlap(pair);
        const auto found = overlapOfConvex(pair);
        ASSERT_EQ(found.has_value(), least > 0.0) << k;
        if (!found) continue;
        ++overlapping;
        // A face may speak for two edges that are as near.
        EXPECT_NEAR(-found->gap, least, 1.1e-3 * least) << k;
        const RelativePair moved{a, b, pair.rotation,
                                 pair.translation - 1.0001 * found->gap * found->normal};
        EXPECT_FALSE(overlapOfConvex(moved)) << k;
        const auto isNormal = [&](const Vec3& n) {
            return std::abs(n.dot(found->normal)) > 0.9999;
        };
        const auto isOfFace = [&](const Shape& shape, const Mat3& rotation) {
            return std::ranges::any_of(shape.features.edges(), [&](const ConvexEdge& edge) {
                return isNormal(rotation * edge.faceNormal[0]) ||
                       isNormal(rotation * edge.faceNormal[1]);
            });
        };
        byEdges += !isOfFace(a, pair.rotation) && !isOfFace(b, Mat3::Identity());
    }
    EXPECT_GT(overlapping, 200);
    EXPECT_GT(byEdges, 20);
}

TEST(ConvexOverlap, KnowsWhatIsConvex)
{
    for (const auto& shape : convexShapes()) EXPECT_TRUE(shape->features.isConvex()) << shape->name;
    for (const auto& shape : {starShape(), angleShape(), binShape(0.3, 1.2),
                              buildMeshShape("ring", makeTorus(1.0, 0.25, {6, 5})),
                              buildMeshShape("ball", makeSphere(0.3, 3))})
        EXPECT_FALSE(shape->features.isConvex()) << shape->name;
}

}  // namespace
}  // namespace scree::test
