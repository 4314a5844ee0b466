// Pairs of solids with edges sharper than square that overlap a little, against what separating
// axes say. A tip goes through such an edge and comes out behind it: then no corner is inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "core/collision/near_features.h"
#include "core/math/rotation.h"
#include "tests/support/deepest_contact.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Of the points of a shape along an axis.
std::pair<double, double> extent(const Shape& shape, const Pose& pose, const Vec3& axis)
{
    std::pair<double, double> range = {std::numeric_limits<double>::infinity(),
                                       -std::numeric_limits<double>::infinity()};
    const Points& points = shape.features.points();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const double along = axis.dot(pose * Vec3(points.col(i)));
        range = {std::min(range.first, along), std::max(range.second, along)};
    }
    return range;
}

/// The shortest way by which two convex shapes come apart [m]; negative when they are.
double overlapOfConvex(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB)
{
    double least = std::numeric_limits<double>::infinity();
    const auto tryAxis = [&](const Vec3& axis) {
        if (axis.norm() < 1e-6) return;
        const auto [lowA, highA] = extent(a, poseA, axis.normalized());
        const auto [lowB, highB] = extent(b, poseB, axis.normalized());
        least = std::min({least, highA - lowB, highB - lowA});
    };
    for (const ConvexEdge& ofA : a.features.edges()) {
        for (const Vec3& normal : ofA.faceNormal) tryAxis(poseA.orientation * normal);
        for (const ConvexEdge& ofB : b.features.edges())
            tryAxis((poseA.orientation * ofA.direction).cross(poseB.orientation * ofB.direction));
    }
    for (const ConvexEdge& ofB : b.features.edges())
        for (const Vec3& normal : ofB.faceNormal) tryAxis(poseB.orientation * normal);
    return least;
}

// Of overlaps of a hundredth one in 270 had been told as less than half of what it is, mostly not
// at all; one in 3000 is left. One in 500 is told as half as deep again.
TEST(SharpPairs, FewSlightOverlapsAreToldAsLessThanHalfOrMuchMoreThanSeparatingAxesSay)
{
    constexpr int kDraws = 3000;
    const std::array shapes = {prismShape(), splinterShape()};
    int missed = 0, tooDeep = 0;
    for (std::uint64_t i = 0; i < kDraws; ++i) {
        const Shape &a = *shapes[i % 2], &b = *shapes[i / 2 % 2];
        const double smaller = std::min(a.boundingRadius, b.boundingRadius), depth = 0.01 * smaller;
        const Vec3 aside = 0.7 * smaller * signedUnits(i, 9), way = signedUnits(i, 6).normalized();
        const Pose poseA{Vec3::Zero(), exponentialMap(3.0 * signedUnits(i, 0))};
        Pose poseB{aside, exponentialMap(3.0 * signedUnits(i, 3))};
        if (overlapOfConvex(a, poseA, b, poseB) < depth) continue;
        double near = 0.0, far = a.boundingRadius + b.boundingRadius + aside.norm();
        for (int n = 0; n < 20; ++n) {
            const double middle = 0.5 * (near + far);
            poseB.position = aside + middle * way;
            (overlapOfConvex(a, poseA, b, poseB) > depth ? near : far) = middle;
        }
        const double told = deepestContact(a, poseA, b, poseB);
        missed += told < 0.5 * depth;
        tooDeep += told > 1.5 * depth;
    }
    EXPECT_LE(missed, kDraws / 1000);
    EXPECT_LE(tooDeep, kDraws / 250);
}

// Seen in a bin, where nothing was told of them until they had locked. By a way that edges of both
// tell the splinters come apart after 4.4 mm and an edge lies 3.5 mm inside.
TEST(SharpPairs, SplintersWhoseEdgesCrossAtATipAreToldOf)
{
    const auto splinter = splinterShape();
    const Pose a{{-0.569475655051267, 0.173578325093944, 0.00767022909243177},
                 Quat(-0.472122576598276, 0.239358384838603, 0.227936854164766, -0.817222507513793)
                     .normalized()};
    const Pose b{{-0.436546635656135, 0.346421023300703, 0.321165827565695},
                 Quat(0.453882803544977, -0.399652867207957, 0.793758128328224, -0.0649308870375774)
                     .normalized()};
    EXPECT_NEAR(overlapOfConvex(*splinter, a, *splinter, b), 0.0044, 1e-4);
    const double told = deepestContact(*splinter, a, *splinter, b);
    EXPECT_GT(told, 0.003);
    EXPECT_LT(told, 0.0044);
}

}  // namespace
}  // namespace scree::test
