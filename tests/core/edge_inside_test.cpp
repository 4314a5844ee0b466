// How deep an edge lies in another body, against the field asked everywhere along it.
#include "core/collision/edge_inside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// By a thousand places along the edge [m].
double deepestOfMany(const RelativePair& pair, const ConvexEdge& edge)
{
    constexpr int kPlaces = 1000;
    double deepest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kPlaces; ++i) {
        const Vec3 place = edge.start + edge.length * i / kPlaces * edge.direction;
        deepest = std::min(deepest, pair.second.distance.value(pair * place));
    }
    return deepest;
}

TEST(EdgeInside, IsAsDeepAsTheDeepestPlaceAlongTheEdge)
{
    const std::array shapes = {buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10})), starShape(),
                               splinterShape(),
                               buildMeshShape("box", makeBox({1.0, 0.7, 0.4}, {2, 2, 2}))};
    int deep = 0;
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Shape &first = *shapes[i % 4], &second = *shapes[i / 4 % 4];
        const Mat3 rotation = exponentialMap(3.0 * signedUnits(i, 0)).toRotationMatrix();
        const RelativePair pair{first, second, rotation,
                                0.8 * second.boundingRadius * signedUnits(i, 3)};
        const double enough = -0.01 * first.boundingRadius * std::abs(signedUnit(i, 6)) - 1e-3;
        for (const ConvexEdge& edge : first.features.edges()) {
            const double expected = deepestOfMany(pair, edge);
            const double found = deepestAlong(pair, edge, enough);
            const double tolerance = 5e-3 * edge.length;
            if (expected < enough - tolerance) {
                ++deep;
                EXPECT_LE(found, expected + tolerance) << i;
            }
            if (found < enough) {
                EXPECT_GE(found, expected - tolerance) << i;
            }
        }
    }
    EXPECT_GT(deep, 1000);
}

// Asked without a least way along them this takes hours.
TEST(EdgeInside, EdgesThatLieAllAlongAFaceComeWithinWhatIsAskedOrNot)
{
    const auto box = buildMeshShape("box", makeBox({1e3, 1e3, 1e3}, {1, 1, 1}));
    const double apart = 1e-9;
    const RelativePair pair{*box, *box, Mat3::Identity(), Vec3(200.0, 1e3 + apart, 100.0)};
    int near = 0;
    for (const ConvexEdge& edge : box->features.edges()) {
        EXPECT_FALSE(comesWithin(pair, edge, 0.0));
        EXPECT_FALSE(comesWithin(pair, edge, 0.5 * apart));
        near += comesWithin(pair, edge, 2.0 * apart);
    }
    // Two of the four below, and the one that stands where these meet; the others are beside.
    EXPECT_EQ(near, 3);
}

// Flush with each other: edges lie in faces, where a ray meets nothing or anything.
TEST(EdgeInside, EdgesOfBoxesFlushWithEachOtherAreAsDeepAsTheBoxesOverlap)
{
    const auto box = buildMeshShape("box", makeBox({1.0, 0.7, 0.4}, {2, 2, 2}));
    for (const double sunk : {0.0, 1e-9, 0.002, 0.01}) {
        const RelativePair pair{*box, *box, Mat3::Identity(), Vec3(0.1, 0.2, 0.4 - sunk)};
        double deepest = 0.0;
        for (const ConvexEdge& edge : box->features.edges())
            deepest = std::min(deepest, deepestAlong(pair, edge, -0.001));
        if (sunk > 0.001) {
            EXPECT_NEAR(deepest, -sunk, 1e-9);
        } else {
            EXPECT_GE(deepest, -0.001);
        }
    }
}

}  // namespace
}  // namespace scree::test
