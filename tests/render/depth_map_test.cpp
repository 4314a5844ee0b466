#include "render/depth_map.h"

#include <gtest/gtest.h>

#include "core/geometry/primitives.h"

namespace scree {
namespace {

constexpr int kSize = 64;

ShadedMesh shaded(const TriMesh& mesh)
{
    return shadeMesh({"mesh", mesh.points, mesh.triangles});
}

/// Looks down from y = 4 to y = −4 on a square of 4 by 4 about the origin: x right, −z up.
Mat4 fromAbove()
{
    Mat4 clip = Mat4::Zero();
    clip(0, 0) = 0.5;
    clip(1, 2) = -0.5;
    clip(2, 1) = -0.25;
    clip(3, 3) = 1.0;
    return clip;
}

DepthMap mapOf(const TriMesh& mesh, const Mat4& clipFromAsset = fromAbove())
{
    DepthMap map;
    clearDepths(map, kSize);
    drawDepths(map, shaded(mesh), clipFromAsset, 0.0);
    return map;
}

TEST(DepthMap, ABoxHidesTheTexelsItCoversAtTheDepthOfItsTop)
{
    const DepthMap map = mapOf(makeBox({2, 2, 1}, {3, 3, 3}));
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            // 16 texels a unit: the top spans columns 16 … 47 and rows 24 … 39.
            const bool isCovered = x >= 16 && x < 48 && y >= 24 && y < 40;
            // Its top is 3 below the eye of a map that is 8 deep.
            EXPECT_NEAR(map.depths[y * kSize + x], isCovered ? 0.375f : 1.0f, 1e-6f)
                << x << ' ' << y;
        }
    }
}

TEST(DepthMap, ASlopeIsSetBackByTheDepthItGainsFromTexelToTexelAlongItsSteeperAxis)
{
    // A triangle that rises by 2 along x and by 1/2 along z: 1/64 and 1/256 of the depth a texel.
    TriMesh slope{Points(3, 3), Triangles(3, 1)};
    slope.points << -1, 1, -1, -2.25, 1.75, -1.75, -1, -1, 0;
    slope.triangles << 0, 2, 1;
    DepthMap flush, setBack;
    for (DepthMap* map : {&flush, &setBack}) {
        clearDepths(*map, kSize);
        drawDepths(*map, shaded(slope), fromAbove(), map == &setBack ? 2.0 : 0.0);
    }
    int covered = 0;
    for (std::size_t i = 0; i < flush.depths.size(); ++i) {
        if (flush.depths[i] == 1.0f) continue;
        ++covered;
        EXPECT_NEAR(setBack.depths[i] - flush.depths[i], 2.0 / 64.0, 1e-6) << i;
    }
    EXPECT_GT(covered, 100);
}

TEST(DepthMap, NoEdgeBetweenTrianglesLeavesAGap)
{
    // A sphere turned any way: every texel well inside its outline is covered, at its height.
    Mat4 turn = Mat4::Identity();
    turn.topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const DepthMap map = mapOf(makeSphere(1.5, 4), fromAbove() * turn);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double u = (x + 0.5) / 16.0 - 2.0, v = (y + 0.5) / 16.0 - 2.0;
            const double distance = std::hypot(u, v);
            if (distance > 1.45) continue;
            const double top = std::sqrt(1.5 * 1.5 - distance * distance);
            // Facets of a sphere of 5120 triangles lie up to 0.4 % of its radius inside; where it
            // is steep that counts several times.
            EXPECT_NEAR(map.depths[y * kSize + x], (4.0 - top) / 8.0, 0.006) << x << ' ' << y;
        }
    }
}

TEST(DepthMap, PlanesReachEveryTexelAndFaceTheLight)
{
    DepthMap map;
    clearDepths(map, kSize);
    drawPlaneDepths(map, {Vec3(0, -1, 0), -Vec3::UnitY()}, fromAbove());
    EXPECT_EQ(map.depths.front(), 1.0f);  // seen from behind
    drawPlaneDepths(map, {Vec3(0, -1, 0), Vec3(-1, 2, 0)}, fromAbove());
    // The plane rises by half of x; its height at x = -2 + 1/32 is -1 - 63/64.
    EXPECT_NEAR(map.depths.front(), (4.0 + 1.0 + 63.0 / 64.0) / 8.0, 1e-6);
    EXPECT_NEAR(map.depths[kSize - 1], (4.0 + 1.0 - 63.0 / 64.0) / 8.0, 1e-6);
}

TEST(DepthMap, BoundsHoldForEveryTexelWithinATile)
{
    const DepthMap map = mapOf(makeSphere(1.3, 3));
    const DepthBounds bounds = boundDepths(map);
    ASSERT_EQ(bounds.size, kSize / DepthBounds::kTileTexels);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const int tile = y / 8 * bounds.size + x / 8;
            for (int dy = -8; dy <= 8; dy += 4) {
                for (int dx = -8; dx <= 8; dx += 4) {
                    const bool isInside =
                        x + dx >= 0 && x + dx < kSize && y + dy >= 0 && y + dy < kSize;
                    const float depth = isInside ? map.depths[(y + dy) * kSize + x + dx] : 1.0f;
                    EXPECT_GE(depth, bounds.values[2 * tile]);
                    EXPECT_LE(depth, bounds.values[2 * tile + 1]);
                }
            }
        }
    }
    EXPECT_EQ(bounds.values[0], 1.0f);  // nothing is near the corner
}

TEST(DepthMap, ABlurKeepsAConstantAndTheSumOfASpot)
{
    DepthMap map;
    clearDepths(map, kSize);
    map.depths[32 * kSize + 32] = 0.0f;
    const DepthMoments moments = blurred(momentsOf(map), 2);
    double missing = 0.0;
    for (std::size_t i = 0; i < map.depths.size(); ++i) missing += 1.0 - moments.values[2 * i];
    EXPECT_NEAR(missing, 1.0, 1e-3);  // 4096 sums in single precision
    EXPECT_NEAR(moments.values[0], 1.0f, 1e-6f);
    EXPECT_LT(moments.values[2 * (32 * kSize + 42)], 1.0f);  // 5 taps of 2 texels away
    EXPECT_NEAR(moments.values[2 * (32 * kSize + 43)], 1.0f, 1e-6f);
}

}  // namespace
}  // namespace scree
