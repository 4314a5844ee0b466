#include "render/view_fit.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(FitDepth, CutsOffNeitherNearNorFarBodies)
{
    Camera camera;
    camera.eye = {0, 0, 100};
    const std::vector<Ball> bodies = {{{0, 0, 60}, 2.0}, {{5, 0, -300}, 4.0}};
    const DepthRange range = fitDepth(camera, 1.5, bodies, {}, 50.0);
    EXPECT_LE(range.nearest, 38.0);
    EXPECT_GE(range.nearest, 30.0);
    EXPECT_GE(range.farthest, 404.0);
}

TEST(FitDepth, GroundAtTheLowerBorderOfThePictureIsKept)
{
    Camera camera;
    camera.eye = {0, 1, 50};
    camera.target = {0, 1, 0};
    camera.fovDegrees = 60.0;
    const DepthRange range = fitDepth(camera, 1.0, {}, {{Vec3::Zero(), Vec3::UnitY()}}, 300.0);
    EXPECT_LE(range.nearest, 1.0 / std::tan(30.0 * 3.14159265 / 180.0));
}

TEST(FitDepthMap, HoldsAllCastersAndLeavesATexelFreeAroundThem)
{
    // Readers take the outermost texels for what is beyond the map: a caster in them would smear.
    for (int k = 0; k < 200; ++k) {
        const std::vector<Ball> casters = {{{-3 + 0.1 * k, 1, 2}, 1.0}, {{8, 20, -4}, 2.0}};
        const Vec3 sun(0.3, 0.8 - 0.003 * k, 0.5);
        const double margin = k % 2 ? 0.7 : 0.0;
        const DepthMapFit fit = fitDepthMap(sun, casters, Points(3, 0), margin, 0.0, 64 + k);
        for (const Ball& ball : casters) {
            const Vec3 clip = (fit.clipFromWorld * ball.centre.homogeneous()).hnormalized();
            const double radius = (ball.radius + margin) * 2.0 / (fit.size * fit.texel);
            EXPECT_LE(clip.head<2>().cwiseAbs().maxCoeff() + radius, 1.0 - 2.0 / fit.size + 1e-9);
            const double depth = ball.radius * 2.0 / fit.depth;
            EXPECT_LE(std::abs(clip.z()) + depth, 1.0 + 1e-9);
        }
    }
}

TEST(FitDepthMap, WithoutCastersItIsStillAMap)
{
    // Happened: a shot of a bare ground had texels of no size, and the ground came out white.
    const DepthMapFit fit = fitDepthMap(Vec3::UnitY(), {}, Points(3, 0), 0.0, 0.0, 1024);
    EXPECT_GT(fit.texel, 1e-6);
    EXPECT_TRUE(fit.clipFromWorld.cast<float>().allFinite());
}

TEST(FitDepthMap, TexelsStayWhereTheyAreWhenTheHeapMoves)
{
    const Vec3 sun(0.3, 0.8, 0.5);
    const DepthMapFit before = fitDepthMap(sun, {{{0, 1, 0}, 9.0}}, Points(3, 0), 0.0, 0.0, 1024);
    const DepthMapFit after =
        fitDepthMap(sun, {{{0.13, 1.2, 0.07}, 8.97}}, Points(3, 0), 0.0, 0.0, 1024);
    ASSERT_EQ(before.texel, after.texel);
    const Eigen::Vector4d place = Vec3(0.4, 0.0, -1.7).homogeneous();
    for (int row = 0; row < 2; ++row) {
        const double texelBefore = 0.5 * before.size * before.clipFromWorld.row(row).dot(place);
        const double texelAfter = 0.5 * after.size * after.clipFromWorld.row(row).dot(place);
        const double shift = texelAfter - texelBefore;
        EXPECT_NEAR(shift, std::round(shift), 1e-6);
    }
}

TEST(FitDepthMap, SpendsNoTexelsOnCastersBesideThePicture)
{
    const std::vector<Ball> casters = {{{0, 0, 0}, 1.0}, {{500, 0, 0}, 1.0}};
    Points visible(3, 2);
    visible << -2, 2, -2, 2, -2, 2;
    const DepthMapFit wide = fitDepthMap(Vec3::UnitY(), casters, Points(3, 0), 0.0, 0.0, 1024);
    const DepthMapFit fitted = fitDepthMap(Vec3::UnitY(), casters, visible, 0.0, 0.0, 1024);
    EXPECT_LT(fitted.texel, 0.05 * wide.texel);
}

}  // namespace
}  // namespace scree
