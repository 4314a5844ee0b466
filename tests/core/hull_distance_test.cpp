// How far apart hulls are, against edges and corners one by one.
#include "core/collision/hull_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

RelativePair boxesAt(const Shape& first, const Shape& second, const Vec3& offset, const Vec3& turn)
{
    return {first, second, exponentialMap(turn).toRotationMatrix(), offset};
}

/// Of two boxes, from the edges of each to the exact field of the other: hardly above it [m].
double distanceOfBoxes(const RelativePair& pair)
{
    double least = std::numeric_limits<double>::infinity();
    for (const RelativePair& way : {pair, pair.reversed()}) {
        for (const ConvexEdge& edge : way.first.features.edges()) {
            for (int i = 0; i <= 200; ++i) {
                const Vec3 place = edge.start + 0.005 * i * edge.length * edge.direction;
                least = std::min(least, way.second.distance.value(way * place));
            }
        }
    }
    return least;
}

TEST(HullDistance, IsNeverAboveThatOfBoxesAndCloseToIt)
{
    const auto beam = boxShape({3.0, 0.4, 0.6}, 1), cube = boxShape(Vec3::Ones(), 1);
    int apart = 0, overlapping = 0;
    for (std::uint64_t run = 0; run < 400; ++run) {
        const RelativePair pair = boxesAt(run % 2 ? *beam : *cube, run % 3 ? *cube : *beam,
                                          2.5 * signedUnits(run, 0), 3.0 * signedUnits(run, 3));
        const double distance = distanceOfBoxes(pair), bound = hullsApart(pair);
        if (distance <= 0.0) {
            EXPECT_LE(bound, 1e-12) << run;
            ++overlapping;
        } else {
            EXPECT_LE(bound, distance + 1e-12) << run;
            EXPECT_GE(bound, 0.88 * distance) << run;
            ++apart;
        }
    }
    EXPECT_GE(apart, 100);
    EXPECT_GE(overlapping, 25);
}

TEST(HullDistance, CopiesInOnePlaceAreNotApart)
{
    const auto cube = boxShape(Vec3::Ones(), 1);
    EXPECT_LT(hullsApart(boxesAt(*cube, *cube, Vec3::Zero(), Vec3::Zero())), 0.0);
}

TEST(HullDistance, IsAskedOnlyOfShapesWithFewCorners)
{
    const auto cube = boxShape(Vec3::Ones(), 1), plane = buildPlaneShape("floor");
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    EXPECT_TRUE(areHullsSmall(boxesAt(*cube, *cube, Vec3::Zero(), Vec3::Zero())));
    EXPECT_FALSE(areHullsSmall(boxesAt(*cube, *plane, Vec3::Zero(), Vec3::Zero())));
    EXPECT_FALSE(areHullsSmall(boxesAt(*ring, *cube, Vec3::Zero(), Vec3::Zero())));
}

}  // namespace
}  // namespace scree::test
