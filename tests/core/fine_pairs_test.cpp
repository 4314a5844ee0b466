// Pairs of fine meshes: what lies deep in them is told by their corners and by edges that cross,
// without any that are passed beyond their ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/deepest_contact.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

const Vec3 kHalfAxes(0.5, 0.35, 0.28);

std::shared_ptr<const Shape> ellipsoid()
{
    static const auto shape = [] {
        TriMesh mesh = makeSphere(1.0, 3);
        mesh.points = kHalfAxes.asDiagonal() * mesh.points;
        return buildMeshShape("ellipsoid", mesh);
    }();
    return shape;
}

/// By how much two ellipsoids overlap along a direction from the first to the second [m].
double overlapAlong(const Vec3& n, const Pose& a, const Pose& b)
{
    const auto reach = [&](const Pose& pose) {
        return kHalfAxes.cwiseProduct(pose.orientation.conjugate() * n).norm();
    };
    return reach(a) + reach(b) - n.dot(b.position - a.position);
}

/// The shortest way by which they come apart [m].
double overlapOf(const Pose& a, const Pose& b, std::uint64_t draw)
{
    Vec3 best = (b.position - a.position).normalized();
    for (std::uint64_t i = 0; i < 400; ++i) {
        const double step = i < 200 ? 1.0 : 0.1;
        const Vec3 n = (best + step * signedUnits(draw, 1000 + 3 * i)).normalized();
        if (overlapAlong(n, a, b) < overlapAlong(best, a, b)) best = n;
    }
    return overlapAlong(best, a, b);
}

TEST(FinePairs, HowDeepEllipsoidsOverlapIsTold)
{
    for (const double share : {0.005, 0.02, 0.1}) {
        const double depth = share * kHalfAxes.minCoeff();
        for (std::uint64_t i = 0; i < 200; ++i) {
            const Pose a{Vec3::Zero(), exponentialMap(3.0 * signedUnits(i, 0))};
            Pose b{Vec3::Zero(), exponentialMap(3.0 * signedUnits(i, 3))};
            const Vec3 way = signedUnits(i, 6).normalized();
            double near = 0.0, far = 2.0 * kHalfAxes.maxCoeff();
            for (int n = 0; n < 20; ++n) {
                const double middle = 0.5 * (near + far);
                b.position = middle * way;
                (overlapOf(a, b, i) > depth ? near : far) = middle;
            }
            const Pose own = inverse(ellipsoid()->bodyFromAsset);
            const double told = deepestContact(*ellipsoid(), a * own, *ellipsoid(), b * own);
            EXPECT_GT(told, 0.5 * depth) << share << ' ' << i;
            EXPECT_LT(told, 1.5 * depth) << share << ' ' << i;
        }
    }
}

TEST(FinePairs, AnEdgeEndsFineWhereAllBendsOutwardByALittle)
{
    const auto countFine = [](const Shape& shape) {
        int fine = 0;
        for (const ConvexEdge& edge : shape.features.edges()) {
            for (const int end : {0, 1}) fine += edge.endsFine[end];
        }
        return fine;
    };
    const auto endsOf = [](const Shape& shape) {
        return 2 * static_cast<int>(shape.features.edges().size());
    };
    EXPECT_EQ(countFine(*ellipsoid()), endsOf(*ellipsoid()));
    EXPECT_EQ(countFine(*boxShape({1.0, 1.0, 1.0}, 1)), 0);
    EXPECT_EQ(countFine(*starShape()), 0);
    // Where a ring is hollow an edge of another may lie in a notch.
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    for (const ConvexEdge& edge : ring->features.edges()) {
        for (const int end : {0, 1}) {
            const Vec3 place =
                inverse(ring->bodyFromAsset) * ring->features.points().col(edge.ends[end]);
            const double fromAxis = std::hypot(place.x(), place.z());
            if (fromAxis > 0.9 && fromAxis < 1.1) continue;
            EXPECT_EQ(edge.endsFine[end], fromAxis > 1.0) << fromAxis;
        }
    }
}

}  // namespace
}  // namespace scree::test
